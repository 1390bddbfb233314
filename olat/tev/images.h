#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "olat/tev/packet.h"
#include "render/image/picture.h"

namespace likeness::olat_tev {

// The pictures that were received, by their names, up to a number of bytes: the one that nobody wrote to for the longest
// goes first. Any thread.
class Images {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 29;
  static constexpr std::size_t kMostImages = 256;

  explicit Images(std::size_t most_bytes = kMostBytes) : most_bytes_(most_bytes) {}

  // What a packet says. What it says of a picture that is not here, or beyond its border, changes nothing. Throws
  // files::InputError: a picture larger than all that is kept.
  void take(const Packet& packet);

  struct Known {
    std::string name;
    std::uint64_t version = 0;  // changes with each packet
  };
  std::vector<Known> list() const;
  std::optional<std::uint64_t> version(const std::string& name) const;

  // Linear Rec. 709, as tev takes it: of the channels R, G and B, or what ends in .R, .G and .B; of pictures without them the
  // first channel as grey. NaN stays. Nothing for a name that is not here.
  std::optional<image::Picture> picture(const std::string& name) const;

  std::size_t bytes() const;

 private:
  struct Image {
    int width = 0, height = 0;
    std::vector<std::string> channels;
    std::vector<std::uint8_t> target;  // of each channel: 0, 1, 2; 3: all three; 4: none
    std::vector<float> rgb;
    std::uint64_t version = 0;
  };
  void create(const Create& create);
  void update(const Update& update);

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::map<std::string, Image> images_;
  std::size_t bytes_ = 0;
  std::uint64_t last_version_ = 0;
};

}  // namespace likeness::olat_tev
