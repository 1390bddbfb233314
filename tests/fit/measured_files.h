#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "fit/measured/half_angles.h"
#include "fit/measured/merl.h"

// Small valid files of each binary format, made from a function of directions. The corpus of the fuzzers is these.
namespace likeness::measured::test {

inline constexpr MerlSize kSmallMerl{4, 3, 6};
using Brdf = std::function<Rgb(const Direction&, const Direction&)>;

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof raw);
}

// A glossy, reciprocal, mirror-symmetric BRDF.
inline Rgb glossy(const Direction& l, const Direction& v) {
  const HalfAngles a = half_angles(l, v);
  const double peak = std::exp(-8 * a.theta_h * a.theta_h) * (0.5 + 0.2 * std::sin(a.theta_d));
  return {0.1 + peak, 0.2 + peak, 0.05 + 2 * peak};
}

inline std::string small_merl(MerlSize size = kSmallMerl) {
  std::vector<Rgb> table;
  for (int h = 0; h < size.theta_h; ++h)
    for (int d = 0; d < size.theta_d; ++d)
      for (int p = 0; p < size.phi_d; ++p) {
        const HalfAngles a = merl_bin_centre(size, h, d, p);
        const auto g = brdf::geometry_at(a.theta_h, a.theta_d, a.phi_d);
        table.push_back(g.above ? glossy(g.to_light, g.to_view) : Rgb(-1));
      }
  return merl_bytes(table, size);
}

inline std::string small_mbsdf(int theta = 3, int phi = 4, const Brdf& brdf = glossy) {
  std::string bytes = "NVIDIA ARC MBSDF V1\nmaterial=test\nMBSDF_DATA_REFLECTION=\n";
  put(bytes, std::uint32_t{1});
  put(bytes, std::uint32_t(theta));
  put(bytes, std::uint32_t(phi));
  for (int i = 0; i < theta; ++i)
    for (int j = 0; j < theta; ++j)
      for (int k = 0; k < phi; ++k) {
        Direction l, v;
        const double step = std::numbers::pi / 2 / theta;
        directions_at({(i + 0.5) * step, (j + 0.5) * step, (k + 0.5) * std::numbers::pi / phi}, l, v);
        const Rgb f = brdf(l, v);
        for (const double c : {f.r, f.g, f.b}) put(bytes, float(c));
      }
  return bytes;
}

// Flat maps: vndf 1, ndf and sigma as given, so that f = color ndf / (4 sigma cos theta_o).
struct RglParts {
  int theta = 3, map = 4, colors = 3, phi = 1;
  float ndf = 2, sigma = 0.5f;
  Rgb color{0.5, 0.25, 0.125};
  std::string color_name = "rgb";
};

inline std::string small_rgl(const RglParts& parts = {}) {
  struct Field {
    std::string name;
    std::uint8_t type;
    std::vector<std::uint64_t> shape;
    std::string data;
  };
  std::vector<Field> fields;
  const auto add = [&](std::string name, std::vector<std::uint64_t> shape,
                       const std::function<float(std::size_t)>& value) {
    std::size_t count = 1;
    for (const auto extent : shape) count *= extent;
    Field field{std::move(name), 10, std::move(shape), {}};
    for (std::size_t i = 0; i < count; ++i) put(field.data, value(i));
    fields.push_back(std::move(field));
  };
  const std::uint64_t phi = parts.phi, theta = parts.theta, map = parts.map, colors = parts.colors;
  fields.push_back({"description", 1, {4}, "test"});
  add("phi_i", {phi}, [](std::size_t i) { return float(i); });
  add("theta_i", {theta}, [&](std::size_t i) { return float(i) / float(theta - 1) * 1.5707964f; });
  add("sigma", {2, map}, [&](std::size_t) { return parts.sigma; });
  add("ndf", {2, map}, [&](std::size_t) { return parts.ndf; });
  add("vndf", {phi, theta, map, map}, [](std::size_t) { return 1.0f; });
  add(parts.color_name, {phi, theta, 3, colors, colors}, [&](std::size_t i) {
    const std::size_t channel = i / (colors * colors) % 3;
    return float(channel == 0 ? parts.color.r : channel == 1 ? parts.color.g : parts.color.b);
  });
  fields.push_back({"jacobian", 1, {1}, "\1"});

  std::string bytes("tensor_file\0\1\0", 14);
  put(bytes, std::uint32_t(fields.size()));
  std::size_t offset = bytes.size();
  for (const Field& f : fields) offset += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
  for (const Field& f : fields) {
    put(bytes, std::uint16_t(f.name.size()));
    bytes += f.name;
    put(bytes, std::uint16_t(f.shape.size()));
    put(bytes, f.type);
    put(bytes, std::uint64_t(offset));
    for (const auto extent : f.shape) put(bytes, extent);
    offset += f.data.size();
  }
  for (const Field& f : fields) bytes += f.data;
  return bytes;
}

inline std::string small_csv() {
  return "# ours\ntheta_i_deg, theta_o_deg, phi_deg, r, g, b, weight\n0,0,0,.1,.2,.3,1\n30,30,180,1,2,3,.5\n"
         "30,30,180,3,2,1,.5 # again\n45,60,-90,.1,-.2,.3,1\n\n10,20,30,nan,0,0,1\n";
}

}  // namespace likeness::measured::test
