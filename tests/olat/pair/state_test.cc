#include "olat/pair/state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "olat/pair/actions.h"
#include "olat/pair/tables.h"
#include "render/files/files.h"

namespace likeness::olat_pair {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& text) {
  try {
    state_of(text);
  } catch (const files::UsageError& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return e.what();
  }
  return "no error";
}

TEST(State, OfNoTextIsTheDefaultAndHasNoText) {
  EXPECT_EQ(state_of(""), State{});
  EXPECT_EQ(state_of("?"), State{});
  EXPECT_EQ(state_of(" {} "), State{});
  EXPECT_EQ(text_of(State{}), "");
}

// Every field, one after the other, to another value than its default and back from text.
TEST(State, ComesBackFromItsTextFieldByField) {
  for (const Field& field : fields()) {
    std::string value = "a b&c=d%41/\xc3\xa9?";
    if (!field.choices.empty()) value = field.choices.back().word;
    else if (!field.names.empty()) value = field.names.back();
    else if (field.range[1] > 0) value = "0.3125";
    else if (std::holds_alternative<bool State::*>(field.at)) value = "1";
    if (std::holds_alternative<double brdf::GtTonemap<double>::*>(field.at))
      value = files::number_text(0.5 * (field.range[0] + field.range[1]));
    State state;
    const std::string json = "{\"" + std::string(field.name) + "\": \"" + value + "\"}";
    ASSERT_NO_THROW(state = state_of(json)) << json;
    EXPECT_NE(state, State{}) << field.name;
    EXPECT_EQ(value_of(state, field), value) << field.name;
    EXPECT_EQ(state_of(text_of(state)), state) << text_of(state);
    EXPECT_THAT(text_of(state), HasSubstr(std::string(field.name) + "="));
  }
}

TEST(State, TellsWhetherATextNamesAFieldIfOnlyWithItsDefault) {
  EXPECT_TRUE(has_field("light=3&ev=0", "ev"));
  EXPECT_TRUE(has_field("{\"ev\": 0}", "ev"));
  EXPECT_FALSE(has_field("light=ev&view=agx", "ev"));
  EXPECT_FALSE(has_field("", "ev"));
}

TEST(State, KeepsFourDecimalsOfANumber) {
  EXPECT_EQ(text_of(state_of("ev=0.123449")), "ev=0.1234");
  EXPECT_EQ(text_of(state_of("ev=-0.00001")), "");
  EXPECT_EQ(text_of(state_of("ev=0.03125")), "ev=0.0313") << "half is rounded up, as the page does";
  EXPECT_EQ(text_of(state_of("ev=-1.5")), "ev=-1.5");
  EXPECT_EQ(state_of("{\"ev\": 1.25, \"zebra\": true}"), state_of("zebra=1&ev=1.25"));
}

TEST(State, ErrorsNameTheKeyTheValueAndTheWayOut) {
  EXPECT_THAT(error_of("modes=wipe"), HasSubstr("\"modes\" is not known; did you mean mode?"));
  EXPECT_THAT(error_of("mode=wipes"), HasSubstr("did you mean wipe?"));
  EXPECT_THAT(error_of("view=gtt"), HasSubstr("did you mean gt?"));
  EXPECT_THAT(error_of("metric=xyzzy"), HasSubstr("there are stops, signed"));
  EXPECT_THAT(error_of("ev=99"), HasSubstr("[-30, 30]"));
  EXPECT_THAT(error_of("ev=1e3000"), HasSubstr("not a number"));
  EXPECT_THAT(error_of("ev=nan"), HasSubstr("not a number"));
  EXPECT_THAT(error_of("ev="), HasSubstr("not a number"));
  EXPECT_THAT(error_of("zebra=2"), HasSubstr("neither 1 nor 0"));
  EXPECT_THAT(error_of("ev"), HasSubstr("no '='"));
  EXPECT_THAT(error_of("ev=1&ev=2"), HasSubstr("twice"));
  EXPECT_THAT(error_of("{\"ev\": [1]}"), HasSubstr("a text or a number"));
  EXPECT_THAT(error_of("{\"ev\": 1"), HasSubstr("not JSON"));
  EXPECT_THAT(error_of("camera=" + std::string(2000, 'x')), HasSubstr("1024"));
  EXPECT_THAT(error_of(std::string(70000, '&')), HasSubstr("65536"));
}

TEST(State, HashesWhatBothPicturesPassAndNothingElse) {
  const std::string plain = hash_of(pipeline_of(State{}));
  EXPECT_EQ(plain.size(), 8u);
  for (const char* same : {"camera=a", "mode=wipe", "metric=smape", "zebra=1", "zoom=2", "channel=red"})
    EXPECT_EQ(hash_of(pipeline_of(state_of(same))), plain) << same;
  for (const char* other : {"ev=0.25", "view=agx", "gt_a=1.1", "match=light"})
    EXPECT_NE(hash_of(pipeline_of(state_of(other))), plain) << other;
  EXPECT_EQ(pipeline_of(state_of("view=agx&gt_a=1.1")), pipeline_of(state_of("view=agx"))) << "agx has no parameters";
  EXPECT_EQ(hash_of("foobar"), "bf9cf968") << "published value of FNV-1a";
}

TEST(Actions, HaveOneIdEachAndNoKeyTwice) {
  std::set<std::string_view> ids, keys;
  for (const Action& a : kActions) {
    EXPECT_TRUE(ids.insert(a.id).second) << a.id;
    for (std::string_view rest = a.keys; !rest.empty();) {
      const std::string_view key = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(rest.size(), key.size() + 1));
      EXPECT_TRUE(keys.insert(key).second) << key << " of " << a.id;
    }
  }
}

TEST(Actions, StandInTheManualAsInTheTable) {
  const std::string manual = files::read_whole(LIKENESS_SOURCE_DIR "/docs/olat_view.md", 1 << 20);
  EXPECT_THAT(manual, HasSubstr(keys_table()));
}

}  // namespace
}  // namespace likeness::olat_pair
