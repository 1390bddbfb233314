#include "render/image/read.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "render/files/files.h"
#include "render/image/tone_curve.h"
#include "render/image/write.h"
#include "tests/render/exr_files.h"
#include "tests/render/picture_files.h"
#include "tests/render/temporary_folder.h"

namespace likeness::image {
namespace {

using files::InputError;
using likeness::test::TemporaryFolder;
using test::exr_bytes;
using test::exr_value;
using test::ExrPart;
using testing::ElementsAre;
using testing::HasSubstr;

std::string error_of(const std::string& bytes, const std::string& name = "picture", const ReadOptions& options = {}) {
  try {
    decode_texels(bytes, name, options);
  } catch (const InputError& e) {
    const std::string text = e.what();
    EXPECT_EQ(text.find('\n'), text.npos) << text;
    EXPECT_EQ(text.find(name + ": "), 0u) << text;
    return text;
  }
  return "no error";
}

// That channel c of every texel is that of the file, in a picture whose windows agree.
void expect_values(const Texels& texels, const std::vector<std::size_t>& of_file) {
  ASSERT_EQ(texels.channels, static_cast<int>(of_file.size()));
  for (int y = 0; y < texels.height; ++y)
    for (int x = 0; x < texels.width; ++x)
      for (std::size_t c = 0; c < of_file.size(); ++c)
        ASSERT_EQ(texels.floats[static_cast<std::size_t>(y * texels.width + x) * of_file.size() + c],
                  exr_value(of_file[c], x, y))
            << x << ' ' << y << ' ' << c;
}

TEST(ReadExr, ReadsEveryPixelTypeAsNumbers) {
  for (const Imf::PixelType type : {Imf::FLOAT, Imf::HALF, Imf::UINT}) {
    ExrPart part;
    part.type = type;
    part.channels = {"R", "G"};  // values of up to 2044 are exact in half
    part.channels.emplace_back("B");
    part.width = 3;
    part.right = 2;
    const Texels texels = decode_texels(exr_bytes({part}), "types");
    EXPECT_EQ(texels.width, 3);
    EXPECT_EQ(texels.height, 3);
    ASSERT_EQ(texels.floats.size(), 27u);
    EXPECT_TRUE(texels.bytes.empty());
    for (std::size_t i = 0; i < 18; i += 3)
      EXPECT_EQ(texels.floats[i], exr_value(0, (static_cast<int>(i) / 3) % 3, static_cast<int>(i) / 9));
  }
}

TEST(ReadExr, ReadsScanLinesAndTilesOfEverySize) {
  for (const int tile : {0, 1, 2, 64, 300})
    for (const int size : {1, 5, 257, 600}) {
      if (tile == 1 && size > 5) continue;
      ExrPart part;
      part.tile = tile;
      part.width = size;
      part.height = size == 1 ? 1 : size + 1;
      part.right = part.width - 1;
      part.bottom = part.height - 1;
      SCOPED_TRACE(std::to_string(tile) + " " + std::to_string(size));
      expect_values(decode_texels(exr_bytes({part}), "sizes"), {0, 1, 2});
    }
}

TEST(ReadExr, TakesColorsInTheirOrderAndLeavesTheRest) {
  ExrPart part;
  part.channels = {"A", "B", "G", "R", "Z", "normal.X"};
  expect_values(decode_texels(exr_bytes({part}), "rgba"), {3, 2, 1, 0});
  part.channels = {"Y", "Z"};
  expect_values(decode_texels(exr_bytes({part}), "y"), {0});
  part.channels = {"A", "Y"};
  expect_values(decode_texels(exr_bytes({part}), "ya"), {1, 0});
  part.channels = {"height"};
  expect_values(decode_texels(exr_bytes({part}), "one"), {0});
  part.channels = {"R"};
  expect_values(decode_texels(exr_bytes({part}), "red"), {0});
}

TEST(ReadExr, MissingColorsAreBlack) {
  ExrPart part;
  part.channels = {"B", "G"};
  const Texels texels = decode_texels(exr_bytes({part}), "gb");
  ASSERT_EQ(texels.channels, 3);
  EXPECT_EQ(texels.floats[0], 0);
  EXPECT_EQ(texels.floats[1], exr_value(1, 0, 0));
  EXPECT_EQ(texels.floats[2], exr_value(0, 0, 0));
}

TEST(ReadExr, TakesTheLayerThatIsNamed) {
  ExrPart part;
  part.channels = {"B",        "G",        "R",       "left.diffuse.B", "left.diffuse.G", "left.diffuse.R",
                   "normal.X", "normal.Y", "normal.Z"};
  const std::string bytes = exr_bytes({part});
  expect_values(decode_texels(bytes, "layers"), {2, 1, 0});
  expect_values(decode_texels(bytes, "layers", {.layer = "left.diffuse"}), {5, 4, 3});
  expect_values(decode_texels(bytes, "layers", {.layer = "normal"}), {6, 7, 8});
  EXPECT_THAT(error_of(bytes, "layers", {.layer = "diffuse"}),
              HasSubstr("EXR has no layer \"diffuse\"; it has \"\", \"left.diffuse\", \"normal\""));
}

TEST(ReadExr, TakesTheOnlyLayerButDoesNotGuessAmongTwo) {
  ExrPart part;
  part.channels = {"a.B", "a.G", "a.R"};
  expect_values(decode_texels(exr_bytes({part}), "one"), {2, 1, 0});
  part.channels = {"a.B", "a.G", "a.R", "b.R"};
  EXPECT_THAT(error_of(exr_bytes({part})), HasSubstr("choose one of its layers \"a\", \"b\""));
  part.channels = {"U", "V"};
  EXPECT_THAT(error_of(exr_bytes({part})), HasSubstr("no channels R, G, B or Y; it has \"U\" and 1 more"));
}

TEST(ReadExr, ReadsPartsOfAFileMixedOfTilesAndLines) {
  ExrPart depth, color, other;
  depth.name = "depth";
  depth.channels = {"Z"};
  color.name = "color";
  color.tile = 2;
  other.name = "other";
  other.channels = {"B", "G", "R"};
  const std::string bytes = exr_bytes({color, depth, other});
  expect_values(decode_texels(bytes, "parts"), {0, 1, 2});
  expect_values(decode_texels(bytes, "parts", {.layer = "other"}), {2, 1, 0});
  expect_values(decode_texels(bytes, "parts", {.layer = "depth"}), {0});
}

TEST(ReadExr, ShowsTheDisplayWindowWhateverTheDataWindowCovers) {
  struct Case {
    int left, top, right, bottom;
  };
  for (const int tile : {0, 3})
    for (const Case& c : {Case{1, 1, 3, 2}, Case{-2, -3, 8, 9}, Case{3, 2, 9, 9}, Case{-5, -4, 1, 0},
                          Case{20, 20, 22, 21}, Case{-300, -700, 3, 900}}) {
      ExrPart part;
      part.tile = tile;
      part.left = c.left;
      part.top = c.top;
      part.right = c.right;
      part.bottom = c.bottom;
      const Texels texels = decode_texels(exr_bytes({part}), "windows");
      ASSERT_EQ(texels.width, 5);
      ASSERT_EQ(texels.height, 3);
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x) {
          const bool is_covered = x >= c.left && x <= c.right && y >= c.top && y <= c.bottom;
          EXPECT_EQ(texels.floats[static_cast<std::size_t>(3 * (5 * y + x) + 1)], is_covered ? exr_value(1, x, y) : 0)
              << c.left << ' ' << x << ' ' << y;
        }
    }
}

TEST(ReadExr, KeepsWhatIsNoNumber) {
  const TemporaryFolder folder;
  Picture picture(2, 1);
  picture.rgb = {std::numeric_limits<float>::quiet_NaN(), -1, std::numeric_limits<float>::infinity(), 1e-40f, 0, 1e38f};
  write_exr(folder / "odd.exr", picture);
  const Picture back = read_picture(folder / "odd.exr");
  EXPECT_TRUE(std::isnan(back.rgb[0]));
  for (std::size_t i = 1; i < 6; ++i) EXPECT_EQ(back.rgb[i], picture.rgb[i]);
}

TEST(ReadExr, RefusesAbsurdSizesBeforeItAsksForMemory) {
  const std::string bytes = exr_bytes({ExrPart{}});
  const auto sized = [&](const char* window, int right, int bottom) {
    return error_of(test::with_window(bytes, window, 0, 0, right, bottom));
  };
  EXPECT_THAT(sized("displayWindow", 999'999'999, 999'999'999), HasSubstr("EXR"));
  EXPECT_THAT(sized("dataWindow", 999'999'999, 999'999'999), HasSubstr("EXR"));
  EXPECT_THAT(sized("displayWindow", 40'000, 40'000), HasSubstr("EXR of 40001 x 40001 pixels; at most 268435456"));
  EXPECT_THAT(sized("dataWindow", 40'000, 40'000), HasSubstr("EXR"));
  EXPECT_THAT(sized("dataWindow", 0x7fffffff, 0x7fffffff), HasSubstr("EXR"));
  EXPECT_THAT(sized("dataWindow", -5, -5), HasSubstr("EXR"));
  EXPECT_THAT(error_of(test::with_window(bytes, "displayWindow", -0x7fffffff, -0x7fffffff, 0x7fffffff, 0x7fffffff)),
              HasSubstr("EXR"));
  EXPECT_THAT(error_of(bytes, "small", {.most_texels = 14}), HasSubstr("EXR of 5 x 3 pixels; at most 14 pixels"));
}

TEST(ReadExr, RefusesAttributesLongerThanTheFile) {
  std::string bytes = exr_bytes({ExrPart{}});
  const std::size_t at = bytes.find(std::string("box2i\0", 6)) + 6;
  bytes[at + 3] = '\x7f';  // its size in the file: 2^31 bytes
  EXPECT_THAT(error_of(bytes), HasSubstr("attribute \"dataWindow\" has 2130706448 bytes, the file has"));
  bytes[at + 3] = 0;
  bytes[at] = 8;
  EXPECT_THAT(error_of(bytes), HasSubstr("attribute \"dataWindow\" of 8 bytes is no \"box2i\""));
}

TEST(ReadExr, RefusesEveryFileThatIsCutOff) {
  for (const int tile : {0, 2}) {
    ExrPart part;
    part.tile = tile;
    const std::string bytes = exr_bytes({part});
    for (std::size_t size = 4; size < bytes.size(); ++size)
      EXPECT_NE(error_of(bytes.substr(0, size)), "no error") << size;
  }
}

TEST(ReadExr, SurvivesEveryFlippedByte) {
  ExrPart part;
  part.channels = {"A", "B", "G", "R"};
  for (const int tile : {0, 2}) {
    part.tile = tile;
    const std::string bytes = exr_bytes({part});
    for (std::size_t at = 4; at < bytes.size(); ++at)
      for (const int flip : {1, 0x80, 0xff}) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] ^ flip);
        error_of(changed, "flipped", {.most_texels = 1 << 16});
      }
  }
}

TEST(ReadExr, RefusesSubsampledChannelsInWords) {
  // The sampling is the last 8 bytes of a channel's entry; the first channel of the list is Y.
  ExrPart part;
  part.channels = {"Y"};
  std::string bytes = exr_bytes({part});
  const std::size_t at = bytes.find(std::string("chlist\0", 7)) + 7 + 4 + 2 + 4 + 4;
  ASSERT_EQ(bytes[at], 1);
  ASSERT_EQ(bytes[at + 4], 1);
  bytes = test::with_window(test::with_window(bytes, "dataWindow", 0, 0, 3, 1), "displayWindow", 0, 0, 3, 1);
  bytes[at] = bytes[at + 4] = 2;
  EXPECT_THAT(error_of(bytes), HasSubstr("stored at every 2 x 2 pixels; only full resolution is read"));
}

TEST(ReadPng, KeepsBytesAsBytesAndColorsFreeOfAlpha) {
  const Texels rgba = decode_texels(test::png_file(2, 1, 8, 6, {200, 100, 50, 0, 10, 20, 30, 128}), "rgba.png");
  EXPECT_EQ(rgba.channels, 4);
  EXPECT_TRUE(rgba.floats.empty());
  EXPECT_THAT(rgba.bytes, ElementsAre(200, 100, 50, 0, 10, 20, 30, 128));
  EXPECT_THAT(decode_texels(test::png_file(1, 2, 8, 0, {7, 255}), "grey").bytes, ElementsAre(7, 255));
  EXPECT_THAT(decode_texels(test::png_file(1, 1, 8, 4, {200, 3}), "grey alpha").bytes, ElementsAre(200, 3));
  EXPECT_THAT(decode_texels(test::png_file(1, 2, 8, 2, {1, 2, 3, 4, 5, 6}), "rgb").bytes,
              ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(ReadPng, MakesSixteenBitsFloats) {
  const Texels deep = decode_texels(test::png_file(2, 1, 16, 2, {0, 1, 32768, 65535, 258, 1000}), "deep");
  EXPECT_TRUE(deep.bytes.empty());
  const std::vector<float> expected{0, 1 / 65535.0f, 32768 / 65535.0f, 1, 258 / 65535.0f, 1000 / 65535.0f};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_FLOAT_EQ(deep.floats[i], expected[i]);  // one rounding
}

TEST(ReadPng, ReadsWhatIsWritten) {
  DisplayPicture picture(31, 17);
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = static_cast<std::uint8_t>(i * 37);
  const Texels back = decode_texels(png_bytes(picture), "written");
  EXPECT_EQ(back.width, 31);
  EXPECT_EQ(back.bytes, picture.rgb);
}

TEST(ReadTga, IsTopFirstHoweverItIsStored) {
  const std::vector<std::uint8_t> rgb{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  EXPECT_EQ(decode_texels(test::tga_file(1, 4, rgb, true), "a.tga").bytes, rgb);
  EXPECT_EQ(decode_texels(test::tga_file(1, 4, rgb, false), "a.TGA").bytes, rgb);
  const std::vector<std::uint8_t> rgba{200, 100, 50, 0, 10, 20, 30, 128};
  EXPECT_EQ(decode_texels(test::tga_file(2, 1, rgba, true), "a.tga").bytes, rgba);
  EXPECT_EQ(decode_texels(test::tga_file(2, 1, rgba, false), "embedded").bytes, rgba) << "known by its footer";
}

TEST(ReadPfm, IsTopFirstAndKeepsEveryFloat) {
  std::vector<float> values{1.5f, -2, 1e30f, 0, 3, 1e-30f, 0.1f, 0.2f, 0.3f, 4, 5, 6};
  EXPECT_EQ(decode_texels(test::pfm_file(2, 2, 3, values), "a.pfm").floats, values);
  EXPECT_EQ(decode_texels(test::pfm_file(3, 4, 1, values), "grey").floats, values);
  values[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(decode_texels(test::pfm_file(2, 2, 3, values), "a.pfm").floats[0]));
}

TEST(ReadHdr, MultipliesByThePowerOfTwo) {
  // v = (m + 0.5) 2^(e - 136) by the format's author, or m 2^(e - 136) by everybody; 128 2^(129 - 136) = 1.
  const Texels texels = decode_texels(test::hdr_file(2, 1, {128, 64, 0, 129, 128, 128, 128, 139}), "a.hdr");
  ASSERT_EQ(texels.channels, 3);
  EXPECT_NEAR(texels.floats[0], 1, 0.5 / 128);        // either convention
  EXPECT_NEAR(texels.floats[1], 0.5, 0.5 / 128);      // the same
  EXPECT_NEAR(texels.floats[3], 1024, 1024 / 256.0);  // the same
}

TEST(ReadJpeg, ReadsTheOneBlockThereIs) {
  const Texels texels = decode_texels(test::jpeg_file(), "a.jpg");
  EXPECT_EQ(texels.width, 8);
  EXPECT_EQ(texels.height, 8);
  EXPECT_EQ(texels.channels, 1);
  EXPECT_EQ(texels.bytes, std::vector<std::uint8_t>(64, 192));
}

TEST(ReadOther, RefusesAbsurdSizesBeforeItAsksForMemory) {
  EXPECT_THAT(error_of("PF\n1000000000 1000000000\n-1.0\n"), HasSubstr("pnm"));
  EXPECT_THAT(error_of("Pf\n20000 20000\n-1\n"), HasSubstr("20000 x 20000 pixels; at most 268435456 pixels"));
  EXPECT_THAT(error_of("P6\n1000000000 1000000000\n255\n"), HasSubstr("pnm"));
  EXPECT_THAT(error_of("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000000 +X 1000000000\n"), HasSubstr("hdr"));
  EXPECT_THAT(error_of(test::png_file(1'000'000'000, 1, 8, 0, {0})), HasSubstr("png"));
  EXPECT_THAT(error_of(test::png_file(60000, 60000, 8, 0, std::vector<std::uint16_t>(60000))),
              HasSubstr("60000 x 60000 pixels"));
  EXPECT_THAT(error_of(test::png_file(2, 1, 8, 0, {0, 0}), "small", {.most_texels = 1}),
              HasSubstr("2 x 1 pixels; at most 1"));
  std::string tga = test::tga_file(1, 1, {1, 2, 3}, true);
  tga[12] = tga[13] = tga[14] = tga[15] = '\xff';
  EXPECT_THAT(error_of(tga, "a.tga"), HasSubstr("targa"));
}

TEST(ReadOther, RefusesFilesThatAreCutOff) {
  const std::vector<std::string> whole{test::png_file(4, 4, 8, 0, std::vector<std::uint16_t>(16, 9)),
                                       test::pfm_file(2, 2, 3, std::vector<float>(12, 1)),
                                       test::hdr_file(2, 1, {1, 2, 3, 128, 1, 2, 3, 128})};
  for (const std::string& bytes : whole)
    for (const std::size_t left : {std::size_t{3}, bytes.size() / 2, bytes.size() - 13})
      EXPECT_NE(error_of(bytes.substr(0, left)), "no error") << bytes.substr(0, 4) << ' ' << left;
}

TEST(ReadOther, RefusesWhatIsNoPicture) {
  EXPECT_THAT(error_of(""), HasSubstr("is empty; expected a picture (EXR, PNG,"));
  EXPECT_THAT(error_of("once upon a time"), HasSubstr("is no picture that is known (EXR, PNG,"));
  EXPECT_THAT(error_of(std::string("\x76\x2f\x31\x01", 4)), HasSubstr("EXR cannot be read"));
  EXPECT_THAT(error_of(test::png_file(1, 1, 8, 0, {0}), "a.png", {.layer = "diffuse"}), HasSubstr("png has no layers"));
  EXPECT_THROW(read_texels("/nowhere/at/all.png"), InputError);
  EXPECT_THROW(read_texels("/"), InputError);
}

TEST(ReadPicture, DecodesBytesAndRepeatsGrey) {
  const TemporaryFolder folder;
  files::write_whole(folder / "grey.png", test::png_file(1, 1, 8, 4, {188, 3}));
  const Picture grey = read_picture(folder / "grey.png");
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(grey.rgb[c], static_cast<float>(srgb_decode8(188)));
  files::write_whole(folder / "rgb.pfm", test::pfm_file(1, 1, 3, {1, 2, 3}));
  EXPECT_THAT(read_picture(folder / "rgb.pfm").rgb, ElementsAre(1, 2, 3));
}

// Smooth channels that have nothing to do with each other, as coefficients have not. Quality 95 of a smooth picture: a step
// of quantisation is at most 10 / 255 of a block's wave, and the largest of them over 8 x 8 pixels is less than 4 / 255; what
// goes through luma and differences is rounded twice more.
TEST(WriteJpeg, IsReadAgainNearlyAsItWas) {
  DisplayPicture picture(37, 21);
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 37; ++x) {
      picture.at(x, y)[0] = static_cast<std::uint8_t>(128 + 100 * std::sin(0.3 * x));
      picture.at(x, y)[1] = static_cast<std::uint8_t>(128 + 100 * std::cos(0.4 * y));
      picture.at(x, y)[2] = static_cast<std::uint8_t>(6 * x);
    }
  for (const JpegColors colors : {JpegColors::kYcc, JpegColors::kRgb}) {
    const Texels read = decode_texels(jpeg_bytes(picture, 95, colors), "picture");
    ASSERT_EQ(read.channels, 3);
    ASSERT_EQ(read.bytes.size(), picture.rgb.size());
    for (std::size_t i = 0; i < picture.rgb.size(); ++i)
      ASSERT_NEAR(read.bytes[i], picture.rgb[i], colors == JpegColors::kRgb ? 5 : 7) << i;
  }
  EXPECT_LT(jpeg_bytes(picture, 30, JpegColors::kYcc).size(), jpeg_bytes(picture, 95, JpegColors::kYcc).size());
  EXPECT_THROW(jpeg_bytes(DisplayPicture(0, 0), 95, JpegColors::kYcc), std::runtime_error);
  EXPECT_THROW(jpeg_bytes(DisplayPicture(65501, 1), 95, JpegColors::kYcc), std::runtime_error);
}

}  // namespace
}  // namespace likeness::image
