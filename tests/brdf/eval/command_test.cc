#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "brdf/catalog/catalog.h"
#include "tests/brdf/eval/program.h"

// `likeness eval` as a user runs it.
namespace likeness::eval::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

class EvalCommand : public Program {};

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// ---- tables

TEST_F(EvalCommand, WithoutATableThereIsOneRowOfDefaults) {
  const Ran ran = run("ggx_d");
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_EQ(ran.out, "roughness,cos_h,d\n0.5,1,5.0929581789406511\n");  // 16 / pi
  EXPECT_EQ(ran.error, "");
}

TEST_F(EvalCommand, SetChangesTheRowOfDefaults) {
  EXPECT_EQ(run("ggx_d --set roughness=1").out, "roughness,cos_h,d\n1,1,0.31830988618379069\n");
  const Ran red = run("lambert --set theta_h=0.2 --set base_color=1,0.5,0");
  EXPECT_EQ(red.out,
            "theta_h,theta_d,phi_d,base_color_r,base_color_g,base_color_b,f_r,f_g,f_b\n"
            "0.2,0,1.5707963267948966,1,0.5,0,0.31830988618379069,0.15915494309189535,0\n");
}

TEST_F(EvalCommand, ATableGoesThroughFilesAndThroughPipesAlike) {
  write("in.csv", "cos_h,roughness\n1,1\n0.5,1\n");
  const std::string want = "cos_h,roughness,d\n1,1,0.31830988618379069\n0.5,1,0.31830988618379069\n";
  EXPECT_EQ(run("ggx_d --in in.csv").out, want);
  EXPECT_EQ(run("ggx_d --in - <in.csv").out, want);
  EXPECT_EQ(shell("cat in.csv | likeness eval ggx_d --in -").out, want);
  const Ran ran = run("ggx_d --in in.csv --out made/here/out.csv");
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(read("made/here/out.csv"), want);
}

TEST_F(EvalCommand, WhatATableLeavesOutIsSaid) {
  write("in.csv", "cos_h\n1\n");
  const Ran ran = run("ggx_d --in in.csv");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.error, "likeness eval: defaults: roughness = 0.5\n");
  EXPECT_EQ(run("ggx_d --in in.csv --set roughness=0.5").error, "");
}

TEST_F(EvalCommand, OutputCanBeInputOfAComparison) {
  write("in.csv", "roughness,cos_h\n0.1,0.99\n0.3,0.5\n");
  ASSERT_EQ(run("ggx_d --in in.csv --out values.csv").exit_code, 0);
  std::string text = read("values.csv");
  text.replace(text.find(",d\n"), 3, ",ref_d\n");
  write("values.csv", text);
  const Ran ran = run("ggx_d --in values.csv --tolerance 0");
  EXPECT_EQ(ran.exit_code, 0) << "17 digits are all of a double";
  EXPECT_THAT(ran.error, HasSubstr("ref_d: no difference in 2 rows; within the tolerance 0"));
  EXPECT_EQ(run("ggx_d --in values.csv --precision float --tolerance 0").exit_code, 1);
}

TEST_F(EvalCommand, ADifferenceAboveTheToleranceIsExitCodeOneAndTheTableIsWritten) {
  write("in.csv", "roughness,cos_h,ref_d\n1,1,0.31830988618379067\n1,0.5,0.3184\n");
  const Ran ran = run("ggx_d --in in.csv --tolerance 1e-4 --out out.csv");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.error, HasSubstr("ref_d: worst relative difference 0.000283 of 2 rows, in row 2 (line 3): "
                                   "0.3183098861837907 against 0.3184; ABOVE the tolerance 0.0001"));
  EXPECT_EQ(lines_in(read("out.csv")), 3u);
  EXPECT_EQ(run("ggx_d --in in.csv --tolerance 1e-3").exit_code, 0);
  EXPECT_EQ(run("ggx_d --in in.csv").exit_code, 0) << "without a tolerance nothing fails";
}

TEST_F(EvalCommand, ExcelsTablesAreRead) {
  write("in.csv", "\xef\xbb\xbf\"roughness\",\"cos_h\"\r\n1,1\r\n\r\n");
  EXPECT_EQ(run("ggx_d --in in.csv").out, "\"roughness\",\"cos_h\",d\r\n1,1,0.31830988618379069\r\n");
}

TEST_F(EvalCommand, AHeaderAloneIsATableWithoutRows) {
  write("in.csv", "roughness,cos_h");
  const Ran ran = run("ggx_d --in in.csv");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.out, "roughness,cos_h,d\n");
}

TEST_F(EvalCommand, NumbersThatAreNoneGoWhereTheEvaluatorTakesThem) {
  write("in.csv", "roughness,cos_h\nnan,1\ninf,1\n");
  const Ran ran = run("ggx_d --in in.csv");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(lines_in(ran.out), 3u);
  EXPECT_THAT(ran.error, HasSubstr("warning: 2 rows have an input outside its range"));
  EXPECT_THAT(ran.error, HasSubstr("in.csv:2: roughness = nan is outside [0, 1]"));
}

TEST_F(EvalCommand, InputsOutsideTheirRangeAreComputedWithOneWarning) {
  write("in.csv", "roughness\n0.5\n1.2\n0.5\n-1\n");
  const Ran ran = run("ggx_d --in in.csv --set cos_h=1");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.error,
            "likeness eval: warning: 2 rows have an input outside its range; computed all the same; the first: "
            "in.csv:3: roughness = 1.2 is outside [0, 1]\n");
  EXPECT_EQ(lines_in(ran.out), 5u);
}

TEST_F(EvalCommand, ChannelsAreNamedByTheirColumns) {
  write("grey.csv", "light_z,base_color\n1,0.5\n");
  EXPECT_THAT(run("lambert --in grey.csv").out, HasSubstr("light_z,base_color,f\n"));
  write("red.csv", "light_z,base_color_r\n1,0.25\n");
  const Ran ran = run("lambert --in red.csv");
  EXPECT_THAT(ran.out,
              HasSubstr("light_z,base_color_r,f_r,f_g,f_b\n1,0.25,0.079577471545947673,0.15915494309189535,0.1"));
  EXPECT_THAT(ran.error, HasSubstr("base_color_g = 0.5, base_color_b = 0.5"));
}

TEST_F(EvalCommand, TheThreePrecisionsAgreeToWhatTheyHold) {
  std::string table = "theta_h,theta_d,roughness\n";
  for (int i = 0; i < 300; ++i)
    table += std::to_string(i * 0.005) + "," + std::to_string((i % 17) * 0.09) + "," +
             std::to_string(0.05 + i * 0.003) + "\n";
  write("in.csv", table);
  ASSERT_EQ(run("callisto --in in.csv --out double.csv").exit_code, 0);
  std::string text = read("double.csv");
  text.replace(text.find(",f\n"), 3, ",ref_f\n");
  write("double.csv", text);
  for (const std::string precision : {"float", "batch"}) {
    const Ran ran = run("callisto --in double.csv --tolerance 2e-5 --precision " + precision);
    EXPECT_EQ(ran.exit_code, 0) << precision << ran.error;
    EXPECT_THAT(ran.error, Not(HasSubstr("no difference"))) << precision;
  }
}

TEST_F(EvalCommand, TheOutputDoesNotDependOnThreads) {
  std::ofstream table(folder / "in.csv");
  table << "roughness,cos_h,ref_d\n";
  for (int i = 0; i < 60000; ++i) table << (i % 1000) / 1000.0 << "," << (i % 77) / 77.0 << "," << i % 13 << "\n";
  table.close();
  const Ran one = run("ggx_d --in in.csv --threads 1 --out 1.csv"),
            four = run("ggx_d --in in.csv --threads 4 --out 4.csv");
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_EQ(one.error, four.error);
  EXPECT_EQ(read("1.csv"), read("4.csv"));
  EXPECT_EQ(lines_in(read("1.csv")), 60001u);
}

TEST_F(EvalCommand, ALargeTableTakesNoMoreMemoryThanASmallOne) {
  const std::string row = "0.50000000000000000000000000000000000,0.90000000000000000000000000000000000\n";
  const auto make = [&](const char* name, int rows) {
    std::ofstream table(folder / name, std::ios::binary);
    table << "roughness,cos_h\n";
    for (int i = 0; i < rows; ++i) table << row;
  };
  make("small.csv", 100);
  make("large.csv", 800000);  // 60 MB
  const Ran small = run("ggx_d --in small.csv --out small.out"), large = run("ggx_d --in large.csv --out large.out");
  EXPECT_EQ(large.exit_code, 0) << large.error;
  const std::uintmax_t header = std::string("roughness,cos_h,d\n").size();
  EXPECT_EQ(fs::file_size(folder / "large.out") - header, 8000 * (fs::file_size(folder / "small.out") - header));
  EXPECT_LE(large.most_memory_kb,
            small.most_memory_kb + 20000);  // two cores: 5 blocks of 256 kB, and what becomes of them
}

// ---- refusals

TEST_F(EvalCommand, EveryTableThatCannotBeUsedIsRefusedWithItsPlace) {
  struct Row {
    std::string table, place, words, allows;
  };
  const std::string callisto_takes = "callisto takes theta_h, theta_d, phi_d, base_color";
  const Row rows[] = {
      {"", "in.csv", "is empty", "a header that names inputs of callisto"},
      {"\n\n", "in.csv", "is empty", "a header"},
      {"theta_h,rougness\n", "in.csv:1", "unknown column \"rougness\"; did you mean roughness?", callisto_takes},
      {"theta_h,zzz\n", "in.csv:1", "unknown column \"zzz\"", callisto_takes},
      {"\ntheta_h,zzz\n", "in.csv:2", "unknown column \"zzz\"", callisto_takes},
      {"theta_h,f\n", "in.csv:1", "unknown column \"f\": it is what callisto returns", "ref_f"},
      {"theta_h,ref_g\n", "in.csv:1", "unknown column \"ref_g\"", "ref_f"},
      {"theta_h;roughness\n", "in.csv:1", "unknown column", "separated by commas"},
      {"theta_h,theta_d,light_x\n", "in.csv:1", "light_x (of light_x, light_y, light_z", "theta_h (of theta_h"},
      {"theta_h,theta_h\n", "in.csv:1", "\"theta_h\" stands twice", ""},
      {"base_color,base_color_g\n", "in.csv:1", "\"base_color_g\" gives again", "one column or one a channel"},
      {"theta_h,\n", "in.csv:1", "column 2 has no name", "the name of an input"},
      {"theta_h,\"roughness\n", "in.csv:1", "a quote that is not closed", "separated by commas"},
      {"theta_h,roughness\n0.1,0.2\n0.1\n", "in.csv:3", "1 values", "expected 2"},
      {"theta_h,roughness\n0.1,0.2,0.3\n", "in.csv:2", "more than 2 values", "expected 2"},
      {"theta_h,roughness\n0.1,abc\n", "in.csv:2", "column roughness holds \"abc\"", "a number"},
      {"theta_h,roughness\n0.1,\n", "in.csv:2", "column roughness holds nothing", "leave the whole column out"},
      {"light_x,light_y,light_z\n0,0,1\n0,0.6,0.9\n", "in.csv:3", "has the length 1.08", "a unit vector, to 1e-6"},
  };
  for (const Row& row : rows) {
    write("in.csv", row.table);
    expect_refusal("callisto --in in.csv", 3, {row.place + ": ", row.words, row.allows});
  }
  write("long.csv", "roughness\n" + std::string(3'000'000, '1'));
  expect_refusal("ggx_d --in long.csv", 3, {"long.csv:2: a line of more than 1048576 bytes", "one row a line"});
  expect_refusal("ggx_d --in absent.csv", 3, {"absent.csv: cannot be read", "a readable CSV file"});
  expect_refusal("ggx_d --in .", 3, {".: cannot be read"});
  expect_refusal("ggx_d --in -", 3, {"standard input: is empty"});
}

// The first fault in the file is told, whichever block is done first.
TEST_F(EvalCommand, TheFirstOfSeveralFaultsIsTold) {
  std::string table = "roughness,cos_h\n";
  for (int i = 0; i < 200000; ++i) table += i == 80000 || i == 80001 || i > 190000 ? "0.5,bad\n" : "0.5,1\n";
  write("in.csv", table);
  expect_refusal("ggx_d --in in.csv --threads 4", 3, {"in.csv:80002: "});
  expect_refusal("ggx_d --in in.csv --threads 1", 3, {"in.csv:80002: "});
}

TEST_F(EvalCommand, EveryWrongOptionIsRefusedWithTheWayOut) {
  write("in.csv", "roughness\n0.5\n");
  expect_refusal("", 2, {"MODEL is missing", "likeness eval --list"});
  expect_refusal("calisto", 2, {"no model \"calisto\"; did you mean callisto?", "--list"});
  expect_refusal("qqqqqqq", 2, {"no model \"qqqqqqq\" (likeness eval --list prints them all)"});
  expect_refusal("ggx_d --set rougness=1", 2, {"--set: unknown input \"rougness\"; did you mean roughness?"});
  expect_refusal("ggx_d --set roughness", 2, {"has no '='", "roughness=0.3"});
  expect_refusal("ggx_d --set roughness=wide", 2, {"\"wide\" is not a number"});
  expect_refusal("ggx_d --set roughness=1,2,3", 2, {"roughness has 3 numbers; it takes 1"});
  expect_refusal("ggx_d --in in.csv --set roughness=1", 2, {"--set and in.csv:1 both give roughness"});
  expect_refusal("ggx --set light_x=0.5", 2, {"(light_x, light_y, light_z)", "a unit vector"});
  expect_refusal("ggx --set light_x=0 --set theta_h=1", 2, {"two ways to name the same"});
  expect_refusal("ggx_d --precision half", 2, {"--precision half", "double, float, batch"});
  expect_refusal("ggx_d --tolerance 1e-3", 2, {"--tolerance", "--in"});
  expect_refusal("ggx_d --in in.csv --tolerance 1e-3", 2, {"no column of in.csv begins with ref_"});
  expect_refusal("ggx_d --in in.csv --tolerance -1", 2, {"--tolerance must be 0 or more"});
  expect_refusal("ggx_d --threads -3", 2, {"--threads -3", "[0, 1024]"});
  expect_refusal("ggx_d --json", 2, {"--json goes with --list"});
  expect_refusal("ggx_d --rows 100", 2, {"--rows does not go with a table", "--stress"});
  expect_refusal("ggx_d --stress --in in.csv", 2, {"--in does not go with --stress"});
  expect_refusal("ggx_d --stress --list", 2, {"--list and --stress exclude"});
  expect_refusal("ggx_d --stress --rows 0", 2, {"--rows must be within [1, 1e12]"});
  expect_refusal("ggx_d --stress --precision double", 2, {"--precision double"});
  expect_refusal("--list", 2, {"--out does not go with --list"});
  expect_refusal("nothing --stress", 2, {"no model \"nothing\""});
}

TEST_F(EvalCommand, AnInstructionSetThatIsNoneIsRefused) {
  const Ran ran = shell("LIKENESS_INSTRUCTION_SET=mmx exec likeness eval ggx_d");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.error, HasSubstr("LIKENESS_INSTRUCTION_SET = mmx"));
}

// /dev/null stays what it is, also for those who may replace it.
TEST_F(EvalCommand, WhatIsNoFileIsWrittenTo) {
  ASSERT_EQ(shell("mkfifo pipe && (likeness eval ggx_d --out pipe & cat pipe; wait)").out,
            "roughness,cos_h,d\n0.5,1,5.0929581789406511\n");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST_F(EvalCommand, AFileThatCannotBeWrittenIsSaid) {
  write("taken", "a file\n");
  const Ran ran = run("ggx_d --out taken/out.csv");
  EXPECT_EQ(ran.exit_code, 4);
  EXPECT_THAT(ran.error, HasSubstr("taken/out.csv: cannot be written"));
}

// ---- whole or absent

TEST_F(EvalCommand, AFaultInTheMiddleLeavesTheOldFile) {
  write("out.csv", "precious\n");
  std::string table = "roughness\n";
  for (int i = 0; i < 100000; ++i) table += "0.5\n";
  write("in.csv", table + "oops\n");
  EXPECT_EQ(run("ggx_d --in in.csv --out out.csv").exit_code, 3);
  EXPECT_EQ(read("out.csv"), "precious\n");
}

TEST_F(EvalCommand, AnInterruptedRunLeavesNothing) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const pid_t child = start(
        "(echo roughness; while sleep 0.01; do echo 0.5; done) | likeness eval ggx_d --in - --out out.csv & "
        "sleep 0.5; kill -" +
        std::to_string(signal) + " $!; wait $!; echo $? >code");
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(read("code"), "130\n");
    EXPECT_THAT(read(".error"), HasSubstr("interrupted; out.csv is not written"));
    EXPECT_FALSE(fs::exists(folder / "out.csv"));
    for (const auto& entry : fs::directory_iterator(folder))
      EXPECT_EQ(entry.path().filename().string().find(".out.csv"), std::string::npos) << entry.path();
  }
}

// ---- lists

TEST_F(EvalCommand, TheListNamesEveryModelWithItsInputsAndOutputs) {
  const Ran ran = run("--list");
  EXPECT_EQ(ran.exit_code, 0);
  for (const catalog::Entry& entry : catalog::entries())
    EXPECT_THAT(ran.out, HasSubstr("\n" + std::string(entry.name) + ": " + std::string(entry.text) + "\n"));
  const Ran one = run("--list callisto");
  for (const char* word :
       {"theta_h ", "light_x ", "theta_i ", "diffuse_fresnel ", "[0, 256]", "  0.75 ", "rad ", "f (linear RGB)"})
    EXPECT_THAT(one.out, HasSubstr(word));
  EXPECT_THAT(one.out, Not(HasSubstr("ggx_d")));
  EXPECT_EQ(run("callisto --list").out, one.out);
}

TEST_F(EvalCommand, TheListForProgramsHoldsEverything) {
  const Ran ran = run("--list --json");
  const Json list = Json::parse(ran.out);
  const auto& entries = catalog::entries();
  ASSERT_EQ(list.size(), entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(list[i].at("name"), entries[i].name);
    EXPECT_EQ(list[i].at("family"), entries[i].family);
    ASSERT_EQ(list[i].at("forms").size(), entries[i].forms.size());
    for (std::size_t f = 0; f < entries[i].forms.size(); ++f) {
      const auto inputs = entries[i].forms[f].inputs;
      const Json& listed = list[i].at("forms")[f].at("inputs");
      ASSERT_EQ(listed.size(), inputs.size());
      for (std::size_t k = 0; k < inputs.size(); ++k) {
        EXPECT_EQ(listed[k].at("name"), inputs[k].name);
        EXPECT_EQ(listed[k].at("default"), inputs[k].initial);
        EXPECT_EQ(listed[k].at("range")[1], inputs[k].range.high);
        EXPECT_EQ(listed[k].at("unit"), inputs[k].unit);
        EXPECT_EQ(listed[k].at("channels"), inputs[k].channels);
      }
    }
    ASSERT_EQ(list[i].at("outputs").size(), entries[i].outputs.size());
  }
  EXPECT_EQ(Json::parse(run("--list ggx_d --json").out).size(), 1u);
}

// Every model answers at its defaults, in every form and precision.
TEST_F(EvalCommand, EveryModelIsReachedByItsName) {
  std::string commands;
  for (const catalog::Entry& entry : catalog::entries())
    for (const catalog::Form& form : entry.forms) {
      const auto& first = form.inputs.front();
      std::ostringstream set;
      set.precision(17);
      set << " --set " << first.name << "=" << first.initial;
      for (const char* precision : {"double", "float", "batch"})
        commands += "likeness eval " + std::string(entry.name) + set.str() + " --precision " + precision +
                    " >>all.csv || echo " + std::string(entry.name) + " >>failed\n";
    }
  const Ran ran = shell(commands);
  EXPECT_FALSE(fs::exists(folder / "failed")) << read("failed") << ran.error;
  EXPECT_EQ(ran.error, "");
  const std::string all = read("all.csv");
  for (const char* bad : {",nan,", ",nan\n", ",inf", ",-inf"}) EXPECT_EQ(all.find(bad), all.npos) << bad;
}

// ---- random inputs

TEST_F(EvalCommand, StressPrintsATableAndWritesIt) {
  const Ran ran = run("--stress ggx_d --rows 1e4 --out stress.csv");
  EXPECT_EQ(ran.exit_code, 0) << ran.out << ran.error;
  EXPECT_THAT(ran.out, HasSubstr("ggx_d                        double           10000           0         0"));
  EXPECT_THAT(ran.out, HasSubstr("ggx_d                        batch"));
  EXPECT_EQ(lines_in(read("stress.csv")), 4u);
  EXPECT_THAT(read("stress.csv"), HasSubstr("ggx_d,surface,float,10000,0,0,"));
  const Ran markdown = run("--stress ggx_d --rows 1000 --markdown --precision batch --seed 3");
  EXPECT_THAT(markdown.out, HasSubstr("| model | precision | rows |"));
  EXPECT_EQ(lines_in(markdown.out), 4u) << "a heading of two lines, double and batch";
}

// ---- the manual

// Every block "console" of a page: after "$ " a command, and below it what it prints, on both streams.
TEST_F(EvalCommand, ThePagesExamplesDoWhatItSays) {
  std::ifstream page(LIKENESS_SOURCE_DIR "/docs/eval.md");
  ASSERT_TRUE(page);
  std::string line, command, want;
  bool inside = false;
  int examples = 0;
  const auto check = [&] {
    if (command.empty()) return;
    EXPECT_EQ(shell("( " + command + " ) 2>&1").out, want) << "$ " << command;
    ++examples;
    command.clear();
    want.clear();
  };
  while (std::getline(page, line)) {
    if (line == "```console") inside = true;
    else if (line == "```") check(), inside = false;
    else if (inside && line.starts_with("$ ")) check(), command = line.substr(2);
    else if (inside) want += line + "\n";
  }
  EXPECT_GE(examples, 8);
}

}  // namespace
}  // namespace likeness::eval::test
