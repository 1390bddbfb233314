#include "fit/film/command.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "brdf/ggx.h"
#include "fit/film/estimate.h"
#include "fit/film/page.h"
#include "fit/film/readings.h"
#include "render/files/files.h"
#include "render/material/material_file.h"

namespace likeness::film {
namespace {

struct Request {
  std::string file, out, scale = "fit";
  std::vector<std::string> reflectances;
  Options options;
  bool is_talk = false, json = false;
};

Readings readings_asked_for(const Request& request) {
  const int ways = (request.file.empty() ? 0 : 1) + (request.is_talk ? 1 : 0) + (request.reflectances.empty() ? 0 : 1);
  if (ways != 1)
    throw files::UsageError(std::string(ways == 0 ? "no readings" : "more than one kind of readings") +
                            ": name one of READINGS.csv, --reflectance and --talk");
  if (request.is_talk) return olsen();
  return request.file.empty() ? readings_of(request.reflectances) : read_readings(request.file);
}

// f0 of the film as a mirror; the roughness of tears is below what a model of facets can say.
material::Material material_of(const Told& told) {
  brdf::Ggx<double> ggx;
  const std::array<double, 3> rgb = told.options.eye.color(told.chosen().best().thickness_nm);
  ggx.f0 = {std::clamp(rgb[0], 0.0, 1.0), std::clamp(rgb[1], 0.0, 1.0), std::clamp(rgb[2], 0.0, 1.0)};
  ggx.roughness = 0.02;
  return {"film of tears, " + files::number_text(std::round(told.chosen().best().thickness_nm)) + " nm of oil", ggx};
}

int run_film(const Request& request) {
  Told told{readings_asked_for(request), request.options, {}, request.scale == "fit"};
  told.study = study_of(told.readings, told.options);
  if (!request.out.empty()) {
    const std::filesystem::path folder = request.out;
    files::write_whole(folder / "film.html", page_of(told));
    files::write_whole(folder / "film.json", json_of(told));
    material::write_material(folder / "tears.material.json", material_of(told));
  }
  std::cout << (request.json ? json_of(told) : text_of(told));
  if (!request.out.empty() && !request.json)
    std::cout << "\nwritten: " << request.out << "/film.html, film.json, tears.material.json\n";
  return 0;
}

constexpr auto kFilmFooter =
    R"(The film of oil on tears is thinner than a wavelength: light from its two sides interferes, so that an eye reflects two to
six percent, not the two that the index of tears says. Two wavelengths tell the thickness.

Examples
  likeness film --talk --out film                              Olsen's ten subjects
  likeness film readings.csv --scale 1 --out film              columns subject,500,700: reflectances, 4 % is 0.04
  likeness film --reflectance 500:0.0406 --reflectance 700:0.0316 --error 0.03

Exit codes: 0 done, 2 usage, 3 a file cannot be used. Manual: docs/film.md)";

}  // namespace

void add_film(CLI::App& program, int& exit_code) {
  const auto request = std::make_shared<Request>();
  Options& o = request->options;
  CLI::App* app = program.add_subcommand("film", "Find the thickness of the film on an eye, and what it reflects");
  app->add_option("READINGS", request->file, "CSV: subject, and one column of reflectances for each wavelength in nm");
  app->add_option("--reflectance", request->reflectances, "NM:REFLECTANCE of one subject; repeat it")
      ->allow_extra_args(false);
  app->add_flag("--talk", request->is_talk, "Take the table of ten subjects by Olsen (1985)");
  app->add_option("--scale", request->scale,
                  "Scale of the readings: fit it (ratios decide), or 1; both are told, this one is used")
      ->check(CLI::IsMember({"fit", "1"}))
      ->capture_default_str();
  app->add_option("--incidence", o.eye.incidence_deg, "Angle of the light to the normal [deg]")
      ->check(CLI::Range(0.0, 85.0))
      ->capture_default_str();
  app->add_option("--film-index", o.eye.film_index, "Index of refraction of the oil")
      ->check(CLI::Range(1.0, 3.0))
      ->capture_default_str();
  app->add_option("--tear-index", o.eye.tear_index, "Index of refraction of the tears")
      ->check(CLI::Range(1.0, 3.0))
      ->capture_default_str();
  app->add_option("--most", o.most_nm, "Thickest film that is tried [nm]")
      ->check(CLI::Range(10.0, 2000.0))
      ->capture_default_str();
  app->add_option("--error", o.error, "Standard error of one reading, as a share of it")
      ->check(CLI::Range(1e-4, 1.0))
      ->capture_default_str();
  app->add_option("--resamples", o.resamples, "Of the bootstrap over the subjects; 0: none")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app->add_option("--seed", o.seed, "Of the bootstrap")->capture_default_str();
  app->add_option("--out", request->out, "Folder for film.html, film.json and tears.material.json");
  app->add_flag("--json", request->json, "Print JSON");
  app->footer(kFilmFooter);
  app->callback([request, &exit_code] { exit_code = run_film(*request); });
}

}  // namespace likeness::film
