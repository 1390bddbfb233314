#include "brdf/eval/columns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/files/files.h"
#include "tests/brdf/eval/toy_evaluators.h"

namespace likeness::eval {
namespace {

using testing::HasSubstr;

const catalog::Entry kToy = test::toy();
using Header = std::vector<std::string_view>;
using Assignments = std::vector<Assignment>;

Columns of(const Header& header, const Assignments& assignments = {}) {
  return columns_of(kToy, header, assignments, "t.csv:1");
}

template <class Error>
std::string refused(const Header& header, const Assignments& assignments = {}) {
  try {
    of(header, assignments);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

std::string output_names(const Columns& columns) {
  std::string names;
  for (const Columns::Output& output : columns.outputs) names += output.name + " ";
  return names;
}

TEST(Columns, TheFormIsTheOneThatKnowsMostOfTheNames) {
  EXPECT_EQ(of({"color", "x"}).form, &kToy.forms[0]) << "of two the first";
  EXPECT_EQ(of({"cos_i"}).form, &kToy.forms[1]);
  EXPECT_EQ(of({"light_z", "x"}).form, &kToy.forms[0]);
  EXPECT_EQ(of({"x"}, {{"cos_i", {0.5}}}).form, &kToy.forms[1]) << "what --set names counts too";
}

TEST(Columns, WhatIsMissingHasItsDefaultAndIsListed) {
  const Columns columns = of({"cos_i", "color_g"});
  EXPECT_EQ(columns.fixed, (std::vector<double>{1, 0.5, 0.5, 0.5, 2}));
  EXPECT_EQ(columns.defaults, "color_r = 0.5, color_b = 0.5, x = 2");
  EXPECT_EQ(of({"cos_i", "color", "x"}).defaults, "");
}

TEST(Columns, AnAssignmentHoldsForEveryRow) {
  EXPECT_EQ(of({"cos_i"}, {{"x", {3}}, {"color", {0.25}}}).fixed, (std::vector<double>{1, 0.25, 0.25, 0.25, 3}));
  EXPECT_EQ(of({"cos_i"}, {{"color", {1, 0, 0.5}}, {"color_b", {0.75}}}).fixed, (std::vector<double>{1, 1, 0, 0.75, 2}))
      << "the later one wins";
}

TEST(Columns, OutputsOfGreyInputsAreOneColumn) {
  EXPECT_EQ(output_names(of({"cos_i", "color"})), "f g ");
  EXPECT_EQ(output_names(of({"cos_i"}, {{"color", {0.3, 0.3, 0.3}}})), "f g ");
}

TEST(Columns, OutputsOfColoredInputsAreOneColumnAChannel) {
  EXPECT_EQ(output_names(of({"cos_i", "color_r"})), "f_r f_g f_b g ");
  EXPECT_EQ(output_names(of({"cos_i"}, {{"color", {0.3, 0.3, 0.2}}})), "f_r f_g f_b g ");
  EXPECT_EQ(output_names(of({"cos_i", "ref_f_g"})), "f_r f_g f_b g ");
}

TEST(Columns, ReferencesAreFoundByTheNamesOfOutputs) {
  const Columns columns = of({"ref_f", "cos_i", "ref_g"});
  ASSERT_EQ(columns.references.size(), 2u);
  EXPECT_EQ(columns.references[0].column, 0u);
  EXPECT_EQ(columns.references[0].channels, 3u);
  EXPECT_EQ(columns.references[1].output, 3u);
}

TEST(Columns, DirectionsAreThreeComponentsThatFollowOneAnother) {
  EXPECT_EQ(of({"light_x"}).directions, (std::vector<std::size_t>{0}));
  EXPECT_TRUE(of({"cos_i"}).directions.empty());
}

TEST(Columns, AnUnknownColumnIsRefusedWithItsPlaceTheNearestNameAndWhatIsAllowed) {
  const std::string said = refused<files::InputError>({"cos_i", "colour"});
  EXPECT_THAT(said, HasSubstr("t.csv:1: unknown column \"colour\""));
  EXPECT_THAT(said, HasSubstr("did you mean color?"));
  EXPECT_THAT(said, HasSubstr("toy takes cos_i, color, x; to compare with: ref_f, ref_g"));
  EXPECT_THAT(refused<files::InputError>({"cos_i", "ref_h"}),
              HasSubstr("unknown column \"ref_h\"; did you mean ref_f"));
}

TEST(Columns, AnOutputIsNoInput) {
  EXPECT_THAT(refused<files::InputError>({"cos_i", "f"}), HasSubstr("name the column ref_f to have it compared"));
  EXPECT_THAT(refused<files::InputError>({"cos_i", "f_r"}), HasSubstr("ref_f_r"));
}

TEST(Columns, ColumnsOfTwoFormsAreRefusedByTheirNames) {
  const std::string said = refused<files::InputError>({"x", "cos_i", "light_x"});
  EXPECT_THAT(said, HasSubstr("t.csv:1"));
  EXPECT_THAT(said, HasSubstr("cos_i (of cos_i)"));
  EXPECT_THAT(said, HasSubstr("light_x, light_y, light_z"));
  EXPECT_THAT(refused<files::UsageError>({"cos_i"}, {{"light_x", {1}}}), HasSubstr("two ways"));
}

TEST(Columns, ANameThatStandsTwiceIsRefused) {
  EXPECT_THAT(refused<files::InputError>({"x", "cos_i", "x"}), HasSubstr("\"x\" stands twice"));
  EXPECT_THAT(refused<files::InputError>({"color", "color_r"}), HasSubstr("\"color_r\" gives again"));
  EXPECT_THAT(refused<files::InputError>({"color_r", "color"}), HasSubstr("\"color\" gives again"));
  EXPECT_THAT(refused<files::UsageError>({"x"}, {{"x", {1}}}), HasSubstr("both give x"));
}

TEST(Columns, AColumnWithoutANameIsRefused) {
  EXPECT_THAT(refused<files::InputError>({"x", ""}), HasSubstr("column 2 has no name"));
}

TEST(Columns, AHeaderWithOtherSeparatorsIsExplained) {
  EXPECT_THAT(refused<files::InputError>({"cos_i;x"}), HasSubstr("separated by commas"));
}

TEST(Columns, UnknownAssignmentsAreRefused) {
  EXPECT_THAT(refused<files::UsageError>({}, {{"colr", {1}}}), HasSubstr("did you mean color?"));
  EXPECT_THAT(refused<files::UsageError>({}, {{"x", {1, 2, 3}}}), HasSubstr("x has 3 numbers; it takes 1"));
  EXPECT_THAT(refused<files::UsageError>({}, {{"color", {1, 2}}}), HasSubstr("1, or 3: red, green, blue"));
}

TEST(Assignments, AreNameAndNumbers) {
  EXPECT_EQ(assignment_of("x=0.5").name, "x");
  EXPECT_EQ(assignment_of("x=0.5").values, std::vector<double>{0.5});
  EXPECT_EQ(assignment_of("color=1,0.5,0").values, (std::vector<double>{1, 0.5, 0}));
  for (const std::string text : {"x", "x=", "x=a", "x=1,", "x=1,,2"})
    EXPECT_THROW(assignment_of(text), files::UsageError) << text;
}

TEST(TableOfDefaults, HoldsEveryInputOfTheFormThatTheAssignmentsChoose) {
  EXPECT_EQ(table_of_defaults(kToy, {}), "light_x,light_y,light_z,color,x\n0,0,1,0.5,2\n");
  EXPECT_EQ(table_of_defaults(kToy, Assignments{{"cos_i", {0.5}}, {"color", {1, 0, 0}}}),
            "cos_i,color_r,color_g,color_b,x\n0.5,1,0,0,2\n");
}

}  // namespace
}  // namespace likeness::eval
