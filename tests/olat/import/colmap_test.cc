#include "olat/import/colmap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "render/files/files.h"
#include "tests/olat/import/small_colmap.h"

namespace likeness::olat_import {
namespace {

using files::InputError;
using testing::HasSubstr;

std::string refusal(const std::string& cameras, const std::string& images) {
  try {
    read_colmap_text(cameras, images, "cameras.txt", "images.txt", 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void expect_small(const std::vector<PosedPicture>& got) {
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(got[0].file, "a view/1.png");
  EXPECT_EQ(got[1].file, "b.png");
  const capture::Camera& first = got[0].camera;
  EXPECT_EQ(first.width, 640);
  EXPECT_EQ(first.intrinsics[0][0], 500);
  EXPECT_EQ(first.intrinsics[1][1], 510);
  EXPECT_EQ(first.intrinsics[2][1], 240);
  EXPECT_TRUE(first.is_undistorted);
  // A quarter turn about y: the camera's z is the world's -x, and camera = R world + t.
  const glm::dmat4& m = first.world_from_camera;
  EXPECT_LT(glm::distance(glm::dvec3(m[2]), glm::dvec3(-1, 0, 0)), 1e-12);
  EXPECT_LT(glm::distance(glm::dvec3(m[3]), glm::dvec3(6, -4, -2)), 1e-12);  // -R^T (1, 2, 3) of 2 m a unit
  const capture::Camera& second = got[1].camera;
  EXPECT_EQ(second.intrinsics[0][0], 400);
  EXPECT_EQ(second.distortion[0], 0.1);
  EXPECT_FALSE(second.is_undistorted);
}

TEST(Colmap, TextAndBinaryAreTheSameCameras) {
  expect_small(read_colmap_text(test::small_cameras(), test::small_images(), "c", "i", 2));
  expect_small(read_colmap_binary(test::small_binary_cameras(), test::small_binary_images(), "c", "i", 2));
}

TEST(Colmap, WhatIsWrongIsNamedWithItsPlace) {
  EXPECT_THAT(refusal("1 THIN_PRISM_FISHEYE 1 1 1 1 1 1 0 0 0 0 0 0 0 0\n", ""),
              HasSubstr("cameras.txt:1: the lens model \"THIN_PRISM_FISHEYE\" is not read (SIMPLE_PINHOLE"));
  EXPECT_THAT(refusal("1 PINHOLE 10 10 5 5 5\n", ""), HasSubstr("PINHOLE has a width, a height and 4 numbers"));
  EXPECT_THAT(refusal("1 PINHOLE 10 10 0 5 5 5\n", ""), HasSubstr("the focal length is not above 0"));
  EXPECT_THAT(refusal("1 PINHOLE 10 10 nan 5 5 5\n", ""), HasSubstr("is not finite"));
  EXPECT_THAT(refusal("1 PINHOLE 10 10 5 5 5 5\n1 PINHOLE 10 10 5 5 5 5\n", ""),
              HasSubstr("cameras.txt:2: camera 1 stands twice"));
  const std::string camera = "1 PINHOLE 10 10 5 5 5 5\n";
  EXPECT_THAT(refusal(camera, "# none\n"), HasSubstr("images.txt: has no pictures"));
  EXPECT_THAT(refusal(camera, "1 1 0 0 0 0 0 0 7 a.png\n\n"), HasSubstr("camera 7 is not among the cameras"));
  EXPECT_THAT(refusal(camera, "1 0 0 0 0 0 0 0 1 a.png\n\n"), HasSubstr("the rotation is no quaternion"));
  EXPECT_THAT(refusal(camera, "1 1 0 0 0 0 0 0 1\n\n"), HasSubstr("a picture without a name"));
}

// The numbers of each model in the places of OpenCV's.
TEST(Colmap, LensesKeepTheirNumbers) {
  const auto lens = [](const std::string& row) {
    return read_colmap_text("1 " + row + "\n", "1 1 0 0 0 0 0 0 1 a.png\n\n", "c", "i", 1)[0].camera;
  };
  using Terms = std::array<double, 8>;
  EXPECT_EQ(lens("SIMPLE_RADIAL 8 8 9 4 4 .1").distortion, (Terms{.1}));
  EXPECT_EQ(lens("RADIAL 8 8 9 4 4 .1 .2").distortion, (Terms{.1, .2}));
  EXPECT_EQ(lens("OPENCV 8 8 9 9 4 4 .1 .2 .3 .4").distortion, (Terms{.1, .2, .3, .4}));
  EXPECT_EQ(lens("FULL_OPENCV 8 8 9 9 4 4 .1 .2 .3 .4 .5 .6 .7 .8").distortion,
            (Terms{.1, .2, .3, .4, .5, .6, .7, .8}));
  const capture::Camera fisheye = lens("OPENCV_FISHEYE 8 8 9 9 4 4 .1 .2 .3 .4");
  EXPECT_EQ(fisheye.distortion, (Terms{.1, .2, .3, .4}));
  EXPECT_EQ(fisheye.lens, capture::Lens::kFisheye);
  EXPECT_FALSE(lens("OPENCV_FISHEYE 8 8 9 9 4 4 0 0 0 0").is_undistorted);
  EXPECT_TRUE(lens("OPENCV 8 8 9 9 4 4 0 0 0 0").is_undistorted);
}

TEST(Colmap, EveryTruncationOfABinaryFileIsRefused) {
  const std::string cameras = test::small_binary_cameras(), images = test::small_binary_images();
  for (std::size_t size = 0; size < cameras.size(); ++size)
    EXPECT_THROW(read_colmap_binary(cameras.substr(0, size), images, "c", "i", 1), InputError) << size;
  for (std::size_t size = 0; size < images.size(); ++size)
    EXPECT_THROW(read_colmap_binary(cameras, images.substr(0, size), "c", "i", 1), InputError) << size;
}

}  // namespace
}  // namespace likeness::olat_import
