#include <gtest/gtest.h>

#include <set>

#include "tests/brdf/evaluate.h"

// The parameter tables of the models that a file or a fit can name.
namespace likeness::brdf {
namespace {

// Calls visit(M{}) for every alternative of AnyBrdf.
template <class F>
void for_each_model(F&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (visit(std::variant_alternative_t<I, AnyBrdf>{}), ...);
  }(std::make_index_sequence<std::variant_size_v<AnyBrdf>>{});
}

TEST(Parameters, NamesAreUniqueAndSnakeCase) {
  for_each_model([]<class M>(const M&) {
    std::set<std::string_view> names;
    for (const Parameter& row : M::kParameters) {
      EXPECT_TRUE(names.insert(row.name).second) << M::kName << ": " << row.name << " stands twice";
      EXPECT_EQ(row.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789"), row.name.npos) << row.name;
    }
  });
}

TEST(Parameters, DefaultsAndUsualValuesAreWithinTheRange) {
  for_each_model([]<class M>(const M&) {
    for (const Parameter& row : M::kParameters) {
      EXPECT_LT(row.range.low, row.range.high) << M::kName << " " << row.name;
      EXPECT_LT(row.typical.low, row.typical.high) << M::kName << " " << row.name;
      EXPECT_GE(row.typical.low, row.range.low) << M::kName << " " << row.name;
      EXPECT_LE(row.typical.high, row.range.high) << M::kName << " " << row.name;
      EXPECT_GE(row.initial, row.range.low) << M::kName << " " << row.name;
      EXPECT_LE(row.initial, row.range.high) << M::kName << " " << row.name;
      EXPECT_FALSE(row.text.empty()) << M::kName << " " << row.name;
      EXPECT_TRUE(row.channels == 1 || row.channels == 3) << M::kName << " " << row.name;
    }
  });
}

TEST(Parameters, ATintNamesTheScaleThatItMultiplies) {
  for_each_model([]<class M>(const M&) {
    for (const Parameter& row : M::kParameters) {
      EXPECT_EQ(row.role == Role::kTint, !row.tints.empty()) << row.name;
      bool found = row.tints.empty();
      for (const Parameter& other : M::kParameters)
        found = found || (other.name == row.tints && other.role == Role::kScale);
      EXPECT_TRUE(found) << M::kName << ": " << row.name << " tints " << row.tints;
    }
  });
}

TEST(Parameters, AModelStartsAtTheDefaultsOfItsTable) {
  for_each_model([]<class M>(const M& model) {
    for_each_parameter(model, [&]<class V>(const Parameter& row, const V& value) {
      if constexpr (std::is_same_v<V, double>) {
        EXPECT_EQ(value, row.initial) << M::kName << " " << row.name;
        EXPECT_EQ(row.channels, 1) << M::kName << " " << row.name;
      } else {
        EXPECT_EQ(channels(value), (Channels{row.initial, row.initial, row.initial})) << M::kName << " " << row.name;
        EXPECT_EQ(row.channels, 3) << M::kName << " " << row.name;
      }
    });
  });
}

template <template <class> class M>
void expect_round_trip(const M<double>&) {
  std::array<double, channel_count<M<double>>()> values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5 + double(i);
  EXPECT_EQ(channels_of(model_from_channels<M, double>(values.data())), values) << M<double>::kName;
}
TEST(Parameters, ChannelsMakeTheModelThatTheyWereTakenFrom) {
  for_each_model([](const auto& model) { expect_round_trip(model); });
}

// Each row's channel moves the field of that name: members() is in the order of the table.
TEST(Parameters, FieldsAreInTheOrderOfTheTable) {
  Callisto<double> callisto;
  std::array<double, channel_count<Callisto<double>>()> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = double(i);
  callisto = model_from_channels<Callisto, double>(values.data());
  EXPECT_EQ(callisto.base_color.b, 2);
  EXPECT_EQ(callisto.roughness, 5);
  EXPECT_EQ(callisto.smooth_terminator, 10);
  EXPECT_EQ(callisto.smooth_terminator_tint.r, 17);
  EXPECT_EQ(callisto.specular_fresnel_falloff, 20);
  EXPECT_EQ(callisto.smooth_terminator_length, 25);
  const auto disney = model_from_channels<Disney2012, double>(values.data());
  EXPECT_EQ(disney.subsurface, 3);
  EXPECT_EQ(disney.roughness, 7);
  EXPECT_EQ(disney.anisotropic, 8);
  EXPECT_EQ(disney.clearcoat_gloss, 12);
}

TEST(Parameters, EveryModelIsFoundByItsName) {
  for_each_model([]<class M>(const M&) {
    AnyBrdf found = Lambert<double>{};
    EXPECT_TRUE(model_of_name(M::kName, found));
    EXPECT_TRUE(std::holds_alternative<M>(found)) << M::kName;
  });
  AnyBrdf unchanged = Ggx<double>{};
  EXPECT_FALSE(model_of_name("phong", unchanged));
  EXPECT_TRUE(std::holds_alternative<Ggx<double>>(unchanged));
}

}  // namespace
}  // namespace likeness::brdf
