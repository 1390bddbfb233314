#include "realis/export/planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "realis/export/export.h"
#include "realis/export/pictures.h"
#include "render/files/interrupt.h"
#include "render/image/read.h"
#include "tests/realis/export/smooth_pictures.h"

namespace likeness::realis {
namespace {

using Json = nlohmann::json;
using test::goes_on;
using test::smooth_pictures;

constexpr std::array kOfPlanes{Format::kPtm, Format::kHsh, Format::kBilinear, Format::kRbf};
const glm::dvec3 kLight = glm::normalize(glm::dvec3(0.3, -0.5, 0.7));

// What a reader of the published format makes of a pixel, from info.json and the JPEGs alone: the sums of OpenLIME's
// ShaderRTI.js, written here again in its own layout (weights of each plane and color, a plane -1 for the mean).
struct Reader {
  Json info;
  std::vector<image::Texels> jpegs;

  explicit Reader(const Planes& planes) : info(Json::parse(info_text(planes, std::vector<glm::dvec3>{kLight}))) {
    for (const std::string& jpeg : planes.jpegs) jpegs.push_back(image::decode_texels(jpeg, "plane"));
  }
  // What nodes or terms weigh.
  std::vector<double> base(const glm::dvec3& l) const {
    const std::string type = info["type"];
    if (type == "ptm") return {1, l.x, l.y, l.x * l.x, l.x * l.y, l.y * l.y};
    if (type == "hsh") {
      const double pi = 3.1415, phi = std::atan2(l.y, l.x), theta = std::min(std::acos(l.z), pi / 2 - 0.15);
      const double cosP = std::cos(phi), cosT = std::cos(theta), cosT2 = cosT * cosT;
      return {1 / std::sqrt(2 * pi),
              std::sqrt(6 / pi) * (cosP * std::sqrt(cosT - cosT2)),
              std::sqrt(3 / (2 * pi)) * (-1 + 2 * cosT),
              std::sqrt(6 / pi) * (std::sqrt(cosT - cosT2) * std::sin(phi)),
              std::sqrt(30 / pi) * (std::cos(2 * phi) * (-cosT + cosT2)),
              std::sqrt(30 / pi) * (cosP * (-1 + 2 * cosT) * std::sqrt(cosT - cosT2)),
              std::sqrt(5 / (2 * pi)) * (1 - 6 * cosT + 6 * cosT2),
              std::sqrt(30 / pi) * ((-1 + 2 * cosT) * std::sqrt(cosT - cosT2) * std::sin(phi)),
              std::sqrt(30 / pi) * ((-cosT + cosT2) * std::sin(2 * phi))};
    }
    std::vector<double> out;
    if (type == "bilinear") {
      const int n = info["resolution"];
      const double s = std::abs(l.x) + std::abs(l.y) + std::abs(l.z);
      const double x = ((l.x + l.y) / s + 1) / 2 * (n - 1), y = ((l.y - l.x) / s + 1) / 2 * (n - 1);
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          out.push_back(std::max(0.0, 1 - std::abs(x - i)) * std::max(0.0, 1 - std::abs(y - j)));
      return out;
    }
    const std::vector<double> lights = info["lights"];
    const double sigma = info["sigma"];
    for (std::size_t i = 0; i < lights.size(); i += 3) {
      const glm::dvec3 d = glm::dvec3(lights[i], lights[i + 1], lights[i + 2]) - l;
      out.push_back(std::exp(-glm::dot(d, d) / (sigma * sigma)));
    }
    for (int pass = 0; pass < 2; ++pass) {
      const double sum = std::accumulate(out.begin(), out.end(), 0.0);
      for (double& w : out) w = pass == 0 && w / sum <= 0.001 ? 0 : w / sum;
    }
    return out;
  }
  double color(std::size_t texel, std::size_t c, const glm::dvec3& l) const {
    const std::vector<double> weights = base(l);
    const Json& material = info["materials"][0];
    const std::size_t count = info["nplanes"];
    double sum = 0;
    for (std::size_t p = 0; p < count; ++p) {
      const double value = (jpegs[p / 3].bytes[3 * texel + p % 3] / 255.0 - material["bias"][p].get<double>()) *
                           material["scale"][p].get<double>();
      if (info["colorspace"] == "rgb") {
        if (p % 3 == c) sum += weights[p / 3] * value;
        continue;
      }
      for (std::size_t d = 0; d < weights.size(); ++d)
        sum += weights[d] * value * (info["basis"][((p + 1) * weights.size() + d) * 3 + c].get<int>() - 127) /
               material["range"][p].get<double>();
    }
    for (std::size_t d = 0; info["colorspace"] == "mrgb" && d < weights.size(); ++d)
      sum += weights[d] * info["basis"][3 * d + c].get<int>() / 255.0;
    return std::clamp(sum, 0.0, 1.0);
  }
};

// 3.1415 of the reader against pi: 1e-4 of a term of about 1.
TEST(Planes, AreReadByTheirPublishedFormulaAsTheViewerReadsThem) {
  for (const Format format : kOfPlanes) {
    const Planes planes = fit_planes(format, smooth_pictures(format, 100), 95, goes_on);
    const Reader reader(planes);
    const Viewer viewer(planes);
    for (const glm::dvec3& light : {kLight, glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(-0.9, 0.4, 0.05))}) {
      const image::Picture seen = viewer.picture(light);
      for (std::size_t texel = 0; texel < 40 * 24; texel += 61)
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_NEAR(reader.color(texel, c, light), seen.rgb[3 * texel + c], 5e-4) << row_of(format).name << texel;
    }
  }
}

// 8 bits of each plane and JPEG of quality 100: a plane is off by one or two of 255 steps of its range, which is below 0.5.
TEST(Planes, GiveBackPicturesThatTheyRepresent) {
  for (const Format format : kOfPlanes) {
    const Lit lit = smooth_pictures(format, 200);
    const Planes planes = fit_planes(format, lit, 100, goes_on);
    const Viewer viewer(planes);
    double sum = 0;
    std::size_t count = 0;
    for (const std::size_t light : {std::size_t{0}, std::size_t{57}, std::size_t{140}}) {
      const image::Picture want = lit.picture(light), got = viewer.picture(lit.to_lights[light]);
      for (std::size_t i = 0; i < want.rgb.size(); ++i, ++count)
        sum += std::pow(static_cast<double>(want.rgb[i]) - static_cast<double>(got.rgb[i]), 2);
    }
    EXPECT_LT(std::sqrt(sum / static_cast<double>(count)), 0.006) << row_of(format).name;
  }
}

TEST(Planes, ThreeLieInAJpegAndBytesUseTheirWholeRange) {
  const Planes planes = fit_planes(Format::kHsh, smooth_pictures(Format::kHsh, 100), 100, goes_on);
  EXPECT_EQ(planes.count(), 27u);
  EXPECT_EQ(planes.jpegs.size(), 9u);
  const image::Texels first = image::decode_texels(planes.jpegs[0], "plane");
  EXPECT_LT(*std::ranges::min_element(first.bytes), 4);
  EXPECT_GT(*std::ranges::max_element(first.bytes), 251);
}

// One light, lights in a line, black, one pixel: finite, and no byte is undefined.
TEST(Planes, OfLittleOrNothingAreFinite) {
  for (const Format format : kOfPlanes)
    for (const std::size_t lights : {std::size_t{1}, std::size_t{2}})
      for (const float value : {0.0f, 1.0f}) {
        Lit lit{3, 2, on_disc(lights), {}};
        lit.picture = [value](std::size_t) {
          image::Picture picture(3, 2);
          std::ranges::fill(picture.rgb, value);
          return picture;
        };
        const Planes planes = fit_planes(format, lit, 95, goes_on);
        for (std::size_t p = 0; p < planes.count(); ++p) EXPECT_TRUE(std::isfinite(planes.scale[p] + planes.bias[p]));
        const Viewer viewer(planes);
        const image::Picture seen = viewer.picture(lit.to_lights[0]);
        for (const float v : seen.rgb) EXPECT_NEAR(v, value, 0.1) << row_of(format).name << " " << lights;
      }
}

TEST(Planes, StopWhenAsked) {
  const auto stops = [](double share, std::string_view) { return share < 0.3; };
  EXPECT_THROW(fit_planes(Format::kPtm, smooth_pictures(Format::kPtm, 64), 95, stops), files::Interrupted);
}

TEST(Terms, OfAGridAreOneAtItsOwnDirections) {
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      // relight's fromOcta: the square turned back by 45 degrees, and lifted onto the octahedron.
      const double u = 2.0 * x / 7 - 1, v = 2.0 * y / 7 - 1, a = (u - v) / 2, b = (u + v) / 2;
      const glm::dvec3 d = glm::normalize(glm::dvec3(a, b, std::max(0.0, 1 - std::abs(a) - std::abs(b))));
      EXPECT_NEAR(terms_of(Format::kBilinear, d)[static_cast<std::size_t>(x + 8 * y)], 1, 1e-9) << x << " " << y;
    }
}

TEST(Terms, AreFiniteOnTheRimAndBlendsSumToOne) {
  for (int k = 0; k < 16; ++k) {
    const glm::dvec3 rim(std::cos(k * 0.4), std::sin(k * 0.4), 0);
    for (const Format format : kOfPlanes) {
      const std::vector<double> terms = terms_of(format, rim);
      EXPECT_EQ(terms.size(), row_of(format).terms);
      for (const double t : terms) EXPECT_TRUE(std::isfinite(t));
      if (row_of(format).has_components) {
        EXPECT_NEAR(std::accumulate(terms.begin(), terms.end(), 0.0), 1, 1e-9);
      }
    }
  }
}

TEST(Disc, IsFilledEvenlyWithUnitDirections) {
  const std::vector<glm::dvec3> lights = on_disc(400);
  int inner = 0;
  for (const glm::dvec3& l : lights) {
    EXPECT_NEAR(glm::length(l), 1, 1e-12);
    EXPECT_GT(l.z, 0);
    inner += std::hypot(l.x, l.y) < 0.5;
  }
  EXPECT_NEAR(inner, 100, 1) << "a quarter of the disc";
}

TEST(Exposure, PutsNinetyNineOfAHundredBelowWhite) {
  image::Picture ramp(100, 1);
  for (int x = 0; x < 100; ++x) std::ranges::fill(ramp.at(x, 0), static_cast<float>((x + 1) / 400.0));
  EXPECT_NEAR(exposure_of(std::span(&ramp, 1)), 2, 0.06);  // the 99th is 0.2475; tenths of a stop
  image::Picture none(2, 1);
  none.rgb = {std::numeric_limits<float>::quiet_NaN(), 1, 1, -1, -1, -1};
  EXPECT_EQ(exposure_of(std::span(&none, 1)), 0);
  EXPECT_EQ(exposure_of({}), 0);
}

TEST(Displayed, IsClippedAndNeverNaN) {
  image::Picture picture(2, 1);
  picture.rgb = {std::numeric_limits<float>::quiet_NaN(), -1, std::numeric_limits<float>::infinity(), 0.5f, 9, 0.0f};
  const image::DisplayPicture out = rounded(displayed(picture, -1));
  EXPECT_THAT(out.rgb, testing::ElementsAre(0, 0, 0, 137, 255, 0));  // 255 srgb(0.25) = 136.96
}

}  // namespace
}  // namespace likeness::realis
