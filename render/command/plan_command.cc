#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "render/command/camera_choice.h"
#include "render/command/command.h"
#include "render/command/effect_cost.h"
#include "render/command/request.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/plan/draw.h"
#include "render/scene/read_scene.h"

namespace likeness::render_command {
namespace {

struct PlanRequest {
  std::string scene, camera, force, out;
  bool json = false, times = false;
  double repeats = 9;
};

// Of a scene, for a heading: most are called scene.json, and their folder says which it is.
std::string name_of(const std::filesystem::path& scene) {
  const std::filesystem::path folder = scene.parent_path().filename();
  return (scene.filename() == "scene.json" && !folder.empty() ? folder / scene.filename() : scene.filename()).string();
}

int run(const PlanRequest& request) {
  const bool force = is_forced(request.force);
  const std::filesystem::path out = request.out;
  if (!request.out.empty() && out.extension() != ".html" && out.extension() != ".svg")
    throw files::UsageError("--out " + files::in_quotes(request.out) +
                            " is neither a page nor a drawing; expected a name that ends with .html or .svg");
  if (!(request.repeats >= 3 && request.repeats <= 1000))
    throw files::UsageError("--repeats " + files::number_text(request.repeats) + " is outside [3, 1000]");
  if (force && request.times)
    throw files::UsageError(
        "--time compares the scene with and without each effect that it calls for; leave --force out");
  files::catch_interrupts();

  const scene::Scene scene = scene::read_scene(request.scene);
  const std::size_t camera = camera_of(scene, request.camera);
  if (!request.out.empty()) files::WholeFile probe(out);
  const plan::Plan plan = plan::plan_of(scene, camera, force);
  std::optional<plan::Costs> costs;
  if (request.times) {
    files::Progress line;
    CostOptions options{.camera = camera, .repeats = static_cast<int>(request.repeats)};
    try {
      costs = costs_of(scene, options, [&](const std::string& what, double share) { line.tell(what, share); });
    } catch (const files::Interrupted&) {
      std::cerr << "likeness plan: interrupted; nothing is written\n";
      return 130;
    }
  }
  const plan::Costs* measured = costs ? &*costs : nullptr;
  const std::string name = name_of(request.scene);
  if (!request.out.empty())
    files::write_whole(
        out, out.extension() == ".svg" ? plan::svg_of(plan, name, measured) : plan::page_of(plan, name, measured));
  std::cout << (request.json ? plan::json_of(plan, name, measured) : plan::text_of(plan, measured));
  return 0;
}

constexpr auto kPlanFooter = R"(Examples
  likeness plan room.json                         a table: on or off, and the fact of the scene that decided it
  likeness plan room.json --out plan.html         the same as a page to look at
  likeness plan room.json --time --out plan.html  and what each effect that is on adds to the time
  likeness plan room.json --json                  for programs; "digest" is the same for scenes that run the same code

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 the page cannot be written, 130 interrupted.
Manual: docs/plan.md)";

}  // namespace

void add_plan(CLI::App& program, int& exit_code) {
  const auto r = std::make_shared<PlanRequest>();
  CLI::App* app = program.add_subcommand("plan", "Say which effects a scene calls for, why, and what they cost");
  app->add_option("SCENE", r->scene, "scene.json, or a mesh file alone: .glb, .gltf, .obj, .ply")->required();
  app->add_option("--camera", r->camera, "Name of a camera of the scene, or its number from 0 (default 0)");
  app->add_option("--out", r->out, "Draw it: .html is a page, .svg the drawing alone");
  app->add_flag("--json", r->json, "Print the plan as JSON");
  app->add_flag("--time", r->times, "Measure what each effect that is on adds, some seconds for each");
  app->add_option("--repeats", r->repeats, "With --time: pairs of readings for each effect")->capture_default_str();
  app->add_option("--force", r->force, "all: every effect, needed or not, as render --force does");
  app->footer(kPlanFooter);
  app->callback([r, &exit_code] { exit_code = run(*r); });
}

}  // namespace likeness::render_command
