#include "brdf/cost/accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace likeness::cost {

Draws draws_of(const Family& family, std::size_t count) {
  Random random(7);
  const std::size_t width = family.draw_names.size();
  Draws draws{count, std::vector<double>(count * width)};
  for (std::size_t i = 0; i < count; ++i) family.draw(random, draws.rows.data() + i * width);
  return draws;
}

Columns columns_of(const Family& family, const Rung& rung, const catalog::Entry& entry, const Draws& draws) {
  const catalog::Form& form = entry.forms.front();
  std::vector<double> defaults;
  for (const brdf::Parameter& p : form.inputs)
    defaults.insert(defaults.end(), static_cast<std::size_t>(p.channels), p.initial);
  Columns columns;
  columns.of_double.assign(form.count, std::vector<double>(draws.count));
  columns.of_float.assign(form.count, std::vector<float>(draws.count));
  for (std::size_t i = 0; i < draws.count; ++i) {
    std::vector<double> row = defaults;
    Inputs inputs(form, row.data());
    rung.inputs(draws.rows.data() + i * family.draw_names.size(), inputs);
    for (std::size_t k = 0; k < form.count; ++k) {
      columns.of_double[k][i] = row[k];
      columns.of_float[k][i] = static_cast<float>(row[k]);
    }
  }
  return columns;
}

namespace {

template <class N>
std::vector<std::vector<double>> outputs(const catalog::Entry& entry, const catalog::Loops<N>& loops,
                                         const std::vector<std::vector<N>>& columns, std::size_t count) {
  std::vector<catalog::Column<N>> in;
  for (const auto& column : columns) in.push_back({column.data(), false});
  std::vector<std::vector<N>> results(entry.output_count, std::vector<N>(count));
  std::vector<N*> out;
  for (auto& column : results) out.push_back(column.data());
  loops.from_inputs(entry.tables(), in.data(), out.data(), count);
  std::vector<std::vector<double>> wide;
  for (const auto& column : results) wide.emplace_back(column.begin(), column.end());
  return wide;
}

}  // namespace

std::vector<double> values_of(const Rung& rung, const catalog::Entry& entry, const Draws& draws, const Columns& columns,
                              Precision precision) {
  const auto out = precision == Precision::kDouble  ? outputs(entry, entry.in_double, columns.of_double, draws.count)
                   : precision == Precision::kFloat ? outputs(entry, entry.in_float, columns.of_float, draws.count)
                                                    : outputs(entry, entry.in_batches, columns.of_float, draws.count);
  std::size_t at = 0;
  for (const brdf::Output& output : entry.outputs) {
    if (rung.output.empty() || output.name == rung.output) return out[at];
    at += static_cast<std::size_t>(output.channels);
  }
  throw std::logic_error(std::string(entry.name) + " has no output " + rung.output);
}

Accuracy accuracy_of(const Family& family, const Draws& draws, const std::vector<double>& values,
                     const std::vector<double>& reference) {
  const std::size_t width = family.draw_names.size();
  const auto draw = [&](std::size_t i) { return draws.rows.data() + i * width; };
  const auto weight = [&](std::size_t i) { return family.value_weight ? family.value_weight(draw(i)) : 1.0; };
  double squares = 0, reference_squares = 0;
  for (std::size_t i = 0; i < draws.count; ++i) {
    const double w = weight(i), d = w * (values[i] - reference[i]);
    squares += d * d;
    reference_squares += w * reference[i] * w * reference[i];
  }
  const double mean = std::sqrt(reference_squares / double(draws.count));
  Accuracy accuracy{std::sqrt(squares / reference_squares), 0, "", std::numeric_limits<double>::quiet_NaN()};
  std::size_t worst = 0;
  for (std::size_t i = 0; i < draws.count; ++i) {
    const double w = weight(i);
    const double off = w * std::abs(values[i] - reference[i]);
    if (off == 0) continue;
    const double relative = off / std::max(w * std::abs(reference[i]), family.negligible * mean);
    if (std::isnan(accuracy.worst)) break;  // no number is farther off than none
    if (!(relative <= accuracy.worst)) accuracy.worst = relative, worst = i;
  }
  for (std::size_t k = 0; k < width; ++k) {
    char text[64];
    std::snprintf(text, sizeof text, "%s%s = %.4g", k == 0 ? "" : ", ", family.draw_names[k].c_str(),
                  draws.rows[worst * width + k]);
    accuracy.where += text;
  }
  if (family.energy_weight) {
    std::vector<double> sum(family.energy_bins), reference_sum(family.energy_bins);
    for (std::size_t i = 0; i < draws.count; ++i) {
      const double w = family.energy_weight(draw(i));
      if (w == 0) continue;
      const std::size_t bin = family.energy_bin ? family.energy_bin(draw(i)) : 0;
      sum[bin] += w * values[i];
      reference_sum[bin] += w * reference[i];
    }
    accuracy.energy = 0;
    for (std::size_t bin = 0; bin < sum.size(); ++bin) {
      if (reference_sum[bin] == 0 || std::isnan(accuracy.energy)) continue;
      const double error = sum[bin] / reference_sum[bin] - 1;
      if (!(std::abs(error) <= std::abs(accuracy.energy))) accuracy.energy = error;
    }
  }
  return accuracy;
}

}  // namespace likeness::cost
