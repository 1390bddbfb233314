#include "render/image/flip_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/image/cie_lab.h"

namespace likeness::image::flip_steps {
namespace {

using Matrix = Matrix3;

// XYZ over that of white, so that white is (1, 1, 1).
constexpr Matrix normalized() {
  Matrix out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = kXyzOfRec709[i][j] / kWhiteOfRec709[i];
  return out;
}

constexpr Matrix inverse(const Matrix& m) {
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  Matrix out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      out[i][j] = (m[a][c] * m[b][d] - m[a][d] * m[b][c]) / determinant;
    }
  return out;
}

constexpr Matrix kToXyz = normalized();
constexpr Matrix kFromXyz = inverse(kToXyz);

Triple times(const Matrix& m, const Triple& v) {
  const auto row = [&](std::size_t i) {
    return static_cast<float>(m[i][0]) * v.x + static_cast<float>(m[i][1]) * v.y + static_cast<float>(m[i][2]) * v.z;
  };
  return {row(0), row(1), row(2)};
}

struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array kSensitivity{Sensitivity{1, 0.0047, 0, 1e-5}, Sensitivity{1, 0.0053, 0, 1e-5},
                                  Sensitivity{34.1, 0.04, 13.5, 0.025}};

// Narkowicz' fraction of x and x^2, with the paper's exposure of 0.6 in its coefficients.
constexpr double kN2 = 0.6 * 0.6 * 2.51, kN1 = 0.6 * 0.03, kD2 = 0.6 * 0.6 * 2.43, kD1 = 0.6 * 0.59, kD0 = 0.14;

}  // namespace

Triple ycxcz_of_linear(const Triple& rgb) {
  const Triple t = times(kToXyz, rgb);
  return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}

Triple linear_of_ycxcz(const Triple& c) {
  const float y = (c.x + 16) / 116;
  return times(kFromXyz, {y + c.y / 500, y, y - c.z / 200});
}

Triple hunt_lab(const Triple& rgb) {
  const Triple t = times(kToXyz, rgb);
  const float x = lab_curve(t.x), y = lab_curve(t.y), z = lab_curve(t.z);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

float hyab(const Triple& p, const Triple& q) {
  const float a = p.y - q.y, b = p.z - q.z;
  return std::abs(p.x - q.x) + std::sqrt(a * a + b * b);
}

float color_difference(float distance) {
  constexpr float kPower = 0.7f, kBend = 0.4f, kAtBend = 0.95f;
  static const float kLargest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kPower);
  const float powered = std::pow(distance, kPower), bend = kBend * kLargest;
  return powered < bend ? kAtBend / bend * powered : kAtBend + (powered - bend) / (kLargest - bend) * (1 - kAtBend);
}

std::vector<Term> contrast_filter(Opponent channel, double pixels_per_degree) {
  constexpr double kPi = std::numbers::pi;
  const double widest = kSensitivity[2].b1;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * kPi * kPi)) * pixels_per_degree));
  const Sensitivity& s = kSensitivity[static_cast<std::size_t>(channel)];
  std::vector<Term> terms;
  double total = 0;
  std::vector<double> weights;
  for (const auto& [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
    if (a == 0) continue;
    std::vector<double> taps;
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
      const double degrees = i / pixels_per_degree;
      sum += taps.emplace_back(std::exp(-kPi * kPi * degrees * degrees / b));
    }
    Term& term = terms.emplace_back();
    for (const double t : taps) term.taps.push_back(static_cast<float>(t / sum));
    total += weights.emplace_back(a * std::sqrt(kPi / b) * sum * sum);
  }
  for (std::size_t i = 0; i < terms.size(); ++i) terms[i].weight = static_cast<float>(weights[i] / total);
  return terms;
}

FeatureFilters feature_filters(double pixels_per_degree) {
  const double deviation = 0.5 * 0.082 * pixels_per_degree;  // 0.082 degrees from peak to trough
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  std::vector<double> gauss, edge, point;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i / deviation, g = std::exp(-0.5 * x * x);
    gauss.push_back(g);
    edge.push_back(-x * g);
    point.push_back((x * x - 1) * g);
  }
  const auto balanced = [](const std::vector<double>& taps) {
    double positive = 0, negative = 0;
    for (const double t : taps) (t > 0 ? positive : negative) += std::abs(t);
    std::vector<float> out;
    for (const double t : taps) out.push_back(t == 0 ? 0 : static_cast<float>(t / (t > 0 ? positive : negative)));
    return out;
  };
  return {balanced(edge), balanced(point), balanced(gauss)};
}

float tone_curve(float light) {
  if (light >= 16) return 1;  // 1 is reached at 12.1; squares of large floats overflow
  const float x = std::max(light, 0.0f);
  const float y = (static_cast<float>(kN2) * x + static_cast<float>(kN1)) * x /
                  ((static_cast<float>(kD2) * x + static_cast<float>(kD1)) * x + static_cast<float>(kD0));
  return std::min(y, 1.0f);
}

double light_of_tone_085() {
  constexpr double kTone = 0.85;  // a x^2 + b x + c = 0
  constexpr double kA = kN2 - kD2 * kTone, kB = kN1 - kD1 * kTone, kC = -kD0 * kTone;
  return (-kB + std::sqrt(kB * kB - 4 * kA * kC)) / (2 * kA);
}

}  // namespace likeness::image::flip_steps
