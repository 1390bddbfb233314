#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/brdf/evaluate.h"
#include "tests/brdf/hair/realtime_cases.h"
#include "tests/brdf/hair/realtime_figure.h"

// How far the run-time forms of hair are from the far field by quadrature: the tables of docs/models/hair_karis.md,
// hair_lut.md and hair_closed.md, and their picture. About a minute.
//
//     ninja hair_realtime_errors && tests/brdf/hair/hair_realtime_errors ../docs/pictures/hair_realtime.svg
namespace likeness::brdf {
namespace {

constexpr double kBetas[]{0.1, 0.2, 0.3, 0.5, 0.7, 1.0};

// Energy under light from everywhere, over that of the reference.
void print_energies(double sigma_a) {
  std::printf("\nenergy over the reference's, sigma_a %g; tilt 2 degrees, beta_m = beta_n = beta\n\n", sigma_a);
  std::printf("| form | theta_o |");
  for (const double beta : kBetas) std::printf(" beta %g |", beta);
  std::printf("\n| --- | --- |");
  for (std::size_t i = 0; i < std::size(kBetas); ++i) std::printf(" --- |");
  std::printf("\n");
  for (const RealtimeForm& form : kRealtimeForms)
    for (const double theta_o : {0.0, 30.0, 60.0, 80.0}) {
      const auto lobes = lobe_energies(sigma_a, std::cos(theta_o * kHairDegree));
      const double want = lobes[0] + lobes[1] + lobes[2] + lobes[3];
      std::printf("| `%s` | %g |", form.name.data(), theta_o);
      for (const double beta : kBetas) {
        const RealtimeFibre fibre{.beta_m = beta, .beta_n = beta, .sigma_a = sigma_a};
        std::printf(" %.3f |", energy_of(form.eval_cos, fibre, theta_o * kHairDegree) / want);
      }
      std::printf("\n");
    }
}

// Directions as the fibre scatters them: a lobe at random, the light's inclination from its M, an even azimuth.
struct Pair {
  double theta_i, theta_o, phi;
};
Pair draw(Random& random, const RealtimeFibre& fibre) {
  const double theta_o = random.uniform(-80, 80) * kHairDegree;
  const auto view = fibre.exact().view(inclination_at(theta_o), 0.0, 0.0);
  const std::size_t p = random.index(4);
  const double u = random.uniform(), w = random.uniform();
  const auto i = sample_hair_mp(view.v[std::min<std::size_t>(p, 2)], view.o[p], u, w);
  return {std::atan2(i.sine, i.cosine), theta_o, random.uniform(-std::numbers::pi, std::numbers::pi)};
}

void print_values() {
  constexpr int kCount = 3000;
  std::printf("\nrelative rms error of S cos(theta_i), then the worst |error| / max(value, rms value)\n\n| form |");
  for (const double beta : kBetas) std::printf(" beta %g |", beta);
  std::printf("\n| --- |");
  for (std::size_t i = 0; i < std::size(kBetas); ++i) std::printf(" --- |");
  std::printf("\n");
  struct Case {
    RealtimeFibre fibre;
    Pair pair;
    double want;
  };
  std::vector<std::vector<Case>> cases;
  for (const double beta : kBetas) {
    Random random(7);
    cases.emplace_back();
    for (int i = 0; i < kCount; ++i) {
      const double sigma_a = random.uniform() < 0.3 ? 0 : random.uniform(0, 1);
      Case c{{.beta_m = beta, .beta_n = beta, .sigma_a = sigma_a}, {}, 0};
      c.pair = draw(random, c.fibre);
      c.want = exact_f_cos(c.fibre, c.pair.theta_i, c.pair.theta_o, c.pair.phi, 1e-4);
      cases.back().push_back(c);
    }
  }
  for (const RealtimeForm& form : kRealtimeForms) {
    std::printf("| `%s` |", form.name.data());
    for (const auto& of_beta : cases) {
      double want2 = 0, off2 = 0, worst = 0;
      for (const Case& c : of_beta) want2 += c.want * c.want;
      for (const Case& c : of_beta) {
        const double off = form.eval_cos(c.fibre, c.pair.theta_i, c.pair.theta_o, c.pair.phi) - c.want;
        off2 += off * off;
        worst = std::max(worst, std::abs(off) / std::max(c.want, std::sqrt(want2 / kCount)));
      }
      std::printf(" %.3g %%, %.3g %% |", 100 * std::sqrt(off2 / want2), 100 * worst);
    }
    std::printf("\n");
  }
}

// Largest and rms error along one axis of a table: at three points between each two of its nodes, with the other two
// coordinates at nodes. Relative to the value, where it is above 5 % of its row's peak over phi.
struct AxisError {
  double worst = 0, sum2 = 0;
  int count = 0;
  void add(double got, double want) {
    const double off = got / want - 1;
    worst = std::max(worst, std::abs(off));
    sum2 += off * off;
    ++count;
  }
};
struct Axis {
  const char* name;
  int between[3];  // 1 along the axis
};
constexpr Axis kAxes[]{{"phi", {1, 0, 0}}, {"cos", {0, 1, 0}}, {"width", {0, 0, 1}}, {"all", {1, 1, 1}}};

// For random cells of `grid`: read(x, y, z) against exact(x, y, z), both at places in [0, 1] on the grid's axes.
template <class Read, class Exact>
void print_axes(const char* name, const HairGrid& grid, Read&& read, Exact&& exact) {
  std::printf("| %s | %d x %d x %d |", name, grid.phi, grid.cosine, grid.width);
  for (const Axis& axis : kAxes) {
    Random random(3);
    AxisError error;
    const int nodes[]{grid.phi, grid.cosine, grid.width};
    while (error.count < 1500) {
      double at[3];
      for (int k = 0; k < 3; ++k) {
        const double cell = double(random.index(std::size_t(nodes[k] - 1)));
        const double way = axis.between[k] ? 0.25 * double(1 + random.index(3)) : double(random.index(2));
        at[k] = (cell + way) / (nodes[k] - 1);
      }
      if (at[1] < std::cos(80 * kHairDegree)) continue;  // the stated range
      double peak = 0;
      for (int i = 0; i < grid.phi; ++i) peak = std::max(peak, read(i / (grid.phi - 1.0), at[1], at[2]));
      const double want = exact(at[0], at[1], at[2]);
      if (want > 0.05 * peak) error.add(read(at[0], at[1], at[2]), want);
    }
    std::printf(" %.2f, %.2f |", 100 * error.worst, 100 * std::sqrt(error.sum2 / error.count));
  }
  std::printf("\n");
}

void print_tables() {
  std::printf("\nerror of tables along each axis: largest, rms [%%]\n\n| table | nodes |");
  for (const Axis& axis : kAxes) std::printf(" %s |", axis.name);
  std::printf("\n| --- | --- | --- | --- | --- | --- |\n");
  const HairLut& lut = hair_lut_at_155();
  const auto width = [](double z) { return kHairLutLeastWidth * std::exp(kHairLutLogRange * z); };
  const auto lobe = [&](int p, double sigma_a, auto&& phi_of) {
    const auto read = [&lut, p, sigma_a, phi_of](double x, double y, double z) {
      const auto n = lut.read(phi_of(x), y, z, Rgb<double>(sigma_a));
      return p == 0 ? n.r : p == 1 ? n.tt.r : n.trt.r;
    };
    const auto exact = [width, p, sigma_a, phi_of](double x, double y, double z) {
      return hair_far(p, phi_of(x), width(z), sigma_a, 1.55, y, 1e-5);
    };
    return std::pair{read, exact};
  };
  const auto even = [](double x) { return std::numbers::pi * x; };
  const auto of_r = [&](double x) { return std::numbers::pi - unbent(lut.dense_r, x); };
  const auto of_trt = [&](double x) { return unbent(lut.dense_trt, x); };
  const auto r = lobe(0, 0, of_r);
  print_axes("`hair_lut` R", lut.r, r.first, r.second);
  const auto tt = lobe(1, 0, even);
  print_axes("`hair_lut` TT", lut.tt, tt.first, tt.second);
  const auto trt = lobe(2, 0, of_trt);
  print_axes("`hair_lut` TRT", lut.trt, trt.first, trt.second);
  const auto tt_absorbed = lobe(1, 2, even), trt_absorbed = lobe(2, 2, even);
  print_axes("TT at sigma_a 2", lut.ways, tt_absorbed.first, tt_absorbed.second);
  print_axes("TRT at sigma_a 2", lut.ways, trt_absorbed.first, trt_absorbed.second);

  const HairTalkLut& talk = hair_talk_lut_at_155();
  const double least = HairTalkLut::kLeastBeta;
  for (std::size_t p = 0; p < 3; ++p) {
    const char* names[]{"talk's R", "talk's TT", "talk's TRT"};
    print_axes(
        names[p], talk.distribution,
        [&](double x, double y, double z) {
          double d[3];
          talk.read(std::numbers::pi * x, y, least + (1 - least) * z, d);
          return d[p];
        },
        [&](double x, double y, double z) {
          HairOffsets offsets(1.55, y);
          offsets.choose(p, hair_width(least + (1 - least) * z));
          return offsets.distribution(std::numbers::pi * x);
        });
  }
  const auto seconds_of = [](auto&& bake) {
    std::vector<double> seconds;
    for (int i = 0; i < 5; ++i) {
      const auto start = std::chrono::steady_clock::now();
      bake();
      seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds[2];
  };
  std::printf("\nhair_lut: %zu bytes, made in %.2f s; the talk's: %zu bytes, made in %.2f s (medians of 5)\n",
              lut.bytes(), seconds_of([] { (void)bake_hair_lut(); }), talk.bytes(),
              seconds_of([] { (void)bake_hair_talk_lut(); }));
}

// The dominant offsets' attenuation against the mean over offsets, where there is no absorption.
void print_attenuations() {
  std::printf(
      "\nattenuation at the dominant offset over the mean of all offsets\n\n| theta_d | TT, sigma_a 0 | TRT, 0 | TT, 1 "
      "| TRT, 1 |\n| --- | --- | --- | --- | --- |\n");
  for (const double theta : {0.0, 40.0, 70.0}) {
    std::printf("| %g |", theta);
    for (const double sigma_a : {0.0, 1.0}) {
      const double cosine = std::cos(theta * kHairDegree);
      const auto a = hair_talk_attenuations(cosine, cosine, 1.55, Rgb<double>(sigma_a));
      const auto e = lobe_energies(sigma_a, cosine);
      std::printf(" %.3f | %.3f |", a.tt.r / e[1], a.trt.r / e[2]);
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace likeness::brdf

int main(int count, char** arguments) {
  using namespace likeness::brdf;
  if (count > 1) return write_realtime_figure(arguments[1]) ? EXIT_SUCCESS : EXIT_FAILURE;
  print_energies(0);
  print_energies(0.5);
  print_values();
  print_tables();
  print_attenuations();
  return EXIT_SUCCESS;
}
