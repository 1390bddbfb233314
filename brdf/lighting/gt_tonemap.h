#pragma once

#include <array>
#include <tuple>

#include "brdf/parameter.h"

namespace likeness::brdf {

// The Gran Turismo tonemapper: a toe, a line and a shoulder.
//
//     f(x) = T(x) (1 - w) + L(x) w     x <  m,        w = smoothstep(0, m, x)
//          = L(x)                      x <= S0 = m + (P - m) l / a
//          = S(x)                      beyond
//     T = m (x / m)^c + b,   L = m + a (x - m),   S = P - (P - S1) exp(-a (x - S0) / (P - S1)),   S1 = L(S0)
//
// x       scene light [1], linear; y = f(x) is display light, before the display's own encoding
// Source  Uchimura 2017, "HDR theory and practice" (CEDEC).
// Holds   f is defined for every float: x below 0 and NaN are taken as 0, and x above 1e30 as 1e30, where f = P to
//         rounding. f(0) = b if m > 0, f is continuous and below or at P. At l = 1 (S1 = P) the shoulder is the
//         constant P. At the defaults f is monotone, and wherever rises() says so.
// Does not  rise everywhere at steep contrasts: the published blend of toe and line dips if a is above 2.3 at c = 1.33,
//         1.3 at c = 2, 1.0 at c = 3, less with a pedestal. Where the dip would go below 0 it is clamped.
template <Scalar S>
struct GtTonemap {
  static constexpr std::string_view kName = "gt_tonemap";
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "P", .initial = 1, .range = {1, 100}, .typical = {1, 10}, .role = Role::kScale,
                .text = "the brightest that the display shows; above m"},
      Parameter{.name = "a", .initial = 1, .range = {0.05, 2}, .typical = {0.8, 1.3}, .text = "contrast: slope of the line"},
      Parameter{.name = "m", .initial = 0.22, .range = {0, 0.9}, .typical = {0.1, 0.4}, .text = "where the line begins"},
      Parameter{.name = "l", .initial = 0.4, .range = {0, 1}, .typical = {0.2, 0.6},
                .text = "length of the line, as a share of what is above m; at 1 there is no shoulder"},
      Parameter{.name = "c", .initial = 1.33, .range = {1, 3}, .typical = {1, 1.6}, .text = "tightness of the blacks: power of the toe"},
      Parameter{.name = "b", .initial = 0, .range = {0, 0.1}, .typical = {0, 0.02}, .text = "pedestal: f(0)"},
  };
  // clang-format on
  static constexpr auto members() {
    using G = GtTonemap;
    return std::tuple{&G::max_brightness, &G::contrast, &G::linear_start, &G::linear_length, &G::black, &G::pedestal};
  }
  S max_brightness = S(kParameters[0].initial);
  S contrast = S(kParameters[1].initial);
  S linear_start = constant<S>(kParameters[2].initial);
  S linear_length = constant<S>(kParameters[3].initial);
  S black = constant<S>(kParameters[4].initial);
  S pedestal = S(kParameters[5].initial);

  // S0, where the shoulder begins.
  S shoulder_start() const { return linear_start + (max_brightness - linear_start) * linear_length / contrast; }

  S eval(const S& value) const {
    const S x = smaller(positive(value), constant<S>(1e30));
    const S& m = linear_start;
    const auto in_toe = greater(m, x);
    const S t = pick(in_toe, S(x / pick(in_toe, m, S(1))), S(1));
    const S w = t * t * (S(3) - S(2) * t), line = m + contrast * (x - m);
    const S toe = positive(S((S(1) - w) * (m * power(t, black) + pedestal) + w * line));

    const S start = shoulder_start(), room = headroom();
    const auto in_shoulder = greater(x, start), has_shoulder = greater(room, constant<S>(kTiny<S>));
    // From below and from above: P - room would lose a small y beside a large P, S1 + room would miss P by a rounding.
    const S z = contrast * positive(S(x - start)) / pick(has_shoulder, room, S(1));
    const S low = start_value() - room * expm1(S(-z)), high = max_brightness - room * exp(S(-z));
    const S shoulder = pick(has_shoulder, pick(greater(S(0.5), z), low, high), max_brightness);
    return pick(in_toe, toe, pick(in_shoulder, shoulder, line));
  }

  // The x of a y, for curves that rise. y at or below b, and NaN, give 0; y at or above P (1 - 2^-53) gives the x of
  // that, 17.4 at the defaults, because no x gives P itself.
  S inverse(const S& y) const { return inverse(y, S(max_brightness - y)); }
  // With P - y apart, which decides near P.
  S inverse(const S& y, const S& below_p) const {
    const S& m = linear_start;
    const S t = toe_inverse(S(y - pedestal) / pick(greater(m, S(0)), m, S(1)));
    const S line = m + (y - m) / contrast;

    const S start = shoulder_start(), room = headroom();
    const auto has_shoulder = greater(room, constant<S>(kTiny<S>));
    // Again from below and from above.
    const S room_or_1 = pick(has_shoulder, room, S(1)),
            risen = smaller(S(positive(S(y - start_value())) / room_or_1), S(0.5));
    const S ratio = larger(S(room_or_1 / larger(below_p, S(constant<S>(0x1p-53) * max_brightness))), S(1));
    const S z = pick(greater(S(0.5), risen), S(-log1p(S(-risen))), S(log(ratio)));
    const S shoulder = start + pick(has_shoulder, S(room * z / contrast), S(0));
    const auto above_line = greater(room, below_p);
    return pick(greater(y, pedestal),
                pick(greater(m, y), S(m * t), pick(both(has_shoulder, above_line), shoulder, smaller(line, start))),
                S(0));
  }

  // Whether the curve falls nowhere, from its slope at 1024 places in the toe, denser towards 0; the rest always rises.
  bool rises() const
    requires std::same_as<S, Value<S>> && std::floating_point<S>
  {
    for (int i = 1; i <= 1024; ++i) {
      const S t = squared(S(squared(S(S(i) / S(1024)))));
      if (slope_times_t(t, power(t, black), contrast, black, pedestal_share()) < S(0)) return false;
    }
    return true;
  }

  // 0 in the toe, 1 on the line, 2 in the shoulder.
  S part(const S& x) const {
    return pick(greater(x, shoulder_start()), S(2), pick(greater(linear_start, positive(x)), S(0), S(1)));
  }

 private:
  S start_value() const { return linear_start + (max_brightness - linear_start) * linear_length; }  // S1
  // P - S1.
  S headroom() const { return positive(S((max_brightness - linear_start) * (S(1) - linear_length))); }
  S pedestal_share() const { return pedestal / pick(greater(linear_start, S(0)), linear_start, S(1)); }

  // (f - b) / m in the toe, at t = x / m with t^c given; share = b / m.
  template <Scalar T>
  static T over_pedestal(const T& t, const T& t_to_c, const T& a, const T& share) {
    const T w = t * t * (T(3) - T(2) * t);
    return (T(1) - w) * t_to_c + w * (T(1) - a * (T(1) - t) - share);
  }
  // Its derivative by t, times t.
  template <Scalar T>
  static T slope_times_t(const T& t, const T& t_to_c, const T& a, const T& c, const T& share) {
    const T w = t * t * (T(3) - T(2) * t), w_slope = T(6) * t * t * (T(1) - t);
    return (T(1) - w) * c * t_to_c + t * w * a + w_slope * (T(1) - a * (T(1) - t) - share - t_to_c);
  }

  // The t of a value of over_pedestal. Newton's method on the logarithms, between which the toe is nearly a line, kept
  // inside a bracket that shrinks; then one step in S, which carries the derivatives (implicit function theorem).
  S toe_inverse(const S& target) const {
    using T = Value<S>;
    const auto value = [](const S& x) { return T(Arithmetic<S>::value(x)); };
    const T a = value(contrast), c = value(black), share = value(pedestal_share());
    const T least = constant<T>(kTiny<T> * kTiny<T>);
    const T log_target = log(smaller(larger(value(target), least), T(1)));
    // over_pedestal <= t^c + 3 t^2 <= 4 t^min(c, 2).
    T low = (log_target - constant<T>(1.3862943611198906)) / smaller(c, T(2)), high = T(0), s = log_target / c;
    for (int i = 0; i < kSteps; ++i) {
      const T t = exp(s), t_to_c = exp(T(c * s));
      const T at = larger(over_pedestal(t, t_to_c, a, share), least);
      const T error = log(at) - log_target, slope = larger(slope_times_t(t, t_to_c, a, c, share), least);
      const auto above = greater(error, T(0));
      high = pick(above, s, high);
      low = pick(above, low, s);
      const T next = s - error * at / slope;
      const auto outside = either(greater(low, next), greater(next, high));
      s = pick(outside, T(T(0.5) * (low + high)), next);
    }
    const T t = exp(s), t_to_c = power(t, c);
    const T slope = larger(T(slope_times_t(t, t_to_c, a, c, share) / larger(t, least)), least);
    const S error = over_pedestal(S(t), power(t, black), contrast, pedestal_share()) - target;
    return positive(S(S(t) - error / S(slope)));
  }
  static constexpr int kSteps = 8;  // 7 reach rounding at 13000 random curves that rise
};

}  // namespace likeness::brdf
