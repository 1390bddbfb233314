#include <OpenColorIO/OpenColorIO.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "render/files/files.h"
#include "render/view/color_config.h"
#include "render/view/view.h"
#include "render/view/view_list.h"
#include "tests/render/temporary_folder.h"

// Every display and view of the published ACES config, against OpenColorIO's own processors.
namespace likeness::view {
namespace {

namespace ocio = OCIO_NAMESPACE;

std::string aces_config() {
  return std::string(LIKENESS_SHARED_DIR) + "/data/ocio/cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio";
}

// Greys and colors from 2^-40 to 2^40, what is negative, and what is no light.
std::vector<float> ramp() {
  std::vector<float> out;
  for (int k = -80; k <= 80; ++k) {
    const float v = std::exp2(0.5f * static_cast<float>(k));
    out.insert(out.end(), {v, v, v, v, 0.2f * v, 0, -0.1f * v, v, 3 * v});
  }
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN(), kAll = std::numeric_limits<float>::infinity();
  for (const float v : {kNone, kAll, -kAll, 0.0f, -1.0f, 1e-40f, 3e38f}) out.insert(out.end(), {v, 0.18f, v, v, v, v});
  return out;
}

TEST(AcesConfig, HasEveryViewFiniteAndAsOpenColorIoComputesIt) {
  if (!std::filesystem::exists(aces_config())) GTEST_SKIP() << "there is no " << aces_config();
  const auto listed = views_of_config(aces_config());
  ASSERT_TRUE(listed);
  const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(aces_config().c_str());
  std::size_t count = 0;
  for (const ConfigDisplay& display : listed->displays)
    for (const std::string& name : display.views) {
      ++count;
      const Shower shower({0, name, display.name, aces_config()});
      std::vector<float> got = ramp(), want = ramp();
      shower.encode(got);
      for (float& v : want) v = std::isnan(v) ? 0 : std::clamp(v, -65504.0f, 65504.0f);
      ocio::DisplayViewTransformRcPtr transform = ocio::DisplayViewTransform::Create();
      transform->setSrc("lin_rec709");
      transform->setDisplay(display.name.c_str());
      transform->setView(name.c_str());
      const auto cpu = config->getProcessor(transform)->getDefaultCPUProcessor();
      for (std::size_t i = 0; i < want.size(); i += 3) cpu->applyRGB(want.data() + i);
      for (std::size_t i = 0; i < got.size(); ++i) {
        ASSERT_TRUE(std::isfinite(got[i])) << display.name << " " << name << " " << i;
        const float kept = want[i] > 0 ? std::min(want[i], 1.0f) : 0;
        ASSERT_EQ(got[i], kept) << display.name << " " << name << " " << i;
      }
    }
  EXPECT_EQ(count, 15u) << "five displays of three views";
}

TEST(AcesConfig, IsListedWithItsDefaultsFirst) {
  if (!std::filesystem::exists(aces_config())) GTEST_SKIP() << "there is no " << aces_config();
  const auto listed = views_of_config(aces_config());
  const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(aces_config().c_str());
  ASSERT_EQ(listed->displays.size(), static_cast<std::size_t>(config->getNumDisplays()));
  EXPECT_EQ(listed->displays[0].name, config->getDefaultDisplay());
  for (const ConfigDisplay& display : listed->displays)
    EXPECT_EQ(display.views[0], config->getDefaultView(display.name.c_str()));
  const std::string text = list_text(aces_config());
  for (const ConfigDisplay& display : listed->displays)
    EXPECT_NE(text.find("--display \"" + display.name + "\""), std::string::npos);
  EXPECT_FALSE(listed->is_of_environment);
}

TEST(DefaultView, IsTheConfigsElseTheBuiltInOneAndSaysWhich) {
  unsetenv("OCIO");
  EXPECT_EQ(with_defaults({0, "", "", ""}).name, "gt");
  EXPECT_EQ(origin_text(with_defaults({0, "", "", ""})), "gt, built in");
  EXPECT_EQ(with_defaults({1.5, "agx", "", ""}).name, "agx");
  EXPECT_THROW(with_defaults({0, "", "screen", ""}), files::InputError);
  EXPECT_THROW(with_defaults({0, "", "", "absent.ocio"}), files::InputError);
  EXPECT_NE(list_text("").find("gt is the default"), std::string::npos);
  if (!std::filesystem::exists(aces_config())) GTEST_SKIP() << "there is no " << aces_config();
  setenv("OCIO", aces_config().c_str(), 1);
  const scene::View view = with_defaults({-2, "", "", ""});
  EXPECT_EQ(view.name, "ACES 1.0 - SDR Video");
  EXPECT_EQ(view.display, "sRGB - Display");
  EXPECT_EQ(view.ev, -2);
  EXPECT_NE(origin_text(view).find("($OCIO)"), std::string::npos) << origin_text(view);
  EXPECT_EQ(with_defaults({0, "", "P3-D65 - Display", ""}).name, "ACES 1.0 - SDR Cinema");
  EXPECT_EQ(origin_text({0, "srgb", "", ""}), "srgb, built in") << "though there is a config";
  EXPECT_THROW(with_defaults({0, "", "P3", ""}), files::InputError);
  unsetenv("OCIO");
}

TEST(UnreadableConfig, IsOneClearLine) {
  const likeness::test::TemporaryFolder folder;
  for (const char* text : {"", "no config", "ocio_profile_version: 99\n", "ocio_profile_version: 2\nroles: [\n"}) {
    const std::string config = (folder / "config.ocio").string();
    files::write_whole(config, text);
    try {
      views_of_config(config);
      ADD_FAILURE() << text;
    } catch (const files::InputError& e) {
      const std::string what = e.what();
      EXPECT_EQ(what.find(config + ": "), 0u) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
  }
}

}  // namespace
}  // namespace likeness::view
