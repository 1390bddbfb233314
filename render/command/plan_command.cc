#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "render/command/camera_choice.h"
#include "render/command/command.h"
#include "render/command/request.h"
#include "render/plan/draw.h"
#include "render/scene/read_scene.h"

namespace likeness::render_command {
namespace {

struct PlanRequest {
  std::string scene, camera, force;
  bool json = false;
};

int run(const PlanRequest& request) {
  const bool force = is_forced(request.force);
  const scene::Scene scene = scene::read_scene(request.scene);
  const plan::Plan plan = plan::plan_of(scene, camera_of(scene, request.camera), force);
  std::cout << (request.json ? plan::json_of(plan, scene.name, nullptr) : plan::text_of(plan, nullptr));
  return 0;
}

}  // namespace

void add_plan(CLI::App& program, int& exit_code) {
  const auto r = std::make_shared<PlanRequest>();
  CLI::App* app = program.add_subcommand("plan", "Say which effects a scene calls for, and why");
  app->add_option("SCENE", r->scene, "scene.json, or a mesh file alone: .glb, .gltf, .obj, .ply")->required();
  app->add_option("--camera", r->camera, "Name of a camera of the scene, or its number from 0 (default 0)");
  app->add_flag("--json", r->json, "Print the plan as JSON");
  app->add_option("--force", r->force, "all: every effect, needed or not");
  app->callback([r, &exit_code] { exit_code = run(*r); });
}

}  // namespace likeness::render_command
