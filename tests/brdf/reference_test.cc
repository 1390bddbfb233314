#include <sstream>
#include <string>
#include <vector>

#include "tests/brdf/evaluator_row.h"

// The models against values computed with 40 digits, and against formulas written independently.
namespace likeness::brdf {
namespace {

template <class S>
class Reference : public ::testing::Test {
 protected:
  // The demand: double to 1e-12, float to 2e-5 relative.
  static constexpr double kRelative = kIsFloat<S> ? 2e-5 : 1e-12;
  // Near zero: 1e-15 in double; in float what is below its normal range.
  static constexpr double kNearZero = kIsFloat<S> ? 1.2e-38 : 1e-15;
  void expect(double got, double want, const std::string& where) {
    const double difference = relative_difference(got, want, kNearZero);
    worst_ = std::max(worst_, difference);
    EXPECT_LE(difference, kRelative) << where << ": got " << got << ", want " << want;
  }
  void TearDown() override { RecordProperty("worst_relative_difference", (std::ostringstream() << worst_).str()); }
  double worst_ = 0;
};
TYPED_TEST_SUITE(Reference, Kinds, KindNames);

TYPED_TEST(Reference, CallistoMeetsItsFile) {
  const auto rows = read_reference("callisto.csv");
  if (rows.empty()) GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/callisto.csv";
  for (std::size_t line = 0; line < rows.size(); ++line) {
    const Row& row = rows[line];
    Callisto<double> model;
    std::size_t used = 4;  // the three angles and the result
    for_each_parameter(model, [&]<class V>(const Parameter& p, V& value) {
      const auto cell = row.find(std::string(p.name));
      if (cell == row.end()) return;
      value = V(cell->second);
      ++used;
    });
    ASSERT_EQ(used, row.size()) << "a column that is no parameter";
    const auto g = geometry_at(row.at("theta_h"), row.at("theta_d"), row.at("phi_d"));
    for (const double f : eval_in<TypeParam>(model, g))
      this->expect(f, row.at("ref_f"), "row " + std::to_string(line + 2));
  }
}

TYPED_TEST(Reference, GgxDistributionMeetsItsFile) {
  const auto rows = read_reference("ggx_d.csv");
  if (rows.empty()) GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/ggx_d.csv";
  using S = TypeParam;
  for (std::size_t line = 0; line < rows.size(); ++line) {
    const double cos_h = rows[line].at("cos_h"), sin2_h = (1 - cos_h) * (1 + cos_h);
    const S alpha = alpha_of_roughness(constant<S>(rows[line].at("roughness")));
    const S d = ggx_distribution(alpha, constant<S>(cos_h), constant<S>(sin2_h));
    this->expect(first(d), rows[line].at("ref_d"), "row " + std::to_string(line + 2));
  }
}

// The file's cosines are independent of one another, so they are put into the pair directly.
TYPED_TEST(Reference, BurleyDiffuseMeetsItsFile) {
  const auto rows = read_reference("burley_diffuse.csv");
  if (rows.empty()) GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/burley_diffuse.csv";
  for (std::size_t line = 0; line < rows.size(); ++line) {
    const Row& row = rows[line];
    auto g = geometry_at(0.3, 0.4, 0.5);
    g.cos_i = row.at("cos_i");
    g.cos_o = row.at("cos_o");
    g.cos_d = row.at("cos_d");
    const BurleyDiffuse<double> model{Rgb<double>(row.at("base_color")), row.at("roughness")};
    for (const double f : eval_in<TypeParam>(model, g))
      this->expect(f, row.at("ref_f"), "row " + std::to_string(line + 2));
  }
}

// Independent statements of the formulas, in long double and in the angles of the papers.
using Long = long double;
constexpr Long kLongPi = std::numbers::pi_v<Long>;

struct Angles {
  Long cos_i, cos_o, theta_h, theta_d, hx, hy, hz;
  Angles(const Vec3<double>& l, const Vec3<double>& v) : cos_i(l.z), cos_o(v.z) {
    const Long x = Long(l.x) + v.x, y = Long(l.y) + v.y, z = Long(l.z) + v.z, length = std::sqrt(x * x + y * y + z * z);
    hx = x / length, hy = y / length, hz = z / length;
    theta_h = std::atan2(std::hypot(hx, hy), hz);
    const Long dx = Long(l.x) - v.x, dy = Long(l.y) - v.y, dz = Long(l.z) - v.z;
    theta_d = std::atan2(std::sqrt(dx * dx + dy * dy + dz * dz), length);
  }
};

Long schlick(Long c) { return std::pow(1 - c, Long(5)); }
Long lerp(Long a, Long b, Long t) { return a + (b - a) * t; }
// Smith's Lambda in the tangent, Heitz 2014.
Long smith_lambda(Long alpha, Long c) { return (std::sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1) / 2; }
Long ggx_by_tangent(Long alpha, Long theta_h) {
  const Long t = std::tan(theta_h) / alpha, c2 = std::cos(theta_h) * std::cos(theta_h);
  return 1 / (kLongPi * alpha * alpha * c2 * c2 * (1 + t * t) * (1 + t * t));
}
Long ggx_lobe(Long alpha, const Angles& a) {
  const Long g2 = 1 / (1 + smith_lambda(alpha, a.cos_i) + smith_lambda(alpha, a.cos_o));
  return ggx_by_tangent(alpha, a.theta_h) * g2 / (4 * a.cos_i * a.cos_o);
}
Long burley(Long roughness, const Angles& a, Long offset = 0.5L, Long scale = 2) {
  const Long c = std::cos(a.theta_d), f90 = offset + scale * roughness * c * c;
  return lerp(1, f90, schlick(a.cos_i)) * lerp(1, f90, schlick(a.cos_o));
}

Channels by_formula(const Lambert<double>& m, const Angles&) {
  return {double(m.base_color.r / kLongPi), double(m.base_color.g / kLongPi), double(m.base_color.b / kLongPi)};
}
Channels by_formula(const Ggx<double>& m, const Angles& a) {
  const Long lobe = ggx_lobe(Long(m.roughness) * m.roughness, a), rise = schlick(std::cos(a.theta_d));
  return {double(lerp(m.f0.r, 1, rise) * lobe), double(lerp(m.f0.g, 1, rise) * lobe),
          double(lerp(m.f0.b, 1, rise) * lobe)};
}
Channels by_formula(const BurleyDiffuse<double>& m, const Angles& a) {
  const Long f = burley(m.roughness, a) / kLongPi;
  return {double(m.base_color.r * f), double(m.base_color.g * f), double(m.base_color.b * f)};
}
Channels by_formula(const Disney2012<double>& m, const Angles& a) {
  const Long rise = schlick(std::cos(a.theta_d));
  const Long ss = 1.25L * (burley(m.roughness, a, 0, 1) * (1 / (a.cos_i + a.cos_o) - 0.5L) + 0.5L);
  const Long diffuse = lerp(burley(m.roughness, a), ss, m.subsurface) / kLongPi;
  const Long aspect = std::sqrt(1 - 0.9L * m.anisotropic), alpha = Long(m.roughness) * m.roughness;
  const Long ax = alpha / aspect, ay = alpha * aspect;
  const Long e = (a.hx / ax) * (a.hx / ax) + (a.hy / ay) * (a.hy / ay) + a.hz * a.hz;
  // G1 / (2 cos) from Lambda: 1 / (2 cos (1 + Lambda)).
  const auto masking = [&](Long alpha_g) {
    return 1 / (4 * a.cos_i * a.cos_o * (1 + smith_lambda(alpha_g, a.cos_i)) * (1 + smith_lambda(alpha_g, a.cos_o)));
  };
  const Long alpha_g = (0.5L + Long(m.roughness) / 2) * (0.5L + Long(m.roughness) / 2);
  const Long lobe = masking(alpha_g) / (kLongPi * ax * ay * e * e);
  const Long c = lerp(0.1L, 0.001L, m.clearcoat_gloss), cc = c * c;
  const Long berry = (cc - 1) / (kLongPi * std::log(cc) * (1 + (cc - 1) * a.hz * a.hz));
  const Long coat = 0.25L * m.clearcoat * lerp(0.04L, 1, rise) * berry * masking(0.25L);
  const Long luminance = 0.3L * m.base_color.r + 0.6L * m.base_color.g + 0.1L * m.base_color.b;
  const auto channel = [&](Long rho) {
    const Long tint = rho / luminance;
    const Long f0 = lerp(0.08L * m.specular * lerp(1, tint, m.specular_tint), rho, m.metallic);
    const Long sheen = rise * m.sheen * lerp(1, tint, m.sheen_tint);
    return double((diffuse * rho + sheen) * (1 - m.metallic) + lerp(f0, 1, rise) * lobe + coat);
  };
  return {channel(m.base_color.r), channel(m.base_color.g), channel(m.base_color.b)};
}
Channels by_formula(const Callisto<double>& m, const Angles& a) {
  const auto r = [](Long x) { return 2 * (1 - x); };
  const auto h = [&](Long t, Long n, Long u, Long k) {
    return std::pow(1 - std::cos(t), 5 * r(n)) * std::pow(std::cos(u), 5 * r(k));
  };
  const auto cube = [](Long x) { return x * x * x; };
  const Long mask = (1 - cube(1 - std::cos(a.theta_d))) * (1 - cube(1 - std::cos(a.theta_h)));
  const Long u = std::clamp(a.cos_i / (mask * m.smooth_terminator_length), 0.0L, 1.0L), step = u * u * (3 - 2 * u);
  const Long alpha = Long(m.roughness) * m.roughness;
  const Long wide = std::min(1.0L, Long(m.roughness) * m.dual_specular_roughness_scale);
  const Long lobe = lerp(ggx_lobe(alpha, a), ggx_lobe(wide * wide, a), m.dual_specular_opacity);
  const auto channel = [&](Long rho, Long tint_f, Long tint_r, Long tint_o) {
    const Long c1 = lerp(1, m.diffuse_fresnel * tint_f,
                         h(a.theta_d, m.diffuse_fresnel_falloff, a.theta_h, m.diffuse_fresnel_tangent_falloff)) *
                    lerp(1, m.retroreflection * tint_r,
                         h(a.theta_h, m.retroreflection_falloff, a.theta_d, m.retroreflection_tangent_falloff));
    const Long c2 = lerp(1, step, mask * m.smooth_terminator * tint_o);
    const Long f0 = lerp(0.08L * m.specular, rho, m.metallic), rn = r(m.specular_fresnel_falloff);
    const Long fresnel = f0 + std::clamp(2 - rn, 0.0L, 1.0L) * (1 - f0) * std::pow(1 - std::cos(a.theta_d), 5 * rn);
    return double((c1 * rho * (1 - m.metallic) / kLongPi + fresnel * lobe) * c2);
  };
  return {channel(m.base_color.r, m.diffuse_fresnel_tint.r, m.retroreflection_tint.r, m.smooth_terminator_tint.r),
          channel(m.base_color.g, m.diffuse_fresnel_tint.g, m.retroreflection_tint.g, m.smooth_terminator_tint.g),
          channel(m.base_color.b, m.diffuse_fresnel_tint.b, m.retroreflection_tint.b, m.smooth_terminator_tint.b)};
}

template <class M>
class Formula : public ::testing::Test {};
using Models =
    ::testing::Types<Callisto<double>, Disney2012<double>, Ggx<double>, Lambert<double>, BurleyDiffuse<double>>;
TYPED_TEST_SUITE(Formula, Models);

TYPED_TEST(Formula, EqualsTheModelWrittenIndependently) {
  Random random(20120802);
  for (int i = 0; i < 3000; ++i) {
    const auto model = random_model<TypeParam>(random, [](const Parameter& row) {
      return row.name == "roughness" ? Interval{0.2, 1}
                                     : row.typical;  // sharper: 1 - cos_h^2 loses the reference's digits
    });
    const auto l = random.direction(0.02), v = random.direction(0.02);
    const Channels got = eval_in<double>(model, l, v), want = by_formula(model, Angles(l, v));
    for (int c = 0; c < 3; ++c) {
      // 1e-12: directions are unit to 1e-16 only, and D at roughness 0.2 magnifies that by up to 1 / alpha^2 = 600.
      EXPECT_LE(relative_difference(got[c], want[c]), 1e-12)
          << "case " << i << ": got " << got[c] << ", want " << want[c];
    }
  }
}

}  // namespace
}  // namespace likeness::brdf
