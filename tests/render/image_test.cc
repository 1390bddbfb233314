#include <gtest/gtest.h>

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "render/files/files.h"
#include "render/image/difference.h"
#include "render/image/tone_curve.h"
#include "render/image/write.h"
#include "tests/render/temporary_folder.h"

namespace likeness::image {
namespace {

using likeness::test::TemporaryFolder;

DisplayPicture noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  DisplayPicture picture(width, height);
  for (auto& v : picture.rgb) v = static_cast<std::uint8_t>(random() & 255);
  return picture;
}

DisplayPicture flat(int width, int height, std::uint8_t value) {
  DisplayPicture picture(width, height);
  for (auto& v : picture.rgb) v = value;
  return picture;
}

TEST(ToneCurve, EncodesTheStandardsOwnPoints) {
  EXPECT_EQ(srgb_encode(0.0), 0.0);
  EXPECT_NEAR(srgb_encode(1.0), 1.0, 1e-15);                      // rounding of 1.055 - 0.055
  EXPECT_NEAR(srgb_encode(0.0031308), 0.0031308 * 12.92, 1e-15);  // still the line
  EXPECT_NEAR(srgb_encode(0.18), 0.46135612950, 1e-10);           // the digits written
  EXPECT_NEAR(srgb_decode(0.5), 0.21404114048, 1e-10);            // the digits written
  EXPECT_EQ(srgb_encode(-0.18), -srgb_encode(0.18));
}

TEST(ToneCurve, DecodesWhatItEncodes) {
  for (int i = 0; i <= 1000; ++i) {
    const double x = i / 1000.0;
    EXPECT_NEAR(srgb_decode(srgb_encode(x)), x, 1e-7) << x;  // the standard's rounded joint: 4e-8
  }
}

TEST(ToneCurve, EightBitValuesSurviveTheRoundTrip) {
  for (int k = 0; k < 256; ++k)
    EXPECT_EQ(srgb_encode8(static_cast<float>(srgb_decode8(static_cast<std::uint8_t>(k)))), k);
}

TEST(ToneCurve, EightBitEncodingRoundsToTheNearest) {
  for (int i = 0; i <= 100000; ++i) {
    const float x = static_cast<float>(i) / 100000.0f;
    ASSERT_EQ(srgb_encode8(x), static_cast<int>(std::floor(255 * srgb_encode(x) + 0.5))) << x;
  }
}

TEST(ToneCurve, EightBitEncodingTakesEveryFloat) {
  EXPECT_EQ(srgb_encode8(-1.0f), 0);
  EXPECT_EQ(srgb_encode8(2.0f), 255);
  EXPECT_EQ(srgb_encode8(std::numeric_limits<float>::infinity()), 255);
  EXPECT_EQ(srgb_encode8(-std::numeric_limits<float>::infinity()), 0);
  EXPECT_EQ(srgb_encode8(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(ToneCurve, AStopOfExposureDoublesTheLight) {
  Picture picture(1, 1);
  picture.at(0, 0)[1] = 0.25f;
  EXPECT_EQ(display(picture, 1).at(0, 0)[1], srgb_encode8(0.5f));
  EXPECT_EQ(display(picture, -1).at(0, 0)[1], srgb_encode8(0.125f));
  EXPECT_EQ(display(picture, 1).at(0, 0)[0], 0);
}

TEST(Picture, IsStoredRowByRowFromTheTop) {
  Picture picture(3, 2);
  picture.at(2, 1)[0] = 7;
  EXPECT_EQ(picture.rgb[3 * (1 * 3 + 2)], 7);
}

TEST(Psnr, OfOneWrongValueIsTheHandComputedOne) {
  DisplayPicture photo = flat(2, 2, 100), render = photo;
  render.rgb[5] = 106;                                                          // mean squared difference 36 / 12 = 3
  EXPECT_NEAR(psnr(photo, render), 10 * std::log10(255.0 * 255.0 / 3), 1e-12);  // rounding
  EXPECT_NEAR(psnr(photo, render), 43.3595, 1e-4);                              // the digits written
}

TEST(Psnr, OfEqualPicturesIsInfinite) {
  EXPECT_EQ(psnr(noise(8, 8, 1), noise(8, 8, 1)), std::numeric_limits<double>::infinity());
}

TEST(Ssim, OfEqualPicturesIsOne) { EXPECT_NEAR(ssim(noise(20, 16, 1), noise(20, 16, 1)), 1.0, 1e-12); }  // rounding

TEST(Ssim, OfTwoFlatPicturesIsTheLuminanceTermAlone) {
  const double c1 = 6.5025;  // (0.01 x 255)^2
  const double expected = (2 * 100 * 120 + c1) / (100 * 100 + 120 * 120 + c1);
  EXPECT_NEAR(ssim(flat(16, 13, 100), flat(16, 13, 120)), expected, 1e-9);  // variances cancel to 1e-12
}

TEST(Ssim, OfOneWindowIsTheHandComputedSum) {
  const DisplayPicture photo = noise(11, 11, 3), render = noise(11, 11, 4);
  double sum = 0, mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (int pass = 0; pass < 2; ++pass)
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 11; ++x) {
        const double w = std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / (2 * 1.5 * 1.5));
        if (pass == 0) {
          sum += w;
          continue;
        }
        const auto p = photo.at(x, y), r = render.at(x, y);
        const double a = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
        const double b = 0.2126 * r[0] + 0.7152 * r[1] + 0.0722 * r[2];
        mx += w / sum * a, my += w / sum * b, xx += w / sum * a * a, yy += w / sum * b * b, xy += w / sum * a * b;
      }
  const double c1 = 6.5025, c2 = 58.5225;
  const double expected =
      (2 * mx * my + c1) * (2 * (xy - mx * my) + c2) / ((mx * mx + my * my + c1) * (xx - mx * mx + yy - my * my + c2));
  EXPECT_NEAR(ssim(photo, render), expected, 1e-12);  // another order of the same sums
}

TEST(Ssim, IsSymmetricAndFallsWithNoise) {
  const DisplayPicture photo = noise(40, 30, 1);
  DisplayPicture little = photo, much = photo;
  const DisplayPicture other = noise(40, 30, 2);
  for (std::size_t i = 0; i < photo.rgb.size(); ++i) {
    little.rgb[i] = static_cast<std::uint8_t>((9 * photo.rgb[i] + other.rgb[i]) / 10);
    much.rgb[i] = static_cast<std::uint8_t>((photo.rgb[i] + other.rgb[i]) / 2);
  }
  EXPECT_NEAR(ssim(photo, much), ssim(much, photo), 1e-12);  // rounding
  EXPECT_GT(ssim(photo, little), ssim(photo, much));
  EXPECT_LT(ssim(photo, little), 1);
}

TEST(Differences, RefusePicturesOfDifferentSize) {
  EXPECT_THROW(psnr(flat(4, 4, 0), flat(4, 5, 0)), std::invalid_argument);
  EXPECT_THROW(ssim(flat(14, 14, 0), flat(14, 15, 0)), std::invalid_argument);
  EXPECT_THROW(ssim(flat(10, 14, 0), flat(10, 14, 0)), std::invalid_argument);
}

TEST(Exr, HoldsEveryFloatAsItWas) {
  const TemporaryFolder folder;
  Picture picture(5, 3);
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = static_cast<float>(i) * 1.7f - 3.0f;
  picture.rgb[4] = 1e30f;
  write_exr(folder / "deep/picture.exr", picture);

  Imf::InputFile in((folder / "deep/picture.exr").c_str());
  const Imath::Box2i window = in.header().dataWindow();
  ASSERT_EQ(window.max.x - window.min.x + 1, 5);
  ASSERT_EQ(window.max.y - window.min.y + 1, 3);
  Picture back(5, 3);
  Imf::FrameBuffer pixels;
  const char* const names[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c)
    pixels.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(back.rgb.data() + c), 12, 12 * 5));
  in.setFrameBuffer(pixels);
  in.readPixels(0, 2);
  EXPECT_EQ(back.rgb, picture.rgb);
}

// The size in the header of a PNG, big endian at byte 16.
int png_size_at(const std::string& bytes, std::size_t at) {
  int value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value * 256 + static_cast<unsigned char>(bytes[at + i]);
  return value;
}

TEST(Png, IsWholeInMemoryAndTheSameInAFile) {
  const TemporaryFolder folder;
  const DisplayPicture picture = noise(31, 17, 5);
  const std::string bytes = png_bytes(picture);
  ASSERT_GT(bytes.size(), 57u);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png_size_at(bytes, 16), 31);
  EXPECT_EQ(png_size_at(bytes, 20), 17);
  EXPECT_EQ(bytes[24], 8);  // bits a channel
  EXPECT_EQ(bytes[25], 2);  // RGB
  EXPECT_EQ(bytes.substr(bytes.size() - 8, 4), "IEND");
  write_png(folder / "picture.png", picture);
  EXPECT_EQ(files::read_whole(folder / "picture.png", 1 << 20), bytes);
}

}  // namespace
}  // namespace likeness::image
