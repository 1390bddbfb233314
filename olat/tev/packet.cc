#include "olat/tev/packet.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "render/files/files.h"

namespace likeness::olat_tev {
namespace {

static_assert(std::endian::native == std::endian::little);

[[noreturn]] void refuse(const std::string& text) { throw files::InputError("tev: " + text); }

class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}

  template <class Number>
  Number number() {
    if (left_.size() < sizeof(Number)) refuse("a packet ends too early");
    Number out;
    std::memcpy(&out, left_.data(), sizeof out);
    left_.remove_prefix(sizeof out);
    return out;
  }
  std::string text() {
    const std::size_t end = left_.substr(0, kLongestName + 1).find('\0');
    if (end == left_.npos)
      refuse("a packet has a name without an end, or of more than " + std::to_string(kLongestName) + " bytes");
    std::string out(left_.substr(0, end));
    left_.remove_prefix(end + 1);
    return out;
  }
  int within(const char* what, int low, int high) {
    const auto value = number<std::int32_t>();
    if (value < low || value > high)
      refuse(std::string(what) + " " + std::to_string(value) + " is not from " + std::to_string(low) + " to " +
             std::to_string(high));
    return value;
  }
  std::vector<std::string> names(int count) {
    std::vector<std::string> out;
    for (int i = 0; i < count; ++i) out.push_back(text());
    return out;
  }
  std::string_view left() const { return left_; }

 private:
  std::string_view left_;
};

Create create_of(Reader& in) {
  Create out;
  in.number<std::uint8_t>();  // to the front or not
  out.name = in.text();
  out.width = in.within("width", 1, kLongestSide);
  out.height = in.within("height", 1, kLongestSide);
  out.channels = in.names(in.within("number of channels", 1, kMostChannels));
  return out;
}

Update update_of(Reader& in, Type type) {
  Update out;
  in.number<std::uint8_t>();
  out.name = in.text();
  const int channels = type == Type::kUpdate ? 1 : in.within("number of channels", 1, kMostChannels);
  out.channels = in.names(channels);
  out.x = in.within("x", 0, kLongestSide - 1);
  out.y = in.within("y", 0, kLongestSide - 1);
  out.width = in.within("width", 1, kLongestSide);
  out.height = in.within("height", 1, kLongestSide);
  const std::int64_t pixels = std::int64_t{out.width} * out.height;
  for (int c = 0; c < channels; ++c) {
    out.offsets.push_back(type == Type::kUpdate3 ? in.number<std::int64_t>() : c * pixels);
    out.strides.push_back(1);
  }
  for (int c = 0; c < channels && type == Type::kUpdate3; ++c)
    out.strides[static_cast<std::size_t>(c)] = in.number<std::int64_t>();
  const auto found = static_cast<std::int64_t>(in.left().size() / sizeof(float));
  for (std::size_t c = 0; c < out.offsets.size(); ++c) {
    // Neither is beyond the packet's 2^24 floats, and there are at most 2^28 pixels: the product fits.
    const bool fits = out.offsets[c] >= 0 && out.offsets[c] < found && out.strides[c] >= 0 && out.strides[c] <= found &&
                      out.offsets[c] + (pixels - 1) * out.strides[c] < found;
    if (!fits)
      refuse("channel " + files::in_quotes(out.channels[c]) + " of " + std::to_string(out.width) + " x " +
             std::to_string(out.height) + " pixels is not within the " + std::to_string(found) +
             " values of the packet");
  }
  out.values.resize(static_cast<std::size_t>(found));
  std::memcpy(out.values.data(), in.left().data(), out.values.size() * sizeof(float));
  return out;
}

class Writer {
 public:
  explicit Writer(Type type) : out_(4, '\0') { out_ += static_cast<char>(type); }
  template <class Number>
  Writer& number(Number value) {
    out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Writer& text(const std::string& text) {
    out_.append(text.c_str(), text.size() + 1);
    return *this;
  }
  std::string& raw() { return out_; }
  std::string whole() {
    const auto length = static_cast<std::uint32_t>(out_.size());
    std::memcpy(out_.data(), &length, sizeof length);
    return std::move(out_);
  }

 private:
  std::string out_;
};

}  // namespace

std::size_t length_of(std::string_view bytes) {
  const auto length = Reader(bytes).number<std::uint32_t>();
  if (length < 5 || length > kMostPacket)
    refuse("a packet of " + std::to_string(length) + " bytes; 5 to " + std::to_string(kMostPacket) + " are allowed");
  return length;
}

Packet packet_of(std::string_view bytes) {
  if (length_of(bytes) != bytes.size()) refuse("a packet is not as long as it says");
  Reader in(bytes.substr(4));
  const auto type = static_cast<Type>(in.number<std::uint8_t>());
  switch (type) {
    case Type::kOpen:
    case Type::kReload:
    case Type::kOpen2:
    case Type::kVector:
      return Ignored{};
    case Type::kClose:
      return Close{in.text()};
    case Type::kCreate:
      return create_of(in);
    case Type::kUpdate:
    case Type::kUpdate2:
    case Type::kUpdate3:
      return update_of(in, type);
  }
  refuse("type " + std::to_string(static_cast<int>(type)) + " of a packet is not known");
}

std::string bytes_of(const Create& create) {
  Writer out(Type::kCreate);
  out.number<std::uint8_t>(1).text(create.name);
  out.number<std::int32_t>(create.width).number<std::int32_t>(create.height);
  out.number(static_cast<std::int32_t>(create.channels.size()));
  for (const std::string& channel : create.channels) out.text(channel);
  return out.whole();
}

std::string bytes_of(const Update& update) {
  Writer out(Type::kUpdate3);
  out.number<std::uint8_t>(0).text(update.name).number(static_cast<std::int32_t>(update.channels.size()));
  for (const std::string& channel : update.channels) out.text(channel);
  for (const int v : {update.x, update.y, update.width, update.height}) out.number<std::int32_t>(v);
  for (const std::int64_t offset : update.offsets) out.number(offset);
  for (const std::int64_t stride : update.strides) out.number(stride);
  out.raw().append(reinterpret_cast<const char*>(update.values.data()), update.values.size() * sizeof(float));
  return out.whole();
}

std::string bytes_of(const Close& close) { return Writer(Type::kClose).text(close.name).whole(); }

}  // namespace likeness::olat_tev
