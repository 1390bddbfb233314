#pragma once

#include <ImfHeader.h>
#include <ImfInputPart.h>

#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace likeness::image {

// Where the values of a channel go: that of pixel i of the display window to first[i * stride]. Where the data window
// leaves the display window bare, nothing is written.
struct ChannelTarget {
  std::string name;
  float* first = nullptr;
  std::size_t stride = 1;
};

// OpenEXR allocates its table of lines or tiles by the header's size before anybody can look at that: to be called
// before a file is opened. The limit is of the process.
void limit_exr_headers();

// Threads to open a file with: as many as the machine has, which OpenEXR shares among all files of the process. It
// compresses 32 MB/s on each.
int exr_threads();

// Refuses, with files::InputError, sizes beyond kLongestSide and `most_texels`, and what needs too much memory for a
// block of lines. `name` begins the message.
void check_exr_windows(const Imf::Header& header, const std::string& name, std::size_t most_texels);

// Refuses channels that are not stored at every pixel.
void check_exr_sampling(const Imf::Header& header, const std::string& channel, const std::string& name);

// All channels in one pass, as floats.
void read_channels(Imf::InputPart& part, std::span<const ChannelTarget> targets);

// Calls `read` and makes one InputError, "name: EXR cannot be read (cause)", of whatever else it throws.
void with_exr_errors(const std::string& name, const std::function<void()>& read);

}  // namespace likeness::image
