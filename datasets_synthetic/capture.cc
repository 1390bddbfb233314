#include "datasets_synthetic/capture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include "brdf/about_normal.h"
#include "datasets_synthetic/random.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/image/attributes.h"

namespace likeness::datasets_synthetic {
namespace {

using capture::Camera;
using capture::Capture;
using capture::Light;
using image::Picture;
using Json = nlohmann::ordered_json;

constexpr int kSide = 3;  // samples across a pixel, on a grid

struct Hit {
  glm::dvec3 position, normal, facing;  // facing: the normal of the shape itself, without waves
};

// The nearer root of |from + t way| = radius ahead of the start, for a unit way; nothing if there is none.
std::optional<double> ball_at(const glm::dvec3& from, const glm::dvec3& way) {
  const double b = glm::dot(from, way), c = glm::dot(from, from) - kBallRadius * kBallRadius;
  const double root = b * b - c;
  if (root < 0) return std::nullopt;
  const double t = -b - std::sqrt(root);
  return t > 1e-9 ? std::optional(t) : std::nullopt;
}

glm::dvec3 wavy(const glm::dvec3& n) {
  const glm::dvec3 slope(std::cos(40 * n.x) * std::cos(35 * n.y), std::cos(37 * n.y), std::cos(33 * n.z));
  const glm::dvec3 along = slope - n * glm::dot(slope, n);
  return glm::normalize(n + 0.25 * along);
}

std::optional<Hit> hit(const glm::dvec3& from, const glm::dvec3& way, bool is_bumpy) {
  if (const auto t = ball_at(from, way)) {
    const glm::dvec3 at = from + *t * way, n = glm::normalize(at);
    return Hit{at, is_bumpy ? wavy(n) : n, n};
  }
  const double t = way.y != 0 ? (-kBallRadius - from.y) / way.y : -1;
  if (!(t > 0)) return std::nullopt;
  const glm::dvec3 at = from + t * way;
  if (at.x * at.x + at.z * at.z > kFloorRadius * kFloorRadius) return std::nullopt;
  return Hit{at, {0, 1, 0}, {0, 1, 0}};
}

glm::dvec3 ray_of(const Camera& camera, double u, double v) {
  const glm::dvec3 way = glm::inverse(camera.intrinsics) * glm::dvec3(u, v, 1);
  return glm::normalize(glm::dmat3(camera.world_from_camera) * way);
}

// Of the lobe that the renders do not have: GGX of alpha 0.2 with F = 1.
double residue_of(const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v) {
  static const brdf::AnyBrdf kLobe = [] {
    brdf::Ggx<double> lobe;
    lobe.roughness = std::sqrt(0.2);  // alpha 0.2
    lobe.f0 = brdf::Rgb<double>(1.0);
    return brdf::AnyBrdf(lobe);
  }();
  return mean(brdf::eval_about(kLobe, n, l, v));
}

std::string numbered(const char* word, int number, int count) {
  std::string digits = std::to_string(number);
  const std::size_t width = std::to_string(count - 1).size();
  if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
  return word + digits;
}

// On a circle of 1 m about the subject, 20 degrees apart, a little from above.
Camera camera_at(const CaptureOptions& options, int index) {
  Camera out;
  out.id = numbered("c", index, options.cameras);
  out.width = options.width;
  out.height = options.height;
  const double focal = 2.2 * std::min(options.width, options.height);
  out.intrinsics = glm::dmat3(focal, 0, 0, 0, focal, 0, 0.5 * options.width, 0.5 * options.height, 1);
  const double turn = (index - 0.5 * (options.cameras - 1)) * std::numbers::pi / 9;
  const glm::dvec3 position = glm::normalize(glm::dvec3(std::sin(turn), 0.35, std::cos(turn)));
  const glm::dvec3 forward = -position;
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
  const glm::dvec3 down = glm::cross(forward, right);
  out.world_from_camera =
      glm::dmat4(glm::dvec4(right, 0), glm::dvec4(down, 0), glm::dvec4(forward, 0), glm::dvec4(position, 1));
  return out;
}

// Evenly over the upper front of the dome: a spiral of the golden angle.
Light light_at(const CaptureOptions& options, int index) {
  Light out;
  out.id = numbered("l", index, options.lights);
  const double height = 0.15 + 0.8 * (index + 0.5) / options.lights;
  const double turn = index * std::numbers::pi * (3 - std::sqrt(5.0));
  const double across = std::sqrt(1 - height * height);
  const glm::dvec3 to_light(across * std::sin(turn), height, across * std::cos(turn));
  if (options.has_near_lights) out.place = capture::NearLight{0.6 * to_light};
  else out.place = capture::DistantLight{to_light};
  out.calibrated_by = "likeness make capture";
  return out;
}

void mirror(Light& light) {
  if (auto* distant = std::get_if<capture::DistantLight>(&light.place)) distant->to_light.x *= -1;
  if (auto* near = std::get_if<capture::NearLight>(&light.place)) near->position.x *= -1;
}

double gain_of(const CaptureFaults& faults, std::size_t light) {
  double ev = 0;
  for (const auto& one : faults.gains)
    if (one.light == light) ev += one.ev;
  return std::exp2(ev);
}

// Of every object's radiance for a light of irradiance 1 (near lights: at 1 m): a skin-like Lambert surface that faces it.
constexpr std::array kObjectColor{0.20, 0.11, 0.08};

// Something that is no part of the subject, before the camera.
void cover(const CaptureFaults& faults, std::size_t light, Picture& picture) {
  for (const CaptureFaults::Object& object : faults.objects) {
    if (object.light != light) continue;
    const double radius = 0.5 * object.size * std::min(picture.width, picture.height);
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        if (std::hypot(x + 0.5 - object.x * picture.width, y + 0.5 - object.y * picture.height) < radius)
          for (std::size_t c = 0; c < 3; ++c) picture.at(x, y)[c] = static_cast<float>(object.gain * kObjectColor[c]);
  }
}

// What the camera does to the light, pixel by pixel, with random numbers of this frame's own.
void expose(const CaptureFaults& faults, double gain, Random random, Random dead, Picture& picture) {
  const double read = faults.read_noise / (faults.full_well > 0 ? faults.full_well : 1000);
  const bool has_noise = read > 0 || faults.full_well > 0;
  for (float& value : picture.rgb) {
    double x = static_cast<double>(value) * gain;
    if (has_noise) {
      const double shot = faults.full_well > 0 ? std::max(x, 0.0) / faults.full_well : 0;
      x += std::sqrt(shot + read * read) * random.normal();
    }
    if (faults.black > 0) x = std::max(x - faults.black, 0.0);
    if (faults.dark > 0 && x < faults.dark) x = 0;
    if (faults.clip > 0) x = std::min(x, faults.clip);
    value = capture::encoded_of(faults.curve, static_cast<float>(x));
  }
  if (!(faults.dead > 0)) return;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3)
    if (dead.chance(faults.dead)) std::fill_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(i), 3, 0.0f);
}

void write_layers_of(const CaptureOptions& options, Capture& capture, std::size_t at) {
  const Camera& camera = capture.cameras[at];
  Picture mask(camera.width, camera.height), normals = mask, positions = mask;
  const glm::dvec3 from(camera.world_from_camera[3]);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      if (const auto found = hit(from, ray_of(camera, x + 0.5, y + 0.5), options.is_bumpy))
        for (std::size_t c = 0; c < 3; ++c) {
          mask.at(x, y)[c] = 1;
          normals.at(x, y)[c] = static_cast<float>(found->normal[static_cast<int>(c)]);
          positions.at(x, y)[c] = static_cast<float>(found->position[static_cast<int>(c)]);
        }
  const auto put = [&](capture::Layer layer, const Picture& picture) {
    const std::filesystem::path file = std::filesystem::path("aux") / camera.id /
                                       (std::string(capture::kLayers[static_cast<std::size_t>(layer)]) + ".exr");
    image::write_exr(capture.root / file, picture, {{"olat:camera", camera.id}}, image::Storage::kFloat);
    capture.layers.push_back({at, layer, file});
  };
  put(capture::Layer::kMask, mask);
  put(capture::Layer::kNormal, normals);
  put(capture::Layer::kPosition, positions);
}

// So many different frames, drawn with the seed.
std::vector<std::size_t> drawn(std::size_t count, std::size_t of, Random random) {
  std::set<std::size_t> out;
  while (out.size() < std::min(count, of))
    out.insert(static_cast<std::size_t>(random.uniform() * static_cast<double>(of)));
  return {out.begin(), out.end()};
}

std::string pair_text(const Capture& capture, std::size_t pair) {
  const std::size_t lights = capture.lights.size();
  return capture.cameras[pair / lights].id + "/" + capture.lights[pair % lights].id;
}

std::string truth_text(const CaptureOptions& options, const Capture& capture, const std::vector<std::size_t>& missing,
                       const std::vector<std::size_t>& duplicated) {
  const CaptureFaults& f = options.faults;
  Json faults = Json::object();
  if (f.shift_x != 0 || f.shift_y != 0) faults["shift_px"] = {f.shift_x, f.shift_y};
  for (const auto& one : f.gains) faults["light_gain_ev"][capture.lights[one.light].id] = one.ev;
  for (const auto& one : f.swaps) faults["swapped"].push_back({capture.lights[one[0]].id, capture.lights[one[1]].id});
  for (const auto& one : f.objects) faults["objects"][capture.lights[one.light].id] = one.size;
  if (f.shadow_offset_m != 0) faults["shadow_offset_m"] = f.shadow_offset_m;
  if (f.residue != 0) faults["residue"] = f.residue;
  if (f.read_noise > 0 || f.full_well > 0) {
    faults["read_noise"] = f.read_noise / (f.full_well > 0 ? f.full_well : 1000);
    faults["full_well_electrons"] = f.full_well;
  }
  if (f.black > 0) faults["black"] = f.black;
  if (f.dark > 0) faults["dark"] = f.dark;
  if (f.dead > 0) faults["dead"] = f.dead;
  if (f.clip > 0) faults["clip"] = f.clip;
  if (f.curve != capture::Transfer::kLinear) faults["curve"] = capture::kTransfers[static_cast<std::size_t>(f.curve)];
  for (const std::size_t pair : missing) faults["missing"].push_back(pair_text(capture, pair));
  for (const std::size_t pair : duplicated) faults["duplicated"].push_back(pair_text(capture, pair));
  if (f.is_mirrored) faults["mirrored"] = "x of every light in lights.json";
  const Json out{{"type", "olat truth"},         {"version", 1},    {"seed", options.seed}, {"variant", "truth"},
                 {"ball_radius_m", kBallRadius}, {"faults", faults}};
  return out.dump(1) + "\n";
}

// Rows for photographs that `likeness olat render --variant photos` will make.
MadeCapture template_of(const CaptureOptions& options) {
  MadeCapture out;
  Capture& capture = out.capture;
  capture.root = options.folder;
  capture.name = "template";
  capture.source = "likeness make capture --template; photographs are the renders of the variant photos";
  capture.variants = {{"photos", "renders/{variant}/{camera}/{light}.exr"}};
  for (int i = 0; i < options.cameras; ++i) capture.cameras.push_back(camera_at(options, i));
  for (int i = 0; i < options.lights; ++i) capture.lights.push_back(light_at(options, i));
  for (std::size_t c = 0; c < capture.cameras.size(); ++c)
    for (std::size_t l = 0; l < capture.lights.size(); ++l) {
      capture::Frame& frame = capture.frames.emplace_back();
      frame.camera = c;
      frame.light = l;
      frame.clip = std::numeric_limits<double>::infinity();
      frame.file = std::filesystem::path("renders/photos") / capture.cameras[c].id / (capture.lights[l].id + ".exr");
    }
  out.truth = truth_text(options, capture, {}, {});
  files::write_whole(capture.root / "truth.json", out.truth);
  capture::write_capture(capture);
  return out;
}

}  // namespace

Picture shoot(const CaptureOptions& options, const Camera& camera, const Light& light, const Shot& shot) {
  Picture out(camera.width, camera.height);
  const glm::dvec3 from(camera.world_from_camera[3]), caster(shot.shadow_offset_m, 0, 0);
  const auto* distant = std::get_if<capture::DistantLight>(&light.place);
  const auto* near = std::get_if<capture::NearLight>(&light.place);
  const auto sample = [&](double u, double v) {
    const glm::dvec3 way = ray_of(camera, u - shot.shift_x, v - shot.shift_y);
    const auto found = hit(from, way, options.is_bumpy);
    if (!found) return brdf::Rgb<double>();
    glm::dvec3 l = distant ? distant->to_light : glm::dvec3(0);
    double falloff = 1;
    if (near) {
      const glm::dvec3 to = near->position - found->position;
      falloff = 1 / glm::dot(to, to);
      l = to * std::sqrt(falloff);
    }
    const double cos_i = glm::dot(found->normal, l);
    if (!(cos_i > 0) || !(glm::dot(found->facing, l) > 0)) return brdf::Rgb<double>();
    const bool is_floor = found->position.y < -kBallRadius * (1 - 1e-9);
    if (is_floor && ball_at(found->position - caster, l)) return brdf::Rgb<double>();
    brdf::Rgb<double> f = brdf::eval_about(options.brdf, found->normal, l, -way);
    if (shot.residue != 0) f = f + brdf::Rgb<double>(shot.residue * residue_of(found->normal, l, -way));
    return f * (cos_i * falloff);
  };
  tbb::parallel_for(0, out.height, [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      brdf::Rgb<double> sum;
      for (int i = 0; i < kSide * kSide; ++i)
        sum = sum + sample(x + (i % kSide + 0.5) / kSide, y + (i / kSide + 0.5) / kSide);
      const auto pixel = out.at(x, y);
      pixel[0] = static_cast<float>(sum.r / (kSide * kSide));
      pixel[1] = static_cast<float>(sum.g / (kSide * kSide));
      pixel[2] = static_cast<float>(sum.b / (kSide * kSide));
    }
  });
  return out;
}

MadeCapture make_capture(const CaptureOptions& options) {
  if (options.is_template) return template_of(options);
  const CaptureFaults& faults = options.faults;
  MadeCapture out;
  Capture& capture = out.capture;
  capture.root = options.folder;
  capture.name = "synthetic";
  capture.source = "likeness make capture; truth.json says what is wrong with it";
  capture.license = "CC0";
  capture.variants = {{"truth", "renders/{variant}/{camera}/{light}.exr"}};
  for (int i = 0; i < options.cameras; ++i) capture.cameras.push_back(camera_at(options, i));
  for (int i = 0; i < options.lights; ++i) capture.lights.push_back(light_at(options, i));
  const std::size_t lights = capture.lights.size(), pairs = capture.cameras.size() * lights;
  const std::vector<std::size_t> missing = drawn(faults.missing, pairs, Random(options.seed, 1));
  const std::vector<std::size_t> duplicated = drawn(faults.duplicated, pairs, Random(options.seed, 2));
  // Whose light is in the photograph that goes by the name of light l.
  std::vector<std::size_t> shown(lights);
  for (std::size_t l = 0; l < lights; ++l) shown[l] = l;
  for (const auto& swap : faults.swaps) std::swap(shown[swap[0]], shown[swap[1]]);

  const image::Storage storage = options.has_floats ? image::Storage::kFloat : image::Storage::kHalf;
  files::Progress line;
  for (std::size_t c = 0; c < capture.cameras.size(); ++c) {
    write_layers_of(options, capture, c);
    for (std::size_t l = 0; l < lights; ++l) {
      if (files::interrupted()) throw files::Interrupted();
      const std::size_t pair = c * lights + l;
      line.tell("pair " + std::to_string(pair + 1) + " of " + std::to_string(pairs),
                static_cast<double>(pair) / static_cast<double>(pairs));
      image::Attributes attributes{{"olat:camera", capture.cameras[c].id}, {"olat:light", capture.lights[l].id}};
      attributes["olat:variant"] = "truth";
      attributes["olat:kind"] = "render";
      image::write_exr(render_file(capture, capture.variants[0], c, l),
                       shoot(options, capture.cameras[c], capture.lights[l], {}), attributes, storage);
      if (std::binary_search(missing.begin(), missing.end(), pair)) continue;
      attributes.erase("olat:variant");
      attributes["olat:kind"] = "photo";
      const std::size_t source = shown[l];
      Picture photo = shoot(options, capture.cameras[c], capture.lights[source],
                            {faults.shift_x, faults.shift_y, faults.shadow_offset_m, faults.residue});
      cover(faults, source, photo);
      expose(faults, gain_of(faults, source), Random(options.seed, 100 + pair), Random(options.seed, 3 + c), photo);
      capture::Frame& frame = capture.frames.emplace_back();
      frame.camera = c;
      frame.light = l;
      frame.clip = faults.clip > 0
                       ? static_cast<double>(capture::encoded_of(faults.curve, static_cast<float>(faults.clip))) *
                             (1 - 0x1p-10)  // a half below it
                       : std::numeric_limits<double>::infinity();
      frame.file = std::filesystem::path("photos") / capture.cameras[c].id / (capture.lights[l].id + ".exr");
      image::write_exr(capture.root / frame.file, photo, attributes, storage);
      if (!options.has_pairs) continue;
      capture::Frame crossed = frame;
      crossed.kind = capture::FrameKind::kCrossed;
      crossed.file = std::filesystem::path("photos") / capture.cameras[c].id / (capture.lights[l].id + "_crossed.exr");
      photo = shoot(options, capture.cameras[c], capture.lights[source],
                    {faults.shift_x, faults.shift_y, faults.shadow_offset_m, 0});
      cover(faults, source, photo);
      expose(faults, gain_of(faults, source), Random(options.seed, 100 + pairs + pair), Random(options.seed, 3 + c),
             photo);
      attributes["olat:kind"] = "crossed";
      image::write_exr(capture.root / crossed.file, photo, attributes, storage);
      capture.frames.push_back(crossed);
    }
  }
  const std::vector<capture::Frame> once = capture.frames;
  for (const std::size_t pair : duplicated)
    for (const capture::Frame& frame : once)
      if (frame.camera * lights + frame.light == pair) capture.frames.push_back(frame);
  if (faults.is_mirrored)
    for (Light& light : capture.lights) mirror(light);
  out.truth = truth_text(options, capture, missing, duplicated);
  files::write_whole(capture.root / "truth.json", out.truth);
  capture::write_capture(capture);
  return out;
}

}  // namespace likeness::datasets_synthetic
