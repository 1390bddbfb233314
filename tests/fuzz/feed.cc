#include "tests/fuzz/feed.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "fit/measured/csv.h"
#include "fit/measured/mbsdf.h"
#include "fit/measured/rgl.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"
#include "tests/fuzz/feed_bake.h"
#include "tests/fuzz/feed_capture.h"
#include "tests/fuzz/feed_exr.h"
#include "tests/fuzz/feed_olat.h"
#include "tests/fuzz/feed_photograph.h"
#include "tests/fuzz/feed_studies.h"

namespace likeness::measured::test {
namespace {

std::unique_ptr<Material> parsed(std::string_view format, std::string_view bytes) {
  if (format == "merl") return parse_merl(std::string(bytes), "fuzz", kSmallMerl);
  if (format == "mbsdf") return parse_mbsdf(bytes, "fuzz");
  if (format == "rgl") return parse_rgl(bytes, "fuzz");
  return parse_csv(bytes, "fuzz");
}

bool usable(const Rgb& f) { return f.r >= 0 && f.g >= 0 && f.b >= 0 && std::isfinite(f.r + f.g + f.b); }

}  // namespace

bool feed(std::string_view format, std::string_view bytes) {
  if (format == "table") return feed_table(bytes);
  if (format == "exr") return image::test::feed_exr(bytes);
  if (format == "bake") return baked::test::feed_bake(bytes);
  for (const std::string_view of_captures : {"capture", "lights_csv", "lp", "dome", "colmap", "colmap_bin"})
    if (format == of_captures) return capture::test::feed_capture(format, bytes);
  if (format == "tev" || format == "state") return olat_pair::test::feed_olat(format, bytes);
  for (const std::string_view of_photographs : {"brackets", "response", "dng"})
    if (format == of_photographs) return feed_photograph(format, bytes);
  for (const std::string_view of_studies : {"readings", "blood_table", "bloom_kernel"})
    if (format == of_studies) return feed_studies(format, bytes);
  for (const std::string_view of_scenes : {"scene", "glb", "ply", "obj", "ies"})
    if (format == of_scenes) return feed_scene(format, bytes);
  std::unique_ptr<Material> material;
  try {
    material = parsed(format, bytes);
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    hold(message.starts_with("fuzz"), "a message names the file");
    hold(message.find('\n') == message.npos, "a message is one line");
    return false;
  }
  const Coverage c = material->coverage();
  hold(c.valid > 0, "an accepted material has valid samples");
  hold(c.valid + c.negative + c.not_finite + c.padding + c.repeats == c.stored, "every sample is counted once");
  int left = 2000;
  material->for_each_sample([&](const Sample& s) {
    if (left-- <= 0) return;
    hold(usable(s.f), "a sample is finite and not negative");
    hold(s.weight > 0 && s.to_light.z > 0 && s.to_view.z > 0, "a sample is above the horizon and has a weight");
    Rgb f;
    if (material->evaluate(s.to_light, s.to_view, f)) hold(usable(f), "a value is finite and not negative");
  });
  for (const double theta : {0.0, 1e-9, 0.5, 1.57079})
    for (const double phi : {0.0, 1.0, 3.1415926535}) {
      Direction l, v;
      directions_at({theta, 1.0, phi}, l, v);
      Rgb f;
      if (material->evaluate(l, v, f)) hold(usable(f), "a value is finite and not negative");
      if (material->evaluate(v, l, f)) hold(usable(f), "a value is finite and not negative");
    }
  return true;
}

}  // namespace likeness::measured::test
