#include <gmock/gmock.h>

#include "render/files/files.h"
#include "render/runtime/quality.h"

namespace likeness::runtime {
namespace {

constexpr std::string_view kStart = "{\"format\": \"likeness quality\",\n \"version\": 1";

std::string refusal(const std::string& text) {
  try {
    parse_quality(text, "q.json");
  } catch (const files::InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}
std::string of_settings(const std::string& settings) {
  return refusal(std::string(kStart) + ",\n \"settings\": {" + settings + "}}");
}

TEST(QualityFile, ReadsBackWhatItWrites) {
  Settings settings;
  settings.pixel_samples = 16, settings.light_samples = 64, settings.environment = EnvironmentLevel::kRays4;
  const std::string text = quality_text(settings, {"a \"room\"", "left", {{"wall_ms", 12.5}, {"flip", 0.07}}});
  const Settings read = parse_quality(text, "q.json");
  EXPECT_EQ(read.pixel_samples, 16);
  EXPECT_EQ(read.light_samples, 64);
  EXPECT_EQ(read.environment, EnvironmentLevel::kRays4);
  EXPECT_THAT(text, testing::HasSubstr("\"wall_ms\": 12.5"));
}

TEST(QualityFile, EveryLevelOfEverySettingGoesThereAndBack) {
  for (const SettingRow& row : kSettings)
    for (std::size_t level = 0; level < row.levels.size(); ++level) {
      Settings settings;
      row.apply(settings, level);
      EXPECT_EQ(row.level_of(parse_quality(quality_text(settings, {}), "q")), level) << row.name;
    }
}

TEST(QualityFile, LeavesOutWhatKeepsItsDefault) {
  const Settings read = parse_quality(std::string(kStart) + ", \"settings\": {\"light_samples\": \"16\"}}", "q");
  EXPECT_EQ(read.light_samples, 16);
  EXPECT_EQ(read.pixel_samples, Settings{}.pixel_samples);
}

TEST(QualityFile, RefusesWhatItDoesNotKnowWithLineAndNearestName) {
  using testing::AllOf, testing::HasSubstr, testing::StartsWith;
  EXPECT_THAT(of_settings("\n\"pixel_sample\": 4"),
              AllOf(StartsWith("q.json:4: /settings/pixel_sample "), HasSubstr("did you mean pixel_samples?")));
  EXPECT_THAT(of_settings("\"environment\": \"ray16\""),
              AllOf(StartsWith("q.json:3: /settings/environment has no level"), HasSubstr("did you mean rays16?")));
  EXPECT_THAT(of_settings("\"light_samples\": 20"), HasSubstr("1, 4, 16, 64, 256; the nearest is 16"));
  EXPECT_THAT(of_settings("\"light_samples\": true"), HasSubstr("expected one of 1, 4, 16, 64, 256"));
  EXPECT_THAT(of_settings("\"environment\": 4"), HasSubstr("the number 4; expected one of maps, rays1"));
}

TEST(QualityFile, RefusesWhatIsNone) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal("[]"), HasSubstr("the file holds a list"));
  EXPECT_THAT(refusal("{}"), HasSubstr("/format is not"));
  EXPECT_THAT(refusal(R"({"format": "likeness material", "version": 1})"), HasSubstr("/format is not"));
  EXPECT_THAT(refusal(R"({"format": "likeness quality", "version": 2, "settings": {}})"),
              HasSubstr("/version is not 1"));
  EXPECT_THAT(refusal(std::string(kStart) + "}"), HasSubstr("/settings is missing"));
  EXPECT_THAT(refusal(std::string(kStart) + ", \"setting\": {}}"), HasSubstr("did you mean settings?"));
  EXPECT_THAT(refusal("{"), testing::StartsWith("q.json:1: "));
}

TEST(Settings, MatterWhereThePlanHasWhatTheyWorkOn) {
  const auto matter = [](std::initializer_list<plan::Effect> effects) {
    plan::Plan plan;
    for (const plan::Effect e : effects) plan.decisions[static_cast<std::size_t>(e)].is_on = true;
    std::string out;
    for (const SettingRow& row : kSettings) out += row.matters(plan) ? '1' : '0';
    return out;
  };
  EXPECT_EQ(matter({plan::Effect::kPointLights}), "10000");
  EXPECT_EQ(matter({plan::Effect::kAreaLights}), "11000");
  EXPECT_EQ(matter({plan::Effect::kEmission}), "11000");
  EXPECT_EQ(matter({plan::Effect::kEnvironment}), "10100");
  EXPECT_EQ(matter({plan::Effect::kTextureLevels}), "10010");
  EXPECT_EQ(matter({plan::Effect::kTextureLevels, plan::Effect::kProxima}), "10011");
}

}  // namespace
}  // namespace likeness::runtime
