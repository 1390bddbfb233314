#include "tests/render/exr_files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>
#include <half.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "render/image/exr_stream.h"

namespace likeness::image::test {
namespace {

Imf::Header header_of(const ExrPart& part, bool is_multipart) {
  Imf::Header header(part.width, part.height);
  header.dataWindow() = Imath::Box2i({part.left, part.top}, {part.right, part.bottom});
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& c : part.channels) header.channels().insert(c, Imf::Channel(part.type));
  if (part.tile > 0) header.setTileDescription(Imf::TileDescription(part.tile, part.tile));
  if (is_multipart) {
    header.setName(part.name);
    header.setType(part.tile > 0 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
  }
  return header;
}

// The pixels of one channel after another, and where OpenEXR finds them.
struct Pixels {
  std::vector<char> bytes;
  Imf::FrameBuffer buffer;
};

Pixels pixels_of(const ExrPart& part) {
  const int width = part.right - part.left + 1, height = part.bottom - part.top + 1;
  const std::size_t size = part.type == Imf::HALF ? 2 : 4;
  const std::size_t plane = size * static_cast<std::size_t>(width * height);
  Pixels out;
  out.bytes.resize(plane * part.channels.size());
  for (std::size_t c = 0; c < part.channels.size(); ++c) {
    char* at = out.bytes.data() + c * plane;
    for (int y = part.top; y <= part.bottom; ++y)
      for (int x = part.left; x <= part.right; ++x, at += size) {
        const float value = exr_value(c, x, y);
        const Imath::half half_value(value);
        const auto whole = static_cast<std::uint32_t>(value);
        if (part.type == Imf::FLOAT) std::memcpy(at, &value, 4);
        if (part.type == Imf::HALF) std::memcpy(at, &half_value, 2);
        if (part.type == Imf::UINT) std::memcpy(at, &whole, 4);
      }
    out.buffer.insert(part.channels[c], Imf::Slice::Make(part.type, out.bytes.data() + c * plane,
                                                         Imath::V2i(part.left, part.top), width, height));
  }
  return out;
}

}  // namespace

float exr_value(std::size_t channel, int x, int y) {
  return static_cast<float>(1000 * (static_cast<int>(channel) + 1) + 10 * y + x);
}

std::string exr_bytes(const std::vector<ExrPart>& parts) {
  MemoryFile memory;
  if (parts.size() == 1) {
    const ExrPart& part = parts[0];
    const Pixels pixels = pixels_of(part);
    if (part.tile > 0) {
      Imf::TiledOutputFile out(memory, header_of(part, false), 0);
      out.setFrameBuffer(pixels.buffer);
      out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
    } else {
      Imf::OutputFile out(memory, header_of(part, false), 0);
      out.setFrameBuffer(pixels.buffer);
      out.writePixels(part.bottom - part.top + 1);
    }
  } else {
    std::vector<Imf::Header> headers;
    headers.reserve(parts.size());
    for (const ExrPart& part : parts) headers.push_back(header_of(part, true));
    Imf::MultiPartOutputFile out(memory, headers.data(), static_cast<int>(headers.size()), true, 0);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const Pixels pixels = pixels_of(parts[p]);
      if (parts[p].tile > 0) {
        Imf::TiledOutputPart to(out, static_cast<int>(p));
        to.setFrameBuffer(pixels.buffer);
        to.writeTiles(0, to.numXTiles() - 1, 0, to.numYTiles() - 1);
      } else {
        Imf::OutputPart to(out, static_cast<int>(p));
        to.setFrameBuffer(pixels.buffer);
        to.writePixels(parts[p].bottom - parts[p].top + 1);
      }
    }
  }
  return memory.content();
}

std::string with_window(std::string bytes, std::string_view attribute, int left, int top, int right, int bottom) {
  const std::string start = std::string(attribute) + '\0' + "box2i" + '\0';
  const std::size_t at = bytes.find(start) + start.size() + 4;  // behind the attribute's size
  for (std::size_t i = 0; i < 4; ++i) {
    const int value = i == 0 ? left : i == 1 ? top : i == 2 ? right : bottom;
    std::memcpy(bytes.data() + at + 4 * i, &value, 4);
  }
  return bytes;
}

}  // namespace likeness::image::test
