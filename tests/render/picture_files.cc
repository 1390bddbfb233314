#include "tests/render/picture_files.h"

#include <cstddef>
#include <cstring>

namespace likeness::image::test {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 255);
  return out;
}

std::uint32_t crc32(const std::string& bytes) {  // of the PNG specification, annex D
  std::uint32_t crc = ~0u;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = (crc & 1) != 0 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
  }
  return ~crc;
}

std::uint32_t adler32(const std::string& bytes) {
  std::uint32_t a = 1, b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

std::string chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(crc32(type + data));
}

}  // namespace

std::string png_file(int width, int height, int bits, int color_type, const std::vector<std::uint16_t>& samples) {
  std::string lines;
  const std::size_t row = samples.size() / static_cast<std::size_t>(height);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % row == 0) lines += '\0';  // no filter
    if (bits == 16) lines += static_cast<char>(samples[i] >> 8);
    lines += static_cast<char>(samples[i] & 255);
  }
  // One stored block of deflate holds at most 65535 bytes.
  const auto size = static_cast<std::uint16_t>(lines.size());
  std::string zlib = "\x78\x01\x01";
  for (const int v : {size & 255, size >> 8, ~size & 255, ~size >> 8 & 255}) zlib += static_cast<char>(v);
  zlib += lines + big_endian(adler32(lines));
  std::string header = big_endian(static_cast<std::uint32_t>(width)) + big_endian(static_cast<std::uint32_t>(height));
  header += static_cast<char>(bits);
  header += static_cast<char>(color_type);
  header += std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", zlib) + chunk("IEND", "");
}

std::string tga_file(int width, int height, const std::vector<std::uint8_t>& samples, bool is_top_first) {
  const std::size_t channels = samples.size() / static_cast<std::size_t>(width * height);
  std::string out(18, '\0');
  out[2] = 2;  // uncompressed RGB
  out[12] = static_cast<char>(width);
  out[14] = static_cast<char>(height);
  out[16] = static_cast<char>(8 * channels);
  out[17] = static_cast<char>((channels == 4 ? 8 : 0) + (is_top_first ? 0x20 : 0));
  for (int line = 0; line < height; ++line) {
    const int y = is_top_first ? line : height - 1 - line;
    for (int x = 0; x < width; ++x) {
      const std::uint8_t* const p = samples.data() + static_cast<std::size_t>(y * width + x) * channels;
      out += static_cast<char>(p[2]);
      out += static_cast<char>(p[1]);
      out += static_cast<char>(p[0]);
      if (channels == 4) out += static_cast<char>(p[3]);
    }
  }
  if (channels < 4) return out;
  // The footer of TGA 2 needs an extension area that says what the alpha is: 3, useful and not multiplied in.
  std::string extension(495, '\0');
  extension[0] = static_cast<char>(495 & 255);
  extension[1] = static_cast<char>(495 >> 8);
  extension[494] = 3;
  const auto at = static_cast<std::uint32_t>(out.size());
  out += extension;
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(at >> shift & 255);
  return out + std::string(4, '\0') + "TRUEVISION-XFILE." + std::string(1, '\0');
}

std::string pfm_file(int width, int height, int channels, const std::vector<float>& samples) {
  std::string out =
      (channels == 3 ? "PF\n" : "Pf\n") + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  for (int y = height - 1; y >= 0; --y)
    out.append(reinterpret_cast<const char*>(samples.data() + static_cast<std::size_t>(y) * row), 4 * row);
  return out;
}

std::string hdr_file(int width, int height, const std::vector<std::uint8_t>& rgbe) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n" +
         std::string(rgbe.begin(), rgbe.end());
}

std::string jpeg_file() {
  const auto segment = [](int marker, const std::string& data) {
    std::string out = "\xff";
    out += static_cast<char>(marker);
    out += static_cast<char>((data.size() + 2) >> 8);
    out += static_cast<char>((data.size() + 2) & 255);
    return out + data;
  };
  using namespace std::string_literals;
  // Every quantiser is 8, so the DC coefficient is the mean less 128: 64 is category 7 with the bits 1000000. Each
  // Huffman table has one code of one bit, category 7 and end of block: 0 1000000 0, filled up with ones.
  const std::string one_code = "\1"s + std::string(15, '\0');
  return "\xff\xd8"s + segment(0xdb, "\0"s + std::string(64, '\x8')) + segment(0xc0, "\x8\0\x8\0\x8\1\1\x11\0"s) +
         segment(0xc4, "\0"s + one_code + "\7"s) + segment(0xc4, "\x10"s + one_code + "\0"s) +
         segment(0xda, "\1\1\0\0\x3f\0"s) + "\x40\x7f\xff\xd9"s;
}

}  // namespace likeness::image::test
