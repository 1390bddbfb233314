#include "fit/capture/capture_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "fit/capture/normals.h"
#include "fit/capture/shared.h"
#include "fit/capture/stack.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/page/html.h"

namespace likeness::capture_fit {
namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point from) { return std::chrono::duration<double>(Clock::now() - from).count(); }

constexpr std::size_t kCurvePixels = 2048;  // that tell how the surface departs from Lambert
constexpr std::size_t kBlock = 2048;        // pixels between two questions, whatever the number of threads
constexpr double kNoTrust = 10 * std::numbers::pi / 180;  // standard error of a normal that is not trusted at all [rad]
constexpr double kSameLight = 0.25 * std::numbers::pi / 180;  // [rad]
// Base colors of surfaces: a capture whose colors are outside states its light in another unit than a surface knows.
constexpr double kDarkest = 0.1, kBrightest = 1, kUsual = 0.5, kBrightShare = 0.98;

// The same numbers on every machine: splitmix64, Steele et al. 2014.
std::uint64_t next(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return z ^ z >> 31;
}

// `count` of `from`, at random, in their order.
template <class T>
std::vector<T> some_of(const std::vector<T>& from, std::size_t count, std::uint64_t seed) {
  if (count >= from.size()) return from;
  std::vector<std::pair<std::uint64_t, std::size_t>> drawn;
  for (std::size_t i = 0; i < from.size(); ++i) drawn.emplace_back(next(seed), i);
  std::nth_element(drawn.begin(), drawn.begin() + static_cast<std::ptrdiff_t>(count), drawn.end());
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(drawn[i].second);
  std::sort(chosen.begin(), chosen.end());
  std::vector<T> out;
  for (const std::size_t i : chosen) out.push_back(from[i]);
  return out;
}

std::vector<std::size_t> lights_of(const capture::Capture& capture, std::size_t camera, const Options& options) {
  const capture::FrameTable frames(capture);
  std::vector<std::size_t> out;
  for (std::size_t light = 0; light < capture.lights.size(); ++light)
    if (frames.frame(camera, light) != capture::kAbsent && capture::has_place(capture.lights[light]) &&
        std::ranges::find(options.leave_out, light) == options.leave_out.end())
      out.push_back(light);
  if (out.empty())
    throw files::UsageError("camera " + files::in_quotes(capture.cameras[camera].id) +
                            " has no photograph under one light whose place is known; give lights.json a direction or "
                            "a position for each, for example by: likeness olat calibrate");
  return out;
}

std::size_t directions_of(const capture::Capture& capture, const std::vector<std::size_t>& lights) {
  std::vector<glm::dvec3> found;
  for (const std::size_t light : lights) {
    const glm::dvec3 to = capture::shine_of(capture.lights[light], glm::dvec3(0)).to_light;
    const double least = std::cos(kSameLight);
    if (std::ranges::none_of(found, [&](const glm::dvec3& other) { return glm::dot(other, to) > least; }))
      found.push_back(to);
  }
  return found.size();
}

// What all pixels share, found on some of them.
struct Fitter {
  const capture::Capture& capture;
  const Options& options;
  const GoesOn& goes_on;
  Fit& fit;
  Sites sites;
  double noise;
  Curve curve{};
  double scale = 1;

  void ask(double share, std::string_view what) const {
    if (!goes_on(share, what)) throw files::Interrupted();
  }

  NormalOfPixel normal_at(const Stack& stack, std::size_t i, Workspace& work) const {
    if (fit.normals_from == NormalSource::kEstimate) return normal_of(work.site, work.y, noise, curve, work);
    NormalOfPixel out;
    const float* n = fit.normals.rgb.data() + 3 * static_cast<std::size_t>(stack.pixels[i]);
    out.normal = {n[0], n[1], n[2]};
    out.seen = seen_by(work.site, work.y, noise);
    return out;
  }
  // Brightness, site and normal of a pixel of a stack.
  NormalOfPixel look(const Stack& stack, std::size_t i, Workspace& work) const {
    sites.at(stack.pixels[i], work.site);
    brightness_of(stack, i, work.y);
    return normal_at(stack, i, work);
  }

  void learn(const Stack& sample) {
    const auto began = Clock::now();
    if (fit.normals_from == NormalSource::kEstimate) {
      ask(0.3, "how it departs from Lambert");
      curve = curve_of(sample, sites, noise);
    }
    fit.normal_seconds += since(began);
    const auto then = Clock::now();
    std::vector<std::size_t> all(sample.pixels.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    const std::vector<std::size_t> chosen = some_of(all, options.pixels, options.seed + 1);
    std::vector<Face> faces(chosen.size());
    tbb::parallel_for(std::size_t{0}, chosen.size(), [&](std::size_t i) {
      Workspace work;
      const NormalOfPixel n = look(sample, chosen[i], work);
      face_of(work.site, n.normal, sample, chosen[i], 1, level_of(work.y, work.scratch), faces[i]);
    });
    std::erase_if(faces, [](const Face& face) { return face.angles.empty(); });
    choose_exposure(faces);
    const SharedFit shared = fit_shared(faces, [&](double) {
      ask(0.45, "shared parameters");
      return true;
    });
    fit.material = shared.material;
    fit.estimates = shared.estimates;
    fit.convergence = shared.convergence;
    fit.residuals = {shared.lambert_rms, shared.callisto_rms, shared.lambert_loss, shared.callisto_loss, shared.scale};
    scale = shared.scale;
    fit.material_seconds = since(then);
  }

  void choose_exposure(std::vector<Face>& faces) const {
    brdf::Callisto<double> lambert;
    lambert.specular = 0;
    lambert.specular_fresnel_falloff = kMatteFalloff;
    std::vector<double> brightest(faces.size(), 0);
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
      FaceShading shading;
      Colored colored;
      shade(lambert, faces[i], shading);
      color_of(faces[i], shading, 0.1, colored);
      brightest[i] = *std::ranges::max_element(colored.color);
    });
    if (brightest.empty()) return;
    const auto at =
        brightest.begin() + static_cast<std::ptrdiff_t>(kBrightShare * static_cast<double>(brightest.size() - 1));
    std::nth_element(brightest.begin(), at, brightest.end());
    if (!(*at > 0) || (*at >= kDarkest && *at <= kBrightest)) return;
    fit.exposure = *at / kUsual;
    for (Face& face : faces)
      for (double& shine : face.shine) shine *= fit.exposure;
    fit.notes.push_back(
        "The brightest surfaces would reflect " + page::number(*at) +
        " of the light if the capture's unit light were an irradiance of 1, so its light is taken as " +
        page::number(fit.exposure) +
        " of it. Base colors and the strength of the specular are relative to that; renders are not changed by it.");
  }

  // Normals, colors and confidence of a stack's pixels.
  void draw(const Stack& stack, std::size_t done, std::size_t of) {
    fit.counts.clipped += stack.clipped;
    fit.counts.not_finite += stack.not_finite;
    fit.counts.negative += stack.negative;
    fit.counts.samples += stack.pixels.size() * stack.lights.size();
    const auto began = Clock::now();
    std::vector<NormalOfPixel> found(std::min(kBlock, stack.pixels.size()));
    std::vector<std::uint8_t> is_colored(found.size());
    for (std::size_t first = 0; first < stack.pixels.size(); first += kBlock) {
      ask(0.5 + 0.5 * static_cast<double>(done + first) / static_cast<double>(std::max<std::size_t>(of, 1)),
          "normals and colors");
      const std::size_t last = std::min(first + kBlock, stack.pixels.size());
      tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, 64), [&](const auto& range) {
        Workspace work;
        Face face;
        FaceShading shading;
        Colored colored;
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const NormalOfPixel n = look(stack, i, work);
          face_of(work.site, n.normal, stack, i, fit.exposure, level_of(work.y, work.scratch), face);
          colored = {};
          if (!face.angles.empty()) {
            shade(fit.material, face, shading);
            color_of(face, shading, scale, colored);
          }
          write(stack.pixels[i], n, colored);
          found[i - first] = n;
          is_colored[i - first] = colored.is_known ? 1 : 0;
        }
      });
      for (std::size_t i = first; i < last; ++i) count(found[i - first], is_colored[i - first] != 0);
    }
    fit.color_seconds += since(began);
  }

  void write(std::uint32_t pixel, const NormalOfPixel& n, const Colored& colored) const {
    const std::size_t at = 3 * static_cast<std::size_t>(pixel);
    const bool is_known = n.normal != glm::dvec3(0);
    const double sure = fit.normals_from == NormalSource::kGiven ? 1.0 : std::clamp(1 - n.sigma / kNoTrust, 0.0, 1.0);
    const std::array<double, 3> trust{colored.weight / static_cast<double>(std::max<std::size_t>(fit.counts.lights, 1)),
                                      is_known ? sure : 0,
                                      colored.is_known ? std::clamp(1 - colored.error, 0.0, 1.0) : 0};
    for (std::size_t c = 0; c < 3; ++c) {
      fit.normals.rgb[at + c] = static_cast<float>(n.normal[static_cast<int>(c)]);
      fit.base_colors.rgb[at + c] = static_cast<float>(colored.is_known ? colored.color[c] : 0);
      fit.confidence.rgb[at + c] = static_cast<float>(trust[c]);
    }
  }
  void count(const NormalOfPixel& n, bool is_colored) const {
    Counts& counts = fit.counts;
    counts.pixels += 1;
    counts.without_normal += n.normal == glm::dvec3(0) ? 1 : 0;
    counts.seen_by_none += n.seen == Seen::kByNone ? 1 : 0;
    counts.seen_by_few += n.seen == Seen::kByFew ? 1 : 0;
    counts.in_one_plane += n.seen == Seen::kInOnePlane ? 1 : 0;
    counts.without_color += is_colored ? 0 : 1;
  }
};

double noise_of(const capture::Capture& capture, std::size_t camera) {
  if (camera >= capture.noise_floor.size()) return 0;
  const glm::dvec3 floor = capture.noise_floor[camera];
  return (floor.x + floor.y + floor.z) / 3;
}

void describe(Fit& fit) {
  const Counts& c = fit.counts;
  const auto of = [&](std::size_t n) { return std::to_string(n) + " of " + std::to_string(c.pixels); };
  if (c.pixels == 0) fit.notes.emplace_back("The mask of the camera is empty: there is nothing to fit.");
  if (fit.normals_from == NormalSource::kEstimate && c.light_directions < 3)
    fit.notes.push_back(
        "Photographs under " + std::to_string(c.light_directions) +
        " different directions of light do not determine normals, for which three are needed: all are 0.");
  else if (c.in_one_plane > 0 && fit.normals_from == NormalSource::kEstimate)
    fit.notes.push_back("The lights that reach " + of(c.in_one_plane) +
                        " pixels lie in one plane, which leaves their normals open: they are 0.");
  if (c.seen_by_none > 0) fit.notes.push_back("No light shows " + of(c.seen_by_none) + " pixels.");
  if (c.seen_by_few > 0 && fit.normals_from == NormalSource::kEstimate)
    fit.notes.push_back("Only one light or two show " + of(c.seen_by_few) + " pixels: their normals are 0.");
  if (c.not_finite > 0)
    fit.notes.push_back(std::to_string(c.not_finite) + " samples of the photographs are not finite and were left out.");
}

// The median color of the pixels that have one.
brdf::Rgb<double> median_color(const image::Picture& colors) {
  std::array<double, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> values;
    for (std::size_t k = c; k < colors.rgb.size(); k += 3)
      if (colors.rgb[k] > 0) values.push_back(colors.rgb[k]);
    if (values.empty()) continue;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    out[c] = std::clamp(static_cast<double>(*middle), 0.0, 1.0);
  }
  return {out[0], out[1], out[2]};
}

}  // namespace

Fit fit_capture(const capture::Capture& capture, std::size_t camera, const Options& options, const GoesOn& goes_on) {
  Fit fit;
  fit.camera = camera;
  const capture::Camera& of = capture.cameras[camera];
  const bool has_normals = !layer_file(capture, camera, capture::Layer::kNormal).empty();
  fit.normals_from = options.normals.value_or(has_normals ? NormalSource::kGiven : NormalSource::kEstimate);
  if (fit.normals_from == NormalSource::kGiven && !has_normals)
    throw files::UsageError("--normals given: camera " + files::in_quotes(of.id) +
                            " has no layer of normals in cameras.json; --normals estimate finds them");
  const std::vector<std::size_t> lights = lights_of(capture, camera, options);
  fit.counts.lights = lights.size();
  fit.counts.light_directions = directions_of(capture, lights);
  fit.normals = image::Picture(of.width, of.height);
  fit.base_colors = image::Picture(of.width, of.height);
  fit.confidence = image::Picture(of.width, of.height);
  Fitter fitter{capture, options, goes_on, fit, Sites(capture, camera, lights), noise_of(capture, camera)};

  const auto began = Clock::now();
  if (fit.normals_from == NormalSource::kGiven) fit.normals = capture::read_normals(capture, camera);
  const capture::CameraLayers layers = capture::read_camera_layers(capture, camera);
  std::vector<std::uint32_t> inside;
  for (std::size_t i = 0; i < layers.mask.size(); ++i) {
    if (layers.mask[i] != 0) inside.push_back(static_cast<std::uint32_t>(i));
    else std::fill_n(fit.normals.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, 0.0f);
  }

  const std::size_t bytes_a_pixel = 3 * sizeof(float) * lights.size();
  const std::size_t a_band = std::max<std::size_t>(options.bytes / bytes_a_pixel, 1);
  const std::size_t bands = std::max<std::size_t>((inside.size() + a_band - 1) / a_band, 1);
  fit.counts.bands = bands;
  const std::size_t passes = bands == 1 ? 1 : bands + 1;
  std::size_t pass = 0;
  const auto read = [&](std::vector<std::uint32_t> pixels) {
    const auto start = Clock::now();
    Stack stack = read_stack(capture, camera, layers, lights, std::move(pixels), [&](std::size_t photos) {
      const double share = static_cast<double>(photos) / static_cast<double>(lights.size());
      return goes_on((static_cast<double>(pass) + share) / static_cast<double>(passes) * (passes == 1 ? 0.3 : 1),
                     "reading photographs");
    });
    ++pass;
    fit.read_seconds += since(start);
    return stack;
  };
  fit.read_seconds = since(began);

  const std::size_t wanted = std::max(kCurvePixels, options.pixels);
  if (bands == 1) {
    const Stack whole = read(inside);
    std::vector<std::size_t> all(whole.pixels.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    fitter.learn(part_of(whole, some_of(all, wanted, options.seed)));
    fitter.draw(whole, 0, inside.size());
  } else {
    fitter.learn(read(some_of(inside, wanted, options.seed)));
    for (std::size_t first = 0; first < inside.size(); first += a_band) {
      const std::size_t last = std::min(first + a_band, inside.size());
      fitter.draw(read({inside.begin() + static_cast<std::ptrdiff_t>(first),
                        inside.begin() + static_cast<std::ptrdiff_t>(last)}),
                  first, inside.size());
    }
  }
  fit.material.base_color = median_color(fit.base_colors);
  const auto& median = fit.material.base_color;
  for (int c = 0; c < 3; ++c)
    fit.estimates.push_back({.name = "base_color",
                             .channel = c,
                             .value = c == 0   ? median.r
                                      : c == 1 ? median.g
                                               : median.b,
                             .sigma = std::numeric_limits<double>::quiet_NaN(),
                             .fitted = true,
                             .why = {}});
  describe(fit);
  return fit;
}

}  // namespace likeness::capture_fit
