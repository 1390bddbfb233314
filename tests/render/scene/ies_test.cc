#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/files/files.h"
#include "render/scene/ies.h"
#include "tests/render/scene/small_files.h"

// IES LM-63 profiles: factors, symmetries, and files that are none.
namespace likeness::scene::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal_of(const std::string& text) {
  try {
    profile_of(text, "a.ies");
  } catch (const likeness::files::InputError& error) {
    return error.what();
  }
  return "";
}
std::string changed(std::string_view from, std::string_view to) {
  std::string text = small_ies();
  return text.replace(text.find(from), from.size(), to);
}

// Candela of each plane straight down, which name the planes.
std::vector<float> planes(const Profile& p) {
  std::vector<float> out;
  for (std::size_t h = 0; h < p.horizontal_deg.size(); ++h) out.push_back(p.candela[h * p.vertical_deg.size()]);
  return out;
}

TEST(Profiles, AreMultipliedByTheirFactors) {
  const Profile p = profile_of(small_ies("0"), "a.ies");
  EXPECT_EQ(p.type, Profile::Type::kC);
  EXPECT_THAT(p.vertical_deg, ElementsAre(0, 45, 90));
  EXPECT_THAT(p.horizontal_deg, ElementsAre(0));
  EXPECT_THAT(p.candela, ElementsAre(100, 50, 0));  // 2.0 times 0.5 times 1
  EXPECT_EQ(profile_of(changed("1000 2.0", "1000 3.0"), "a.ies").candela[0], 150);
  EXPECT_EQ(profile_of(changed("0.5 1 40", "0.5 0.5 40"), "a.ies").candela[0], 50);
}

TEST(Profiles, QuadrantsAndHalvesAreCompleted) {
  const Profile quadrant = profile_of(small_ies("0 45 90"), "a.ies");
  EXPECT_THAT(quadrant.horizontal_deg, ElementsAre(0, 45, 90, 135, 180, 225, 270, 315, 360));
  EXPECT_THAT(planes(quadrant), ElementsAre(100, 110, 120, 110, 100, 110, 120, 110, 100));
  const Profile half = profile_of(small_ies("0 45 90 180"), "a.ies");
  EXPECT_THAT(half.horizontal_deg, ElementsAre(0, 45, 90, 180, 270, 315, 360));
  EXPECT_THAT(planes(half), ElementsAre(100, 110, 120, 130, 120, 110, 100));
  const Profile side = profile_of(small_ies("90 135 180 225 270"), "a.ies");
  EXPECT_THAT(side.horizontal_deg, ElementsAre(0, 45, 90, 135, 180, 225, 270, 315, 360));
  EXPECT_THAT(planes(side), ElementsAre(120, 110, 100, 110, 120, 130, 140, 130, 120));
  const Profile whole = profile_of(small_ies("0 90 180 270 360"), "a.ies");
  EXPECT_THAT(whole.horizontal_deg, ElementsAre(0, 90, 180, 270, 360));
  const Profile open = profile_of(small_ies("0 90 180 270"), "a.ies");  // 360 left out, as some files do
  EXPECT_THAT(open.horizontal_deg, ElementsAre(0, 90, 180, 270, 360));
  EXPECT_THAT(planes(open), ElementsAre(100, 110, 120, 130, 100));
}

TEST(Profiles, OfTypeBAreCompletedToBothSides) {
  const Profile p = profile_of(changed("3 3 1 2", "3 3 2 2"), "a.ies");
  EXPECT_EQ(p.type, Profile::Type::kB);
  EXPECT_THAT(p.horizontal_deg, ElementsAre(-90, -45, 0, 45, 90));
  EXPECT_THAT(p.vertical_deg, ElementsAre(-90, -45, 0, 45, 90));
  EXPECT_THAT(p.candela, testing::ElementsAreArray({0,  50, 120, 50, 0,   0,  50, 110, 50, 0,   0,  50, 100,
                                                    50, 0,  0,   50, 110, 50, 0,  0,   50, 120, 50, 0}));
}

TEST(Profiles, ATiltTableIsReadOver) {
  const Profile p = profile_of(small_ies("0", "TILT=INCLUDE\n1\n2\n0 90\n1.0 0.8\n"), "a.ies");
  EXPECT_THAT(p.candela, ElementsAre(100, 50, 0));
  EXPECT_THAT(profile_of(small_ies("0", "TILT=lamp.tlt\n"), "a.ies").candela, ElementsAre(100, 50, 0));
}

TEST(Profiles, TheirSolidAngleIsTheIntegralOverTheSphere) {
  // Linear from 1 at 0 to 1/2 at 45 degrees to 0 at 90: 2 pi times the integral of (1 - t / (pi / 2)) sin t, which is
  // 2 pi (1 - 2 / pi).
  EXPECT_NEAR(solid_angle(profile_of(small_ies("0"), "a.ies")), 2 * std::numbers::pi - 4, 1e-9);
  Profile even;
  even.vertical_deg = {0, 60, 180};
  even.horizontal_deg = {0, 90, 360};
  even.candela.assign(9, 7.0f);
  EXPECT_NEAR(solid_angle(even), 4 * std::numbers::pi, 1e-6);  // angles are floats
  even.type = Profile::Type::kB;
  even.vertical_deg = even.horizontal_deg = {-90, 10, 90};
  EXPECT_NEAR(solid_angle(even), 2 * std::numbers::pi, 1e-6);
}

TEST(Profiles, AreRefusedInOneLine) {
  EXPECT_EQ(refusal_of("Gibberish"), "a.ies:1: has no line TILT=; expected a photometric file of IES LM-63");
  EXPECT_EQ(refusal_of(""), "a.ies:1: has no line TILT=; expected a photometric file of IES LM-63");
  EXPECT_THAT(refusal_of(changed("3 3 1 2", "3 3 3 2")), HasSubstr("a.ies:4: the photometric type is 3 (A)"));
  EXPECT_THAT(refusal_of(changed("3 3 1 2", "3 x 1 2")),
              HasSubstr("the number of horizontal angles is \"x\"; expected a number"));
  EXPECT_THAT(refusal_of(changed("3 3 1 2", "3 999999999 1 2")), HasSubstr("expected a whole number from 1 to 4096"));
  EXPECT_THAT(refusal_of(changed("0 45 90\r\n0", "0 95 90\r\n0")),
              HasSubstr("a.ies:6: the vertical angle 90 does not come after 95"));
  EXPECT_THAT(refusal_of(changed("0 45 90\r\n0", "0 45 190\r\n0")),
              HasSubstr("the vertical angle 190 is outside [0, 180] degrees"));
  EXPECT_THAT(refusal_of(small_ies("0 45 100")),
              HasSubstr("horizontal angles of type C run from 0 to 100; expected 0 alone, 0 to 90"));
  EXPECT_THAT(refusal_of(small_ies("90 170 270")), HasSubstr("leave out 180"));
  EXPECT_THAT(refusal_of(changed("100 50, 0", "100 -50, 0")), HasSubstr("a candela of -50; expected 0 or more"));
  EXPECT_THAT(refusal_of(changed("100 50, 0", "nan 50, 0")), HasSubstr("expected a number"));
  EXPECT_THAT(refusal_of(changed("1000 2.0", "1000 0")), HasSubstr("multiplier times factors is 0"));
  const std::string text = small_ies();
  const std::size_t end = text.rfind('0');
  for (std::size_t size = 0; size < end; ++size)
    ASSERT_THAT(refusal_of(text.substr(0, size)), testing::StartsWith("a.ies:")) << size;
}

}  // namespace
}  // namespace likeness::scene::test
