#include "brdf/fresnel/thin_film_color.h"

#include "brdf/fresnel/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Films as an observer and as cameras see them.
namespace likeness::brdf {
namespace {

template <class S>
class FilmColor : public ::testing::Test {
 protected:
  static Channels rgb(double c, double n0, double n1, double n2, double d) {
    return channels(evaluate_row<ThinFilmRgb, S>({c, n0, n1, n2, d}));
  }
  static Channels camera(double c, double n0, double n1, double n2, double d, double width = 35) {
    return channels(evaluate_row<ThinFilmCamera, S>({c, n0, n1, n2, d, 600, 540, 460, width}));
  }
  static double bare(double c, double n0, double n1, double n2) {
    return evaluate_row<ThinFilmReflectance, S>({c, n0, n1, n2, 0, 550})[0];
  }
  static Channels channels(const std::vector<double>& out) { return {out[0], out[1], out[2]}; }
  static constexpr double kRounding = kIsFloat<S> ? 4e-6 : 4e-14;  // of a sum of 512 terms, some of them negative
};
TYPED_TEST_SUITE(FilmColor, Kinds, KindNames);

// The same average by brute force: a film's reflectance at every 5 pm, in wavelength.
template <class F>
Channels by_wavelength(const F& sensitivity, double c, double n0, double n1, double n2, double d) {
  std::array<double, 3> sum{}, total{};
  for (double nm = 360.0025; nm < 780; nm += 0.005) {
    const std::array<double, 3> w = sensitivity(nm);
    const double r = thin_film(c, n0, n1, n2, d, nm);
    for (std::size_t i = 0; i < 3; ++i) {
      sum[i] += w[i] * r;
      total[i] += w[i];
    }
  }
  return {sum[0] / total[0], sum[1] / total[1], sum[2] / total[2]};
}
std::array<double, 3> rec709(double nm) {  // the matrix of IEC 61966-2-1, which has four digits
  const auto xyz = cie_1931(nm);
  const double d65 = cie_d65(nm), x = xyz[0] * d65, y = xyz[1] * d65, z = xyz[2] * d65;
  return {3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
          0.0557 * x - 0.2040 * y + 1.0570 * z};
}

struct Case {
  double c, n0, n1, n2, d;
};
const std::vector<Case> kCases{{1, 1, 1.48, 1.337, 60}, {0.5, 1, 1.48, 1.337, 150}, {1, 1, 1.33, 1, 400},
                               {0.2, 1, 1.33, 1, 1500}, {0.7, 1, 2.4, 1.5, 900},    {1, 1, 1.38, 1.52, 100},
                               {0.6, 1.5, 1, 1.5, 200}, {0.3, 1, 1.5, 2.2, 5000},   {1, 1, 1.33, 1, 20000},
                               {0.05, 1, 2, 1, 1200},   {0.74, 1.5, 1, 1.5, 3000}};

TYPED_TEST(FilmColor, IsTheAverageOverWavelengths) {
  for (const Case& f : kCases) {
    const Channels want = by_wavelength(rec709, f.c, f.n0, f.n1, f.n2, f.d);
    const Channels got = this->rgb(f.c, f.n0, f.n1, f.n2, f.d);
    for (int i = 0; i < 3; ++i)  // 3e-5: the four digits of the matrix above; 1e-5 the 512 wavelengths
      EXPECT_NEAR(got[i], want[i], 5e-5) << f.d << " channel " << i;
  }
}

TYPED_TEST(FilmColor, OfACameraIsTheAverageOverWavelengths) {
  for (const double width : {10.0, 35.0})
    for (const Case& f : kCases) {
      const auto sensitivity = [&](double nm) {
        const auto gauss = [&](double at) { return std::exp(-squared(nm - at) / (2 * width * width)); };
        return std::array<double, 3>{gauss(600), gauss(540), gauss(460)};
      };
      const Channels want = by_wavelength(sensitivity, f.c, f.n0, f.n1, f.n2, f.d);
      const Channels got = this->camera(f.c, f.n0, f.n1, f.n2, f.d, width);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], 2e-5) << f.d << " channel " << i << " width " << width;
    }
}

TYPED_TEST(FilmColor, OfNoThicknessIsTheBareBoundary) {
  for (const double c : {0.0, 1e-7, 0.3, 1.0}) {
    const double bare = this->bare(c, 1, 1.48, 1.337);
    EXPECT_EQ(this->rgb(c, 1, 1.48, 1.337, 0), (Channels{bare, bare, bare})) << c;
    EXPECT_EQ(this->camera(c, 1, 1.48, 1.337, 0), (Channels{bare, bare, bare})) << c;
    for (const double d : {1e-30, 1e-6, 1e-3, 0.1})
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(this->rgb(c, 1, 1.48, 1.337, d)[i], bare, 0.01 * d + this->kRounding) << c << " " << d;
        EXPECT_NEAR(this->camera(c, 1, 1.48, 1.337, d)[i], bare, 0.01 * d + this->kRounding) << c << " " << d;
      }
  }
}

TYPED_TEST(FilmColor, OfAnythingThatReflectsEverythingIsWhite) {
  for (const double d : {0.0, 60.0, 20000.0})
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(this->rgb(0, 1, 1.48, 1.337, d)[i], 1, this->kRounding);
      EXPECT_NEAR(this->rgb(0.5, 1.5, 1.2, 1, d)[i], 1, this->kRounding);
      EXPECT_NEAR(this->camera(0.5, 1.5, 1.2, 1, d)[i], 1, this->kRounding);
    }
}

// Thick films lose their color: 1 - T0 / (1 - (r01 r12)^2), the sum of intensities, for either polarisation.
TYPED_TEST(FilmColor, OfAThickFilmIsTheSumOfIntensities) {
  const double r01 = (1 - 1.5) / 2.5, r12 = (1.5 - 1.3) / 2.8, both = r01 * r01 * r12 * r12;
  const double want = 1 - (1 - r01 * r01) * (1 - r12 * r12) / (1 - both);
  // At 60 um the fringes of D65's own structure have 4e-4 of contrast left, of fringes of 0.056.
  for (const double d : {14000.0, 20000.0})
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(this->rgb(1, 1, 1.5, 1.3, d)[i], want, 4e-5) << d;
      EXPECT_NEAR(this->camera(1, 1, 1.5, 1.3, d)[i], want, 1e-5) << d;  // 3e-6: blue ends at 360 nm
    }
}

TYPED_TEST(FilmColor, OfACameraIsBetweenNothingAndEverything) {
  Random random(3);
  const auto edge = [&](std::initializer_list<double> edges, double low, double high) {
    return random.uniform() < 0.5 ? edges.begin()[random.index(edges.size())] : random.uniform(low, high);
  };
  for (int i = 0; i < 300; ++i) {
    const double c = edge({0, 1, 1e-7, 1e-38}, 0, 1), n0 = edge({1, 1.5, 0.1, 10}, 1, 2);
    const double n1 = edge({1, 1.5, 0.1, 10}, 1, 2), n2 = edge({1, 1.5, 0.1, 10}, 1, 2);
    const double d = edge({0, 1e-30, 20000}, 0, 1500), width = edge({5, 200, 0, 1e6}, 10, 60);
    for (const double r : this->camera(c, n0, n1, n2, d, width))
      ASSERT_TRUE(r >= -this->kRounding && r <= 1 + this->kRounding) << r << " at " << c << " " << d << " " << width;
    for (const double r : this->rgb(c, n0, n1, n2, d))  // the weights' absolute values sum to at most 2
      ASSERT_TRUE(r >= -0.5 && r <= 1.5) << r << " at " << c << " " << n0 << " " << n1 << " " << n2 << " " << d;
  }
}

TYPED_TEST(FilmColor, IsMadeInFloatsToo) {  // an engine has no doubles
  using S = TypeParam;
  const SpectralWeights& weights = ThinFilmRgb::tables();
  for (const Case& f : kCases) {
    if (f.d > 2000) continue;
    const ThinFilm<S> film(constant<S>(f.c), constant<S>(f.n0), constant<S>(f.n1), constant<S>(f.n2));
    const auto got = brdf::channels(FilmSpectrum<S>(film, constant<S>(f.d)).seen_with(weights));
    const Channels want = this->rgb(f.c, f.n0, f.n1, f.n2, f.d);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], kIsFloat<S> ? 2e-5 : 1e-13) << f.d;
  }
}

TEST(SpectralWeights, AreWhiteForAConstantSpectrum) {
  const SpectralWeights weights = rec709_under_d65();
  double sum[3]{}, below_zero[3]{};
  for (const auto& w : weights.weight)
    for (int c = 0; c < 3; ++c) {
      sum[c] += w[c];
      below_zero[c] += std::min(w[c], 0.0);
    }
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(sum[c], 1, 1e-14);
    EXPECT_LT(below_zero[c], -0.1) << "no gamut of primaries holds all colors";
  }
}

TEST(SpectralWeights, PutTheWhiteOfD65WhereItIs) {
  double xyz[3]{};
  for (double nm = 360; nm <= 780; ++nm)
    for (std::size_t i = 0; i < 3; ++i) xyz[i] += cie_1931(nm)[i] * cie_d65(nm);
  EXPECT_NEAR(xyz[0] / (xyz[0] + xyz[1] + xyz[2]), 0.3127, 2e-4);  // 0.31261: the fit's error
  EXPECT_NEAR(xyz[1] / (xyz[0] + xyz[1] + xyz[2]), 0.3290, 3e-4);  // 0.32921
  EXPECT_EQ(cie_d65(560), 100);
  EXPECT_NEAR(cie_d65(565), (100 + 96.3342) / 2, 1e-12) << "linear between the rows of the standard";
}

// A measured camera comes as a table. This one has Gaussians in it, every 2 nm.
TEST(SpectralWeights, TakeATable) {
  std::vector<std::array<double, 3>> table;
  for (double nm = 380; nm <= 740; nm += 2) {
    const auto gauss = [&](double at) { return std::exp(-squared(nm - at) / (2 * 35.0 * 35.0)); };
    table.push_back({gauss(600), gauss(540), gauss(460)});
  }
  const auto camera = SpectralWeights::of(table, 380, 2);
  const FilmSpectrum<double> film(ThinFilm<double>(0.8, 1.0, 1.48, 1.337), 300.0);
  const Rgb<double> got = film.seen_with(camera), want = film.seen_with(GaussianCamera<double>{600, 540, 460, 35});
  EXPECT_NEAR(got.r, want.r, 1e-5);  // the table's step, and its ends
  EXPECT_NEAR(got.g, want.g, 1e-5);
  EXPECT_NEAR(got.b, want.b, 1e-4);  // 460 - 380 is only 2.3 widths
}

// What the talk asks of eyes: 2.5 to 5.5 % where a film of no thickness gives 2 %.
TEST(FilmOfTheEye, HasTheReflectanceOfLivingEyes) {
  for (const double d : {30.0, 60.0, 90.0}) {
    const auto rgb = evaluate_row<ThinFilmRgb, double>({1, 1, 1.48, 1.337, d});
    const double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    EXPECT_GT(y, 0.025) << d;
    EXPECT_LT(y, 0.060) << d;
  }
}

}  // namespace
}  // namespace likeness::brdf
