#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The tags of a TIFF in memory (TIFF 6.0, chapter 2), which is what EXIF and DNG keep their facts in. Nothing is believed: what
// points outside of the bytes is not there.
namespace likeness::photograph {

class TiffTags {
 public:
  // A directory by where its bytes begin.
  using Directory = std::size_t;
  static constexpr std::size_t kMostNumbers = 4096, kMostDirectories = 64;

  // Nothing if the bytes do not begin as a TIFF does.
  static std::optional<TiffTags> of(std::string_view bytes);

  // The first directory, those that follow it, and the sub-directories (tag 330) of them.
  const std::vector<Directory>& directories() const { return directories_; }

  // The numbers of a tag, rationals divided (x / 0 is left out with the whole tag), at most kMostNumbers; empty if there is no
  // such tag, if it is text or if it points outside.
  std::vector<double> numbers(Directory directory, std::uint16_t tag) const;
  std::optional<double> number(Directory directory, std::uint16_t tag) const;
  // Printable characters only, without blanks at the end.
  std::string text(Directory directory, std::uint16_t tag) const;
  // The directory that a tag (34665: EXIF) points to.
  std::optional<Directory> pointed(Directory directory, std::uint16_t tag) const;

 private:
  struct Row {
    std::size_t type = 0, count = 0, at = 0;
  };
  std::uint64_t whole(std::size_t at, std::size_t size) const;  // 0 beyond the end
  std::optional<Row> row(Directory directory, std::uint16_t tag) const;

  std::string_view bytes_;
  bool is_little_ = true;
  std::vector<Directory> directories_;
};

// How a picture was taken, as far as its file says: of JPEG and TIFF (DNG too) by EXIF, of EXR by its attributes.
struct Taken {
  std::optional<double> exposure_s, f_number, iso;  // above 0
};
// `name` begins the message of files::InputError, for an EXR with a damaged header. Of other files nothing is known.
Taken taken_of(std::string_view bytes, const std::string& name);

}  // namespace likeness::photograph
