#include "render/image/exr_part.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfThreading.h>
#include <ImfTileDescription.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "render/files/files.h"
#include "render/image/exr_lines.h"
#include "render/image/read.h"

namespace likeness::image {
namespace {

struct Extent {
  std::int64_t left, top, width, height;
};

Extent extent_of(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, std::int64_t{box.max.x} - box.min.x + 1, std::int64_t{box.max.y} - box.min.y + 1};
}

}  // namespace

void limit_exr_headers() {
  static const bool kLimited = [] {
    Imf::Header::setMaxImageSize(kLongestSide, kLongestSide);
    Imf::Header::setMaxTileSize(kLongestSide, kLongestSide);
    return true;
  }();
  (void)kLimited;
}

int exr_threads() {
  static const int kThreads = [] {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
    return threads;
  }();
  return kThreads;
}

void check_exr_windows(const Imf::Header& header, const std::string& name, std::size_t most_texels) {
  const Extent shown = extent_of(header.displayWindow()), data = extent_of(header.dataWindow());
  for (const Extent& e : {shown, data})
    if (e.width < 1 || e.height < 1 || e.width > kLongestSide || e.height > kLongestSide ||
        static_cast<std::uint64_t>(e.width * e.height) > most_texels)
      throw files::InputError(name + ": EXR of " + std::to_string(e.width) + " x " + std::to_string(e.height) +
                              " pixels; at most " + std::to_string(most_texels) + " pixels and " +
                              std::to_string(kLongestSide) + " a side are allowed");
  // OpenEXR keeps one block of lines of every channel in memory, or one row of tiles.
  std::uint64_t bytes_of_pixel = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
    bytes_of_pixel += c.channel().type == Imf::HALF ? 2 : 4;
  std::uint64_t width = static_cast<std::uint64_t>(data.width), lines = 256;  // of the largest block, DWAB
  if (header.hasTileDescription()) {
    width = std::max<std::uint64_t>(width, header.tileDescription().xSize);
    lines = header.tileDescription().ySize;
  } else {
    lines = std::min(lines, static_cast<std::uint64_t>(data.height));
  }
  constexpr std::uint64_t kMostBlockBytes = std::uint64_t{1} << 31;
  const std::uint64_t needed = bytes_of_pixel * width * lines, allowed = std::min(kMostBlockBytes, 64 * most_texels);
  if (needed > allowed)
    throw files::InputError(name + ": EXR needs " + std::to_string(needed) + " bytes for one block of lines; at most " +
                            std::to_string(allowed) + " are allowed");
}

void check_exr_sampling(const Imf::Header& header, const std::string& channel, const std::string& name) {
  const Imf::Channel& c = header.channels()[channel.c_str()];
  if (c.xSampling != 1 || c.ySampling != 1)
    throw files::InputError(name + ": EXR channel " + files::in_quotes(channel) + " is stored at every " +
                            std::to_string(c.xSampling) + " x " + std::to_string(c.ySampling) +
                            " pixels; only full resolution is read");
}

void read_channels(Imf::InputPart& part, std::span<const ChannelTarget> targets) {
  if (read_zip_lines(part, targets)) return;
  const Extent data = extent_of(part.header().dataWindow()), shown = extent_of(part.header().displayWindow());
  const std::int64_t left = std::max(data.left, shown.left);
  const std::int64_t right = std::min(data.left + data.width, shown.left + shown.width);
  const std::int64_t top = std::max(data.top, shown.top);
  const std::int64_t bottom = std::min(data.top + data.height, shown.top + shown.height);
  if (left >= right || top >= bottom) return;
  // Blocks of lines are counted from the top of the data window. 256 is a multiple of every compression's.
  constexpr std::int64_t kLines = 256;
  const auto row = static_cast<std::size_t>(data.width);
  const std::size_t plane = row * static_cast<std::size_t>(std::min(kLines, data.height));
  std::vector<float> lines(plane * targets.size());
  for (std::int64_t block = (top - data.top) / kLines; data.top + block * kLines < bottom; ++block) {
    const std::int64_t from = std::max(top, data.top + block * kLines);
    const std::int64_t to = std::min(bottom, data.top + (block + 1) * kLines);
    Imf::FrameBuffer pixels;
    for (std::size_t c = 0; c < targets.size(); ++c)
      pixels.insert(targets[c].name, Imf::Slice::Make(Imf::FLOAT, lines.data() + c * plane,
                                                      Imath::V2i(static_cast<int>(data.left), static_cast<int>(from)),
                                                      data.width, to - from));
    part.setFrameBuffer(pixels);
    part.readPixels(static_cast<int>(from), static_cast<int>(to - 1));
    for (std::size_t c = 0; c < targets.size(); ++c)
      for (std::int64_t y = from; y < to; ++y) {
        const float* const in = lines.data() + c * plane + static_cast<std::size_t>(y - from) * row +
                                static_cast<std::size_t>(left - data.left);
        float* const out =
            targets[c].first +
            static_cast<std::size_t>((y - shown.top) * shown.width + left - shown.left) * targets[c].stride;
        for (std::size_t x = 0; x < static_cast<std::size_t>(right - left); ++x) out[x * targets[c].stride] = in[x];
      }
  }
}

void with_exr_errors(const std::string& name, const std::function<void()>& read) {
  try {
    read();
  } catch (const files::InputError&) {
    throw;
  } catch (const std::exception& e) {
    std::string cause = e.what();
    std::ranges::replace(cause, '\n', ' ');
    throw files::InputError(name + ": EXR cannot be read (" + cause.substr(0, 300) + ")");
  }
}

}  // namespace likeness::image
