#include "olat/import/command.h"

#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "olat/import/bring.h"
#include "olat/import/color_space.h"
#include "olat/import/export_lp.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/json/section.h"

namespace likeness::olat_import {
namespace {

namespace fs = std::filesystem;

std::size_t count_of(const capture::Capture& capture, capture::Layer layer) {
  std::size_t out = 0;
  for (const capture::LayerFile& one : capture.layers) out += one.layer == layer;
  return out;
}

std::string plural(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

int run_import(const ImportOptions& options, bool json) {
  const Import done = bring(options);
  const capture::Capture& capture = done.capture;
  const std::string root = capture.root.string();
  if (json) {
    std::cout << "{\"capture\": " << json::in_json(root) << ", \"cameras\": " << capture.cameras.size()
              << ", \"lights\": " << capture.lights.size() << ", \"frames\": " << capture.frames.size()
              << ", \"missing\": " << done.missing.size() << "}\n";
    return 0;
  }
  std::cout << root << ": " << plural(capture.cameras.size(), "camera") << ", "
            << plural(capture.lights.size(), "light") << ", " << plural(capture.frames.size(), "photograph")
            << (options.copies ? " (copied)" : " (where they were)") << '\n';
  for (const std::string& note : done.notes) std::cout << "  " << note << '\n';
  if (!done.missing.empty())
    std::cerr << "likeness olat import: " << plural(done.missing.size(), "photograph") << " of the list "
              << (done.missing.size() == 1 ? "is" : "are") << " not there, the first is "
              << files::in_quotes(done.missing[0]) << '\n';
  std::cout << "Next: likeness olat render " << root
            << (count_of(capture, capture::Layer::kNormal) > 0 ? " --from-normals" : " --scene scene.json")
            << "\n  or: likeness realis report " << root << "   (relight it, and how near that comes)\n";
  return 0;
}

constexpr auto kImportFooter = R"(PATH is a folder with photographs and a list of lights, or that list:
  lights.csv   file,lx,ly,lz,ir,ig,ib   x right, y up, z towards the camera; distant lights
  *.lp         reflectance transformation imaging: count, then "file x y z"
  *.dome       RelightLab; photographs are those of the folder, in the order of their names
or a folder of COLMAP (cameras.txt and images.txt, or .bin), with or without a list.
A mask (mask.*, NAME.mask.*) and normals (normal.*, normals.*, normal_gt.*) in the folder are found by their names.

Photographs are EXR, PFM, HDR, DNG (linear by definition), PNG, TIFF, JPEG, TGA (say --color-space, unless lights.csv
calls its pixels linear). Nothing is guessed, and no pixel is read but of one photograph a camera, for its size.

Examples
  likeness olat import shared/captures/diligent-cat
  likeness olat import shared/captures/uw-buddha --color-space srgb --out buddha
  likeness olat import coin/coin.lp --color-space srgb --hash
  likeness olat import stage --cameras stage/sparse/0 --lights stage/lights.csv --photos photos/{camera}/{light}.exr

Exit codes: 0 done, 2 something must be said (--color-space ...), 3 a file cannot be used.
Manual: docs/olat_import.md, docs/capture.md)";

int run_export(const std::string& path, const std::string& camera, const std::string& out) {
  const capture::Capture capture = capture::read_capture(path);
  std::size_t at = 0;
  if (!camera.empty()) {
    at = capture::camera_of(capture, camera);
    std::vector<std::string_view> ids;
    for (const capture::Camera& one : capture.cameras) ids.push_back(one.id);
    const std::string near = files::nearest_name(camera, ids.data(), ids.size());
    if (at == capture::kAbsent)
      throw files::UsageError("--camera " + files::in_quotes(camera) + " is not in the capture" +
                              (near.empty() ? "" : "; did you mean " + near + "?"));
  } else if (capture.cameras.size() > 1) {
    throw files::UsageError("the capture has " + std::to_string(capture.cameras.size()) +
                            " cameras and an .lp has one; say --camera ID");
  }
  const Exported done = export_lp(capture, at, out);
  std::cout << out << ": " << plural(done.lights, "light") << '\n';
  if (done.near > 0)
    std::cerr << "likeness olat export: " << plural(done.near, "light")
              << " stand near; their directions are those from the world's origin\n";
  if (done.left_out > 0)
    std::cerr << "likeness olat export: " << plural(done.left_out, "light")
              << " left out, without a place or without a photograph\n";
  return 0;
}

}  // namespace

void add_import(CLI::App& olat, int& exit_code) {
  CLI::App* sub = olat.add_subcommand("import", "Make a capture of photographs that somebody has taken and listed");
  auto options = std::make_shared<ImportOptions>();
  auto json = std::make_shared<bool>(false);
  sub->add_option("PATH", options->path, "Folder of photographs, or its list of lights")->required();
  sub->add_option("--out", options->out, "Folder of the capture (default: NAME.capture in the current folder)");
  sub->add_option("--lights", options->lights, "List of lights, if it is not in the folder");
  sub->add_option("--cameras", options->cameras, "Folder of COLMAP, if that is not PATH");
  sub->add_option("--photos", options->photos, "With COLMAP: names of files below PATH, with {camera} and {light}");
  sub->add_option("--mask", options->mask, "File: white where the subject is");
  sub->add_option("--normals", options->normals, "File: normals in the world's axes");
  std::string spaces;
  for (const ColorSpace& one : kColorSpaces)
    spaces += (spaces.empty() ? "" : "; ") + std::string(one.name) + ": " + std::string(one.text);
  sub->add_option("--color-space", options->color_space, "What the numbers of the photographs mean. " + spaces);
  sub->add_option("--black", options->black, "Decoded value that stands for no light (integers: of their largest; 0)");
  sub->add_option("--white", options->white, "Decoded value that stands for 1 (1)");
  sub->add_option("--clip", options->clip, "The sensor is full at and above it (1; DNG 0.99; EXR, PFM and HDR never)");
  sub->add_option("--picture-width-m", options->picture_width_m, "What an orthographic picture spans [m] (1)");
  sub->add_option("--unit-m", options->unit_m, "Length of the unit of a .dome or of COLMAP [m], for example 0.01");
  sub->add_flag("--copy", options->copies, "Copy the photographs into the capture, byte by byte");
  sub->add_flag("--hash", options->hashes, "Put the SHA-256 of each photograph into frames.json");
  sub->add_flag("--overwrite", options->overwrites, "Write over a capture that is there");
  sub->add_flag("--json", *json, "Print one JSON object in the place of the summary");
  sub->footer(kImportFooter);
  sub->callback([options, json, &exit_code] { exit_code = run_import(*options, *json); });
}

void add_export(CLI::App& olat, int& exit_code) {
  CLI::App* sub = olat.add_subcommand("export", "Write a capture's lights in the format of another program");
  auto path = std::make_shared<std::string>(), camera = std::make_shared<std::string>(),
       out = std::make_shared<std::string>();
  sub->add_option("CAPTURE", *path, "Folder of the capture")->required();
  sub->add_option("--lp", *out, "File: an .lp of a camera's photographs, for RTI programs (PTM, HSH, RBF)")->required();
  sub->add_option("--camera", *camera, "Id; needed if there are several");
  sub->footer(R"(The axes of the .lp are the camera's: x right, y up, z towards it. Photographs are named, not copied.

Example
  likeness olat export diligent-cat.capture --lp cat.lp)");
  sub->callback([path, camera, out, &exit_code] { exit_code = run_export(*path, *camera, *out); });
}

}  // namespace likeness::olat_import
