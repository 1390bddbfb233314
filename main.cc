// The front door: one program whose subcommands the rooms contribute. Here they are only assembled, and what
// goes wrong in any of them becomes one line on stderr and an exit code, once.

#include <algorithm>
#include <exception>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "brdf/cost/command.h"
#include "brdf/eval/command.h"
#include "datasets_synthetic/command.h"
#include "fit/capture/command.h"
#include "fit/command.h"
#include "fit/film/command.h"
#include "fit/measured/command.h"
#include "fit/slice/command.h"
#include "olat/calibrate/command.h"
#include "olat/check/command.h"
#include "olat/command.h"
#include "olat/compare/command.h"
#include "olat/import/command.h"
#include "olat/photograph/command.h"
#include "olat/render/command.h"
#include "olat/view/command.h"
#include "realis/ablation/command.h"
#include "realis/command.h"
#include "realis/export/command.h"
#include "realis/report/command.h"
#include "render/blood/command.h"
#include "render/bloom/command.h"
#include "render/command/command.h"
#include "render/cost/command.h"
#include "render/expose/command.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/mip/command.h"

namespace {

enum ExitCode { kDone = 0, kUsage = 2, kBadInput = 3, kOurFault = 4, kInterrupted = 130 };

constexpr auto kFooter = R"(Examples
  likeness fit gold.binary --out out/gold      fit one measured material, and write a report
  likeness fit materials/ --out out/all        fit a folder; interrupt it at any moment, run it again to resume
  likeness convert paint.mbsdf paint.csv       write a measured material in another format
  likeness make material --help                make a measured material with known parameters
  likeness eval ggx --in angles.csv            a column of results for a table of inputs; --list prints every model
  likeness slice callisto --out slice          a picture of how a model, or a measurement, reflects
  likeness film --talk --out out/film          how thick the film on an eye is, and what it reflects
  likeness cost evaluators --out out/cost      what accuracy costs in time, on this machine
  likeness render room.json                    a picture of a scene; Ctrl-C keeps what there is
  likeness cost room.json --out out/room       what each setting of the run-time pipeline costs and gains on a scene
  likeness expose church.exr --page why.html   an exposure, and why: histogram, zones, what every other would clip
  likeness bloom fit lamp.exr lamp_glow.exr    how a lens makes lamps glow; bloom apply puts it over renders
  likeness blood spatter --speed high          decals of spatter; blood palette fits colors of blood to a table
  likeness plan room.json                      which effects a scene calls for, and why
  likeness hdr merge --list image_list.txt     bracketed photographs to linear light
  likeness raw chart.dng --out chart.exr       a raw photograph to linear light
  likeness olat import photos/                 photographs, one light at a time: compare them with renders
  likeness realis bake capture/                what the renders of a capture lack, to be added at run time
  likeness realis export capture/ --help       that for relighting programs of others, and as a page to look at

Exit codes: 0 done, 1 a check said no, 2 usage, 3 a file cannot be used, 4 the program failed, 130 interrupted.
Manual: docs/README.md)";

// The subcommand that was being read when parsing stopped, with the words that led to it.
struct Place {
  const CLI::App* app;
  std::string words;
};
Place innermost(const CLI::App& program) {
  Place place{&program, program.get_name()};
  while (!place.app->get_subcommands().empty()) {
    place.app = place.app->get_subcommands().back();
    place.words += " " + place.app->get_name();
  }
  return place;
}

std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

// What the user may have meant by a word that the subcommand does not know.
std::string did_you_mean(const CLI::App& app, std::string_view word) {
  const std::string_view wanted = word.substr(0, word.find('='));
  std::vector<std::string> known;
  if (wanted.starts_with("-")) {
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  } else {
    for (const CLI::App* sub : subcommands_of(app)) known.push_back(sub->get_name());
  }
  const std::vector<std::string_view> names(known.begin(), known.end());
  const std::string near = likeness::files::nearest_name(wanted, names.data(), names.size());
  return near.empty() ? "" : "; did you mean " + near + "?";
}

// One line: place, what is wrong, the nearest name, the way out.
std::string usage_message(const CLI::App& program, const CLI::ParseError& error) {
  const Place place = innermost(program);
  const std::string way_out = " (" + place.words + " --help lists what there is)";
  for (const std::string& word : place.app->remaining()) {
    const bool is_option = word.size() > 1 && word.front() == '-';
    const bool is_subcommand = !is_option && !subcommands_of(*place.app).empty();
    const std::string kind = is_option ? "option" : is_subcommand ? "subcommand" : "argument";
    return place.words + ": unknown " + kind + " " + word + did_you_mean(*place.app, word) + way_out;
  }
  if (const auto subs = subcommands_of(*place.app);
      place.app->get_require_subcommand_min() > 0 && !subs.empty() && place.app->get_subcommands().empty()) {
    std::string names;
    for (const CLI::App* sub : subs) names += (names.empty() ? "" : ", ") + sub->get_name();
    return place.words + ": a subcommand is needed: " + names + way_out;
  }
  std::string what = error.what();
  std::replace(what.begin(), what.end(), '\n', ' ');
  return place.words + ": " + what + way_out;
}

int fail(ExitCode code, const std::string& message) {
  std::cout.flush();
  std::cerr << message << '\n';
  return code;
}

}  // namespace

int main(int argc, char** argv) try {
  int exit_code = kDone;
  CLI::App program{"Likeness fits shading models to measured materials, and proves how near they come.", "likeness"};
  program.set_version_flag("--version", "likeness " LIKENESS_VERSION);
  program.require_subcommand(1);
  likeness::capture_fit::add_capture(likeness::fit::add_fit(program, exit_code), exit_code);
  likeness::measured::add_convert(program, exit_code);
  likeness::datasets_synthetic::add_make(program, exit_code);
  likeness::eval::add_eval(program, exit_code);
  likeness::fit::add_slice(program, exit_code);
  likeness::film::add_film(program, exit_code);
  likeness::scene_cost::add_scene(likeness::cost::add_cost(program, exit_code), exit_code);
  likeness::render_command::add_render(program, exit_code);
  likeness::render_command::add_plan(program, exit_code);
  likeness::expose::add_expose(program, exit_code);
  likeness::mip::add_mip(program, exit_code);
  likeness::bloom::add_bloom(program);
  likeness::blood::add_blood(program);
  likeness::olat_photograph::add_raw(program, exit_code);
  likeness::olat_photograph::add_hdr(program, exit_code);
  CLI::App& olat = likeness::olat::add_olat(program);
  likeness::olat_import::add_import(olat, exit_code);
  likeness::olat_import::add_export(olat, exit_code);
  likeness::olat_render::add_render(olat, exit_code);
  likeness::olat_calibrate::add_calibrate(olat, exit_code);
  likeness::olat_check::add_check(olat, exit_code);
  likeness::olat_compare::add_compare(olat, exit_code);
  likeness::olat_view::add_view(olat, exit_code);
  CLI::App& realis = likeness::realis::add_realis(program, exit_code);
  likeness::realis::add_report(realis, exit_code);
  likeness::realis::add_ablate(realis, exit_code);
  likeness::realis::add_export(realis, exit_code);
  program.footer(kFooter);  // last: a subcommand made after it would repeat it

  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return program.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return fail(kUsage, usage_message(program, error));
  } catch (const likeness::files::UsageError& error) {
    return fail(kUsage, innermost(program).words + ": " + error.what());
  } catch (const likeness::files::Interrupted&) {
    return fail(kInterrupted, innermost(program).words + ": interrupted; files are whole or were not touched");
  }
  return exit_code;
} catch (const likeness::files::InputError& error) {
  return fail(kBadInput, error.what());
} catch (const std::exception& error) {
  return fail(kOurFault, std::string("likeness: failed: ") + error.what() +
                             " (if this is neither a full disk nor a missing permission, it is our fault:"
                             " please report it with the command line)");
}
