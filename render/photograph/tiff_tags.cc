#include "render/photograph/tiff_tags.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "render/image/exr_exposure.h"

namespace likeness::photograph {
namespace {

constexpr std::size_t kRowBytes = 12;
// Bytes of each TIFF type: BYTE ASCII SHORT LONG RATIONAL SBYTE UNDEFINED SSHORT SLONG SRATIONAL FLOAT DOUBLE IFD.
constexpr std::array<std::size_t, 14> kSizes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};

std::optional<double> above_0(std::optional<double> value) {
  return value && *value > 0 && std::isfinite(*value) ? value : std::nullopt;
}

// The TIFF within a JPEG's segment APP1 "Exif"; empty if there is none.
std::string_view exif_of_jpeg(std::string_view bytes) {
  for (std::size_t at = 2; at + 4 <= bytes.size() && bytes[at] == '\xff';) {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    const std::size_t length = static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + 2])) << 8 |
                               static_cast<unsigned char>(bytes[at + 3]);
    if (marker == 0xda || length < 2) break;  // pixels begin
    const std::string_view segment = bytes.substr(at + 4, length - 2);
    constexpr std::string_view kExif("Exif\0\0", 6);
    if (marker == 0xe1 && segment.starts_with(kExif)) return segment.substr(kExif.size());
    at += 2 + length;
  }
  return {};
}

}  // namespace

std::optional<TiffTags> TiffTags::of(std::string_view bytes) {
  TiffTags out;
  out.bytes_ = bytes;
  if (bytes.starts_with(std::string_view("II*\0", 4))) out.is_little_ = true;
  else if (bytes.starts_with(std::string_view("MM\0*", 4))) out.is_little_ = false;
  else return std::nullopt;
  const auto add = [&](std::uint64_t at) {
    const bool is_new = std::ranges::find(out.directories_, at) == out.directories_.end();
    if (at < 8 || at + 2 > bytes.size() || !is_new || out.directories_.size() >= kMostDirectories) return false;
    out.directories_.push_back(at);
    return true;
  };
  for (std::uint64_t at = out.whole(4, 4); add(at);) at = out.whole(at + 2 + kRowBytes * out.whole(at, 2), 4);
  constexpr std::uint16_t kSubDirectories = 330;
  for (std::size_t i = 0, firsts = out.directories_.size(); i < firsts; ++i)
    for (const double at : out.numbers(out.directories_[i], kSubDirectories))
      add(static_cast<std::uint64_t>(std::abs(at)));
  return out;
}

std::uint64_t TiffTags::whole(std::size_t at, std::size_t size) const {
  if (at > bytes_.size() || size > bytes_.size() - at) return 0;
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < size; ++i)
    out = out << 8 | static_cast<unsigned char>(bytes_[is_little_ ? at + size - 1 - i : at + i]);
  return out;
}

std::optional<TiffTags::Row> TiffTags::row(Directory directory, std::uint16_t tag) const {
  const std::uint64_t rows = whole(directory, 2);
  for (std::uint64_t i = 0; i < rows; ++i) {
    const std::size_t at = directory + 2 + kRowBytes * i;
    if (at + kRowBytes > bytes_.size()) break;
    if (whole(at, 2) != tag) continue;
    Row out{whole(at + 2, 2), whole(at + 4, 4), at + 8};
    if (out.type == 0 || out.type >= kSizes.size()) return std::nullopt;
    const std::size_t size = kSizes[out.type] * out.count;
    if (size > 4) out.at = whole(at + 8, 4);
    if (out.at > bytes_.size() || size > bytes_.size() - out.at) return std::nullopt;
    return out;
  }
  return std::nullopt;
}

std::vector<double> TiffTags::numbers(Directory directory, std::uint16_t tag) const {
  const std::optional<Row> found = row(directory, tag);
  constexpr std::size_t kAscii = 2;
  if (!found || found->type == kAscii) return {};
  std::vector<double> out;
  for (std::size_t i = 0, size = kSizes[found->type]; i < std::min(found->count, kMostNumbers); ++i) {
    const std::size_t at = found->at + size * i;
    const auto long_at = [&](std::size_t from, bool is_signed) {
      const auto value = static_cast<std::uint32_t>(whole(from, 4));
      return is_signed ? static_cast<double>(static_cast<std::int32_t>(value)) : static_cast<double>(value);
    };
    switch (found->type) {
      case 6:
        out.push_back(static_cast<std::int8_t>(whole(at, 1)));
        break;
      case 8:
        out.push_back(static_cast<std::int16_t>(whole(at, 2)));
        break;
      case 9:
        out.push_back(long_at(at, true));
        break;
      case 5:
      case 10: {
        const double below = long_at(at + 4, found->type == 10);
        if (below == 0) return {};
        out.push_back(long_at(at, found->type == 10) / below);
        break;
      }
      case 11:
        out.push_back(static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(whole(at, 4)))));
        break;
      case 12:
        out.push_back(std::bit_cast<double>(whole(at, 8)));
        break;
      default:
        out.push_back(static_cast<double>(whole(at, size)));
    }
    if (!std::isfinite(out.back())) return {};
  }
  return out;
}

std::optional<double> TiffTags::number(Directory directory, std::uint16_t tag) const {
  const std::vector<double> all = numbers(directory, tag);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

std::string TiffTags::text(Directory directory, std::uint16_t tag) const {
  const std::optional<Row> found = row(directory, tag);
  if (!found || kSizes[found->type] != 1) return {};
  std::string out;
  for (const char c : bytes_.substr(found->at, std::min<std::size_t>(found->count, 200))) {
    if (c == '\0') break;
    out += c >= ' ' && c <= '~' ? c : '?';
  }
  out.erase(out.find_last_not_of(' ') + 1);
  return out;
}

std::optional<TiffTags::Directory> TiffTags::pointed(Directory directory, std::uint16_t tag) const {
  const std::optional<double> at = number(directory, tag);
  if (!at || !(*at >= 8) || !(*at + 2 <= static_cast<double>(bytes_.size()))) return std::nullopt;
  return static_cast<Directory>(*at);
}

Taken taken_of(std::string_view bytes, const std::string& name) {
  Taken out;
  const image::ExrExposure exr = image::exposure_of_exr(bytes, name);
  if (exr.exposure_s || exr.f_number || exr.iso)
    return {above_0(exr.exposure_s), above_0(exr.f_number), above_0(exr.iso)};
  if (bytes.starts_with("\xff\xd8")) bytes = exif_of_jpeg(bytes);
  const std::optional<TiffTags> tags = TiffTags::of(bytes);
  if (!tags || tags->directories().empty()) return out;
  constexpr std::uint16_t kExif = 34665, kExposureTime = 33434, kFNumber = 33437, kIso = 34855;
  const TiffTags::Directory first = tags->directories().front();
  for (const TiffTags::Directory directory : {tags->pointed(first, kExif).value_or(first), first}) {
    if (!out.exposure_s) out.exposure_s = above_0(tags->number(directory, kExposureTime));
    if (!out.f_number) out.f_number = above_0(tags->number(directory, kFNumber));
    if (!out.iso) out.iso = above_0(tags->number(directory, kIso));
  }
  return out;
}

}  // namespace likeness::photograph
