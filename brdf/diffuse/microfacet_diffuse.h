#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <type_traits>

#include "brdf/vector.h"

// Diffuse reflection by microfacets that are each Lambertian, with GGX's distribution of normals and no shadowing
// (G2 = 1), over the base color:
//
//     f / rho = 1 / (pi cos_o cos_i) integral over normals h of max(0, o . h) max(0, i . h) D(h) dh     [1/sr]
//
// Source  Heitz 2014 (JCGT 3(2)), which states the integral; with G2 = 1 as in The Callisto Protocol (SIGGRAPH 2023,
//         Advances), because a normal map does not know what it hides. It has no closed form; here it is done to
//         rounding.
//
// How     Slopes are divided by alpha and laid on the unit sphere, u = (V cos t, V sin t, m): then D is even, and a
//         facet turns from o where u . (alpha sin_o, 0, cos_o) < 0, which is a great circle
//         (docs/models/microfacet_diffuse.md). Along an azimuth t the integral from the pole to V is elementary, of
//         moments() below. So three pieces are left: azimuths where neither circle is in the way, in closed form; and
//         the arc of either circle that is the first one met from the pole, as an integral over that arc, whose
//         integrand is analytic and never cancels. Gauss's rule takes it in a variable that pushes its nearest
//         singularity to a distance of pi / 2.
// Error   double 1e-8, float 1e-5, for every alpha in [0, 1], angle up to 89.9 degrees, and azimuth.
namespace likeness::brdf {

inline constexpr std::size_t kPolarColumns = 9;  // the plain numbers of a PolarPair

// What microfacet_diffuse() reads of two directions above the horizon, without cancellation.
template <Scalar S>
struct PolarPair {
  S cos_o, sin_o, cos_i, sin_i;  // of the viewer's and the light's angle to the normal
  S cos_phi, sin_phi;            // of the azimuth between them, taken to [0, pi]
  S gap;                         // pi - that azimuth
  S past_o, past_i;              // sin_o cos_i - cos_o sin_i cos_phi, and with o and i exchanged

  // Directions that stand upright have no azimuth: it is taken as 0, as good as any.
  static auto leaning(const S& sin_o, const S& sin_i) { return greater(larger(sin_o, sin_i), constant<S>(1e-15)); }

  // From angles in [0, pi / 2] to the normal, and any azimuth between them.
  static PolarPair at(const S& theta_o, const S& theta_i, const S& phi) {
    const S sin_o = sin(theta_o), sin_i = sin(theta_i), cos_o = cos(theta_o), cos_i = cos(theta_i);
    const auto any = leaning(sin_o, sin_i);
    const S cos_phi = pick(any, S(cos(phi)), S(1)), sin_phi = pick(any, S(abs(S(sin(phi)))), S(0));
    const S versine = pick(any, S(S(2) * squared(S(sin(S(phi * S(0.5)))))), S(0));
    const S beyond = sin(S(theta_o - theta_i));
    return {cos_o,
            sin_o,
            cos_i,
            sin_i,
            cos_phi,
            sin_phi,
            S(atan2(sin_phi, S(-cos_phi))),
            S(beyond + cos_o * sin_i * versine),
            S(cos_i * sin_o * versine - beyond)};
  }

  // From unit vectors in the local frame. What would cancel when they are near each other comes from their difference.
  static PolarPair of(const Vec3<S>& l, const Vec3<S>& v) {
    const S sin_o = safe_sqrt(S(v.x * v.x + v.y * v.y)), sin_i = safe_sqrt(S(l.x * l.x + l.y * l.y));
    const auto usable_o = greater(sin_o, constant<S>(1e-15)), usable_i = greater(sin_i, constant<S>(1e-15));
    const auto flat = [](const auto& usable, const S& x, const S& sine) {
      return pick(usable, S(x / pick(usable, sine, S(1))), S(0));
    };
    const S ox = flat(usable_o, v.x, sin_o), oy = flat(usable_o, v.y, sin_o);
    const S ix = flat(usable_i, l.x, sin_i), iy = flat(usable_i, l.y, sin_i);
    const auto both_lean = both(usable_o, usable_i);
    const Vec3<S> d = v - l;
    const S cos_phi = pick(both_lean, S(ox * ix + oy * iy), S(1));
    // v x l = v x (l - v) = v x (l + v): from the shortest of the three it keeps its digits at 0 and at 180 degrees.
    const auto acute = greater(cos_phi, S(0));
    const S tx = l.x - pick(acute, v.x, S(-v.x)), ty = l.y - pick(acute, v.y, S(-v.y));
    const auto shorter = greater(S(sin_i * sin_i), S(tx * tx + ty * ty));
    const S across = v.x * pick(shorter, ty, l.y) - v.y * pick(shorter, tx, l.x);  // sin_o sin_i sin phi
    const S sin_phi = pick(both_lean, S(abs(across) / pick(both_lean, S(sin_o * sin_i), S(1))), S(0));
    // Upright, the other's past is its own sine times 1, for an azimuth of 0.
    const S past_o = pick(usable_o, S(ox * (l.z * d.x - l.x * d.z) + oy * (l.z * d.y - l.y * d.z)), S(-sin_i));
    const S past_i = pick(usable_i, S(ix * (v.x * d.z - v.z * d.x) + iy * (v.y * d.z - v.z * d.y)), S(-sin_o));
    return {v.z, sin_o, l.z, sin_i, cos_phi, sin_phi, S(atan2(sin_phi, S(-cos_phi))), past_o, past_i};
  }

  // As kPolarColumns numbers, for tables and streams, and back.
  void to_columns(S* out) const {
    const S all[]{cos_o, sin_o, cos_i, sin_i, cos_phi, sin_phi, gap, past_o, past_i};
    for (std::size_t i = 0; i < kPolarColumns; ++i) out[i] = all[i];
  }
  static PolarPair from_columns(const S* in) { return {in[0], in[1], in[2], in[3], in[4], in[5], in[6], in[7], in[8]}; }
};

// The nodes of Gauss's rule on an arc, and where series take over from closed forms that cancel.
template <class Number>
struct ArcRule;
template <>
struct ArcRule<double> {
  static constexpr double kNear = 0.05;
  static constexpr std::array kNode{
      0.0068580956515938306, 0.035782558168213241, 0.086399342465117503, 0.15635354759415726, 0.24237568182092295,
      0.34044381553605512,   0.44597252564632817,  0.55402747435367183,  0.65955618446394488, 0.75762431817907705,
      0.84364645240584274,   0.9136006575348825,   0.96421744183178676,  0.99314190434840617};
  static constexpr std::array kWeight{
      0.017559730165875932, 0.040079043579880105, 0.060759285343951592, 0.078601583579096767, 0.092769198738968907,
      0.1025992318606478,   0.1076319267315789,   0.1076319267315789,   0.1025992318606478,   0.092769198738968907,
      0.078601583579096767, 0.060759285343951592, 0.040079043579880105, 0.017559730165875932};
};
template <>
struct ArcRule<float> {
  static constexpr double kNear = 0.25;
  static constexpr std::array kNode{0.01304673574141414, 0.067468316655507745, 0.1602952158504878, 0.2833023029353764,
                                    0.42556283050918439, 0.57443716949081561,  0.7166976970646236, 0.8397047841495122,
                                    0.93253168334449226, 0.98695326425858586};
  static constexpr std::array kWeight{
      0.033335672154344069, 0.074725674575290297, 0.10954318125799102, 0.13463335965499818,  0.14776211235737644,
      0.14776211235737644,  0.13463335965499818,  0.10954318125799102, 0.074725674575290297, 0.033335672154344069};
};
template <Scalar S>
using ArcRuleOf = ArcRule<std::conditional_t<sizeof(typename Arithmetic<S>::Number) == 4, float, double>>;

// The GGX slopes of one roughness.
template <Scalar S>
class MicrofacetSlopes {
 public:
  // alpha in [0, 1]; below 1e-18 (float; 1e-150 in double) the surface is flat for the integral.
  explicit MicrofacetSlopes(const S& alpha)
      : alpha_(larger(smaller(alpha, S(1)), constant<S>(kTiny<S>))),
        alpha2_(alpha_ * alpha_),
        beta2_((S(1) - alpha_) * (S(1) + alpha_)),
        beta_(safe_sqrt(beta2_)) {}

  // The integral of max(0, o . h) max(0, i . h) D(h), [1], <= 1.
  S projected(const PolarPair<S>& p) const {
    const S arcs = p.cos_o * arc(p.cos_o, p.sin_o, p.past_o, p.cos_i, p.sin_i, p) +
                   p.cos_i * arc(p.cos_i, p.sin_i, p.past_i, p.cos_o, p.sin_o, p);
    return (arcs + unhindered(p)) * constant<S>(std::numbers::inv_pi);
  }

 private:
  // J_k = integral from r = 0 to R = alpha V / m of r^(k + 1) alpha^2 / (alpha^2 + r^2)^2 / sqrt(1 + r^2) dr: in units
  // of alpha^k V^(k + 2) they are finite everywhere.
  struct Moments {
    S zeroth, first, second;
  };

  // With w = sqrt(alpha^2 + beta^2 m^2), beta^2 = 1 - alpha^2, g = beta V^2 / (w + m) and d = asinh g:
  //
  //     J_0 = (beta (1 - m w) - alpha^2 d) / (2 beta^3)
  //     J_1 = alpha (asin(beta V) - beta V w) / (2 beta^3)
  //     J_2 = alpha^2 (d / beta - J_0)
  //
  // which are 0 / 0 towards alpha = 1 and V = 0. There, asinh and asin are series about 0, with the leading terms taken
  // out by hand.
  Moments moments(const S& m, const S& v2) const {
    constexpr double kNear = ArcRuleOf<S>::kNear;
    const S w = sqrt(S(alpha2_ + beta2_ * m * m)), over_sum = S(1) / (w + m), over_w = S(1) / (S(1) + w);
    const S smooth = (S(1) + m) * over_w;
    Moments out;

    const S g = beta_ * v2 * over_sum, g2 = g * g;
    const auto far = greater(g2, constant<S>(kNear));
    const S safe_g = pick(far, g, S(1));
    const S d = log(S(safe_g + sqrt(S(S(1) + safe_g * safe_g))));
    const S beta2 = pick(far, beta2_, S(1)), beta = pick(far, beta_, S(1));
    const S far_zeroth = S(0.5) * (smooth + alpha2_ * (S(1) - d / safe_g) * over_sum / beta2);
    const S safe_v2 = pick(far, v2, S(1));
    const S far_second = (d / beta - far_zeroth * safe_v2) / (safe_v2 * safe_v2);
    const S cubic = binomial_series<1, -1>(pick(far, S(0), g2)) * (over_sum * over_sum * over_sum);
    const S near_zeroth = S(0.5) * (smooth + alpha2_ * v2 * v2 * cubic);
    const S near_second = S(0.5) * ((S(2) + m + w) * over_sum * over_w / (S(1) + m) - (S(1) + beta2_) * v2 * cubic);
    out.zeroth = pick(far, far_zeroth, near_zeroth);
    out.second = pick(far, far_second, near_second);

    const S s2 = beta2_ * v2;
    const auto wide = greater(s2, constant<S>(kNear));
    const S safe_s2 = pick(wide, s2, S(1)), s = sqrt(safe_s2);
    out.first =
        pick(wide, S((atan(S(s / w)) - s * w) / (S(2) * s * safe_s2)), binomial_series<0, 1>(pick(wide, S(0), s2)));
    return out;
  }

  // Sum over k of binomial(2 (k + kFirst), k + kFirst) / 4^(k + kFirst) (kSign x)^k / (2 k + 3), for x up to kNear:
  // kFirst = 0: (asin s - s sqrt(1 - s^2)) / (2 s^3) of x = s^2;  kFirst = 1: (1 - asinh(g) / g) / g^2 of x = g^2.
  template <int kFirst, int kSign>
  static S binomial_series(const S& x) {
    constexpr int kTerms = 10;
    constexpr auto kCoefficients = [] {
      std::array<double, kTerms> out{};
      double binomial = 1;
      for (int k = 0; k < kTerms + kFirst; ++k) {
        if (k > 0) binomial *= (2.0 * k - 1) / (2.0 * k);
        if (k >= kFirst) out[std::size_t(k - kFirst)] = binomial / (2 * (k - kFirst) + 3);
      }
      return out;
    }();
    S sum = constant<S>(kCoefficients[kTerms - 1]);
    for (std::size_t k = kTerms - 1; k-- > 0;) sum = constant<S>(kCoefficients[k]) + S(kSign) * x * sum;
    return sum;
  }

  static S inverse_sinh(const S& x) { return log1p(S(x + x * x / (S(1) + sqrt(S(S(1) + x * x))))); }

  // The arc of a's circle on which it is met before b's, times 1 / cos_a. With tau the angle along it from its highest
  // point, where it turns from a: u = (c cos tau, sin tau, s cos tau), c and s being the cosine and sine of a's
  // stretched angle. It runs from the horizon, tau = -pi / 2, to where the circles cross, tan tau = c past / (cos_a
  // sin_b sin phi).
  S arc(const S& cos_a, const S& sin_a, const S& past, const S& cos_b, const S& sin_b, const PolarPair<S>& p) const {
    const S length = sqrt(S(cos_a * cos_a + alpha2_ * sin_a * sin_a));
    const S c = cos_a / length, s = alpha_ * sin_a / length;
    const S run = cos_a * sin_b * p.sin_phi, rise = past * c;
    const S longer = larger(run, S(abs(rise))), shorter = smaller(run, S(abs(rise)));
    const auto crossing =
        greater(longer, constant<S>(kTiny<S>));  // else they are one circle, or both directions upright
    const S scale = pick(crossing, longer, S(1)), ratio = shorter / scale;
    const S hypotenuse = longer * sqrt(S(S(1) + ratio * ratio));
    const S end = pick(crossing, S(run / pick(crossing, S(hypotenuse + abs(rise)), S(1))), S(1));
    // Both halves are taken from the horizon, with tan(half the angle from it) = k sinh y: the integrand's
    // singularities, where w = 0, lie at tangents i k and i / k.
    const S k = alpha_ / (beta_ * s + sqrt(S(beta2_ * s * s + alpha2_)));
    const S y_top = inverse_sinh(S(S(1) / k)), y_end = inverse_sinh(S(end / k));
    const auto ascending = greater(S(0), rise);
    const S first = half_arc(S(0), pick(ascending, y_end, y_top), S(-1), k, c, s, cos_b, sin_b, p);
    const S second = half_arc(pick(ascending, y_top, y_end), y_top, S(1), k, c, s, cos_b, sin_b, p);
    return c * (first + second) * S(2) * k;
  }

  S half_arc(const S& low, const S& high, const S& side, const S& k, const S& c, const S& s, const S& cos_b,
             const S& sin_b, const PolarPair<S>& p) const {
    using Rule = ArcRuleOf<S>;
    const S width = high - low, c2 = c * c, s2 = s * s, lean = alpha_ * sin_b;
    S sum = S(0);
    for (std::size_t j = 0; j < Rule::kNode.size(); ++j) {
      const S e = exp(S(low + width * constant<S>(Rule::kNode[j]))), e1 = S(1) / e;
      const S tangent = S(0.5) * k * (e - e1);
      const S scale = S(1) / (S(1) + tangent * tangent);
      const S cos_tau = S(2) * tangent * scale, sin_tau = side * (S(1) - tangent * tangent) * scale;
      const S m = s * cos_tau;
      const Moments j_of = moments(m, S(c2 + s2 * sin_tau * sin_tau));
      const S toward_b = c * cos_tau * p.cos_phi + sin_tau * p.sin_phi;  // V cos(azimuth to b)
      const S value = cos_b * (j_of.zeroth - m * j_of.first) - lean * toward_b * (j_of.first - m * j_of.second);
      sum = sum + constant<S>(Rule::kWeight[j]) * S(0.5) * (e + e1) * scale * value;
    }
    return sum * width;
  }

  // The azimuths from which both o and i face away, so that facets of every slope see both: an angle of `gap`.
  S unhindered(const PolarPair<S>& p) const {
    const Moments j = moments(S(0), S(1));
    const auto acute = greater(p.cos_phi, S(0));
    const S versine =
        pick(acute, S(S(1) + p.cos_phi), S(p.sin_phi * p.sin_phi / (S(1) - pick(acute, S(0), p.cos_phi))));
    const S x = p.gap, x2 = x * x;
    const S series = x * x2 *
                     (constant<S>(1.0 / 3) -
                      x2 * (constant<S>(1.0 / 30) -
                            x2 * (constant<S>(1.0 / 840) -
                                  x2 * (constant<S>(1.0 / 45360) -
                                        x2 * (constant<S>(1.0 / 3991680) - x2 * constant<S>(1.0 / 518918400))))));
    const S wedge = pick(greater(x, S(1)), S(p.sin_phi + x * p.cos_phi), series);  // sin x - x cos x
    return p.cos_o * p.cos_i * x * j.zeroth + alpha_ * (p.cos_o * p.sin_i + p.cos_i * p.sin_o) * versine * j.first +
           S(0.5) * alpha2_ * p.sin_o * p.sin_i * wedge * j.second;
  }

  S alpha_, alpha2_, beta2_, beta_;
};

// f / rho and f cos_i / rho. Unbounded towards grazing angles, where nothing is hidden from anything: by 1 / (cos_o
// cos_i) in f and by 1 / cos_o in f cos. Cosines below kTiny count as that, so both are finite; at or below the horizon
// both are 0. alpha = 0 is Lambert, 1 / pi, exactly.
template <Scalar S>
struct Reflected {
  S f, f_cos;  // [1/sr]
};
template <Scalar S>
Reflected<S> microfacet_diffuse(const S& alpha, const PolarPair<S>& pair) {
  const auto above = both(greater(pair.cos_o, S(0)), greater(pair.cos_i, S(0)));
  const auto rough = greater(alpha, constant<S>(kTiny<S>));
  PolarPair<S> p = pair;
  p.cos_o = pick(above, larger(p.cos_o, constant<S>(kTiny<S>)), S(1));
  p.cos_i = pick(above, larger(p.cos_i, constant<S>(kTiny<S>)), S(1));
  const S f_cos = MicrofacetSlopes<S>(alpha).projected(p) * constant<S>(std::numbers::inv_pi) / p.cos_o;
  const S lambert = constant<S>(std::numbers::inv_pi);
  return {pick(above, pick(rough, S(f_cos / p.cos_i), lambert), S(0)),
          pick(above, pick(rough, f_cos, S(lambert * p.cos_i)), S(0))};
}

// The part of the light from all around that reaches a viewer, over rho: a facet gets the light of the half of the
// sphere that it sees, (1 + h . n) / 2, and what it sends is counted by the area that it shows, so
//
//     albedo = integral of max(0, o . h) (1 + h . n) / 2 D(h) dh / cos_o
//
// At most 1 near the normal, and unbounded towards grazing views: without shadowing, facets show more area than the
// surface has. alpha = 0 gives 1.
template <Scalar S>
S microfacet_diffuse_albedo(const S& alpha, const S& cos_o, const S& sin_o) {
  const S c = larger(cos_o, constant<S>(kTiny<S>));
  const S shown = S(0.5) * (c + sqrt(S(c * c + alpha * alpha * sin_o * sin_o)));
  const PolarPair<S> to_normal{c, sin_o, S(1), S(0), S(1), S(0), constant<S>(std::numbers::pi), sin_o, S(-sin_o)};
  return S(0.5) * (shown + MicrofacetSlopes<S>(alpha).projected(to_normal)) / c;
}

}  // namespace likeness::brdf
