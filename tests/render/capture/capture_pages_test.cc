#include <gtest/gtest.h>

#include <set>

#include "render/files/files.h"
#include "tests/render/capture/sections.h"
#include "tests/render/scene/pages.h"

namespace likeness::capture::test {
namespace {

TEST(CapturePages, TheTablesAreThoseOfTheReader) {
  const std::string page = files::read_whole(LIKENESS_SOURCE_DIR "/docs/capture.md", 1 << 20);
  for (const json::Section* section : kSections) {
    std::string fresh = page;
    ASSERT_TRUE(scene::test::put_table(fresh, std::string(section->name), json::table_text(*section)))
        << section->name << " has no table in docs/capture.md";
    EXPECT_EQ(fresh == page, true) << section->name
                                   << ": rewrite docs/capture.md with: cmake --build BUILD --target capture_pages";
  }
}

TEST(CapturePages, EveryKeySaysWhatItIs) {
  for (const json::Section* section : kSections) {
    std::set<std::string_view> keys;
    for (const json::Key& key : section->keys) {
      EXPECT_TRUE(keys.insert(key.name).second) << section->name << ' ' << key.name;
      EXPECT_FALSE(key.text.empty()) << section->name << ' ' << key.name;
      EXPECT_EQ(key.form == json::Form::kChoice, !key.choices.empty()) << key.name;
    }
  }
}

}  // namespace
}  // namespace likeness::capture::test
