#include "fit/slice/evaluator_slice.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "render/files/files.h"

namespace likeness::fit {

const catalog::Form* half_angle_form(const catalog::Entry& entry) {
  for (const catalog::Form& form : entry.forms)
    if (eval::input_named(form, "theta_h").channels == 1 && eval::input_named(form, "theta_d").channels == 1 &&
        eval::input_named(form, "phi_d").channels == 1)
      return &form;
  return nullptr;
}

SlicePicture slice_of(const catalog::Entry& entry, std::span<const eval::Assignment> assignments,
                      const SliceGrid& grid) {
  const catalog::Form* form = half_angle_form(entry);
  if (form == nullptr)
    throw files::UsageError("model " + std::string(entry.name) +
                            " has no slice: it takes no theta_h, theta_d and phi_d (likeness eval --list)");
  // The angles as columns of a table, so that no assignment may name them.
  constexpr std::string_view kAngles[]{"theta_h", "theta_d", "phi_d"};
  const eval::Columns columns = eval::columns_of(entry, kAngles, assignments, "the slice");
  const std::size_t size = static_cast<std::size_t>(grid.size);
  std::vector<double> in = columns.fixed, features(entry.features);
  std::vector<double> values((entry.features + entry.output_count) * size);
  std::vector<catalog::Column<double>> from(entry.features);
  std::vector<double*> to(entry.output_count);
  for (std::size_t i = 0; i < from.size(); ++i) from[i].data = values.data() + i * size;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = values.data() + (from.size() + i) * size;

  SlicePicture slice(grid.size);
  constexpr double kDegree = std::numbers::pi / 180;
  const void* tables = entry.tables();
  const bool color = entry.outputs.front().channels == 3;
  for (int row = 0; row < grid.size; ++row) {
    for (int column = 0; column < grid.size; ++column) {
      in[columns.inputs[0].first] = slice_theta_h_deg(column, grid.size) * kDegree;
      in[columns.inputs[1].first] = slice_theta_d_deg(row, grid.size) * kDegree;
      in[columns.inputs[2].first] = grid.phi_d;
      columns.form->prepare(in.data(), features.data());
      for (std::size_t i = 0; i < features.size(); ++i)
        values[i * size + static_cast<std::size_t>(column)] = features[i];
    }
    entry.in_double.from_features(tables, from.data(), to.data(), size);
    for (int column = 0; column < grid.size; ++column) {
      const auto pixel = slice.f.at(column, row);
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<float>(to[color ? c : 0][column]);
      slice.valid[slice.index(column, row)] = std::isfinite(pixel[0] + pixel[1] + pixel[2]);
    }
  }
  return slice;
}

}  // namespace likeness::fit
