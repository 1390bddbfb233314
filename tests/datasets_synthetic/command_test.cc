#include "datasets_synthetic/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <sstream>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "brdf/any_brdf.h"
#include "datasets_synthetic/faults.h"
#include "render/files/files.h"
#include "render/material/parameters.h"

namespace likeness::datasets_synthetic {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class MakeMaterial : public testing::Test {
 protected:
  MakeMaterial() { std::filesystem::remove_all(folder_); }
  ~MakeMaterial() override { std::filesystem::remove_all(folder_); }

  // What `likeness make material ARGUMENTS` prints; FOLDER in the arguments is a folder of the test's own.
  std::string run(std::string arguments) {
    for (std::size_t at; (at = arguments.find("FOLDER")) != std::string::npos;)
      arguments.replace(at, 6, folder_.string());
    CLI::App program{"", "likeness"};
    int exit_code = -1;
    add_make(program, exit_code);
    std::ostringstream out;
    std::streambuf* const terminal = std::cout.rdbuf(out.rdbuf());
    try {
      program.parse("make material " + arguments);
    } catch (...) {
      std::cout.rdbuf(terminal);
      throw;
    }
    std::cout.rdbuf(terminal);
    EXPECT_EQ(exit_code, 0);
    return out.str();
  }

  // The message that the arguments are refused with; nothing may have been written.
  std::string refusal(const std::string& arguments) {
    std::string message;
    try {
      run(arguments);
    } catch (const files::UsageError& error) {
      message = error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(folder_)) << arguments;
    EXPECT_NE(message, "") << arguments;
    return message;
  }

  std::string bytes(const std::string& file) { return files::read_whole(folder_ / file, 100 << 20); }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("likeness_make_material_test_" + std::to_string(getpid()));
};

TEST_F(MakeMaterial, HelpNamesEveryModelAndFault) {
  CLI::App program{"", "likeness"};
  int exit_code = -1;
  add_make(program, exit_code);
  const std::string help = program.get_subcommand("make")->get_subcommand("material")->help();
  for (const std::string_view name : brdf::kModelNames) EXPECT_THAT(help, HasSubstr(std::string(name)));
  for (const FaultRow& row : kFaults) EXPECT_THAT(help, HasSubstr("--" + std::string(row.name)));
  EXPECT_THAT(help, HasSubstr("Examples"));
}

TEST_F(MakeMaterial, ListHasEveryRowOfTheModelsTable) {
  for (const std::string_view name : brdf::kModelNames) {
    const std::string list = run("--list --model " + std::string(name));
    brdf::AnyBrdf brdf;
    ASSERT_TRUE(brdf::model_of_name(name, brdf));
    for (const material::Entry& entry : material::entries(brdf)) {
      EXPECT_THAT(list, HasSubstr(std::string(entry.row.name)));
      EXPECT_THAT(list, HasSubstr(std::string(entry.row.text)));
    }
  }
}

TEST_F(MakeMaterial, SetsParametersAndGreyStandsForThreeChannels) {
  const Json made =
      Json::parse(run("--set roughness=0.3 --set base_color=0.5,0.2,0.1 --set diffuse_fresnel_tint=0.7 "
                      "--theta-bins 4 --phi-bins 4 --out FOLDER/red.csv --json"));
  const Json& parameters = made[0]["parameters"];
  EXPECT_EQ(parameters["roughness"], 0.3);
  EXPECT_EQ(parameters["base_color"], Json({0.5, 0.2, 0.1}));
  EXPECT_EQ(parameters["diffuse_fresnel_tint"], Json({0.7, 0.7, 0.7}));
  EXPECT_EQ(parameters["specular"], 0.5);
  EXPECT_EQ(made[0]["table"]["bins"], Json({4, 4, 4}));
}

TEST_F(MakeMaterial, SameSeedSameBytes) {
  const std::string options = "--random --seed 4 --noise 0.1 --invalid 0.2 --theta-bins 9 --phi-bins 9 --out FOLDER/";
  run(options + "a.mbsdf");
  run(options + "b.mbsdf");
  EXPECT_EQ(bytes("a.mbsdf"), bytes("b.mbsdf"));
  EXPECT_EQ(bytes("a.mbsdf").size(), 43 + 12 + 12 * 9u * 9 * 9);  // heading, sizes, floats
}

TEST_F(MakeMaterial, AFolderGetsOneFileASeed) {
  run("--random --seed 4 --count 3 --format mbsdf --theta-bins 5 --phi-bins 5 --out FOLDER");
  run("--random --seed 6 --theta-bins 5 --phi-bins 5 --out FOLDER/alone.mbsdf");
  EXPECT_NE(bytes("callisto_4.mbsdf"), bytes("callisto_5.mbsdf"));
  EXPECT_EQ(bytes("callisto_6.mbsdf"), bytes("alone.mbsdf"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "callisto_5.truth.json"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "callisto_5.material.json"));
}

TEST_F(MakeMaterial, StartsFromAMaterialFileAndSetComesAfter) {
  run("--model ggx --set roughness=0.7 --set f0=0.9,0.8,0.3 --theta-bins 3 --phi-bins 3 --out FOLDER/gold.csv");
  const Json made =
      Json::parse(run("--from FOLDER/gold.material.json --set roughness=0.2 --theta-bins 3 --phi-bins 3 "
                      "--out FOLDER/sharp.csv --json"));
  EXPECT_EQ(made[0]["model"], "ggx");
  EXPECT_EQ(made[0]["parameters"]["f0"], Json({0.9, 0.8, 0.3}));
  EXPECT_EQ(made[0]["parameters"]["roughness"], 0.2);
}

TEST_F(MakeMaterial, BadArgumentsSayWhatIsAllowed) {
  const std::string out = " --out FOLDER/x.csv";
  EXPECT_EQ(refusal("--set rougness=1" + out),
            "--set \"rougness\" is not a parameter of model \"callisto\"; did you mean "
            "\"roughness\"?");
  EXPECT_THAT(refusal("--set roughness=1.2" + out),
              HasSubstr("--set roughness = 1.2 is outside [0, 1] (of the sharper"));
  EXPECT_THAT(refusal("--set roughness" + out), HasSubstr("--set \"roughness\" has no '='; write"));
  EXPECT_THAT(refusal("--set roughness=" + out), HasSubstr("\"\" is not a number"));
  EXPECT_THAT(refusal("--set roughness=0.3x" + out), HasSubstr("\"0.3x\" is not a number"));
  EXPECT_THAT(refusal("--set roughness=nan" + out), HasSubstr("roughness = nan is outside [0, 1]"));
  EXPECT_THAT(refusal("--set base_color=0.1,0.2" + out), HasSubstr("base_color has 2 numbers; it takes 3"));
  EXPECT_THAT(refusal("--model calisto" + out), HasSubstr("--model: no model \"calisto\"; did you mean \"callisto\"?"));
  EXPECT_THAT(refusal("--model ggx --from x.material.json" + out), HasSubstr("exclude each other"));
  EXPECT_THAT(refusal("--format mrl" + out), HasSubstr("--format \"mrl\" is unknown; did you mean merl?"));
  EXPECT_THAT(refusal("--format merl" + out), HasSubstr("does not go with --format merl, which is written as .binary"));
  EXPECT_THAT(refusal(""), HasSubstr("--out is missing: a file ending in .binary, .mbsdf or .csv, or a folder"));
  EXPECT_THAT(refusal("--count 3" + out), HasSubstr("--count 3 needs a folder for --out"));
  EXPECT_THAT(refusal("--count 0" + out), HasSubstr("--count = 0 is outside [1, 10000]"));
  EXPECT_THAT(refusal("--theta-bins 3 --out FOLDER/x.binary"), HasSubstr("a MERL file always has 90 x 90 x 180"));
  EXPECT_THAT(refusal("--theta-bins 1000" + out), HasSubstr("--theta-bins = 1000 is outside [2, 180]"));
  EXPECT_THAT(refusal("--phi-bins -1" + out), HasSubstr("--phi-bins = -1 is outside [2, 360]"));
  EXPECT_THAT(refusal("--noise-by-angle" + out), HasSubstr("add --noise 0.1"));
  EXPECT_THAT(refusal("--theta-bins 3 --phi-bins 3 --truncate 99999" + out), HasSubstr("cut fewer"));
}

TEST_F(MakeMaterial, EveryFaultRefusesWhatIsOutsideItsRow) {
  for (const FaultRow& row : kFaults) {
    const std::string name = "--" + std::string(row.name);
    EXPECT_THAT(refusal(name + " 1e30 --out FOLDER/x.csv"), HasSubstr(name + " = 1e+30 is outside ["));
    EXPECT_THAT(refusal(name + " -1 --out FOLDER/x.csv"), HasSubstr(name + " = -1 is outside ["));
    EXPECT_THAT(refusal(name + " nan --out FOLDER/x.csv"), HasSubstr(name + " = nan is outside ["));
  }
}

TEST_F(MakeMaterial, ABadMaterialFileIsBadInput) {
  EXPECT_THROW(run("--from FOLDER/absent.material.json --out FOLDER/x.csv"), files::InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_));
}

}  // namespace
}  // namespace likeness::datasets_synthetic
