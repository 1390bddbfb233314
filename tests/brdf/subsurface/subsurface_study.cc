// The numbers of docs/models/{burley_profile,gaussian_profile,random_walk_profile}.md and the picture on them.
//
//   subsurface_study gaussians          fits the constants of brdf/subsurface/gaussian_profile.h, and their errors
//   subsurface_study inverse            relative errors of the inverse in float, and of each step of Halley's method
//   subsurface_study walk [WALKS]       profiles and shapes against random walks, and what a walk costs
//   subsurface_study picture FILE.svg   profiles over the distance
#include <ceres/ceres.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <random>
#include <string>
#include <string_view>

#include "brdf/subsurface/isotropic_half_space.h"
#include "render/page/html.h"
#include "render/page/svg.h"
#include "tests/brdf/subsurface/profile_errors.h"

namespace likeness::brdf {
namespace {

// ---- gaussians

template <int kCount>
void fit_gaussians() {
  constexpr int kParameters = kFitParameters<kCount>;
  std::mt19937_64 random(kCount);
  std::array<double, kParameters> best{};
  double least = 1e300;
  int found = 0;
  for (int start = 0; start < 40; ++start) {
    std::array<double, kParameters> parameters;
    for (int i = 0; i < kParameters; ++i)
      parameters[i] = i < kParameters - kCount ? std::uniform_real_distribution(-1.0, 1.0)(random)
                                               : std::uniform_real_distribution(-5.0, 4.0)(random);
    ceres::Problem problem;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CdfResiduals<kCount>, ceres::DYNAMIC, kParameters>(
                                 new CdfResiduals<kCount>, static_cast<int>(radial_nodes().size())),
                             nullptr, parameters.data());
    for (int i = 0; i < kParameters; ++i) {  // nothing overflows on the way
      problem.SetParameterLowerBound(parameters.data(), i, -12);
      problem.SetParameterUpperBound(parameters.data(), i, 12);
    }
    ceres::Solver::Options options;
    options.max_num_iterations = 1000;
    options.function_tolerance = 1e-18;
    options.parameter_tolerance = 1e-14;
    options.gradient_tolerance = 1e-16;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    found += std::abs(summary.final_cost - least) < 1e-9 * least;
    if (summary.final_cost < least * (1 - 1e-9)) {
      least = summary.final_cost;
      best = parameters;
      found = 1;
    }
  }
  const auto values = fit_values<kCount>(best.data());
  std::vector<std::pair<double, double>> terms;
  terms.reserve(kCount);
  for (int i = 0; i < kCount; ++i) terms.emplace_back(values.variance[i], values.weight[i]);
  std::sort(terms.begin(), terms.end());
  std::printf("%d: %d of 40 starts end here; weights and variances\n", kCount, found);
  for (const auto& [variance, weight] : terms) std::printf("   %.17g %.17g\n", weight, variance);
  if (kCount == 1) std::printf("   delta %.17g\n", values.delta);
}

void gaussians() {
  fit_gaussians<1>();
  fit_gaussians<2>();
  fit_gaussians<4>();
  std::printf("\n| Gaussians | CDF rms | CDF worst | density rms | value rms | value worst | energy - 1 |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
  const auto row = [](const char* name, const ProfileError& e, double energy) {
    std::printf("| %s | %.1f %% | %.1f %% | %.1f %% | %.1f %% | %.0f %% | %.1e |\n", name, 100 * e.cdf_rms,
                100 * e.cdf_worst, 100 * e.density_rms, 100 * e.value_rms, 100 * e.value_worst, energy - 1);
  };
  row("1 and a delta", error_of_gaussians<1>(), gaussian_cdf<1>(1e6));
  row("2", error_of_gaussians<2>(), gaussian_cdf<2>(1e6));
  row("4", error_of_gaussians<4>(), gaussian_cdf<4>(1e6));
}

// ---- inverse

// The closed form as it is published, in float.
float published_inverse(float u) {
  const float w = 1 - u, g = 1 + 4 * w * (2 * w + std::sqrt(1 + 4 * w * w));
  const float n = std::pow(g, -1 / 3.0f), p = g * n * n;
  return 3 * std::log((1 + p + n) / (4 * w));
}

void inverse() {
  std::printf("| u | as published | here |\n| --- | --- | --- |\n");
  for (const double decade : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    double published = 0, here = 0;
    for (int i = 0; i < 1000; ++i) {
      const double u = decade * std::pow(10, i / 1000.0), want = burley_icdf(u, 1 - u);
      published = std::max(published, std::abs(published_inverse(float(u)) / want - 1));
      here = std::max(here, std::abs(burley_icdf(float(u), float(1 - u)) / want - 1));
    }
    std::printf("| %g | %.0e | %.0e |\n", decade, published, here);
  }
  std::printf("\n");
  std::printf("| steps | u = 1e-4 | 0.1 | 0.5 | 0.9 | 0.99 | 0.999 | 1 - 1e-4 | 1 - 2^-24 |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (int steps = 0; steps <= 4; ++steps) {
    std::printf("| %d |", steps);
    for (const double u : {1e-4, 0.1, 0.5, 0.9, 0.99, 0.999, 1 - 1e-4, 1 - 0x1p-24}) {
      double x = burley_halley_start(u);
      for (int i = 0; i < steps; ++i) x = burley_halley_step(x, u, 1 - u);
      std::printf(" %.0e |", std::abs(x / burley_icdf(u, 1 - u) - 1));
    }
    std::printf("\n");
  }
}

// ---- walk

std::vector<double> ring_edges(int rings, double low, double high) {
  std::vector<double> edges{0};
  for (int i = 0; i <= rings; ++i) edges.push_back(low * std::pow(high / low, double(i) / rings));
  return edges;
}

// sqrt(integral (P - P0)^2 dr / integral (1 - P0)^2 dr) and max |P - P0|, P0 the walk's, at the rings' edges.
struct WalkError {
  double rms, worst;
};
template <class P>
WalkError error_against_walk(const std::vector<double>& edges, const WalkProfile& walk, P&& cdf) {
  double inside = 0, sum = 0, rest = 0, worst = 0;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double area = std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]);
    inside += walk.reflectance[i] * area / walk.total.mean();
    const double d = cdf(edges[i + 1]) - inside, width = edges[i + 1] - edges[i];
    sum += d * d * width;
    rest += (1 - inside) * (1 - inside) * width;
    worst = std::max(worst, std::abs(d));
  }
  return {std::sqrt(sum / rest), worst};
}

template <class P>
double best_shape(double s, P&& error) {
  double best = s;
  for (double shape = s / 2; shape < 2 * s; shape *= 1.002)
    if (error(shape).rms < error(best).rms) best = shape;
  return best;
}

void walk(std::int64_t walks) {
  const auto edges = ring_edges(240, 1e-3, 1e3);
  for (const Incidence incidence : {Incidence::kPencil, Incidence::kDiffuse}) {
    const bool pencil = incidence == Incidence::kPencil;
    std::printf("\n%s\n\n| A | alpha | A of the walk | s, eq. %d | s, best | Burley | best s | 4 | 2 | 1 Gaussian |",
                pencil ? "Light along the normal" : "Light from all sides", pencil ? 5 : 6);
    std::printf(" collisions | walks / CPU s |\n");
    std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const double albedo : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95}) {
      const double alpha = single_scattering_albedo(albedo, incidence);
      const std::clock_t begin = std::clock();
      const WalkProfile profile = random_walk_profile({.alpha = alpha}, incidence, edges, walks, 1);
      const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
      const double s = pencil ? burley_shape_searchlight(albedo) : burley_shape_diffuse(albedo);
      const auto burley = [&](double shape) {
        return error_against_walk(edges, profile, [&](double r) { return burley_cdf(shape * r); });
      };
      const double best = best_shape(s, burley);
      const auto text = [](const WalkError& e) {
        char buffer[40];
        std::snprintf(buffer, sizeof buffer, "%.1f, %.1f %%", 100 * e.rms, 100 * e.worst);
        return std::string(buffer);
      };
      const auto gaussian = [&]<int kCount>(std::integral_constant<int, kCount>) {
        return text(error_against_walk(edges, profile, [&](double r) { return gaussian_cdf<kCount>(squared(s * r)); }));
      };
      std::printf("| %.2f | %.5f | %.4f ± %.4f | %.3f | %.3f | %s | %s | %s | %s | %s | %.0f | %.3g |\n", albedo, alpha,
                  profile.total.mean(), profile.total.error(), s, best, text(burley(s)).c_str(),
                  text(burley(best)).c_str(), gaussian(std::integral_constant<int, 4>()).c_str(),
                  gaussian(std::integral_constant<int, 2>()).c_str(),
                  gaussian(std::integral_constant<int, 1>()).c_str(), double(profile.where.collisions) / double(walks),
                  double(walks) / seconds);
      std::fflush(stdout);
    }
  }
  const WalkProfile refracted = random_walk_profile({.alpha = 0.99, .eta = 1.4}, Incidence::kPencil, edges, walks, 1);
  const double s = burley_shape_searchlight(refracted.total.mean());
  std::printf("\neta 1.4, alpha 0.99: A %.3f, s of eq. 5 %.3f, best s %.3f\n", refracted.total.mean(), s,
              best_shape(s, [&](double shape) {
                return error_against_walk(edges, refracted, [&](double r) { return burley_cdf(shape * r); });
              }));
  const std::clock_t begin = std::clock();
  const WalkProfile white = random_walk_profile({.alpha = 1}, Incidence::kPencil, edges, 2000, 1);
  std::printf("alpha 1: %.0f collisions and %.2g CPU ms a walk, %.2f %% of the light unfinished\n",
              double(white.where.collisions) / 2000, 1e3 * double(std::clock() - begin) / CLOCKS_PER_SEC / 2000,
              100 * white.where.unfinished / 2000);
}

// ---- picture

std::string picture() {
  using page::svg_line, page::svg_text;
  constexpr double kLeft = 62, kRight = 600, kTop = 18, kBottom = 390;
  constexpr double kLowX = -2, kHighX = 1.3, kLowY = -6, kHighY = 1.5;  // decades
  const auto at_x = [&](double r) { return kLeft + (std::log10(r) - kLowX) / (kHighX - kLowX) * (kRight - kLeft); };
  const auto at_y = [&](double v) { return kBottom - (std::log10(v) - kLowY) / (kHighY - kLowY) * (kBottom - kTop); };
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 620 440\" font-family=\"DejaVu Sans, sans-serif\">"
      "<title>Diffusion profiles over the distance, both logarithmic</title>"
      "<rect width=\"620\" height=\"440\" fill=\"#fff\"/>";
  const auto power = [](int e) {
    return "10<tspan dy=\"-4\" font-size=\"8\">" + std::string(e < 0 ? "−" : "") + std::to_string(std::abs(e)) +
           "</tspan>";
  };
  for (int e = int(kLowX); e <= int(kHighX); ++e) {
    out += svg_line(at_x(std::pow(10, e)), kTop, at_x(std::pow(10, e)), kBottom, "stroke=\"#ddd\"");
    out += svg_text(at_x(std::pow(10, e)), kBottom + 16, "middle", power(e), 11);
  }
  for (int e = int(kLowY); e <= int(kHighY); ++e) {
    out += svg_line(kLeft, at_y(std::pow(10, e)), kRight, at_y(std::pow(10, e)), "stroke=\"#ddd\"");
    out += svg_text(kLeft - 6, at_y(std::pow(10, e)) + 4, "end", power(e), 11);
  }
  out += svg_text((kLeft + kRight) / 2, 428, "middle", "distance r, in mean free paths", 12);
  out += svg_text(14, (kTop + kBottom) / 2, "middle", "R(r)", 12, " transform=\"rotate(-90 14 204)\"");
  out +=
      "<clipPath id=\"f\"><rect x=\"62\" y=\"18\" width=\"538\" height=\"372\"/></clipPath><g clip-path=\"url(#f)\">";

  const double albedo = 0.8, s = burley_shape_searchlight(albedo);
  const auto curve = [&](std::string_view style, auto&& value) {
    out += "<polyline fill=\"none\" " + std::string(style) + " points=\"";
    for (int i = 0; i <= 160; ++i) {
      const double r = std::pow(10, kLowX + (kHighX - kLowX) * i / 160), v = value(r);
      if (v > 1e-9) out += page::number(at_x(r), 5) + "," + page::number(at_y(v), 5) + " ";
    }
    out += "\"/>";
  };
  constexpr std::string_view kStyles[]{"stroke=\"#1b7837\" stroke-width=\"1.6\" stroke-dasharray=\"2 3\"",
                                       "stroke=\"#762a83\" stroke-width=\"1.6\" stroke-dasharray=\"6 3\"",
                                       "stroke=\"#d95f02\" stroke-width=\"1.6\"",
                                       "stroke=\"#0b5394\" stroke-width=\"2.4\""};
  curve(kStyles[0], [&](double r) { return gaussian_profile<1>(r, s, albedo); });
  curve(kStyles[1], [&](double r) { return gaussian_profile<2>(r, s, albedo); });
  curve(kStyles[2], [&](double r) { return gaussian_profile<4>(r, s, albedo); });
  curve(kStyles[3], [&](double r) { return burley_profile(r, s, albedo); });
  const auto edges = ring_edges(40, 0.01, 20);
  const WalkProfile walked = random_walk_profile({.alpha = single_scattering_albedo(albedo, Incidence::kPencil)},
                                                 Incidence::kPencil, edges, 1000000, 1);
  for (std::size_t i = 1; i + 1 < edges.size(); ++i) {
    const double r = std::sqrt(edges[i] * edges[i + 1]), v = walked.reflectance[i], e = walked.error[i];
    if (v <= 2 * e) continue;
    out += svg_line(at_x(r), at_y(v - 2 * e), at_x(r), at_y(v + 2 * e), "stroke=\"#000\"");
    out += "<circle cx=\"" + page::number(at_x(r), 5) + "\" cy=\"" + page::number(at_y(v), 5) + "\" r=\"2.6\"/>";
  }
  out += "</g><rect x=\"62\" y=\"18\" width=\"538\" height=\"372\" fill=\"none\" stroke=\"#555\"/>";
  const char* names[]{"1 Gaussian and a delta", "2 Gaussians", "4 Gaussians", "Burley, s of eq. 5"};
  for (int i = 0; i < 4; ++i) {
    out += svg_line(80, 372 - 18 * i, 116, 372 - 18 * i, kStyles[i]);
    out += svg_text(124, 376 - 18 * i, "start", names[i], 12);
  }
  out +=
      "<circle cx=\"98\" cy=\"300\" r=\"2.6\"/>" + svg_text(124, 304, "start", "random walk, ± 2 standard errors", 12);
  out += svg_text(80, 286, "start", "surface albedo 0.8, light along the normal", 12);
  return out + "</svg>\n";
}

int run(int count, char** words) {
  const std::string_view what = count > 1 ? words[1] : "";
  if (what == "gaussians") gaussians();
  else if (what == "inverse") inverse();
  else if (what == "walk") walk(count > 2 ? std::atoll(words[2]) : 200000);
  else if (what == "picture" && count > 2) return (std::ofstream(words[2]) << picture()) ? 0 : 3;
  else {
    std::fprintf(stderr, "usage: subsurface_study gaussians|inverse|walk [WALKS]|picture FILE.svg\n");
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace likeness::brdf

int main(int count, char** words) { return likeness::brdf::run(count, words); }
