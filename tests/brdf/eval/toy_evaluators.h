#pragma once

#include "brdf/catalog/catalog.h"

// Evaluators that are simple enough to know every answer, as entries of the catalog that is not asked for them.
namespace likeness::eval::test {

using brdf::Parameter;
using brdf::Role;

// f = color x cos_i, two forms: vectors, or an angle; and g = -x, which may be negative.
struct Toy {
  // clang-format off
  static constexpr std::array kVectors{
      Parameter{.name = "light_x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "x"},
      Parameter{.name = "light_y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "y"},
      Parameter{.name = "light_z", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kDirection, .text = "z"},
      Parameter{.name = "color", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .channels = 3, .text = "a color"},
      Parameter{.name = "x", .initial = 2, .range = {0, 10}, .typical = {1, 3}, .text = "a number"}};
  static constexpr std::array kAngles{
      Parameter{.name = "cos_i", .initial = 1, .range = {0, 1}, .typical = {0, 1}, .text = "a cosine"},
      Parameter{.name = "color", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .channels = 3, .text = "a color"},
      Parameter{.name = "x", .initial = 2, .range = {0, 10}, .typical = {1, 3}, .text = "a number"}};
  static constexpr std::array kOutputs{brdf::Output{.name = "f", .channels = 3, .text = "color times cosine"},
                                       brdf::Output{.name = "g", .may_be_negative = true, .text = "-x"}};
  // clang-format on

  template <class N>
  static void loop(const void*, const catalog::Column<N>* in, N* const* out, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = [&](std::size_t k) { return in[k].data[in[k].constant ? 0 : i]; };
      for (std::size_t c = 0; c < 3; ++c) out[c][i] = at(0) * at(1 + c);
      out[3][i] = -at(4);
    }
  }
  // Of the first form.
  template <class N>
  static void loop_from_vectors(const void*, const catalog::Column<N>* in, N* const* out, std::size_t count) {
    loop<N>(nullptr, in + 2, out, count);
  }
};

inline const void* no_tables() { return nullptr; }

inline catalog::Entry toy() {
  const auto from_vectors = [](const double* in, double* features) {
    for (int i = 0; i < 5; ++i) features[i] = in[i + 2];
  };
  const auto from_angles = [](const double* in, double* features) {
    for (int i = 0; i < 5; ++i) features[i] = in[i];
  };
  return {.name = "toy",
          .family = "test",
          .text = "for tests",
          .forms = {{Toy::kVectors, 7, from_vectors}, {Toy::kAngles, 5, from_angles}},
          .outputs = Toy::kOutputs,
          .features = 5,
          .output_count = 4,
          .tables = &no_tables,
          .in_double = {&Toy::loop<double>, &Toy::loop_from_vectors<double>},
          .in_float = {&Toy::loop<float>, &Toy::loop_from_vectors<float>},
          .in_batches = {&Toy::loop<float>, &Toy::loop_from_vectors<float>},
          .one_by_one = false};
}

}  // namespace likeness::eval::test
