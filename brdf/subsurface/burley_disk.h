#pragma once

#include <numbers>

#include "brdf/subsurface/burley_profile.h"
#include "brdf/vector.h"

namespace likeness::brdf {

// A point of the disk around the point of entry, where light leaves.
template <Scalar S>
struct DiskSample {
  S x, y, r;      // [length], r = sqrt(x^2 + y^2)
  S pdf;          // [1/length^2], over the area of the plane
  Rgb<S> weight;  // R / (A pdf) by channel, [1]: finite also where R and pdf are not, or are too small for a number
};

// Burley's profile of a color, to be sampled.
//
// u, v, choice  independent and uniform in [0, 1); u near 1 is far away
// Holds         a pdf integrates to 1 over the plane; the mean of `weight` is 1 in every channel
template <Scalar S>
struct BurleyDisk {
  Rgb<S> s;  // by channel, [1/length]

  // The smallest s: of the channel that scatters farthest.
  S widest() const { return smaller(s.r, smaller(s.g, s.b)); }

  // The radius is drawn for the channel that scatters farthest, as in 'Efficient Screen-Space Subsurface Scattering'
  // (SIGGRAPH 2018 Advances). Weights reach s / widest, near the point of entry.
  DiskSample<S> sample_widest(const S& u, const S& v) const {
    const S a = widest(), r = burley_icdf(u, S(S(1) - u)) / a, over = S(1) / relative(a, r);
    const Rgb<S> weight = Rgb<S>(relative(s.r, r), relative(s.g, r), relative(s.b, r)) * over;
    return {S(r * cos(angle(v))), S(r * sin(angle(v))), r, pdf_widest(r), weight};
  }
  S pdf_widest(const S& r) const { return burley_sum(S(widest() * r)) * widest() / circle(r); }

  // A third of the radii is drawn for each channel. The density is the mean of the three, so no weight exceeds 3.
  // Source  the balance heuristic: Veach 1997, 'Robust Monte Carlo Methods for Light Transport Simulation', 9.2.
  DiskSample<S> sample(const S& choice, const S& u, const S& v) const {
    return sample(choice, u, S(S(1) - u), S(cos(angle(v))), S(sin(angle(v))));
  }
  // The same with 1 - u and the direction given apart, for who knows them with more digits.
  DiskSample<S> sample(const S& choice, const S& u, const S& rest, const S& along, const S& across) const {
    const S after_red = pick(greater(constant<S>(2.0 / 3.0), choice), s.g, s.b);
    const S a = pick(greater(constant<S>(1.0 / 3.0), choice), s.r, after_red), r = burley_icdf(u, rest) / a;
    const Rgb<S> seen(relative(s.r, r), relative(s.g, r), relative(s.b, r));
    return {S(r * along), S(r * across), r, pdf(r), seen * S(S(3) / (seen.r + seen.g + seen.b))};
  }
  S pdf(const S& r) const {
    const S sum = s.r * burley_sum(S(s.r * r)) + s.g * burley_sum(S(s.g * r)) + s.b * burley_sum(S(s.b * r));
    return sum * constant<S>(1.0 / 3.0) / circle(r);
  }

 private:
  // What turns s burley_sum(s r) into a density over area. Held near 0, as in burley_density_over_area.
  S circle(const S& r) const {
    return larger(r, S(constant<S>(kBurleyLeastX) / widest())) * constant<S>(8 * std::numbers::pi);
  }
  // c burley_sum(c r) over widest exp(-widest r / 3): never infinite, and at least 1 for the widest channel.
  S relative(const S& c, const S& r) const {
    const S third = r * constant<S>(-1.0 / 3.0), a = widest();
    return c / a * exp(S((c - a) * third)) * (S(1) + exp(S(S(2) * c * third)));
  }
  static S angle(const S& v) { return v * constant<S>(2 * std::numbers::pi); }
};

}  // namespace likeness::brdf
