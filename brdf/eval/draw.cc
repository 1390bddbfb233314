#include "brdf/eval/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace likeness::eval {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array kSpecial{0.0, 1e-45, 1.2e-38, 1e-20, 1e-7, 1e-4,    0.25,    0.5, 2.0 / 3, 1 - 1e-7, 1.0,
                              1.5, 2.0,   3.0,     4.0,   kPi,  kPi / 2, kPi / 4, 10., 100.0,   1000.0};

// Inputs that say how much work is done, and not where: more of it is dearer and no harder. They are drawn up to where their
// usual values begin.
constexpr std::array kEfforts{std::string_view("walks")};

brdf::Parameter drawn(brdf::Parameter p) {
  if (std::find(kEfforts.begin(), kEfforts.end(), p.name) == kEfforts.end()) return p;
  p.range.high = p.initial = p.typical.high = p.typical.low;
  p.typical.low = p.range.low;
  return p;
}

float within(double value, float low, float high) { return std::clamp(static_cast<float>(value), low, high); }

// The float within [low, high] that is nearest to one of its ends.
float rounded_up(double low) {
  const float x = static_cast<float>(low);
  return double{x} < low ? std::nextafter(x, std::numeric_limits<float>::infinity()) : x;
}
float rounded_down(double high) {
  const float x = static_cast<float>(high);
  return double{x} > high ? std::nextafter(x, -std::numeric_limits<float>::infinity()) : x;
}

double power_of_ten(Random& random, double least) { return std::pow(10.0, random.uniform(least, 0)); }

struct Vector {
  double x, y, z;
};

Vector at_height(double z, double phi) {
  const double r = std::sqrt(std::max(0.0, (1 - z) * (1 + z)));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Vector any_direction(Random& random, unsigned edges) {
  double z = random.uniform(-0.1, 1);
  if (random.below(8) < edges) {
    constexpr std::array kHeights{0.0, 1.0, 1e-7, -1e-7, 1e-4, 1e-12, 1e-20, 1e-38, -1.0, 1 - 1e-7, 0.5, 1e-2};
    z = random.below(4) == 0 ? random.uniform(-1, 1) : kHeights[random.below(kHeights.size())];
  }
  if (random.below(4) != 0) return at_height(z, random.uniform(0, 2 * kPi));
  const Vector along = at_height(z, 0);  // along an axis, exactly
  switch (random.below(4)) {
    case 0:
      return along;
    case 1:
      return {0, along.x, z};
    case 2:
      return {-along.x, 0, z};
    default:
      return {0, -along.x, z};
  }
}

Vector beside(const Vector& v, double distance, Random& random) {
  Vector w{v.x + distance * random.uniform(-1, 1), v.y + distance * random.uniform(-1, 1),
           v.z + distance * random.uniform(-1, 1)};
  const double length = std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z);
  if (length < 0.1) return v;
  return {w.x / length, w.y / length, w.z / length};
}

// A direction after the one before it: often identical, mirrored or opposite.
Vector next_direction(const Vector& before, Random& random, unsigned edges) {
  Vector v{};
  switch (random.below(8)) {
    case 0:
      v = before;
      break;
    case 1:
    case 2:
    case 3:
      v = {-before.x, -before.y, before.z};
      break;
    case 4:
      v = {-before.x, -before.y, -before.z};
      break;
    default:
      return any_direction(random, edges);
  }
  return random.below(2) == 0 ? v : beside(v, power_of_ten(random, -8), random);
}

}  // namespace

std::uint64_t stream_of(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return Random(seed, hash).next();
}

Draw::Draw(std::span<const brdf::Parameter> inputs) {
  int run = 0;
  for (const brdf::Parameter& row : inputs) {
    const brdf::Parameter p = drawn(row);
    Input input{p, rounded_up(p.range.low), rounded_down(p.range.high), {}, false};
    for (const double value : kSpecial)
      for (const double signed_value : {value, -value})
        if (signed_value >= p.range.low && signed_value <= p.range.high) input.special.push_back(signed_value);
    if (input.special.empty()) input.special.push_back(p.initial);
    rows_.insert(rows_.end(), static_cast<std::size_t>(p.channels), input);
    run = p.role == brdf::Role::kDirection && p.channels == 1 ? run + 1 : 0;
    if (run == 3) {
      rows_[rows_.size() - 3].direction = true;
      run = 0;
    }
  }
}

float Draw::beside(std::size_t input, float x) const {
  const float infinity = std::numeric_limits<float>::infinity();
  return std::nextafter(x, 2 * x < rows_[input].low + rows_[input].high ? infinity : -infinity);
}

float Draw::scalar(const Input& input, Random& random, unsigned edges) const {
  const brdf::Parameter& p = input.parameter;
  const double low = p.range.low, high = p.range.high, span = high - low;
  if (random.below(8) >= edges) {
    if (!p.logarithmic || low < 0) return within(random.uniform(low, high), input.low, input.high);
    const double from = std::log(low > 0 ? low : 1e-12 * high);
    return within(std::exp(random.uniform(from, std::log(high))), input.low, input.high);
  }
  double value = 0;
  switch (random.below(12)) {
    case 0:
    case 1:
      value = low;
      break;
    case 2:
    case 3:
      value = high;
      break;
    case 4:
      value = p.initial;
      break;
    case 5:
      value = low + span * (random.below(2) == 0 ? 1e-7 : power_of_ten(random, -12));
      break;
    case 6:
      value = high - span * (random.below(2) == 0 ? 1e-7 : power_of_ten(random, -8));
      break;
    case 7:
      value = (random.below(2) == 0 ? -1 : 1) * std::max(std::abs(low), std::abs(high)) * power_of_ten(random, -38);
      break;
    case 8:
    case 9:
      value = random.uniform(p.typical.low, p.typical.high);
      break;
    default:
      value = input.special[random.below(static_cast<unsigned>(input.special.size()))];
  }
  return within(value, input.low, input.high);
}

void Draw::row(Random& random, float* const* columns, std::size_t row) const {
  constexpr std::array<unsigned, 4> kEdges{0, 1, 4, 4};  // inputs in eight that lie on an edge
  const unsigned edges = kEdges[random.below(4)];
  Vector before{};
  bool first = true;
  for (std::size_t i = 0; i < rows_.size();) {
    if (!rows_[i].direction) {
      columns[i][row] = scalar(rows_[i], random, edges);
      ++i;
      continue;
    }
    const Vector v = first ? any_direction(random, edges) : next_direction(before, random, edges);
    first = false;
    before = v;
    for (const double x : {v.x, v.y, v.z}) {
      columns[i][row] = within(x, rows_[i].low, rows_[i].high);
      ++i;
    }
  }
}

}  // namespace likeness::eval
