#include "render/image/exr_lines.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "render/files/files.h"
#include "render/image/exr_stream.h"
#include "render/image/read_exr.h"

// The quick way through an EXR against OpenEXR's own.
namespace likeness::image {
namespace {

struct Want {
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  Imath::Box2i shown{{0, 0}, {36, 49}}, data{{0, 0}, {36, 49}};
  Imf::LineOrder order = Imf::INCREASING_Y;
  bool is_noise = true;
};

// A, B and G as half, R as float, Z as uint.
std::string file_of(const Want& want) {
  MemoryFile memory;
  Imf::Header header(want.shown, want.data);
  header.compression() = want.compression;
  header.lineOrder() = want.order;
  for (const char* name : {"A", "B", "G"}) header.channels().insert(name, Imf::Channel(Imf::HALF));
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  header.channels().insert("Z", Imf::Channel(Imf::UINT));
  const std::int64_t width = want.data.max.x - want.data.min.x + 1, height = want.data.max.y - want.data.min.y + 1;
  std::mt19937 random(3);
  std::vector<std::vector<std::uint32_t>> planes;
  {
    Imf::OutputFile out(memory, header);
    Imf::FrameBuffer pixels;
    planes.reserve(5);
    for (const char* name : {"A", "B", "G", "R", "Z"}) {
      std::vector<std::uint32_t>& plane = planes.emplace_back(static_cast<std::size_t>(width * height));
      for (std::size_t i = 0; i < plane.size(); ++i)
        plane[i] = want.is_noise ? static_cast<std::uint32_t>(random()) : static_cast<unsigned>(i / 64);
      pixels.insert(name, Imf::Slice::Make(*name == 'R'   ? Imf::FLOAT
                                           : *name == 'Z' ? Imf::UINT
                                                          : Imf::HALF,
                                           plane.data(), want.data, 4, static_cast<std::size_t>(4 * width)));
    }
    out.setFrameBuffer(pixels);
    // Lines of a decreasing file are taken from the last.
    out.writePixels(static_cast<int>(height));
  }
  return memory.content();
}

constexpr float kUntouched = -77;

// What was read of R, G and Z, interleaved; and whether the quick way took it.
std::pair<bool, std::vector<float>> read(const std::string& bytes, bool is_quick) {
  MemoryInput stream(bytes);
  Imf::MultiPartInputFile file(stream, 0, false);
  const Imath::Box2i shown = file.header(0).displayWindow(), data = file.header(0).dataWindow();
  const auto width = static_cast<std::size_t>(shown.max.x - shown.min.x + 1);
  std::vector<float> out(3 * width * static_cast<std::size_t>(shown.max.y - shown.min.y + 1), kUntouched);
  const char* const names[] = {"R", "G", "Z"};
  Imf::InputPart part(file, 0);
  if (is_quick) {
    std::vector<ChannelTarget> targets;
    for (std::size_t c = 0; c < 3; ++c) targets.push_back({names[c], out.data() + c, 3});
    const bool taken = read_zip_lines(part, targets);
    return {taken, out};
  }
  const std::size_t row = static_cast<std::size_t>(data.max.x - data.min.x + 1);
  std::vector<std::vector<float>> planes(
      3, std::vector<float>(row * static_cast<std::size_t>(data.max.y - data.min.y + 1)));
  Imf::FrameBuffer pixels;
  for (std::size_t c = 0; c < 3; ++c)
    pixels.insert(names[c], Imf::Slice::Make(Imf::FLOAT, planes[c].data(), data, 4, 4 * row));
  part.setFrameBuffer(pixels);
  part.readPixels(data.min.y, data.max.y);
  for (int y = std::max(data.min.y, shown.min.y); y <= std::min(data.max.y, shown.max.y); ++y)
    for (int x = std::max(data.min.x, shown.min.x); x <= std::min(data.max.x, shown.max.x); ++x)
      for (std::size_t c = 0; c < 3; ++c)
        out[3 * (static_cast<std::size_t>(y - shown.min.y) * width + static_cast<std::size_t>(x - shown.min.x)) + c] =
            planes[c][static_cast<std::size_t>(y - data.min.y) * row + static_cast<std::size_t>(x - data.min.x)];
  return {true, out};
}

// By their bits: noise has NaN among its numbers.
void expect_same(const Want& want) {
  const std::string bytes = file_of(want);
  const auto [taken, quick] = read(bytes, true);
  const auto [read_too, slow] = read(bytes, false);
  ASSERT_TRUE(taken && read_too);
  ASSERT_EQ(quick.size(), slow.size());
  EXPECT_EQ(std::memcmp(quick.data(), slow.data(), quick.size() * sizeof(float)), 0);
}

TEST(ExrLines, AreThoseThatOpenExrReads) {
  const Imath::Box2i boxes[] = {{{0, 0}, {36, 49}},    {{0, 0}, {0, 0}},       {{0, 0}, {0, 99}},    {{0, 0}, {200, 1}},
                                {{-5, -7}, {31, 60}},  {{10, 20}, {20, 30}},   {{36, 49}, {90, 90}}, {{-9, -9}, {0, 0}},
                                {{3, 17}, {2000, 33}}, {{-100, 15}, {30, 16}}, {{50, 60}, {70, 80}}};
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION})
    for (const bool is_noise : {true, false})
      for (const Imath::Box2i& data : boxes)
        for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
          SCOPED_TRACE(testing::Message() << "compression " << int(compression) << ", noise " << is_noise << ", from "
                                          << data.min.x << ", " << data.min.y << ", order " << int(order));
          expect_same({.compression = compression, .data = data, .order = order, .is_noise = is_noise});
        }
}

TEST(ExrLines, LeaveOtherKindsToOpenExr) {
  for (const Imf::Compression compression : {Imf::RLE_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAA_COMPRESSION}) {
    const auto [taken, values] = read(file_of({.compression = compression}), true);
    EXPECT_FALSE(taken);
    for (const float v : values) ASSERT_EQ(v, kUntouched);
  }
}

TEST(ExrLines, AreRefusedWhereABlockIsNotWhole) {
  const std::string bytes = file_of({.is_noise = false});
  const std::size_t start = bytes.size() / 2;
  for (std::size_t at = start; at < bytes.size(); at += 3) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(~damaged[at]);
    try {
      decode_exr(damaged, "damaged.exr", {});  // a checksum at the end of each block finds every change
      ADD_FAILURE() << "byte " << at << " of " << bytes.size();
    } catch (const files::InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("damaged.exr: EXR cannot be read (")) << error.what();
    }
  }
  EXPECT_THROW(decode_exr(std::string_view(bytes).substr(0, bytes.size() - 1), "short.exr", {}), files::InputError);
}

}  // namespace
}  // namespace likeness::image
