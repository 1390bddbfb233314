#include <array>
#include <stdexcept>
#include <string>

#include "render/files/files.h"
#include "render/image/io_module.h"
#include "render/image/load_io_module.h"
#include "render/image/write.h"

namespace likeness::image {

std::string png_bytes(const DisplayPicture& picture) {
  static const auto kEncode = reinterpret_cast<likeness_encode_png_function>(io_function(kEncodePngName));
  std::string bytes;
  std::array<char, 512> error{};
  const auto sink = [](void* state, const void* data, size_t size) {
    static_cast<std::string*>(state)->assign(static_cast<const char*>(data), size);
  };
  if (kEncode(picture.rgb.data(), picture.width, picture.height, sink, &bytes, error.data(), error.size()) != 0)
    throw std::runtime_error("PNG of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                             " pixels: " + error.data());
  return bytes;
}

void write_png(const std::filesystem::path& file, const DisplayPicture& picture) {
  files::write_whole(file, png_bytes(picture));
}

}  // namespace likeness::image
