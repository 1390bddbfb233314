#include "fit/coordinates.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "render/files/files.h"

namespace likeness::fit {

namespace {

using brdf::Parameter;
using brdf::Tier;

std::span<const Parameter> table_of(const brdf::AnyBrdf& model) {
  return std::visit([](const auto& m) { return std::span<const Parameter>(m.kParameters); }, model);
}

brdf::AnyBrdf model_at(std::size_t index) {
  brdf::AnyBrdf out;
  brdf::model_of_name(brdf::kModelNames[index], out);
  return out;
}

int first_channel(std::span<const Parameter> table, std::string_view name) {
  int at = 0;
  for (const Parameter& row : table) {
    if (row.name == name) return at;
    at += row.channels;
  }
  return -1;
}

const Parameter* tint_of(std::span<const Parameter> table, const Parameter& scale) {
  for (const Parameter& row : table)
    if (row.tints == scale.name) return &row;
  return nullptr;
}

bool exposed(const Parameter& row, Tier tier) { return static_cast<int>(row.tier) <= static_cast<int>(tier); }

// Directional variables mean nothing for data without a tangent frame.
bool isotropic_only(const Parameter& row) { return row.name == "anisotropic"; }

Coordinate coordinate(const Parameter& row, std::string_view name, std::vector<int> channels, int color) {
  Coordinate c;
  c.name = name;
  c.color = color;
  c.channels = std::move(channels);
  c.low = row.range.low;
  c.high = row.range.high;
  c.start_low = row.typical.low;
  c.start_high = row.typical.high;
  c.logarithmic = row.name == "roughness" || row.range.high > 4;
  if (c.logarithmic) c.start_low = std::max(c.start_low, c.start_high / 32);
  c.signed_scale = row.range.low < 0;
  c.reflectance = row.role == brdf::Role::kScale && row.channels == 3;
  return c;
}

}  // namespace

bool has_tier(const brdf::AnyBrdf& model, Tier tier) {
  return std::ranges::any_of(table_of(model), [&](const Parameter& row) { return row.tier == tier; });
}

Coordinates coordinates_of(const brdf::AnyBrdf& model, Tier tier) {
  if (tier != Tier::kPlain && !has_tier(model, tier))
    throw files::UsageError("--tier " + std::string(brdf::kTierNames[static_cast<std::size_t>(tier)]) + ": model " +
                            std::string(brdf::kModelNames[model.index()]) + " has no tiers; leave the option out");
  const auto table = table_of(model);
  Coordinates out;
  out.model = model.index();
  out.fixed = folded(model_at(out.model));
  int at = 0;
  for (const Parameter& row : table) {
    const int first = at;
    at += row.channels;
    if (!exposed(row, tier) || isotropic_only(row)) continue;
    if (!row.tints.empty()) {
      const Parameter& scale = *std::ranges::find(table, row.tints, &Parameter::name);
      for (int c = 0; c < 3; ++c) out.variables.push_back(coordinate(scale, row.name, {first + c}, c));
    } else if (const Parameter* tint = tint_of(table, row)) {
      if (exposed(*tint, tier)) continue;  // its tint carries the product, one variable a color
      const int t = first_channel(table, tint->name);
      out.variables.push_back(coordinate(row, row.name, {t, t + 1, t + 2}, -1));
    } else if (row.channels == 3) {
      for (int c = 0; c < 3; ++c) out.variables.push_back(coordinate(row, row.name, {first + c}, c));
    } else {
      out.variables.push_back(coordinate(row, row.name, {first}, -1));
    }
  }
  return out;
}

std::vector<double> Coordinates::channels_at(const std::vector<double>& x) const {
  std::vector<double> channels = fixed;
  for (std::size_t i = 0; i < variables.size(); ++i)
    for (const int c : variables[i].channels) channels[c] = x[i];
  return channels;
}

std::vector<double> Coordinates::at_channels(const std::vector<double>& channels) const {
  std::vector<double> x(size());
  for (std::size_t i = 0; i < size(); ++i)
    x[i] = std::clamp(channels[variables[i].channels.front()], variables[i].low, variables[i].high);
  return x;
}

std::vector<double> plain_channels(const brdf::AnyBrdf& model) {
  return std::visit(
      []<template <class> class M>(const M<double>& m) {
        const auto channels = brdf::channels_of(m);
        return std::vector<double>(channels.begin(), channels.end());
      },
      model);
}

std::vector<double> folded(const brdf::AnyBrdf& model) {
  std::vector<double> channels = plain_channels(model);
  const auto table = table_of(model);
  int at = 0;
  for (const Parameter& row : table) {
    if (!row.tints.empty()) {
      const int scale = first_channel(table, row.tints);
      for (int c = 0; c < 3; ++c) channels[at + c] *= channels[scale];
      channels[scale] = 1;
    }
    at += row.channels;
  }
  return channels;
}

brdf::AnyBrdf unfolded(std::size_t model, const std::vector<double>& folded_channels) {
  std::vector<double> channels = folded_channels;
  brdf::AnyBrdf out = model_at(model);
  const auto table = table_of(out);
  int at = 0;
  for (const Parameter& row : table) {
    if (!row.tints.empty()) {
      double scale = 0;
      for (int c = 0; c < 3; ++c)
        if (std::abs(channels[at + c]) > std::abs(scale)) scale = channels[at + c];
      for (int c = 0; c < 3; ++c) channels[at + c] = scale == 0 ? 1 : channels[at + c] / scale;
      channels[first_channel(table, row.tints)] = scale;
    }
    at += row.channels;
  }
  std::visit([&]<template <class> class M>(M<double>& m) { m = brdf::model_from_channels<M, double>(channels.data()); },
             out);
  return out;
}

}  // namespace likeness::fit
