#include "render/cost/command.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>

#include <CLI/CLI.hpp>

#include "render/command/camera_choice.h"
#include "render/cost/study.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/image/write.h"
#include "render/page/html.h"
#include "render/plan/plan.h"
#include "render/runtime/quality.h"
#include "render/scene/read_scene.h"

namespace likeness::scene_cost {
namespace {

namespace fs = std::filesystem;
using files::UsageError;

struct Request {
  std::string scene, camera, size, reference, out, quality, by = "wall";
  std::uint32_t samples = 256;
  int bounces = 64, repeats = 5, threads = 0;
  double longest = 4000;
  std::optional<double> budget_ms, budget_flip;
  bool csv = false, json = false;
};

void check(const Request& r, const CLI::App& app) {
  if (r.scene.empty()) {
    std::string names;
    for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
      names += " or " + sub->get_name();
    throw UsageError("what to measure is missing: a scene" + names + " (likeness cost --help)");
  }
  if (r.budget_ms && r.budget_flip)
    throw UsageError("--budget-ms and --budget-flip exclude each other; give one of them");
  if (!r.quality.empty() && !r.budget_ms && !r.budget_flip)
    throw UsageError("--quality needs a budget to choose by: --budget-ms X or --budget-flip X");
  if (r.csv && r.json) throw UsageError("--csv and --json exclude each other; give one of them");
  // A subcommand with a typing error would be read as a scene.
  std::error_code ignored;
  if (!fs::exists(r.scene, ignored)) {
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(sub->get_name());
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::string near = files::nearest_name(r.scene, known.data(), known.size());
    if (!near.empty())
      throw UsageError(files::in_quotes(r.scene) + " is no file; did you mean likeness cost " + near + "?");
  }
}

// Says the choice on standard output, and writes it. 1: nothing keeps to the budget.
int choose(const Request& request, const Study& study) {
  if (!request.budget_ms && !request.budget_flip) return 0;
  using page::number;
  const bool by_cpu = study.options.counts_cpu;
  const std::string unit = by_cpu ? " ms of CPU" : " ms";
  const auto text = [&](std::size_t i) {
    const Row& row = study.rows[i];
    return name_of(study, row) + ": " + number(row.timing(by_cpu).median) + unit + ", FLIP " + number(row.errors.flip);
  };
  const std::optional<std::size_t> choice = choice_of(study, {request.budget_ms, request.budget_flip});
  if (!choice) {
    const auto nearest = choice_of(study, request.budget_ms ? Budget{{}, 1e300} : Budget{1e300, {}});
    std::cerr << "likeness cost: no combination "
              << (request.budget_ms ? "takes at most " + number(*request.budget_ms) + unit
                                    : "has a FLIP of at most " + number(*request.budget_flip))
              << (nearest ? (request.budget_ms ? "; the fastest is " : "; the most exact is ") + text(*nearest) : "")
              << (request.quality.empty() ? "" : "; " + request.quality + " is not written") << "\n";
    return 1;
  }
  std::ostream& out = request.csv || request.json ? std::cerr : std::cout;
  out << "chosen: " << text(*choice) << "\n";
  if (request.quality.empty()) return 0;
  const Row& row = study.rows[*choice];
  runtime::QualityOrigin origin{study.scene, study.camera, {}};
  origin.measured = {{"wall_ms", row.timing(false).median},
                     {"cpu_ms", row.timing(true).median},
                     {"width", study.width},
                     {"height", study.height},
                     {"threads", study.options.threads},
                     {"flip", row.errors.flip},
                     {"relmse", row.errors.relmse}};
  runtime::write_quality(request.quality, settings_of(row.levels), origin);
  std::cerr << "written: " << request.quality << ", for likeness render --quality\n";
  return 0;
}

int run(const Request& request, const CLI::App& app) {
  check(request, app);
  Options options;
  options.reference_samples = request.samples, options.reference_file = request.reference;
  options.max_bounces = request.bounces, options.repeats = request.repeats, options.threads = request.threads;
  options.longest_ms = request.longest, options.counts_cpu = request.by == "cpu";

  scene::Scene scene = scene::read_scene(request.scene);
  options.camera = render_command::camera_of(scene, request.camera);
  scene::Camera& camera = scene.cameras[options.camera];
  if (!request.size.empty()) render_command::resize(camera, render_command::size_of(request.size));
  constexpr std::size_t kPicturesAtOnce = 4;  // both halves of the reference, their mean, a frame with its cells
  const std::size_t memory = render_command::memory_of_machine() / kPicturesAtOnce;
  render_command::check_memory(camera, false, 0, memory);
  const fs::path folder = request.out;
  std::optional<files::WholeFile> page, csv, json;  // said at once if they cannot be written
  if (!request.out.empty())
    page.emplace(folder / "cost.html"), csv.emplace(folder / "cost.csv"), json.emplace(folder / "cost.json");
  if (!request.quality.empty()) files::WholeFile probe(request.quality);

  const plan::Plan plan = plan::plan_of(scene, options.camera);
  const world::World world(scene, plan);
  files::catch_interrupts();
  std::optional<files::Progress> progress;
  std::string phase;
  std::mutex mutex;
  const Study study = run_study(world, options, [&](std::string_view now, double share) {
    const std::scoped_lock lock(mutex);  // the path tracer asks from all its threads
    if (now != phase) phase = now, progress.emplace();
    progress->tell(phase, share);
    return !files::interrupted();
  });
  progress.reset();

  if (!study.rows.empty()) std::cout << (request.csv ? csv_of(study) : request.json ? json_of(study) : table_of(study));
  const bool has_reference = !study.reference.picture.rgb.empty() && study.reference.samples > 0;
  if (page) {
    if (has_reference) image::write_exr(folder / "reference.exr", study.reference.picture);
    if (!study.rows.empty()) {
      page->append(page_of(study)), page->commit();
      csv->append(csv_of(study)), csv->commit();
      json->append(json_of(study)), json->commit();
      std::cerr << "written: " << (folder / "cost.html").string() << ", cost.csv"
                << (has_reference ? ", cost.json and reference.exr" : " and cost.json") << " beside it\n";
    }
  }
  if (study.is_complete) return choose(request, study);
  std::cerr << "likeness cost: interrupted"
            << (study.rows.empty() ? " before anything was measured"
                                   : "; what is written is what was measured until then")
            << (page && has_reference ? "; " + (folder / "reference.exr").string() + " can be given as --reference"
                                      : "")
            << "\n";
  return 130;
}

constexpr auto kFooter = R"(Examples
  likeness cost room.json --out out/room                     a table, and a page with plots and pictures
  likeness cost room.json --size 320x180 --repeats 3         a first look
  likeness cost room.json --reference out/room/reference.exr the reference of an earlier run: saves its time
  likeness cost room.json --budget-ms 16 --quality game.json the best that 16 ms pay for, for likeness render
  likeness cost evaluators --out out/cost                    the forms of the evaluators instead of a scene

A frame of the run-time pipeline is rendered at every level of each setting that the scene calls for, one at a time
against the rest at best, then in the combinations that promise something; and the path tracer at 1, 4, 16 and 64
samples. All are read in drawn order, --repeats times, and compared with the reference: relMSE of the light, FLIP of what
the screen shows, stops where there is a surface. "predicted" is what the passes of other frames say the time should be.

Ctrl-C writes what was measured so far. Exit codes: 0 done, 1 nothing keeps to the budget, 2 usage, 3 a file cannot be
used, 4 the results cannot be written, 130 interrupted. Manual: docs/scene_cost.md)";

}  // namespace

void add_scene(CLI::App& cost, int& exit_code) {
  const auto r = std::make_shared<Request>();
  cost.require_subcommand(0, 1);
  cost.add_option("SCENE", r->scene, "scene.json, or a mesh file alone: .glb, .gltf, .obj, .ply");
  const std::string seen = "What is seen", truth = "What it is compared with", how = "How it is measured",
                    results = "Results", budget = "Budget";
  cost.add_option("--camera", r->camera, "Name of a camera of the scene, or its number from 0 (default 0)")
      ->group(seen);
  cost.add_option("--size", r->size, "WIDTHxHEIGHT in pixels, instead of the camera's")->group(seen);
  cost.add_option("--reference-spp", r->samples, "Samples a pixel of the reference, by the path tracer")
      ->check(CLI::Range(2, 1 << 24))
      ->capture_default_str()
      ->group(truth);
  cost.add_option("--reference", r->reference, "A picture instead: linear light, .exr, of the same size")->group(truth);
  cost.add_option("--bounces", r->bounces,
                  "Of light in the reference and the path tracer, at most; 1: direct light only")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str()
      ->group(truth);
  cost.add_option("--repeats", r->repeats, "Readings of each frame's time; the median counts")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str()
      ->group(how);
  cost.add_option("--threads", r->threads, "0: one a core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group(how);
  cost.add_option("--by", r->by, "What time is: wall or cpu (on a machine that does other things too)")
      ->check(CLI::IsMember({"wall", "cpu"}))
      ->capture_default_str()
      ->group(how);
  cost.add_option("--longest-ms", r->longest, "CPU time of a frame; combinations that would take more are left out")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str()
      ->group(how);
  cost.add_option("--out", r->out, "Folder for cost.html, cost.csv, cost.json and reference.exr")->group(results);
  cost.add_flag("--csv", r->csv, "Print CSV instead of the table")->group(results);
  cost.add_flag("--json", r->json, "Print JSON instead of the table")->group(results);
  cost.add_option("--budget-ms", r->budget_ms, "Choose the combination with the least FLIP that takes no more")
      ->check(CLI::PositiveNumber)
      ->group(budget);
  cost.add_option("--budget-flip", r->budget_flip, "Choose the fastest combination whose FLIP is no more")
      ->check(CLI::PositiveNumber)
      ->group(budget);
  cost.add_option("--quality", r->quality, "Write the choice, for likeness render --quality")->group(budget);
  cost.footer(kFooter);
  cost.callback([r, &cost, &exit_code] {
    if (cost.get_subcommands().empty()) exit_code = run(*r, cost);
  });
}

}  // namespace likeness::scene_cost
