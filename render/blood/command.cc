#include "render/blood/command.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "render/blood/palette_page.h"
#include "render/blood/spatter_page.h"
#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/tone_curve.h"
#include "render/image/write.h"

namespace likeness::blood {
namespace {

struct PaletteRequest {
  std::string table, encoding = "srgb", out = "palette";
  int width = 256, height = 128;
  bool json = false;
};

struct ExampleRequest {
  std::string out;
  double noise = 0.02;
  std::uint64_t seed = 1;
};

struct SpatterRequest {
  std::string speed = "medium", receiver = "wall", out = "spatter";
  SpatterOptions options;
  int size = 1024;
  double extent = 0, time = 0;
  bool json = false;
};

void run_palette(const PaletteRequest& request) {
  const Table table = read_table(request.table, request.encoding == "srgb" ? Encoding::kSrgb : Encoding::kLinear);
  PaletteFit fit;
  try {
    fit = fit_palette(table);
  } catch (const std::invalid_argument& error) {
    throw files::InputError(request.table + ": " + error.what());
  }
  const std::filesystem::path folder = request.out;
  const image::Picture picture = picture_of(fit.palette, request.width, request.height);
  image::write_exr(folder / "palette.exr", picture);
  image::write_png(folder / "palette.png", image::display(picture));
  files::write_whole(folder / "palette.json", json_of(table, fit));
  files::write_whole(folder / "palette.html", page_of(table, fit));
  std::cout << (request.json ? json_of(table, fit) : summary_of(table, fit));
  if (!request.json)
    std::cout << "written: " << request.out << "/palette.html, palette.json, palette.exr, palette.png\n";
}

void run_example(const ExampleRequest& request) {
  files::write_whole(request.out, text_of(example_table(request.noise, request.seed)));
  std::cout << request.out << ": 4 drops at 9 times, noise " << request.noise << "\n";
}

// The cone and a fifth more, and never less than some large stains.
double extent_by_default(const SpatterOptions& options) {
  const double cone = kSpeeds[static_cast<std::size_t>(options.speed)].cone_deg * 3.14159265358979 / 180;
  return std::clamp(2400 * options.distance * std::tan(cone), 60.0, 20000.0);
}

void write_layers_of(const std::filesystem::path& folder, const Decal& decal) {
  image::Layers layers{decal.size, decal.size, {}, ""};
  for (const PartRow& row : kParts) {
    const auto part = static_cast<std::size_t>(row.part);
    std::vector<float> both;
    both.reserve(2 * decal.coverage[part].size());
    image::DisplayPicture mask(decal.size, decal.size);
    for (std::size_t i = 0; i < decal.coverage[part].size(); ++i) {
      both.push_back(decal.coverage[part][i]), both.push_back(decal.thickness[part][i]);
      for (std::size_t c = 0; c < 3; ++c)
        mask.rgb[3 * i + c] =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(decal.coverage[part][i], 0.0f, 1.0f)));
    }
    image::write_png(folder / (std::string(row.name) + ".png"), mask);
    layers.layers.push_back(
        {std::string(row.name), {"coverage", "thickness"}, std::move(both), image::Storage::kFloat});
  }
  image::write_layers(folder / "spatter.exr", layers);
}

void run_spatter(SpatterRequest request) {
  for (const SpeedRow& row : kSpeeds)
    if (request.speed == row.name) request.options.speed = row.speed;
  request.options.is_wall = request.receiver == "wall";
  const double extent = request.extent > 0 ? request.extent : extent_by_default(request.options);
  const Spatter spatter = spatter_of(request.options);
  const Decal decal = decal_of(spatter, request.size, extent);
  const image::Picture preview = preview_of(decal, request.time);
  const std::filesystem::path folder = request.out;
  write_layers_of(folder, decal);
  image::write_png(folder / "preview.png", image::display(preview));
  files::write_whole(folder / "spatter.json", json_of(request.options, spatter, decal));
  files::write_whole(folder / "spatter.html", page_of(request.options, spatter, decal, preview));
  std::cout << (request.json ? json_of(request.options, spatter, decal) : summary_of(request.options, spatter, decal));
  if (!request.json)
    std::cout << "written: " << request.out
              << "/spatter.html, spatter.json, spatter.exr, preview.png, and a PNG a layer\n";
}

void add_palette(CLI::App& blood) {
  const auto p = std::make_shared<PaletteRequest>();
  CLI::App* app =
      blood.add_subcommand("palette", "Fit a palette color(opacity, time) to a table of photographed drops");
  app->add_option("TABLE", p->table, "CSV: drop, opacity, time_s, r, g, b")->required();
  app->add_option("--encoding", p->encoding, "Of r, g, b: srgb (0 to 255) or linear (reflectance)")
      ->check(CLI::IsMember({"srgb", "linear"}))
      ->capture_default_str();
  app->add_option("--out", p->out, "Folder for palette.html, .json, .exr and .png")->capture_default_str();
  app->add_option("--width", p->width, "Of the picture: opacities")->check(CLI::Range(2, 4096))->capture_default_str();
  app->add_option("--height", p->height, "Of the picture: times")->check(CLI::Range(2, 4096))->capture_default_str();
  app->add_flag("--json", p->json, "Print the palette and its errors as JSON");
  app->footer(
      "  likeness blood example --out table.csv; likeness blood palette table.csv --out palette\n\nExit codes: 0 done, "
      "2 usage, 3 a file cannot be used. Manual: docs/blood.md");
  app->callback([p] { run_palette(*p); });
}

void add_example(CLI::App& blood) {
  const auto e = std::make_shared<ExampleRequest>();
  CLI::App* app = blood.add_subcommand("example", "Make a table of drops of known colors, to try the palette on");
  app->add_option("--out", e->out, "CSV to write")->required();
  app->add_option("--noise", e->noise, "Standard deviation of each channel, as a share")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app->add_option("--seed", e->seed, "Of the noise")->capture_default_str();
  app->footer("  likeness blood example --noise 0.02 --out table.csv\n\nManual: docs/blood.md");
  app->callback([e] { run_example(*e); });
}

void add_spatter(CLI::App& blood) {
  const auto s = std::make_shared<SpatterRequest>();
  CLI::App* app = blood.add_subcommand("spatter", "Make decals of spatter by speed class and distance");
  app->add_option("--speed", s->speed, "Class: low (drips), medium (a blow), high (a shot)")
      ->check(CLI::IsMember({"low", "medium", "high"}))
      ->capture_default_str();
  app->add_option("--distance", s->options.distance, "From the source to the receiver along the axis [m]")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  app->add_option("--angle", s->options.angle_deg, "Of the axis to the receiver [deg]")
      ->check(CLI::Range(5.0, 90.0))
      ->capture_default_str();
  app->add_option("--receiver", s->receiver, "wall: drips run down; floor: none")
      ->check(CLI::IsMember({"wall", "floor"}))
      ->capture_default_str();
  app->add_option("--drops", s->options.drops, "Thrown (default: as the class has them: 24, 400, 20000)")
      ->check(CLI::Range(0, 1000000));
  app->add_option("--seed", s->options.seed, "The same seed, the same bytes")->capture_default_str();
  app->add_option("--size", s->size, "Pixels a side")->check(CLI::Range(1, kMostDecalPixels))->capture_default_str();
  app->add_option("--extent", s->extent,
                  "mm a side (default: 2.4 times the cone's radius at that distance, 60 or more)")
      ->check(CLI::Range(0.01, 1e6));
  app->add_option("--time", s->time, "Age of the blood in the preview [s]")
      ->check(CLI::Range(0.0, 1e8))
      ->capture_default_str();
  app->add_option("--out", s->out, "Folder")->capture_default_str();
  app->add_flag("--json", s->json, "Print every drop as JSON");
  app->footer(
      "  likeness blood spatter --speed high --distance 0.6 --seed 4 --out shot\n\nExit codes: 0 done, 2 usage. "
      "Manual: docs/blood.md");
  app->callback([s] { run_spatter(*s); });
}

}  // namespace

void add_blood(CLI::App& program) {
  CLI::App* blood = program.add_subcommand("blood", "Colors of blood by opacity and age, and decals of spatter");
  blood->require_subcommand(1);
  blood->footer(
      "  likeness blood palette table.csv --out palette\n  likeness blood spatter --speed high --distance 0.6 --out "
      "shot\n\nManual: docs/blood.md");
  add_palette(*blood);
  add_example(*blood);
  add_spatter(*blood);
}

}  // namespace likeness::blood
