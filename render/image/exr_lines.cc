#include "render/image/exr_lines.h"

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfPartType.h>
#include <half.h>
#include <libdeflate.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace likeness::image {
namespace {

// A channel as it lies in a line of a block, and where its values go.
struct Stored {
  std::size_t at = 0;  // from the start of the line [byte]
  Imf::PixelType type = Imf::HALF;
  ChannelTarget target;
};

struct Block {
  int first = 0, lines = 0;  // from the top of the data window
  const char* bytes = nullptr;
  std::size_t size = 0;
};

std::size_t size_of(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

// Lines of a block, or 0 for a part of another kind.
int lines_of_block(const Imf::Header& header) {
  if (header.hasTileDescription() || (header.hasType() && header.type() != Imf::SCANLINEIMAGE)) return 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1) return 0;
  switch (header.compression()) {
    case Imf::NO_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
      return 16;
    default:
      return 0;
  }
}

// Inflates into `deflated`, and undoes what ZIP is preceded by: bytes of even places come first, then those of odd ones, and
// each is a difference to the one before, plus 128.
void unzip(const Block& block, std::vector<unsigned char>& deflated, std::vector<unsigned char>& out) {
  const std::size_t size = out.size(), even = (size + 1) / 2;
  deflated.resize(size);
  thread_local const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflater(
      libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  if (!inflater) throw std::bad_alloc();
  // Without a place for the size that was found, any other is an error.
  if (libdeflate_zlib_decompress(inflater.get(), block.bytes, block.size, deflated.data(), size, nullptr) !=
      LIBDEFLATE_SUCCESS)
    throw std::runtime_error("the block of line " + std::to_string(block.first) + " is damaged");
  const unsigned char *const a = deflated.data(), *const b = a + even;
  const auto next = [](unsigned before, unsigned difference) { return (before + difference + 128) & 255; };
  unsigned low = a[0], high = a[0];
  for (std::size_t i = 1; i < even; ++i) high = next(high, a[i]);  // two chains, so that neither waits for the other
  out[0] = a[0];
  for (std::size_t i = 0; i < size - even; ++i) {
    if (i > 0) out[2 * i] = static_cast<unsigned char>(low = next(low, a[i]));
    out[2 * i + 1] = static_cast<unsigned char>(high = next(high, b[i]));
  }
  if (size % 2 == 1 && size > 1) out[size - 1] = static_cast<unsigned char>(next(low, a[even - 1]));
}

// EXR is little-endian, and so are the machines that OpenEXR's own fast paths are for; others take the slow way.
template <class Value, class Number>
void spread(const unsigned char* from, std::size_t count, float* to, std::size_t stride, Number number) {
  for (std::size_t i = 0; i < count; ++i) {
    Value value;
    std::memcpy(&value, from + i * sizeof value, sizeof value);
    to[i * stride] = number(value);
  }
}

void spread(const Stored& channel, const unsigned char* line, std::size_t skipped, std::size_t count, float* to) {
  const unsigned char* const from = line + channel.at + skipped * size_of(channel.type);
  const std::size_t stride = channel.target.stride;
  if (channel.type == Imf::HALF)
    spread<std::uint16_t>(from, count, to, stride, [](std::uint16_t bits) { return imath_half_to_float(bits); });
  else if (channel.type == Imf::FLOAT) spread<float>(from, count, to, stride, [](float v) { return v; });
  else spread<std::uint32_t>(from, count, to, stride, [](std::uint32_t v) { return static_cast<float>(v); });
}

}  // namespace

bool read_zip_lines(Imf::InputPart& part, std::span<const ChannelTarget> targets) {
  const Imf::Header& header = part.header();
  const int lines_a_block = lines_of_block(header);
  if (lines_a_block == 0 || std::endian::native != std::endian::little) return false;

  const Imath::Box2i data = header.dataWindow(), shown = header.displayWindow();
  const int left = std::max(data.min.x, shown.min.x), right = std::min(data.max.x, shown.max.x);
  const int top = std::max(data.min.y, shown.min.y), bottom = std::min(data.max.y, shown.max.y);
  if (left > right || top > bottom) return true;
  const auto width = static_cast<std::size_t>(std::int64_t{data.max.x} - data.min.x + 1);

  std::vector<Stored> channels;
  std::size_t line_bytes = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    for (const ChannelTarget& target : targets)
      if (target.name == c.name()) channels.push_back({line_bytes, c.channel().type, target});
    line_bytes += width * size_of(c.channel().type);
  }
  constexpr std::size_t kMostBlock = std::size_t{1} << 26;  // each thread holds two
  if (channels.size() != targets.size() || line_bytes * static_cast<std::size_t>(lines_a_block) > kMostBlock)
    return false;

  // Where the blocks are; the file is in memory, and its bytes stay where they are.
  std::vector<Block> blocks;
  const int height = data.max.y - data.min.y + 1;
  for (int y = (top - data.min.y) / lines_a_block * lines_a_block; y <= bottom - data.min.y; y += lines_a_block) {
    int size = 0;
    Block block{y, std::min(lines_a_block, height - y), nullptr, 0};
    part.rawPixelData(data.min.y + y, block.bytes, size);
    block.size = static_cast<std::size_t>(size);
    blocks.push_back(block);
  }

  const std::size_t shown_width = static_cast<std::size_t>(std::int64_t{shown.max.x} - shown.min.x + 1);
  const auto skipped = static_cast<std::size_t>(left - data.min.x), count = static_cast<std::size_t>(right - left + 1);
  const auto read = [&](const Block& block, std::vector<unsigned char>& deflated, std::vector<unsigned char>& lines) {
    const std::size_t size = line_bytes * static_cast<std::size_t>(block.lines);
    const unsigned char* from = reinterpret_cast<const unsigned char*>(block.bytes);
    if (block.size < size && header.compression() != Imf::NO_COMPRESSION) {
      lines.resize(size);
      unzip(block, deflated, lines);
      from = lines.data();
    } else if (block.size != size) {
      throw std::runtime_error("the block of line " + std::to_string(block.first) + " has " +
                               std::to_string(block.size) + " bytes; expected " + std::to_string(size));
    }
    for (int l = 0; l < block.lines; ++l) {
      const int y = data.min.y + block.first + l;
      if (y < top || y > bottom) continue;
      const std::size_t pixel =
          static_cast<std::size_t>(y - shown.min.y) * shown_width + static_cast<std::size_t>(left - shown.min.x);
      for (const Stored& channel : channels)
        spread(channel, from + static_cast<std::size_t>(l) * line_bytes, skipped, count,
               channel.target.first + pixel * channel.target.stride);
    }
  };
  // Isolated, so that a thread that waits here does not begin another picture meanwhile.
  tbb::this_task_arena::isolate([&] {
    const std::size_t grain = std::max<std::size_t>(1, 64 / static_cast<std::size_t>(lines_a_block));
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), grain), [&](const auto& range) {
      std::vector<unsigned char> deflated, lines;
      for (std::size_t b = range.begin(); b != range.end(); ++b) read(blocks[b], deflated, lines);
    });
  });
  return true;
}

}  // namespace likeness::image
