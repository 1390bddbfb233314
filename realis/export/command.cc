#include "realis/export/command.h"

#include <array>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "realis/export/export.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::realis {
namespace {

struct ExportRequest {
  std::string capture, out, format = "rbf", lights, ev = "auto";
  ExportOptions options;
  bool is_json = false;
};

Format format_of(const std::string& name) {
  std::vector<std::string_view> names;
  std::string all;
  for (const FormatRow& row : kFormats) {
    if (row.name == name) return row.format;
    names.push_back(row.name);
    all += (all.empty() ? "" : ", ") + std::string(row.name);
  }
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw files::UsageError("--format " + files::in_quotes(name) + " is not one of " + all +
                          (near.empty() ? "" : "; did you mean " + near + "?"));
}

void read_lights(const std::string& text, ExportOptions& options) {
  if (text.empty()) return;
  if (text == "photographs") options.lights = LightsFrom::kPhotographs;
  else if (text == "capture") options.lights = LightsFrom::kCapture;
  else {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const auto least = static_cast<double>(options.format == Format::kLp ? 1 : kLeastLights);
    if (end == text.c_str() || *end != 0 || !(value >= least && value <= static_cast<double>(kMostLights)) ||
        value != static_cast<double>(static_cast<std::size_t>(value)))
      throw files::UsageError("--lights " + files::in_quotes(text) +
                              " is not `photographs`, `capture` or a whole number from " + files::number_text(least) +
                              " to " + std::to_string(kMostLights));
    options.lights = LightsFrom::kDisc;
    options.count = static_cast<std::size_t>(value);
  }
}

void read_ev(const std::string& text, ExportOptions& options) {
  if (text == "auto") return;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != 0 || !(value >= -30 && value <= 30))
    throw files::UsageError("--ev " + files::in_quotes(text) + " is not `auto` or stops from -30 to 30");
  options.ev = value;
}

std::string decibels(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f dB", value);
  return text.data();
}

void print(const Exported& done, const ExportOptions& options) {
  const FormatRow& row = row_of(options.format);
  std::cout << row.name << ": " << done.lights << (done.lights == 1 ? " light" : " lights") << ", exposure "
            << (done.ev > 0 ? "+" : "") << files::number_text(done.ev) << " stops, ";
  if (done.planes > 0)
    std::cout << done.planes << " planes in " << done.planes / 3 << " JPEG of quality " << options.quality << ", ";
  std::cout << done.files.size() << " files, " << (done.bytes + 1023) / 1024 << " KiB\n";
  if (done.psnr_disc)
    std::cout << "against likeness realis apply: " << decibels(*done.psnr_disc) << " over the disc of lights";
  if (done.psnr_photographed) std::cout << ", " << decibels(*done.psnr_photographed) << " at those of the photographs";
  if (done.psnr_disc) std::cout << '\n';
  std::cout << done.files[0].string()
            << (done.planes > 0 ? ": open it in a browser, and move the light; info.json is for other viewers\n"
                                : "\n");
  if (done.near > 0)
    std::cerr << "likeness realis export: " << done.near
              << " lights stand near; their directions are those from the world's origin\n";
}

std::string json_of(const Exported& done, const ExportOptions& options) {
  using Json = nlohmann::ordered_json;
  Json out{{"format", row_of(options.format).name},
           {"file", done.files[0].string()},
           {"files", done.files.size()},
           {"bytes", done.bytes},
           {"lights", done.lights},
           {"near_lights", done.near},
           {"ev", done.ev},
           {"planes", done.planes}};
  out["psnr_db"] = done.psnr_disc ? Json(*done.psnr_disc) : Json(nullptr);
  out["psnr_photographed_db"] = done.psnr_photographed ? Json(*done.psnr_photographed) : Json(nullptr);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

int run_export(ExportRequest request) {
  files::catch_interrupts();
  ExportOptions& options = request.options;
  options.format = format_of(request.format);
  options.out = request.out;
  read_lights(request.lights, options);
  read_ev(request.ev, options);
  const capture::Capture capture = capture::read_capture(request.capture);
  Exported done;
  {
    files::Progress progress;
    done = export_capture(capture, options, [&](double share, std::string_view what) {
      progress.tell(what, share);
      return !files::interrupted();
    });
  }
  if (request.is_json) std::cout << json_of(done, options);
  else print(done, options);
  return 0;
}

}  // namespace

void add_export(CLI::App& realis, int& exit_code) {
  CLI::App* sub =
      realis.add_subcommand("export", "Write a bake for relighting programs of others, and a page to look at");
  auto request = std::make_shared<ExportRequest>();
  std::string formats;
  for (const FormatRow& row : kFormats)
    formats += "\n  " + std::string(row.name) + std::string(10 - row.name.size(), ' ') + std::string(row.text);
  sub->add_option("CAPTURE", request->capture, "folder with capture.json (likeness olat import)")->required();
  sub->add_option("--format", request->format, "one of those below")->capture_default_str();
  sub->add_option("--out", request->out, "folder, empty or not there")->required();
  sub->add_option("--name", request->options.name, "of the bake")->capture_default_str();
  sub->add_option(
      "--lights", request->lights,
      "lp: `photographs` (default), or relit pictures: under the lights of the `capture`, or so many others; "
      "planes: how many lights they are fitted to (256)");
  sub->add_option("--camera", request->options.camera, "of photographs; needed if there are several");
  sub->add_option("--ev", request->ev, "exposure [stop]; auto: 99 % of the light is at most white")
      ->capture_default_str();
  sub->add_option("--quality", request->options.quality, "of JPEG")->check(CLI::Range(1, 100))->capture_default_str();
  sub->add_flag("--png", request->options.is_png, "pictures of lp as PNG, without loss");
  sub->add_flag("--overwrite", request->options.overwrites, "write into a folder that is not empty");
  sub->add_flag("--json", request->is_json, "print one JSON object instead of the summary");
  sub->footer("Formats" + formats + R"(
Planes are JPEG with an info.json as relight writes them and OpenLIME reads them, and index.html shows them. They hold
display values: sRGB curve, 8 bit. How far they are from `likeness realis apply` is measured and printed.

Examples
  likeness realis export capture --out web                planes and a page: open web/index.html
  likeness realis export capture --format lp --out rti    the photographs and lights.lp, for RTI programs
  likeness realis export capture --format lp --lights 64 --out dome    64 relit pictures as if of a dome

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 the program failed, 130 interrupted (nothing is left).
Manual: docs/realis_export.md)");
  sub->callback([request, &exit_code] { exit_code = run_export(*request); });
}

}  // namespace likeness::realis
