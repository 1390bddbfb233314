// How the numbers of brdf/diffuse/microfacet_diffuse_fit.h and what docs/models/microfacet_diffuse.md says come about:
//
//   diffuse_study fit                 the coefficients of the fit: 2 s
//   diffuse_study errors              the page's tables of errors: 10 s
//   diffuse_study times               nanoseconds of each form
//   diffuse_study picture FILE.svg    the forms over the light's angle

#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "brdf/catalog/catalog.h"
#include "render/page/html.h"
#include "render/page/svg.h"
#include "tests/brdf/diffuse/forms.h"
#include "tests/brdf/diffuse/least_squares.h"

namespace likeness::brdf {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Of form / integral - 1, and of the difference in what a patch sends to a viewer, f cos_i cos_o, over its own rms.
struct Errors {
  std::vector<double> relative;
  double squares = 0, difference2 = 0, size2 = 0;

  void add(double got, double want, double weight) {
    relative.push_back(got / want - 1);
    squares += relative.back() * relative.back();
    difference2 += (got - want) * (got - want) * weight * weight;
    size2 += want * want * weight * weight;
  }
  double rms() const { return std::sqrt(squares / double(relative.size())); }
  double largest() const {
    double worst = 0;
    for (const double x : relative) worst = std::max(worst, std::abs(x));
    return worst;
  }
  double at(double part) {
    const auto place = relative.begin() + std::ptrdiff_t(part * double(relative.size() - 1));
    std::nth_element(relative.begin(), place, relative.end());
    return *place;
  }
  double median_size() const {
    std::vector<double> sizes;
    for (const double x : relative) sizes.push_back(std::abs(x));
    std::nth_element(sizes.begin(), sizes.begin() + std::ptrdiff_t(sizes.size() / 2), sizes.end());
    return sizes[sizes.size() / 2];
  }
};

void print_errors(Directions directions, int draws) {
  std::printf(
      "\n| form | relative rms | median | least | largest | rms of f cos_i cos_o |\n| --- | --- | --- | --- | --- | "
      "--- |\n");
  for (const Form form : kForms) {
    Errors errors;
    for (int n = 0; n < draws; ++n) {
      const Draw at = draw(n, directions);
      const PolarPair<double> p = at.pair();
      errors.add(over_lambert_cos(form, at.alpha, p), over_lambert_cos(Form::kIntegral, at.alpha, p), p.cos_o);
    }
    std::printf("| `%s` | %.3g | %.3g | %+.2f | %+.3g | %.3g |\n", name_of(form).data(), errors.rms(),
                errors.median_size(), errors.at(0), errors.at(1), std::sqrt(errors.difference2 / errors.size2));
  }
}

void print_albedo_errors() {
  constexpr int kAlphas = 12, kAngles = 12;
  std::printf(
      "\n| form | mean error of the albedo | where the integral's counts as 1 above 1 | largest albedo |\n"
      "| --- | --- | --- | --- |\n");
  std::vector<double> want;
  for (const Form form : {Form::kIntegral, Form::kLambert, Form::kProxima, Form::kLut, Form::kAzimuthLut, Form::kFit}) {
    double sum = 0, capped = 0, largest = 0;
    std::size_t at = 0;
    for (int a = 0; a < kAlphas; ++a)
      for (int o = 0; o < kAngles; ++o, ++at) {
        const double got = albedo(form, (a + 0.5) / kAlphas, std::acos(std::sqrt((o + 0.5) / kAngles)));
        if (form == Form::kIntegral) want.push_back(got);
        sum += std::abs(got - want[at]);
        capped += std::abs(got - std::min(1.0, want[at]));
        largest = std::max(largest, got);
      }
    std::printf("| `%s` | %.3f | %.3f | %.2f |\n", name_of(form).data(), sum / double(at), capped / double(at),
                largest);
  }
}

void print_albedos() {
  std::printf("\n| alpha | theta_o |");
  for (const Form form : {Form::kIntegral, Form::kProxima, Form::kLut, Form::kAzimuthLut, Form::kFit})
    std::printf(" `%s` |", name_of(form).data());
  std::printf("\n| --- | --- | --- | --- | --- | --- | --- |\n");
  for (const double alpha : {0.1, 0.25, 0.5, 1.0})
    for (const double theta : {0, 45, 60, 75, 85}) {
      std::printf("| %g | %g |", alpha, theta);
      for (const Form form : {Form::kIntegral, Form::kProxima, Form::kLut, Form::kAzimuthLut, Form::kFit})
        std::printf(" %.3f |", albedo(form, alpha, theta * kDegree));
      std::printf("\n");
    }
}

// The tables against the integral at the azimuths that they hold, and at all.
void print_tables() {
  std::printf(
      "\n| table | compared at | along | max | rms | max, of f | rms, of f |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n");
  const auto compare = [](Form form, const char* azimuths, const char* along, auto&& azimuth_of, int free_axes) {
    Errors errors;
    double largest = 0, squares = 0;
    constexpr int kDraws = 30000;
    for (int n = 0; n < kDraws; ++n) {
      const Draw at = draw(n, Directions::kUniform);
      // Coordinates of the table, of which some are moved to the nearest node.
      const auto node = [&](double t, std::size_t nodes, bool is_free) {
        return is_free ? t : std::round(t * double(nodes - 1)) / double(nodes - 1);
      };
      using Table = MicrofacetDiffuseTable<1>;
      const double root = std::max(0.01, node(std::sqrt(at.alpha), Table::kAlphas, free_axes & 1));
      const double alpha = root * root, last = 0.999;
      const auto theta = [&](double x) { return std::min(std::atan2(2 * x, alpha * (1 - x * x)), 89.9 * kDegree); };
      const double theta_o = theta(std::min(last, node(at.cos_o, Table::kAngles, free_axes & 2)));
      const double theta_i = theta(std::min(last, node(at.cos_i, Table::kAngles, free_axes & 4)));
      const auto p = PolarPair<double>::at(theta_o, theta_i, azimuth_of(at.phi));
      const double got = over_lambert_cos(form, alpha, p), want = over_lambert_cos(Form::kIntegral, alpha, p);
      errors.add(got, want, p.cos_o);
      // q, what the table holds: f pi cos_o cos_i over the areas shown to both.
      const auto shown = [&](double c, double sine) { return 0.5 * (c + std::hypot(c, alpha * sine)); };
      const double q = (got - want) * p.cos_o / (shown(p.cos_o, p.sin_o) * shown(p.cos_i, p.sin_i));
      largest = std::max(largest, std::abs(q));
      squares += q * q / kDraws;
    }
    std::printf("| `%s` | %s | %s | %.2g | %.2g | %.2g | %.2g |\n", name_of(form).data(), azimuths, along, largest,
                std::sqrt(squares), errors.largest(), errors.rms());
  };
  const auto coplanar = [](double) { return 0.0; };
  const auto nodes = [](double phi) { return std::round(phi / (std::numbers::pi / 2)) * (std::numbers::pi / 2); };
  const auto any = [](double phi) { return phi; };
  for (const auto& [along, axes] : {std::pair{"alpha", 1}, {"theta_o", 2}, {"theta_i", 4}, {"all three", 7}})
    compare(Form::kLut, "phi = 0", along, coplanar, axes);
  for (const auto& [along, axes] : {std::pair{"alpha", 1}, {"theta_o", 2}, {"theta_i", 4}, {"all three", 7}})
    compare(Form::kAzimuthLut, "phi = 0, pi / 2, pi", along, nodes, axes);
  compare(Form::kLut, "every phi", "all", any, 7);
  compare(Form::kAzimuthLut, "every phi", "all", any, 7);
}

void print_fit() {
  const LeastSquares fit = least_squares(200000);
  for (std::size_t i = 0; i < fit.best.size(); ++i)
    std::printf("%c %8.4f   in the header %8.4f\n", "abcde"[i], fit.best[i],
                MicrofacetDiffuseFit<double>::kCoefficients[i]);
  std::printf("rms %.5f, with the header's numbers %.5f\n", fit.rms_of_best, fit.rms_of_header);
}

void print_all_errors() {
  std::printf("Directions by their cosines, alpha uniform, 100 000 draws:\n");
  print_errors(Directions::kByCosine, 100000);
  std::printf("\nThe same with uniform directions:\n");
  print_errors(Directions::kUniform, 100000);
  std::printf("\nAlbedo, cosine-weighted view, alpha uniform:\n");
  print_albedo_errors();
  std::printf("\nAlbedo at some points:\n");
  print_albedos();
  std::printf("\nTables, over their own coordinates, up to 89.9 degrees:\n");
  print_tables();
}

// The least of nine runs over 4096 rows, in CPU time of one thread: from features, as the engines call it.
template <class N>
double nanoseconds(const catalog::Entry& entry, catalog::Loop<N> loop,
                   const std::vector<std::vector<double>>& features) {
  const std::size_t rows = features.front().size();
  std::vector<std::vector<N>> in, out(entry.output_count, std::vector<N>(rows));
  std::vector<catalog::Column<N>> columns;
  std::vector<N*> results;
  for (const auto& column : features) in.emplace_back(column.begin(), column.end());
  for (const auto& column : in) columns.push_back({column.data(), false});
  for (auto& column : out) results.push_back(column.data());
  double least = 1e300;
  for (int run = 0; run < 9; ++run) {
    const auto start = std::clock();
    int turns = 0;
    do {
      loop(entry.tables(), columns.data(), results.data(), rows);
      ++turns;
    } while (std::clock() - start < CLOCKS_PER_SEC / 50);
    least = std::min(least, double(std::clock() - start) / CLOCKS_PER_SEC / turns / double(rows));
  }
  return least * 1e9;
}

void print_times() {
  std::printf("| form | batch (%s) | float | double |\n| --- | --- | --- | --- |\n", catalog::instruction_set().data());
  for (const char* name : {"lambert", "proxima", "microfacet_diffuse_fit", "microfacet_diffuse_lut",
                           "microfacet_diffuse_azimuth_lut", "microfacet_diffuse"}) {
    const catalog::Entry* entry = catalog::find(name);
    if (!entry) continue;
    // The polar form, by name: every other input stays at its default.
    const auto form = std::find_if(entry->forms.begin(), entry->forms.end(), [](const catalog::Form& f) {
      return std::any_of(f.inputs.begin(), f.inputs.end(), [](const Parameter& p) { return p.name == "theta_o"; });
    });
    if (form == entry->forms.end()) continue;
    std::vector<std::vector<double>> features(entry->features, std::vector<double>(4096));
    std::vector<double> in(form->count), row(entry->features);
    for (int n = 0; n < 4096; ++n) {
      const Draw at = draw(n, Directions::kByCosine);
      std::size_t k = 0;
      for (const Parameter& p : form->inputs)
        for (int channel = 0; channel < p.channels; ++channel, ++k)
          in[k] = p.name == "alpha"     ? at.alpha
                  : p.name == "theta_o" ? std::acos(at.cos_o)
                  : p.name == "theta_i" ? std::acos(at.cos_i)
                  : p.name == "phi"     ? at.phi
                                        : p.initial;
      form->prepare(in.data(), row.data());
      for (std::size_t f = 0; f < row.size(); ++f) features[f][std::size_t(n)] = row[f];
    }
    std::printf("| `%s` | %.3g | %.3g | %.3g |\n", name,
                nanoseconds<float>(*entry, entry->in_batches.from_features, features),
                nanoseconds<float>(*entry, entry->in_float.from_features, features),
                nanoseconds<double>(*entry, entry->in_double.from_features, features));
  }
}

// pi f cos_i / rho over the light's angle in the plane of the view: nine panels, alpha down and the view's angle
// across.
struct Curve {
  Form form;
  const char *label, *style;
};
constexpr std::array kCurves{
    Curve{Form::kLut, "table, one azimuth", "stroke=\"#b07aa1\" stroke-width=\"1.6\" stroke-dasharray=\"6 3\""},
    Curve{Form::kIntegral, "integral", "stroke=\"#000\" stroke-width=\"3\""},
    Curve{Form::kAzimuthLut, "table, three azimuths",
          "stroke=\"#f2d13c\" stroke-width=\"1.4\" stroke-dasharray=\"2 4\""},
    Curve{Form::kLambert, "Lambert", "stroke=\"#888\" stroke-width=\"1.4\" stroke-dasharray=\"2 3\""},
    Curve{Form::kProxima, "Proxima", "stroke=\"#d1495b\" stroke-width=\"1.6\""},
    Curve{Form::kFit, "fit", "stroke=\"#1f77b4\" stroke-width=\"1.8\""},
};

std::string panel(double left, double top, double alpha, double view_deg, double high) {
  constexpr double kWidth = 240, kHeight = 150;
  using page::svg_line, page::svg_text;
  const auto x_of = [&](double degrees) { return left + (degrees + 90) / 180 * kWidth; };
  const auto y_of = [&](double value) { return top + kHeight * (1 - value / high); };
  std::string out;
  for (const int degrees : {-90, -45, 0, 45, 90}) {
    out += svg_line(x_of(degrees), top, x_of(degrees), top + kHeight, "stroke=\"#ddd\"");
    out += svg_text(x_of(degrees), top + kHeight + 13, "middle", std::to_string(degrees) + "°", 10);
  }
  for (double value = 0; value <= high; value += 0.5) {
    out += svg_line(left, y_of(value), left + kWidth, y_of(value), "stroke=\"#ddd\"");
    out += svg_text(left - 4, y_of(value) + 3.5, "end", page::plain(value), 10);
  }
  out += svg_text(left + 6, top + 13, "start",
                  "α = " + page::plain(alpha) + ",  view at " + page::plain(view_deg) + "°", 11);
  for (const Curve& curve : kCurves) {
    std::string points;
    bool inside = false;
    for (int step = -45; step <= 45; ++step) {
      const double degrees = std::clamp(2.0 * step, -89.9, 89.9);
      const auto p =
          PolarPair<double>::at(view_deg * kDegree, std::abs(degrees) * kDegree, degrees < 0 ? std::numbers::pi : 0);
      const double value = over_lambert_cos(curve.form, alpha, p);
      const bool is_inside = value <= high;
      if (is_inside)
        points += (inside ? " " : (points.empty() ? "M" : " M")) + page::number(x_of(degrees), 4) + "," +
                  page::number(y_of(value), 4);
      inside = is_inside;
    }
    out += "<path d=\"" + points + "\" fill=\"none\" " + curve.style + "/>";
  }
  return out;
}

std::string picture() {
  using page::svg_line, page::svg_text;
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 860 616\" font-family=\"DejaVu Sans, sans-serif\">"
      "<title>Microfacet diffuse: the integral and the forms that stand for it, over the angle of the light</title>"
      "<rect width=\"860\" height=\"616\" fill=\"#fff\"/>";
  double x = 46;
  for (const Curve& curve : kCurves) {
    if (curve.form == Form::kAzimuthLut) out += svg_line(x, 20, x + 26, 20, "stroke=\"#000\" stroke-width=\"3\"");
    out += svg_line(x, 20, x + 26, 20, curve.style);
    out += svg_text(x + 31, 24, "start", curve.label, 12);
    x += 52 + 6.9 * double(std::string_view(curve.label).size());
  }
  const double views[]{0, 45, 75}, alphas[]{0.25, 0.5, 1}, highs[]{1.2, 1.6, 2.6};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      out += panel(46 + column * 275, 44 + row * 186, alphas[row], views[column], highs[column]);
  out += svg_text(430, 603, "middle",
                  "angle of the light: left on the far side of the normal from the viewer, right on the viewer's side",
                  12);
  out += svg_text(14, 315, "middle", "π f cos θ / ρ", 12, " transform=\"rotate(-90 14 315)\"");
  return out + "</svg>\n";
}

}  // namespace
}  // namespace likeness::brdf

int main(int count, char** arguments) {
  using namespace likeness::brdf;
  const std::string what = count > 1 ? arguments[1] : "";
  if (what == "fit" && count == 2) return print_fit(), 0;
  if (what == "errors" && count == 2) return print_all_errors(), 0;
  if (what == "times" && count == 2) return print_times(), 0;
  if (what == "picture" && count == 3) {
    std::ofstream file(arguments[2]);
    file << picture();
    if (file.flush()) return 0;
    std::fprintf(stderr, "%s: cannot be written\n", arguments[2]);
    return 3;
  }
  std::fputs("usage: diffuse_study fit | errors | times | picture FILE.svg\n", stderr);
  return 2;
}
