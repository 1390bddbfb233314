#include "realis/ablation/command.h"

#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "realis/ablation/ablation.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::realis {
namespace {

struct AblationRequest {
  AblationOptions options;
  std::filesystem::path out = "ablation";
  bool is_json = false;
};

int run_ablate(AblationRequest request) {
  files::catch_interrupts();
  std::filesystem::create_directories(request.out);
  request.options.folder = request.out / "captures";
  Ablation ablation;
  {
    files::Progress progress;
    ablation = ablate(request.options, [&](double share, std::string_view what) {
      progress.tell(what, share);
      return !files::interrupted();
    });
  }
  std::filesystem::remove_all(request.options.folder);
  files::write_whole(request.out / "ablation.html", page_of(ablation, request.options));
  files::write_whole(request.out / "ablation.csv", csv_of(ablation));
  files::write_whole(request.out / "ablation.json", json_of(ablation));
  if (request.is_json) std::cout << json_of(ablation);
  else std::cout << table_of(ablation) << "page, CSV and JSON: " << (request.out / "ablation.html").string() << "\n";
  return 0;
}

}  // namespace

void add_ablate(CLI::App& realis, int& exit_code) {
  CLI::App* ablate = realis.add_subcommand("ablate", "What each weight is worth, on captures with known faults");
  auto request = std::make_shared<AblationRequest>();
  AblationOptions& options = request->options;
  ablate->add_option("--lights", options.lights, "of the captures; may be repeated")
      ->check(CLI::Range(std::size_t{2}, std::size_t{1024}))
      ->allow_extra_args(false)
      ->capture_default_str();
  ablate->add_option("--seeds", options.seeds, "captures of each kind; noise and the sizes of faults are drawn")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000}))
      ->capture_default_str();
  ablate->add_option("--first-seed", options.first_seed, "of them")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 40))
      ->capture_default_str();
  ablate->add_option("--size", options.side, "width and height of the photographs [pixel]")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  ablate->add_option("--full-well", options.full_well, "electrons at 1, of every capture; 0: no noise")
      ->check(CLI::Range(0.0, 1e12))
      ->capture_default_str();
  ablate->add_option("--fault", options.faults, "only this one; may be repeated")->allow_extra_args(false);
  ablate->add_option("--out", request->out, "folder")->capture_default_str();
  ablate->add_flag("--json", request->is_json, "the numbers as JSON instead of the table");
  std::string faults;
  for (const Fault& fault : kFaults)
    faults += "\n  " + std::string(fault.name) + std::string(18 - fault.name.size(), ' ') + std::string(fault.text) +
              (fault.weight.empty() ? "; no weight is there for it" : "; weight: " + std::string(fault.weight));
  ablate->footer("Faults" + faults + R"(

Examples
  likeness realis ablate                                    all faults under 12, 32 and 96 lights, five seeds
  likeness realis ablate --fault object --lights 32         one of them
Manual: docs/realis_weights.md

Exit codes: 0 done, 2 usage, 4 the program failed.)");
  ablate->callback([request, &exit_code] { exit_code = run_ablate(*request); });
}

}  // namespace likeness::realis
