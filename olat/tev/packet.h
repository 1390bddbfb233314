#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

// The protocol by which renderers show pictures in tev (Tom94/tev, src/Ipc.cpp): over TCP, packets of
//
//   u32 length, itself included | u8 type | payload
//
// little-endian; a text ends with a NUL, a flag is a byte, numbers are i32, offsets and strides i64, values f32. Every
// number of a packet is checked before memory is asked for by it.
namespace likeness::olat_tev {

enum class Type : unsigned char {
  kOpen = 0,
  kReload = 1,
  kClose = 2,
  kUpdate = 3,  // one channel
  kCreate = 4,
  kUpdate2 = 5,  // planes, one after the other
  kUpdate3 = 6,  // channels by offset and stride
  kOpen2 = 7,
  kVector = 8,
};

inline constexpr std::size_t kMostPacket = std::size_t{64} << 20;  // bytes
inline constexpr int kLongestSide = 16384;                         // of a picture
inline constexpr int kMostChannels = 64;
inline constexpr std::size_t kLongestName = 1024;
inline constexpr std::string_view kTevAddress = "127.0.0.1:14158";     // where tev listens
inline constexpr std::string_view kListenAddress = "127.0.0.1:14159";  // where we do, beside it

struct Create {
  std::string name;
  int width = 0, height = 0;
  std::vector<std::string> channels;
};

// Of channel c and pixel i of the rectangle: values[offsets[c] + i * strides[c]], all within the packet.
struct Update {
  std::string name;
  std::vector<std::string> channels;
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<std::int64_t> offsets, strides;
  std::vector<float> values;
};

struct Close {
  std::string name;
};

// What asks for files or draws lines: understood, and nothing is done.
struct Ignored {};

using Packet = std::variant<Ignored, Create, Update, Close>;

// A whole packet with its length. Throws files::InputError, one line beginning "tev: ", for what is none.
Packet packet_of(std::string_view bytes);

// The length that a packet's first four bytes state. Throws files::InputError below 5 and beyond kMostPacket.
std::size_t length_of(std::string_view bytes);

std::string bytes_of(const Create& create);
std::string bytes_of(const Update& update);  // kUpdate3
std::string bytes_of(const Close& close);

}  // namespace likeness::olat_tev
