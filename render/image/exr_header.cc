#include "render/image/exr_header.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "render/files/files.h"

namespace likeness::image {
namespace {

struct TypeSize {
  std::string_view type;
  std::uint32_t size;
};
constexpr std::array kSizes{
    TypeSize{"box2f", 16},      TypeSize{"box2i", 16},   TypeSize{"chromaticities", 32},
    TypeSize{"compression", 1}, TypeSize{"double", 8},   TypeSize{"envmap", 1},
    TypeSize{"float", 4},       TypeSize{"int", 4},      TypeSize{"keycode", 28},
    TypeSize{"m33d", 72},       TypeSize{"m33f", 36},    TypeSize{"m44d", 128},
    TypeSize{"lineOrder", 1},   TypeSize{"m44f", 64},    TypeSize{"rational", 8},
    TypeSize{"tiledesc", 9},    TypeSize{"timecode", 8}, TypeSize{"v2d", 16},
    TypeSize{"v2f", 8},         TypeSize{"v2i", 8},      TypeSize{"v3d", 24},
    TypeSize{"v3f", 12},        TypeSize{"v3i", 12},     TypeSize{"deepImageState", 1},
};

// Little endian words and texts one after another; empty where they end.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
  std::size_t left() const { return bytes_.size(); }
  bool is_at_zero() const { return !bytes_.empty() && bytes_[0] == 0; }
  std::optional<std::string_view> text() {
    const std::size_t end = bytes_.find('\0');
    if (end == bytes_.npos) return {};
    const std::string_view out = bytes_.substr(0, end);
    bytes_.remove_prefix(end + 1);
    return out;
  }
  std::optional<std::uint32_t> word() {
    const std::optional<std::string_view> four = take(4);
    if (!four) return {};
    std::uint32_t out = 0;
    for (std::size_t i = 0; i < 4; ++i) out |= std::uint32_t{static_cast<unsigned char>((*four)[i])} << (8 * i);
    return out;
  }
  std::optional<std::string_view> take(std::size_t count) {
    if (count > bytes_.size()) return {};
    const std::string_view out = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return out;
  }

 private:
  std::string_view bytes_;
};

bool fills_channel_list(Bytes value) {
  constexpr std::size_t kChannel = 16;  // type, linearity, sampling
  while (value.left() > 0 && !value.is_at_zero())
    if (!value.text() || !value.take(kChannel)) return false;
  return value.left() == 1;
}

bool fills_texts(Bytes value) {
  while (value.left() > 0) {
    const std::optional<std::uint32_t> length = value.word();
    if (!length || !value.take(*length)) return false;
  }
  return true;
}

bool fills_preview(Bytes value) {
  const std::optional<std::uint32_t> width = value.word(), height = value.word();
  return width && height && std::uint64_t{*width} < 1 << 16 && std::uint64_t{*height} < 1 << 16 &&
         4 * std::uint64_t{*width} * *height == value.left();
}

bool is_sound(std::string_view type, std::string_view value) {
  if (type == "chlist") return fills_channel_list(Bytes(value));
  if (type == "stringvector") return fills_texts(Bytes(value));
  if (type == "preview") return fills_preview(Bytes(value));
  if (type == "floatvector") return value.size() % 4 == 0;
  if (type == "idmanifest") return false;
  const auto* const row = std::ranges::find(kSizes, type, &TypeSize::type);
  return row == kSizes.end() || row->size == value.size();
}

}  // namespace

void check_exr_header(std::string_view bytes, const std::string& name) {
  const auto refuse = [&](const std::string& cause) {
    throw files::InputError(name + ": EXR cannot be read (" + cause + ")");
  };
  constexpr const char* kEnds = "it ends within its header";
  constexpr std::size_t kStart = 8;  // magic number, and version with flags
  if (bytes.size() <= kStart) refuse(kEnds);
  const bool has_parts = (static_cast<unsigned char>(bytes[5]) & 0x10) != 0;
  Bytes rest(bytes.substr(kStart));
  // A header is a list of name, type, size and value, and ends with an empty name; parts end with an empty header.
  do {
    while (!rest.is_at_zero()) {
      const std::optional<std::string_view> attribute = rest.text();
      const std::optional<std::string_view> type = attribute ? rest.text() : std::nullopt;
      const std::optional<std::uint32_t> size = type ? rest.word() : std::nullopt;
      if (!size) {
        refuse(kEnds);
        return;
      }
      const std::size_t left = rest.left();
      const std::optional<std::string_view> value = rest.take(*size);
      if (!value)
        refuse("attribute " + files::in_quotes(*attribute) + " has " + std::to_string(*size) + " bytes, the file has " +
               std::to_string(left) + " left");
      else if (!is_sound(*type, *value))
        refuse("attribute " + files::in_quotes(*attribute) + " of " + std::to_string(*size) + " bytes is no " +
               files::in_quotes(*type));
    }
    rest.take(1);
  } while (has_parts && rest.left() > 0 && !rest.is_at_zero());
}

}  // namespace likeness::image
