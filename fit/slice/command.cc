#include "fit/slice/command.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>
#include <CLI/CLI.hpp>

#include "brdf/eval/list.h"
#include "fit/slice/evaluator_slice.h"
#include "fit/slice/labels.h"
#include "fit/slice/slice.h"
#include "render/files/files.h"
#include "render/image/write.h"
#include "render/material/material_file.h"
#include "render/material/parameters.h"

namespace likeness::fit {
namespace {

namespace fs = std::filesystem;
using files::UsageError;

constexpr double kCutDeg = 80;  // beyond it a slice says little, and its exposure is not chosen by it

struct SliceOptions {
  std::string what, material, out;
  std::vector<std::string> assignments;
  int size = 256;
  double phi_d = std::numbers::pi / 2;
  std::optional<double> ev;
  bool labels = false;
};

// A slice and what to call it.
struct Drawn {
  SlicePicture slice;
  std::string name;
};

// The parameters of a material file, as assignments to the evaluator of its model.
std::vector<eval::Assignment> assignments_of(const brdf::AnyBrdf& brdf) {
  std::vector<eval::Assignment> assignments;
  for (const material::Entry& entry : material::entries(brdf))
    assignments.push_back({std::string(entry.row.name),
                           std::vector<double>(entry.value.begin(), entry.value.begin() + entry.row.channels)});
  return assignments;
}

Drawn slice_of_model(const SliceOptions& o, const SliceGrid& grid) {
  std::string model = o.what, name = model;
  std::vector<eval::Assignment> assignments;
  const bool what_is_material = model.ends_with(material::kExtension);
  if (what_is_material && !o.material.empty())
    throw UsageError("--material names a second material file; " + model + " is one already");
  if (what_is_material || !o.material.empty()) {
    const material::Material read = material::read_material(what_is_material ? model : o.material);
    const std::string in_file(material::model_name(read.brdf));
    if (!what_is_material && !model.empty() && model != in_file)
      throw UsageError("--material " + o.material + " is of the model " + in_file + ", not of " + model);
    assignments = assignments_of(read.brdf);
    model = in_file;
    name = read.name.empty() ? model : read.name;
  }
  for (const std::string& text : o.assignments) assignments.push_back(eval::assignment_of(text));
  return {slice_of(eval::entry_named(model), assignments, grid), name};
}

Drawn draw(const SliceOptions& o, const SliceGrid& grid) {
  if (o.what.empty() && o.material.empty())
    throw UsageError("nothing to draw: name a model, a measured file, or a --material");
  const bool is_model = o.what.empty() || o.what.ends_with(material::kExtension) || catalog::find(o.what) != nullptr;
  if (is_model || !o.material.empty()) return slice_of_model(o, grid);
  // A word without a dot or a slash that is no file can only be meant as a model.
  if (!fs::exists(o.what) && o.what.find_first_of("./") == o.what.npos) return slice_of_model(o, grid);
  if (!o.assignments.empty()) throw UsageError("--set changes models; " + o.what + " is a measured file");
  return {slice_of(*measured::read(o.what), grid), fs::path(o.what).filename().string()};
}

std::string exposure_text(double ev) { return (ev > 0 ? "+" : "") + files::number_text(ev) + " EV"; }

int run_slice(const SliceOptions& o) {
  if (o.out.empty()) throw UsageError("--out is missing: the name of the pictures, without .exr or .png");
  if (o.size < 8 || o.size > 4096) throw UsageError("--size " + std::to_string(o.size) + " is outside [8, 4096]");
  if (!(std::abs(o.phi_d) <= 2 * std::numbers::pi))
    throw UsageError("--phi-d " + files::number_text(o.phi_d) + " is outside [-6.2832, 6.2832]; it is in radians");
  if (o.ev && !(std::abs(*o.ev) <= 60)) throw UsageError("--ev " + files::number_text(*o.ev) + " is outside [-60, 60]");
  const SliceGrid grid{o.size, o.phi_d};
  const Drawn drawn = draw(o, grid);
  const double ev = o.ev.value_or(slice_exposure(drawn.slice, kCutDeg));
  image::DisplayPicture picture = slice_picture(drawn.slice, ev);
  if (o.labels)
    picture = with_axes(picture, drawn.name + "  phi_d " + files::number_text(std::round(o.phi_d * 1e4) / 1e4) + "  " +
                                     exposure_text(ev));
  std::string out = o.out;
  for (const std::string_view extension : {".exr", ".png"})
    if (out.ends_with(extension)) out.resize(out.size() - extension.size());
  image::write_exr(out + ".exr", drawn.slice.f);
  image::write_png(out + ".png", picture);
  std::size_t invalid = 0;
  for (const std::uint8_t valid : drawn.slice.valid) invalid += valid == 0;
  std::cout << out << ".exr  f [1/sr], linear RGB, " << o.size << " x " << o.size << "\n"
            << out << ".png  sRGB at " << exposure_text(ev) << (o.ev ? "" : " (the median luminance near 0.18)")
            << "\n";
  if (invalid > 0)
    std::cout << "no data in " << invalid << " of " << drawn.slice.valid.size()
              << " pixels: 0 in the EXR, hatched in the PNG\n";
  return 0;
}

constexpr auto kFooter =
    R"(The slice: phi_d fixed, theta_h from 0 to 90 degrees to the right, theta_d from 0 to 90 degrees upwards.
Top: Fresnel peak; left: specular peak; right: retroreflection; the rest: diffuse.

Examples
  likeness slice callisto --set roughness=0.3 --set diffuse_fresnel=4 --out cloth
  likeness slice gold.material.json --size 512 --labels --out gold
  likeness slice gold.binary --ev 0 --out measured

Exit codes: 0 done, 2 usage, 3 a file cannot be used.
Manual: docs/slice.md)";

}  // namespace

void add_slice(CLI::App& program, int& exit_code) {
  const auto o = std::make_shared<SliceOptions>();
  CLI::App* app = program.add_subcommand("slice", "Draw the BRDF slice of a model, a material or a measured file");
  app->add_option("WHAT", o->what, "A model (likeness eval --list), NAME.material.json, or a measured material");
  app->add_option("--set", o->assignments, "NAME=NUMBER or NAME=R,G,B of a model; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--material", o->material, "Take the model and its parameters from a material file");
  app->add_option("--size", o->size, "Pixels along either side")->capture_default_str();
  app->add_option("--phi-d", o->phi_d, "Azimuth of the light about the half vector [rad]")->capture_default_str();
  app->add_option("--ev", o->ev, "Exposure of the PNG in stops (default: chosen so that the median is a middle grey)");
  app->add_flag("--labels", o->labels, "Draw axes, title and the names of the four regions into the PNG");
  app->add_option("--out", o->out, "Name of the pictures: NAME.exr and NAME.png; replaced if they exist");
  app->footer(kFooter);
  app->callback([o, &exit_code] { exit_code = run_slice(*o); });
}

}  // namespace likeness::fit
