#include "render/bloom/command.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "render/bloom/apply.h"
#include "render/bloom/fit.h"
#include "render/bloom/page.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/image/read.h"
#include "render/image/write.h"

namespace likeness::bloom {
namespace {

struct FitRequest {
  std::string source, glare, out = "bloom";
  FitOptions options;
  bool json = false;
};

struct ApplyRequest {
  std::string picture, kernel, out, edges = "lose";
  bool json = false;
};

// Says how far it is, and stops after Ctrl-C: nothing is written before the end.
auto teller(files::Progress& progress, const char* what) {
  return [&progress, what](double share) {
    if (files::interrupted()) throw files::Interrupted{};
    progress.tell(what, share);
  };
}

void run_fit(const FitRequest& request) {
  const image::Picture source = image::read_picture(request.source), glare = image::read_picture(request.glare);
  files::catch_interrupts();
  Fit fit;
  try {
    files::Progress progress;
    FitOptions options = request.options;
    options.tell = teller(progress, "fitting");
    fit = fit_kernel(source, glare, options);
  } catch (const std::invalid_argument& error) {
    throw files::InputError(request.source + ": " + error.what());
  }
  const std::filesystem::path folder = request.out;
  files::write_whole(folder / "kernel.json", json_of(fit));
  files::write_whole(folder / "bloom.html", page_of(fit, request.source, request.glare));
  std::cout << (request.json ? json_of(fit) : summary_of(fit));
  if (!request.json) std::cout << "written: " << (folder / "kernel.json").string() << ", bloom.html\n";
}

void run_apply(const ApplyRequest& request) {
  const Kernel kernel = read_kernel(request.kernel);
  const image::Picture picture = image::read_picture(request.picture);
  files::catch_interrupts();
  ApplyOptions options;
  options.edges = request.edges == "reflect" ? Edges::kReflect : Edges::kLose;
  Applied applied;
  {
    files::Progress progress;
    options.tell = teller(progress, "scattering");
    applied = apply(picture, kernel, options);
  }
  image::write_exr(request.out, applied.picture);
  std::array<double, 3> before{}, after{};
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    if (std::isfinite(picture.rgb[i])) before[i % 3] += static_cast<double>(picture.rgb[i]);
    after[i % 3] += static_cast<double>(applied.picture.rgb[i]);
  }
  if (request.json) {
    std::cout << "{\"not_a_number\": " << applied.not_a_number << ", \"infinite\": " << applied.infinite
              << ", \"sum_before\": [" << files::number_text(before[0]) << ", " << files::number_text(before[1]) << ", "
              << files::number_text(before[2]) << "], \"sum_after\": [" << files::number_text(after[0]) << ", "
              << files::number_text(after[1]) << ", " << files::number_text(after[2]) << "]}\n";
    return;
  }
  const double all_before = before[0] + before[1] + before[2], all_after = after[0] + after[1] + after[2];
  std::cout << request.out << ": " << picture.width << " x " << picture.height << ", light after over before "
            << files::number_text(all_before != 0 ? std::round(1e6 * all_after / all_before) / 1e6 : 1)
            << (options.edges == Edges::kLose ? " (the rest left at the edges)\n" : "\n");
  if (applied.not_a_number + applied.infinite > 0)
    std::cout << applied.not_a_number << " values were no numbers and taken for 0, " << applied.infinite
              << " infinite and taken for 65504\n";
}

constexpr auto kBloomFooter =
    R"(A lens scatters a little light far: around a lamp it glows. Photograph a small lamp with that glow and without it (through a
cleaner lens, at a smaller aperture, or as a short exposure scaled up), both as linear light; the kernel that makes one of
the other is then put over renders.

  likeness bloom fit lamp.exr lamp_glow.exr --out bloom
  likeness bloom apply render.exr bloom/kernel.json --out glow.exr

Manual: docs/bloom.md)";

}  // namespace

void add_bloom(CLI::App& program) {
  CLI::App* bloom = program.add_subcommand("bloom", "Fit how a lens makes lamps glow, and put it over pictures");
  bloom->require_subcommand(1);
  bloom->footer(kBloomFooter);

  const auto f = std::make_shared<FitRequest>();
  CLI::App* fit = bloom->add_subcommand("fit", "The kernel that makes the photograph with glare of the one without");
  fit->add_option("SOURCE", f->source, "The small source without glare, linear")->required();
  fit->add_option("GLARE", f->glare, "The same with glare, linear, of the same size")->required();
  fit->add_option("--out", f->out, "Folder for kernel.json and bloom.html")->capture_default_str();
  fit->add_option("--radius", f->options.radius,
                  "Of the part that is looked at [pixels]; 0: to the nearest edge, at most 256")
      ->check(CLI::Range(0, kMostRadius / 2))
      ->capture_default_str();
  fit->add_option("--components", f->options.most, "At most so many")->check(CLI::Range(1, 6))->capture_default_str();
  fit->add_option("--clip", f->options.clip,
                  "Values from here on are clipped and not used (default: found, if four are the largest)");
  fit->add_flag("--json", f->json, "Print the kernel and how it was found as JSON");
  fit->footer(
      "  likeness bloom fit lamp.exr lamp_glow.exr --out bloom\n\nExit codes: 0 done, 2 usage, 3 a picture cannot be "
      "used, 130 interrupted. Manual: docs/bloom.md");
  fit->callback([f] { run_fit(*f); });

  const auto a = std::make_shared<ApplyRequest>();
  CLI::App* put = bloom->add_subcommand("apply", "A picture as that lens would have shown it");
  put->add_option("PICTURE", a->picture, "Linear light: EXR, HDR; bytes are decoded as sRGB")->required();
  put->add_option("KERNEL", a->kernel, "kernel.json of a fit")->required();
  put->add_option("--out", a->out, "EXR to write")->required();
  put->add_option("--edges", a->edges,
                  "Beyond the edges: lose (dark) or reflect (the picture mirrored; keeps all light)")
      ->check(CLI::IsMember({"lose", "reflect"}))
      ->capture_default_str();
  put->add_flag("--json", a->json, "Print sums of light and counts as JSON");
  put->footer(
      "  likeness bloom apply render.exr bloom/kernel.json --edges reflect --out glow.exr\n\nExit codes: 0 done, 2 "
      "usage, 3 a file cannot be used, 130 interrupted. Manual: docs/bloom.md");
  put->callback([a] { run_apply(*a); });
}

}  // namespace likeness::bloom
