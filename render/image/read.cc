#include "render/image/read.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "render/files/files.h"
#include "render/files/module.h"
#include "render/image/io_module.h"
#include "render/image/read_exr.h"
#include "render/image/tone_curve.h"

namespace likeness::image {
namespace {

using files::InputError;

constexpr const char* kFormats = "EXR, PNG, JPEG, TIFF, TGA, HDR, PFM, PNM, BMP, WebP, DDS, PSD, DNG";

struct Signature {
  std::string_view bytes;
  const char* format;  // OpenImageIO's name
};
constexpr std::array kSignatures{
    Signature{"\x89PNG\r\n\x1a\n", "png"},
    Signature{"\xff\xd8\xff", "jpeg"},
    Signature{{"II*\0", 4}, "tiff"},
    Signature{{"MM\0*", 4}, "tiff"},
    Signature{{"II+\0", 4}, "tiff"},
    Signature{{"MM\0+", 4}, "tiff"},
    Signature{"#?", "hdr"},
    Signature{"DDS ", "dds"},
    Signature{"8BPS", "psd"},
    Signature{"BM", "bmp"},
    Signature{"PF\n", "pnm"},
    Signature{"Pf\n", "pnm"},
    Signature{"PF ", "pnm"},
    Signature{"Pf ", "pnm"},
};

bool is_tga(std::string_view bytes, const std::string& name) {
  const std::size_t dot = name.rfind('.');
  std::string extension = dot == name.npos ? "" : name.substr(dot + 1);
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == "tga" || bytes.ends_with(std::string_view("TRUEVISION-XFILE.\0", 18));
}

// OpenImageIO's name of the format; null if it is none that is read.
const char* format_of(std::string_view bytes, const std::string& name) {
  for (const Signature& s : kSignatures)
    if (bytes.starts_with(s.bytes)) return std::string_view(s.format) == "tiff" && is_dng(bytes) ? "raw" : s.format;
  if (bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.substr(8, 4) == "WEBP") return "webp";
  if (bytes.size() > 3 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
      std::isspace(static_cast<unsigned char>(bytes[2])))
    return "pnm";
  return is_tga(bytes, name) ? "targa" : nullptr;
}

struct Place {
  Texels texels;
  std::size_t most_texels;
};

// Called from the module, through C: no exception may leave it.
void* place(void* state, int width, int height, int channels, int is_float, char* error, size_t error_size) noexcept {
  Place& to = *static_cast<Place*>(state);
  if (width < 1 || height < 1 || width > kLongestSide || height > kLongestSide ||
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > to.most_texels) {
    std::snprintf(error, error_size, "%d x %d pixels; at most %zu pixels and %d a side are allowed", width, height,
                  to.most_texels, kLongestSide);
    return nullptr;
  }
  if (channels < 1 || channels > 4) {
    std::snprintf(error, error_size, "%d channels; 1 to 4 are allowed", channels);
    return nullptr;
  }
  try {
    to.texels.width = width;
    to.texels.height = height;
    to.texels.channels = channels;
    const std::size_t count = to.texels.count() * static_cast<std::size_t>(channels);
    if (is_float != 0) {
      to.texels.floats.resize(count);
      return to.texels.floats.data();
    }
    to.texels.bytes.resize(count);
    return to.texels.bytes.data();
  } catch (const std::bad_alloc&) {
    std::snprintf(error, error_size, "%d x %d pixels, for which there is no memory", width, height);
    return nullptr;
  }
}

Texels decode_other(const char* format, std::string_view bytes, const std::string& name, const ReadOptions& options) {
  static constexpr files::Module kIoModule{kIoModuleFile, "pictures other than EXR", "OpenImageIO"};
  static const auto kDecode =
      reinterpret_cast<likeness_decode_function>(files::module_function(kIoModule, kDecodeName));
  Place to{{}, options.most_texels};
  std::array<char, 512> error{};
  if (kDecode(format, bytes.data(), bytes.size(), place, &to, error.data(), error.size()) != 0) {
    std::string cause = error.data();
    while (!cause.empty() && std::isspace(static_cast<unsigned char>(cause.back()))) cause.pop_back();
    for (char& c : cause)
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    throw InputError(name + ": " + format + " cannot be read (" + (cause.empty() ? "damaged" : cause) + ")");
  }
  return std::move(to.texels);
}

}  // namespace

// Its first directory has the tag DNGVersion (Adobe, DNG 1.7, chapter 4).
bool is_dng(std::string_view bytes) {
  const bool is_little = bytes.starts_with("II");
  if (!is_little && !bytes.starts_with("MM")) return false;
  const auto number = [&](std::size_t at, std::size_t size) {
    std::size_t out = 0;
    for (std::size_t i = 0; i < size && at + size <= bytes.size(); ++i)
      out = out << 8 | static_cast<unsigned char>(bytes[is_little ? at + size - 1 - i : at + i]);
    return out;
  };
  const std::size_t directory = number(4, 4);
  if (directory + 2 > bytes.size()) return false;
  constexpr std::size_t kRow = 12, kDngVersion = 50706;
  for (std::size_t i = 0, count = number(directory, 2); i < count; ++i)
    if (number(directory + 2 + kRow * i, 2) == kDngVersion) return true;
  return false;
}

Texels decode_texels(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  if (is_exr(bytes)) return decode_exr(bytes, name, options);
  if (bytes.empty()) throw InputError(name + ": is empty; expected a picture (" + kFormats + ")");
  const char* const format = format_of(bytes, name);
  if (!format) throw InputError(name + ": is no picture that is known (" + kFormats + ")");
  if (!options.layer.empty())
    throw InputError(name + ": " + format + " has no layers; " + files::in_quotes(options.layer) + " was asked for");
  return decode_other(format, bytes, name, options);
}

Texels decode_mosaic(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  if (!is_dng(bytes)) throw InputError(name + ": is no DNG; camera raw files of other kinds are to be converted to it");
  Texels texels = decode_other("mosaic", bytes, name, options);
  if (texels.channels != 1)
    throw InputError(name + ": has no mosaic, but " + std::to_string(texels.channels) + " channels");
  if (texels.floats.empty()) texels.floats.assign(texels.bytes.begin(), texels.bytes.end()), texels.bytes.clear();
  else
    for (float& v : texels.floats) v = std::round(65535 * v);
  return texels;
}

Texels read_texels(const std::filesystem::path& file, const ReadOptions& options) {
  return decode_texels(files::read_whole(file, kMostFileBytes), file.string(), options);
}

Picture read_picture(const std::filesystem::path& file, const ReadOptions& options) {
  return picture_of(read_texels(file, options));
}

Picture picture_of(Texels texels) {
  std::array<float, 256> decoded{};
  for (std::size_t k = 0; k < 256; ++k) decoded[k] = static_cast<float>(srgb_decode8(static_cast<std::uint8_t>(k)));
  if (texels.channels == 3 && texels.bytes.empty()) {
    Picture same;
    same.width = texels.width;
    same.height = texels.height;
    same.rgb = std::move(texels.floats);
    return same;
  }
  Picture out(texels.width, texels.height);
  const auto channels = static_cast<std::size_t>(texels.channels);
  for (std::size_t i = 0; i < texels.count(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t from = i * channels + (channels < 3 ? 0 : c);
      out.rgb[3 * i + c] = texels.bytes.empty() ? texels.floats[from] : decoded[texels.bytes[from]];
    }
  return out;
}

}  // namespace likeness::image
