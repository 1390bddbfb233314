#include "render/material/material_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "render/files/files.h"
#include "render/material/parameters.h"

namespace likeness::material {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// A value inside the row's range that takes all 53 bits to write, and differs for every channel.
double awkward(const brdf::Parameter& row, int which) {
  const double t = 1.0 / 3 + 0.1 * which / (which + 1.0);
  return row.range.low + (row.range.high - row.range.low) * t * 0.7;
}

brdf::AnyBrdf awkward_model(std::string_view name) {
  brdf::AnyBrdf brdf;
  EXPECT_TRUE(brdf::model_of_name(name, brdf));
  int which = 0;
  for (const Entry& entry : entries(brdf)) {
    std::array<double, 3> value{};
    for (double& v : value) v = awkward(entry.row, which++);
    EXPECT_EQ(assign(brdf, entry.row.name, std::span(value).first(static_cast<std::size_t>(entry.row.channels))), "");
  }
  return brdf;
}

// The message that a text is refused with; empty if it is taken.
std::string refusal(const std::string& text) {
  try {
    material_of(text, "gold.material.json");
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("gold.material.json:"));
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    return error.what();
  }
  return "";
}

std::string with_parameters(const std::string& parameters) {
  return "{\"format\": \"likeness material\", \"version\": 1, \"model\": \"callisto\",\n\"parameters\": {\n" +
         parameters + "}}";
}

TEST(MaterialFile, EveryModelComesBackBitForBit) {
  for (const std::string_view name : brdf::kModelNames) {
    const Material written{"a \"quoted\" name, \xc3\xa9", awkward_model(name)};
    const Material read = material_of(text_of(written), "x");
    EXPECT_EQ(read.name, written.name);
    ASSERT_EQ(model_name(read.brdf), name);
    const auto a = entries(written.brdf), b = entries(read.brdf);
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < a[i].row.channels; ++c)
        EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i].value[c]), std::bit_cast<std::uint64_t>(b[i].value[c]))
            << a[i].row.name;
  }
}

TEST(MaterialFile, KeepsTheSignOfMinusZeroAndTheSmallestDouble) {
  for (const double value : {-0.0, 5e-324, -5e-324, 0.1, 1.0 / 3}) {
    brdf::Callisto<double> callisto;
    callisto.smooth_terminator = value;
    const auto read = std::get<brdf::Callisto<double>>(material_of(text_of({"", callisto}), "x").brdf);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.smooth_terminator), std::bit_cast<std::uint64_t>(value)) << value;
  }
}

TEST(MaterialFile, WritesEveryRowOfTheTableByName) {
  for (const std::string_view name : brdf::kModelNames) {
    const std::string text = text_of({"m", awkward_model(name)});
    for (const Entry& entry : entries(awkward_model(name)))
      EXPECT_THAT(text, HasSubstr(testing::PrintToString(entry.row.name) + (entry.row.channels == 3 ? ": [" : ": ")));
  }
}

TEST(MaterialFile, MissingParametersTakeTheirDefaults) {
  const Material read = material_of(with_parameters("\"roughness\": 0.25"), "x");
  const auto& callisto = std::get<brdf::Callisto<double>>(read.brdf);
  EXPECT_EQ(callisto.roughness, 0.25);
  EXPECT_EQ(callisto.specular, 0.5);
  EXPECT_EQ(callisto.dual_specular_roughness_scale, 2);
  EXPECT_EQ(read.name, "");
}

TEST(MaterialFile, ParametersMayStandBeforeTheModel) {
  const Material read = material_of(
      R"({"parameters": {"f0": [0.1, 0.2, 0.3]}, "model": "ggx", "version": 1.0, "format": "likeness material"})", "x");
  EXPECT_EQ(std::get<brdf::Ggx<double>>(read.brdf).f0.g, 0.2);
}

TEST(MaterialFile, OutOfRangeNamesFileLineParameterValueRangeAndMeaning) {
  EXPECT_EQ(refusal(with_parameters("\"metallic\": 0,\n\"roughness\": 1.2\n")),
            "gold.material.json:4: /parameters/roughness = 1.2 is outside [0, 1] (of the sharper lobe; its square is "
            "the GGX alpha, kept above 1e-4)");
  EXPECT_THAT(refusal(with_parameters("\"base_color\": [0, 1,\n-0.5]")),
              HasSubstr("/parameters/base_color/2 (blue) = -0.5 is outside [0, 1]"));
}

TEST(MaterialFile, EveryRowRefusesTheNextDoubleOutsideItsRange) {
  for (const std::string_view name : brdf::kModelNames) {
    brdf::AnyBrdf brdf;
    ASSERT_TRUE(brdf::model_of_name(name, brdf));
    for (const Entry& entry : entries(brdf)) {
      const auto count = static_cast<std::size_t>(entry.row.channels);
      for (const auto& [inside, outside] :
           {std::pair{entry.row.range.low, std::nextafter(entry.row.range.low, -1e9)},
            std::pair{entry.row.range.high, std::nextafter(entry.row.range.high, 1e9)}}) {
        const std::vector<double> good(count, inside), bad(count, outside);
        EXPECT_EQ(assign(brdf, entry.row.name, good), "");
        EXPECT_THAT(assign(brdf, entry.row.name, bad), HasSubstr("is outside")) << entry.row.name;
      }
      const std::vector<double> nan(count, std::numeric_limits<double>::quiet_NaN());
      EXPECT_THAT(assign(brdf, entry.row.name, nan), HasSubstr("is outside")) << entry.row.name;
    }
  }
}

TEST(MaterialFile, UnknownNamesGetTheNearest) {
  EXPECT_THAT(refusal(with_parameters("\"rougness\": 0.1")), HasSubstr("did you mean \"roughness\"?"));
  EXPECT_THAT(refusal(with_parameters("\"rougness\": 0.1")), StartsWith("gold.material.json:3: /parameters/"));
  EXPECT_THAT(refusal(R"({"format": "likeness material", "version": 1, "model": "calisto"})"),
              HasSubstr("/model: no model \"calisto\"; did you mean \"callisto\"?"));
  EXPECT_THAT(refusal(R"({"modl": "callisto"})"),
              HasSubstr("/modl is not a key of a material file; did you mean \"model\"?"));
  EXPECT_THAT(refusal(with_parameters("\"zzzzzzzzzzzz\": 0.1")), HasSubstr("it has: base_color, metallic"));
}

TEST(MaterialFile, WrongTypesSayWhatWasFoundAndExpected) {
  EXPECT_THAT(refusal(with_parameters("\"roughness\": null")),
              HasSubstr("/parameters/roughness is null; expected a number"));
  EXPECT_THAT(refusal(with_parameters("\"roughness\": \"0.3\"")), HasSubstr("is the text \"0.3\"; expected a number"));
  EXPECT_THAT(refusal(with_parameters("\"roughness\": true")), HasSubstr("is true; expected"));
  EXPECT_THAT(refusal(with_parameters("\"roughness\": {}")), HasSubstr("is an object; expected"));
  EXPECT_THAT(refusal(with_parameters("\"roughness\": [0.5]")), HasSubstr("list of one number"));
  EXPECT_THAT(refusal(with_parameters("\"roughness\": [0.5, 0.5]")), HasSubstr("has 2 numbers; it takes 1"));
  EXPECT_THAT(refusal(with_parameters("\"base_color\": [0.5, 0.5]")),
              HasSubstr("has 2 numbers; it takes 3: red, green, blue"));
  EXPECT_THAT(refusal(with_parameters("\"base_color\": []")), HasSubstr("has 0 numbers; it takes 3"));
  EXPECT_THAT(refusal(with_parameters("\"base_color\": 0.5")), HasSubstr("has 1 number; it takes 3"));
  EXPECT_THAT(refusal(with_parameters("\"base_color\": [0.5, null, 0.5]")),
              HasSubstr("/parameters/base_color/1 is null"));
  EXPECT_THAT(refusal(with_parameters("\"base_color\": [[0.5]]")), HasSubstr("/parameters/base_color/0 is a list"));
  EXPECT_THAT(refusal(R"({"version": "1"})"), HasSubstr("/version is the text \"1\"; expected a whole number"));
  EXPECT_THAT(refusal(R"({"parameters": [1]})"), HasSubstr("/parameters is a list; expected an object"));
  EXPECT_THAT(refusal(R"({"name": 7})"), HasSubstr("/name is the number 7; expected a text"));
  EXPECT_THAT(refusal("[1, 2]"), HasSubstr("the file is a list; expected an object"));
}

TEST(MaterialFile, DuplicateKeysAreRefused) {
  EXPECT_THAT(refusal(with_parameters("\"roughness\": 0.1,\n\"roughness\": 0.2")),
              HasSubstr(":4: /parameters/roughness is given twice (first in line 3)"));
  EXPECT_THAT(refusal(R"({"model": "ggx", "model": "ggx"})"), HasSubstr("/model is given twice"));
}

TEST(MaterialFile, MissingOrForeignHeadIsRefused) {
  EXPECT_THAT(refusal("{}"), HasSubstr("/format is missing"));
  EXPECT_THAT(refusal(R"({"format": "likeness material", "model": "ggx"})"), HasSubstr("/version is missing"));
  EXPECT_THAT(refusal(R"({"format": "likeness material", "version": 1})"), HasSubstr("/model is missing"));
  EXPECT_THAT(refusal(R"({"format": "gltf"})"), HasSubstr("/format = \"gltf\"; expected \"likeness material\""));
  EXPECT_THAT(refusal("{\n\"version\": 2}"), HasSubstr(":2: /version = 2; this program reads version 1"));
}

TEST(MaterialFile, TextThatIsNotJsonIsRefusedWithItsLine) {
  EXPECT_THAT(refusal(""), HasSubstr("not JSON"));
  EXPECT_THAT(refusal("{\"format\":\n\n oops}"), StartsWith("gold.material.json:3: not JSON (byte "));
  EXPECT_THAT(refusal(with_parameters("\"roughness\": NaN")), StartsWith("gold.material.json:3: not JSON"));
  EXPECT_THAT(refusal(with_parameters("\"roughness\": 1e999")), HasSubstr("number overflow"));
  EXPECT_THAT(refusal(with_parameters("\"roughness\": 0.1") + "}"), HasSubstr("not JSON"));
  EXPECT_THAT(refusal(with_parameters("\"rough\xff\": 0.1")), HasSubstr("not JSON"));
  EXPECT_THAT(refusal(std::string(100'000, '[')),
              HasSubstr("expected an object"));  // no recursion, no stack to exhaust
}

TEST(MaterialFile, EveryPrefixOfAGoodFileIsRefused) {
  const std::string text = text_of({"m", awkward_model("callisto")});
  for (std::size_t size = 0; size + 2 < text.size(); ++size) EXPECT_NE(refusal(text.substr(0, size)), "") << size;
}

TEST(MaterialFile, HugeInputIsBounded) {
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "\"p" + std::to_string(i) + "\": 0,";
  EXPECT_THAT(refusal(with_parameters(many)), HasSubstr("more than 256 entries"));
  std::string numbers;
  for (int i = 0; i < 1000; ++i) numbers += "0,";
  EXPECT_THAT(refusal(with_parameters("\"base_color\": [" + numbers)), HasSubstr("more than 64 numbers"));
  const std::string key(300'000, 'k');
  EXPECT_LT(refusal(with_parameters("\"" + key + "\": 0")).size(), 1000u);  // the message repeats 60 characters of it
}

TEST(MaterialFile, RefusesToWriteWhatItCouldNotRead) {
  brdf::Ggx<double> ggx;
  ggx.roughness = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(text_of({"m", ggx}), std::invalid_argument);
  ggx.roughness = 1.5;
  EXPECT_THROW(text_of({"m", ggx}), std::invalid_argument);
}

TEST(MaterialFile, GoesThroughTheDisk) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("likeness_material_file_test_" + std::to_string(getpid())) / "m.material.json";
  write_material(file, {"m", awkward_model("callisto")});
  EXPECT_EQ(text_of(read_material(file)), text_of({"m", awkward_model("callisto")}));
  std::ofstream(file, std::ios::binary) << std::string(kLargestFile + 1, ' ');
  EXPECT_THROW(read_material(file), files::InputError);
  std::filesystem::remove_all(file.parent_path());
  EXPECT_THROW(read_material(file), files::InputError);
}

}  // namespace
}  // namespace likeness::material
