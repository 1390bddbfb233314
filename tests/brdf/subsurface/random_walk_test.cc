#include <numbers>

#include "brdf/subsurface/evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/subsurface/profile_errors.h"

// The random walk, against what is known exactly. Every statistical test has a fixed seed and allows 4.2 standard errors,
// 2.7e-5 each; there are about 80 of them: 2e-3 for the file, once, when a seed or the walk is changed.
namespace likeness::brdf {
namespace {

constexpr double kSigmas = 4.2;
constexpr Incidence kIncidences[]{Incidence::kPencil, Incidence::kDiffuse};
constexpr Estimator kEstimators[]{Estimator::kWeighted, Estimator::kAnalog};

// Nodes over cosines, dense at 0, where H is not smooth, and with an end at `kink`.
std::vector<Node> cosine_nodes(double kink = 1) {
  std::vector<Node> nodes;
  for (const auto& [low, high] : {std::pair(0.0, kink), std::pair(kink, 1.0)}) {
    if (high <= low) continue;
    double from = low;
    for (int i = 11; i >= 0; --i) {
      const double to = low + (high - low) * std::pow(0.3, i);
      append_nodes(from, to, nodes);
      from = to;
    }
  }
  return nodes;
}

// ---- the exact side.

TEST(HalfSpace, HSolvesChandrasekharsEquation) {
  for (const double alpha : {0.0, 0.1, 0.5, 0.9, 0.99, 0.9999, 1.0}) {
    double zeroth = 0;
    for (const Node& node : cosine_nodes()) zeroth += node.weight * chandrasekhar_h(node.x, alpha);
    EXPECT_NEAR(alpha / 2 * zeroth, 1 - std::sqrt(1 - alpha), 1e-11) << alpha;  // the quadrature over cosines: 1e-12
    for (const double mu : {0.01, 0.3, 1.0}) {                                  // the quadrature near mu = 0.01: 3e-11
      double integral = 0;
      for (const Node& node : cosine_nodes())
        integral += node.weight * node.x * chandrasekhar_h(node.x, alpha) / (mu + node.x);
      EXPECT_NEAR(1 / chandrasekhar_h(mu, alpha), std::sqrt(1 - alpha) + alpha / 2 * integral, 1e-10)
          << alpha << " " << mu;
    }
  }
  // 25 digits, by another program.
  EXPECT_NEAR(chandrasekhar_h(0.01, 0.9999), 1.034081247075952285103382, 1e-13);
  EXPECT_NEAR(chandrasekhar_h(0.3, 0.5), 1.143889508574921923548028, 1e-13);
  EXPECT_NEAR(chandrasekhar_h(1, 0.9), 1.850098516769812325572634, 1e-13);
  EXPECT_NEAR(chandrasekhar_h(1, 1), 2.9078, 5e-5);  // the table in Chandrasekhar's book
}

TEST(HalfSpace, AlbedoIsFoundAgainFromTheMedium) {
  EXPECT_NEAR(plane_albedo(1, 0.9), 1 - 1.85009851676981 * std::sqrt(0.1), 1e-12);
  EXPECT_NEAR(spherical_albedo(1), 1, 1e-14);
  EXPECT_NEAR(spherical_albedo(0), 0, 1e-15);
  for (const Incidence incidence : kIncidences)
    for (const double albedo : {0.01, 0.3, 0.8, 0.99})
      EXPECT_NEAR(surface_albedo(single_scattering_albedo(albedo, incidence), incidence), albedo, 1e-9);  // 1 - alpha
}

// Fresnel's equations and Snell's law, from the cosine inside.
double reflectance_from_inside(double cosine, double eta) {
  const double sine2 = eta * eta * (1 - cosine * cosine);
  if (sine2 >= 1) return 1;
  const double outside = std::sqrt(1 - sine2);
  const double s = (eta * cosine - outside) / (eta * cosine + outside);
  const double p = (cosine - eta * outside) / (cosine + eta * outside);
  return (s * s + p * p) / 2;
}

// With a boundary that reflects: flux that arrives at it from below at the cosine mu, per unit that enters at mu0, is
// alpha / 2 H(mu0) H(mu) mu / (mu + mu0), which integrates to the plane albedo; what is returned enters again.
double albedo_behind_boundary(double alpha, double eta, Incidence incidence) {
  const auto nodes = cosine_nodes(eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 1);
  std::vector<double> h, arriving;
  for (const Node& node : nodes) h.push_back(chandrasekhar_h(node.x, alpha));
  const double h1 = chandrasekhar_h(1, alpha);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double first = h1 / (nodes[i].x + 1);
    if (incidence == Incidence::kDiffuse) {
      first = 0;
      for (std::size_t k = 0; k < nodes.size(); ++k)
        first += nodes[k].weight * 2 * nodes[k].x * h[k] / (nodes[i].x + nodes[k].x);
    }
    arriving.push_back(alpha / 2 * h[i] * nodes[i].x * first);
  }
  const std::size_t n = nodes.size();
  std::vector<double> again(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      again[i * n + k] = alpha / 2 * h[i] * nodes[i].x * h[k] / (nodes[i].x + nodes[k].x) * nodes[k].weight *
                         reflectance_from_inside(nodes[k].x, eta);
  const std::vector<double> source = arriving;
  for (int round = 0; round < 300; ++round) {  // at most 0.94 of it is returned and comes back: 1e-8 is left
    std::vector<double> next = source;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) next[i] += again[i * n + k] * arriving[k];
    arriving = next;
  }
  double leaves = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    leaves += nodes[i].weight * (1 - reflectance_from_inside(nodes[i].x, eta)) * arriving[i];
  return leaves;
}

// ---- the walk's parts.

TEST(WalkParts, ScatteredCosineInvertsHenyeyAndGreenstein) {
  for (const double g : {-0.95, -0.3, 1e-3, 0.5, 0.9, 0.99})
    for (double u = 0.005; u < 1; u += 0.01) {
      const double c = scattered_cosine(g, u);
      const double cdf = (1 - g * g) / (2 * g) * (1 / std::sqrt(1 + g * g - 2 * g * c) - 1 / (1 + g));
      EXPECT_NEAR(cdf, u, 1e-11) << g;  // the CDF cancels at small g and near g = 1
    }
  for (const double u : {0.1, 0.5, 0.9}) EXPECT_EQ(scattered_cosine(0, u), 2 * u - 1);
  EXPECT_NEAR(scattered_cosine(1e-9, 0.3), -0.4, 1e-8);
}

TEST(WalkParts, TurnedDirectionsKeepTheirAngle) {
  Random random(1);
  std::vector<WalkDirection> from{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {1e-9, 0, -1}};
  for (int i = 0; i < 100; ++i) {
    const auto d = random.direction(-1, 1);
    from.push_back({d.x, d.y, d.z});
  }
  for (const WalkDirection& a : from) {
    WalkDirection sum{0, 0, 0};
    for (int i = 0; i < 8; ++i) {
      const double turn = i * std::numbers::pi / 4;
      const WalkDirection b = a.turned(0.3, {0.5 * std::cos(turn), 0.5 * std::sin(turn), 0.25});
      EXPECT_NEAR(a.x * b.x + a.y * b.y + a.z * b.z, 0.3, 1e-8);  // a is a unit vector to 1e-9
      EXPECT_NEAR(b.x * b.x + b.y * b.y + b.z * b.z, 1, 1e-14);
      sum = {sum.x + b.x / 8, sum.y + b.y / 8, sum.z + b.z / 8};
    }
    EXPECT_NEAR(sum.x, 0.3 * a.x, 1e-8);  // all azimuths alike: what is across cancels
    EXPECT_NEAR(sum.y, 0.3 * a.y, 1e-8);
    EXPECT_NEAR(sum.z, 0.3 * a.z, 1e-8);
  }
}

TEST(WalkParts, RandomNumbersAreEvenAndApart) {
  double sum = 0, squares = 0, product = 0, disk_squares = 0, disk_x = 0;
  constexpr int kWalks = 100000;
  for (int i = 0; i < kWalks; ++i) {
    WalkRandom one(5, std::uint64_t(i)), next(5, std::uint64_t(i) + 1), disk(6, std::uint64_t(i));
    const auto p = disk.in_disk();
    ASSERT_TRUE(p.square > 0 && p.square < 1);
    disk_squares += p.square;
    disk_x += p.x;
    const double a = one.uniform() - 0.5, b = next.uniform() - 0.5;
    sum += a;
    squares += a * a;
    product += a * b;
  }
  EXPECT_LE(std::abs(sum / kWalks), kSigmas * std::sqrt(1.0 / 12 / kWalks));
  EXPECT_LE(std::abs(squares / kWalks - 1.0 / 12), kSigmas * std::sqrt(1.0 / 180 / kWalks));
  EXPECT_LE(std::abs(product / kWalks), kSigmas / 12 * std::sqrt(1.0 / kWalks));  // neighbours
  EXPECT_LE(std::abs(disk_squares / kWalks - 0.5), kSigmas * std::sqrt(1.0 / 12 / kWalks));
  EXPECT_LE(std::abs(disk_x / kWalks), kSigmas * std::sqrt(1.0 / 4 / kWalks));  // variance of x in the disk: 1 / 4
}

// ---- the walk.

TEST(RandomWalk, AlbedoIsTheExactOne) {
  const std::vector<double> edges{0, 1e9};
  for (const double alpha : {0.3, 0.8, 0.95, 0.999})
    for (const Incidence incidence : kIncidences)
      for (const Estimator estimator : kEstimators) {
        const auto walked = random_walk_profile({.alpha = alpha}, incidence, edges, 20000, 11, estimator);
        const double exact = surface_albedo(alpha, incidence), off = walked.total.mean() - exact;
        EXPECT_LE(std::abs(off), kSigmas * walked.total.error()) << alpha << ": " << off / walked.total.error();
        EXPECT_LE(walked.total.error(), 0.6 / std::sqrt(20000.0));  // a test that could hardly fail would pass all
      }
}

TEST(RandomWalk, AlbedoBehindABoundaryThatRefractsIsTheExactOne) {
  const std::vector<double> edges{0, 1e9};
  // Giovanelli 1955: 0.2600 of all light, 0.04 of which never enters. His last digit: 8e-5.
  EXPECT_NEAR(0.04 + 0.96 * albedo_behind_boundary(0.9, 1.5, Incidence::kPencil), 0.2600, 1e-4);
  // 0.3 reflects at every angle and totally at none.
  for (const double eta : {0.3, 1.33, 1.5})
    for (const double alpha : {0.8, 0.99})
      for (const Incidence incidence : kIncidences)
        for (const Estimator estimator : kEstimators) {
          const int walks = alpha < 0.9 && estimator == Estimator::kWeighted ? 50000 : 10000;  // they are short
          const auto walked = random_walk_profile({.alpha = alpha, .eta = eta}, incidence, edges, walks, 12, estimator);
          const double off = walked.total.mean() - albedo_behind_boundary(alpha, eta, incidence);
          EXPECT_LE(std::abs(off), kSigmas * walked.total.error()) << eta << " " << alpha << ": " << off;
        }
}

TEST(RandomWalk, NothingIsLost) {
  for (const Estimator estimator : kEstimators)
    for (const HalfSpace& medium : {HalfSpace{.alpha = 0.95}, {.alpha = 0.9, .g = 0.8}, {.alpha = 0.97, .eta = 1.4}}) {
      WalkMean roulette;
      for (int i = 0; i < 3000; ++i) {
        WalkRandom random(13, std::uint64_t(i));
        double seen = 0;
        const WalkLedger w = random_walk(medium, Incidence::kPencil, estimator, random, [&](double r, double weight) {
          ASSERT_TRUE(r >= 0 && weight > 0);
          seen += weight;
        });
        ASSERT_NEAR(w.reflected + w.absorbed + w.roulette + w.unfinished, 1, 1e-12);  // rounding, walk by walk
        ASSERT_NEAR(seen, w.reflected, 1e-12);
        roulette.add(w.roulette);
      }
      EXPECT_LE(std::abs(roulette.mean()), kSigmas * roulette.error() + 1e-300);
    }
}

TEST(RandomWalk, EverythingReturnsFromAMediumThatDoesNotAbsorb) {
  const std::vector<double> edges{0, 1e9};
  const auto nearly = random_walk_profile({.alpha = 0.99999}, Incidence::kPencil, edges, 1000, 14);
  EXPECT_LE(std::abs(nearly.total.mean() - plane_albedo(1, 0.99999)), kSigmas * nearly.total.error());
  const auto white = random_walk_profile({.alpha = 1}, Incidence::kPencil, edges, 200, 14);
  EXPECT_EQ(white.where.absorbed, 0);
  EXPECT_NEAR((white.where.reflected + white.where.roulette + white.where.unfinished) / 200, 1, 1e-9);  // 1e6 sums
  EXPECT_LE(white.where.unfinished / 200, 0.02);  // of those that are deep after 1e6 collisions
  const auto black = random_walk_profile({.alpha = 0}, Incidence::kDiffuse, edges, 100, 14);
  EXPECT_EQ(black.where.reflected, 0);
}

// Where light scatters once: alpha / (4 pi) integral of z exp(-z - d) / d^3 dz, d = sqrt(r^2 + z^2); near the beam that is
// alpha / (4 pi r). At alpha = 0.01 what scatters more often adds 1 % within two mean free paths.
TEST(RandomWalk, ProfileOfSingleScatteringIsTheExactOne) {
  const double alpha = 0.01;
  const std::vector<double> edges{0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 0.6, 1, 1.5, 2};
  const auto walked = random_walk_profile({.alpha = alpha}, Incidence::kPencil, edges, 1000000, 15);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    std::vector<Node> radii;
    append_nodes(edges[i], edges[i + 1], radii);
    double sum = 0;
    for (const Node& r : radii) {
      double single = 0;
      for (const Node& z : radial_nodes()) {
        const double d = std::hypot(r.x, z.x);
        single += z.weight * z.x * std::exp(-z.x - d) / (d * d * d);
      }
      sum += r.weight * 2 * std::numbers::pi * r.x * alpha / (4 * std::numbers::pi) * single;
    }
    const double want = sum / (std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]));
    const double error = kSigmas * walked.error[i];
    EXPECT_GE(walked.reflectance[i], want - error) << edges[i];
    EXPECT_LE(walked.reflectance[i], 1.012 * want + error) << edges[i];
    EXPECT_LE(walked.error[i], 0.04 * want) << edges[i];
  }
}

TEST(RandomWalk, BothEstimatorsGiveOneProfile) {
  const std::vector<double> edges{0, 0.1, 0.3, 1, 2, 4, 8, 16};
  for (const HalfSpace& medium : {HalfSpace{.alpha = 0.9}, {.alpha = 0.9, .g = 0.7}, {.alpha = 0.9, .eta = 1.4}}) {
    const auto analog = random_walk_profile(medium, Incidence::kPencil, edges, 60000, 16, Estimator::kAnalog);
    const auto weighted = random_walk_profile(medium, Incidence::kPencil, edges, 60000, 17);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      const double error = std::hypot(analog.error[i], weighted.error[i]);
      EXPECT_LE(std::abs(analog.reflectance[i] - weighted.reflectance[i]), kSigmas * error) << i;
      EXPECT_LT(weighted.error[i], analog.error[i]) << i;  // why it is done
    }
  }
}

TEST(RandomWalk, DependsOnSeedAndNumberOfTheWalkAlone) {
  const std::vector<double> edges{0, 1, 10};
  const auto one = random_walk_profile({}, Incidence::kPencil, edges, 1000, 18);
  const auto again = random_walk_profile({}, Incidence::kPencil, edges, 1000, 18);
  const auto other = random_walk_profile({}, Incidence::kPencil, edges, 1000, 19);
  EXPECT_EQ(one.reflectance, again.reflectance);
  EXPECT_EQ(one.error, again.error);
  EXPECT_NE(one.reflectance, other.reflectance);
}

// Table on docs/models/random_walk_profile.md: where the paper's shapes hold, and that they are for a boundary that does
// nothing.
TEST(RandomWalk, BurleysShapesFitAtAlbedosUpToSevenTenths) {
  std::vector<double> edges{0};
  for (int i = 0; i <= 60; ++i) edges.push_back(0.01 * std::pow(1e4, i / 60.0));
  const auto worst = [&](const HalfSpace& medium, Incidence incidence, double s) {
    const auto walked = random_walk_profile(medium, incidence, edges, 20000, 20);
    double inside = 0, most = 0;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      const double area = std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]);
      inside += walked.reflectance[i] * area / walked.total.mean();
      most = std::max(most, std::abs(inside - burley_cdf(s * edges[i + 1])));
    }
    return most;
  };
  for (const double albedo : {0.2, 0.4, 0.7}) {
    const double pencil = single_scattering_albedo(albedo, Incidence::kPencil);
    const double diffuse = single_scattering_albedo(albedo, Incidence::kDiffuse);
    // 2.3 % and 1.9 % on the page; 0.4 % of statistics.
    EXPECT_LE(worst({.alpha = pencil}, Incidence::kPencil, burley_shape_searchlight(albedo)), 0.03) << albedo;
    EXPECT_LE(worst({.alpha = diffuse}, Incidence::kDiffuse, burley_shape_diffuse(albedo)), 0.03) << albedo;
  }
  EXPECT_GE(worst({.alpha = 0.99, .eta = 1.4}, Incidence::kPencil, burley_shape_searchlight(0.62)), 0.1);
}

// ---- as a row.

TEST(RandomWalk, ARowIsTheRingAroundItsRadius) {
  const double length = 0.5, r = 0.7;
  const auto row = evaluate_row<RandomWalkProfile, double>({r, 0.9, 0, 1, length, 0, 0, 0.05, 3000, 21});
  const double inner = r / length * 0.95, outer = r / length * 1.05;
  const std::vector<double> edges{inner, outer};
  const auto walked = random_walk_profile({.alpha = 0.9}, Incidence::kPencil, edges, 3000, 21);
  EXPECT_LE(relative_difference(row[0], walked.reflectance[0] / (length * length)), 1e-12);  // sums in another order
  EXPECT_LE(relative_difference(row[1], walked.error[0] / (length * length)), 1e-9);
  EXPECT_EQ(row[2], walked.total.mean());
  EXPECT_EQ(row[3], walked.total.error());
  const auto in_float = evaluate_row<RandomWalkProfile, float>({r, 0.9, 0, 1, length, 0, 0, 0.05, 3000, 21});
  EXPECT_LE(relative_difference(in_float[2], row[2]), 1e-6);  // alpha rounded
}

TEST(RandomWalk, ARowIsFiniteAtEveryEdge) {
  for (const double r : {0.0, 1e9})
    for (const double alpha : {0.0, 0.999})
      for (const double g : {-0.99, 0.99})
        for (const double eta : {1.0, 4.0})
          for (const double diffuse : {0.0, 1.0})
            for (const double analog : {0.0, 1.0})
              for (const double x :
                   evaluate_row<RandomWalkProfile, double>({r, alpha, g, eta, 1e-6, diffuse, analog, 1e-3, 2, 0}))
                EXPECT_TRUE(std::isfinite(x) && x >= 0);
  const auto albedo = evaluate_row<RandomWalkAlbedo, float>({0.9});
  EXPECT_NEAR(albedo[0], plane_albedo(1, 0.9), 1e-6);
  EXPECT_NEAR(albedo[1], spherical_albedo(0.9), 1e-6);
}

}  // namespace
}  // namespace likeness::brdf
