#include "datasets_synthetic/capture_command.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "datasets_synthetic/capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/material/material_file.h"

namespace likeness::datasets_synthetic {
namespace {

using files::in_quotes;
using files::number_text;
using files::UsageError;

struct CaptureCommand {
  std::string folder, size = "256x256", shift, curve, material;
  std::vector<std::string> gains, swaps, objects;
  double cameras = 1, lights = 16, seed = 0, missing = 0, duplicated = 0;
  bool overwrites = false;
  CaptureOptions options;
};

double within(const std::string& option, double value, double low, double high) {
  if (value >= low && value <= high) return value;
  throw UsageError("--" + option + " = " + number_text(value) + " is outside [" + number_text(low) + ", " +
                   number_text(high) + "]");
}
double whole_within(const std::string& option, double value, double low, double high) {
  if (value != std::floor(value)) throw UsageError("--" + option + " = " + number_text(value) + " is no whole number");
  return within(option, value, low, high);
}

// Two numbers with one of `separators` between them.
std::array<double, 2> two_of(const std::string& option, const std::string& text, char separator, const char* example) {
  std::array<double, 2> out{};
  const std::size_t at = text.find(separator);
  const auto read = [&](std::string_view part, double& number) {
    if (part.starts_with('+')) part.remove_prefix(1);
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
    return error == std::errc{} && end == part.data() + part.size() && std::isfinite(number);
  };
  const std::string_view whole = text;
  if (at == text.npos || !read(whole.substr(0, at), out[0]) || !read(whole.substr(at + 1), out[1]))
    throw UsageError("--" + option + " " + in_quotes(text) + "; expected two numbers: " + example);
  return out;
}

std::size_t light_of(const std::string& option, double number, int lights) {
  if (number != std::floor(number) || number < 0 || number >= lights)
    throw UsageError("--" + option + ": light " + number_text(number) + " is not one of 0 to " +
                     std::to_string(lights - 1));
  return static_cast<std::size_t>(number);
}

void run(CaptureCommand asked) {
  CaptureOptions& options = asked.options;
  CaptureFaults& faults = options.faults;
  const auto size = two_of("size", asked.size, 'x', "256x256");
  options.width = static_cast<int>(whole_within("size", size[0], 1, 16384));
  options.height = static_cast<int>(whole_within("size", size[1], 1, 16384));
  options.cameras = static_cast<int>(whole_within("cameras", asked.cameras, 1, 64));
  options.lights = static_cast<int>(whole_within("lights", asked.lights, 1, 1024));
  options.seed = static_cast<std::uint64_t>(whole_within("seed", asked.seed, 0, 0x1p53));
  if (!asked.material.empty()) options.brdf = material::read_material(asked.material).brdf;
  if (!asked.shift.empty()) {
    const auto shift = two_of("shift", asked.shift, ',', "1.5,-0.25");
    faults.shift_x = within("shift", shift[0], -100, 100);
    faults.shift_y = within("shift", shift[1], -100, 100);
  }
  for (const std::string& text : asked.gains) {
    const auto gain = two_of("light-gain", text, '=', "3=0.5 (light 3, half a stop brighter)");
    faults.gains.push_back({light_of("light-gain", gain[0], options.lights), within("light-gain", gain[1], -20, 20)});
  }
  for (const std::string& text : asked.swaps) {
    const auto swap = two_of("swap", text, ',', "3,7");
    faults.swaps.push_back({light_of("swap", swap[0], options.lights), light_of("swap", swap[1], options.lights)});
  }
  for (const std::string& text : asked.objects) {
    const auto object = two_of("object", text, '=', "3=0.2 (under light 3, a fifth of the picture wide)");
    faults.objects.push_back({light_of("object", object[0], options.lights), within("object", object[1], 0, 2)});
  }
  within("shadow-offset-m", faults.shadow_offset_m, -0.2, 0.2);
  within("residue", faults.residue, 0, 10);
  within("read-noise", faults.read_noise, 0, 1e6);
  within("full-well", faults.full_well, 0, 1e9);
  within("black", faults.black, 0, 1);
  within("dark", faults.dark, 0, 1);
  within("dead", faults.dead, 0, 1);
  within("clip", faults.clip, 0, 1e6);
  const double pairs = double(options.cameras) * options.lights;
  faults.missing = static_cast<std::size_t>(whole_within("missing", asked.missing, 0, pairs - 1));
  faults.duplicated = static_cast<std::size_t>(whole_within("duplicate", asked.duplicated, 0, pairs));
  if (!asked.curve.empty()) {
    const auto at = std::find(capture::kTransfers.begin(), capture::kTransfers.end(), asked.curve);
    const std::string near = files::nearest_name(asked.curve, capture::kTransfers.data(), capture::kTransfers.size());
    if (at == capture::kTransfers.end())
      throw UsageError("--curve " + in_quotes(asked.curve) + " is unknown" +
                       (near.empty() ? "" : "; did you mean " + near + "?") + " (linear, srgb, rec709, gamma22)");
    faults.curve = static_cast<capture::Transfer>(at - capture::kTransfers.begin());
  }
  options.folder = asked.folder;
  std::error_code error;
  const bool is_ours = std::filesystem::exists(options.folder / "truth.json", error);
  if (std::filesystem::exists(options.folder / "capture.json", error) && !(is_ours && asked.overwrites))
    throw UsageError(
        options.folder.string() + " holds a capture already" +
        (is_ours ? "; --overwrite makes it anew" : ", which this command did not make; choose another folder"));
  if (is_ours)
    for (const char* inner : {"photos", "renders/truth", "aux"})
      std::filesystem::remove_all(options.folder / inner, error);
  files::catch_interrupts();
  const MadeCapture made = make_capture(options);
  const auto count = [](std::size_t number, const std::string& thing) {
    return std::to_string(number) + " " + thing + (number == 1 ? "" : "s");
  };
  std::cout << options.folder.string() << ": " << count(made.capture.cameras.size(), "camera") << ", "
            << count(made.capture.lights.size(), "light") << ", ";
  if (options.is_template)
    std::cout << "no picture yet\nNext: likeness olat render " << options.folder.string()
              << " --scene scene.json --variant photos\n";
  else
    std::cout << count(made.capture.frames.size(), "photograph")
              << "; renders/truth is without faults, truth.json says what is wrong\n";
}

constexpr auto kCaptureFooter =
    R"(A ball of 0.1 m on a floor, direct light with exact shadows. photos/ has the faults that are asked for, renders/truth
has none; without any fault the two are equal. Lights are numbered from 0. The same options give the same bytes.

Examples
  likeness make capture ball                                        16 lights, one camera, no fault
  likeness make capture shifted --shift 1.5,-0.25                   photographs 1.5 pixels to the right, a quarter up
  likeness make capture bright --light-gain 3=0.5 --full-well 20000 --read-noise 5
                                                                    light 3 half a stop too bright, under noise
  likeness make capture head --template --cameras 4 --lights 32 --near --size 480x640
  likeness make capture mixed --swap 3,7 --missing 2 --duplicate 1 --curve srgb
Manual: docs/make_capture.md)";

}  // namespace

void add_make_capture(CLI::App& make, int& exit_code) {
  CLI::App* sub =
      make.add_subcommand("capture", "Photographs under one light at a time whose truth is known, with faults");
  auto asked = std::make_shared<CaptureCommand>();
  CaptureOptions& options = asked->options;
  CaptureFaults& faults = options.faults;
  sub->add_option("FOLDER", asked->folder, "Where to")->required();
  sub->add_option("--cameras", asked->cameras, "1 to 64 (1)");
  sub->add_option("--lights", asked->lights, "1 to 1024 (16)");
  sub->add_option("--size", asked->size, "WxH in pixels (256x256)");
  sub->add_flag("--near", options.has_near_lights, "Lights at 0.6 m, in the place of distant ones");
  sub->add_flag("--bumpy", options.is_bumpy, "The ball's normals wave");
  sub->add_option("--material", asked->material, "Material file (Callisto at its defaults)");
  sub->add_flag("--float", options.has_floats, "EXR of 32 bit in the place of half");
  sub->add_flag("--polarized", options.has_pairs,
                "Each photograph a second time through crossed polarizers: without the lobe of --residue");
  sub->add_option("--seed", asked->seed, "Of noise and of frames that are drawn (0)");
  sub->add_flag("--template", options.is_template,
                "Cameras and lights only: photographs will be renders of any scene (olat render --variant photos)");
  sub->add_flag("--overwrite", asked->overwrites, "Write over a capture that this command made");
  const std::string group = "Faults of the photographs";
  sub->add_option("--shift", asked->shift, "X,Y in pixels: the subject is that much to the right and down")
      ->group(group);
  sub->add_option("--light-gain", asked->gains, "LIGHT=EV: brighter by EV stops than lights.json says; may be repeated")
      ->allow_extra_args(false)
      ->group(group);
  sub->add_option("--swap", asked->swaps, "A,B: the photographs of two lights go by each other's name; may be repeated")
      ->allow_extra_args(false)
      ->group(group);
  sub->add_option(
         "--object", asked->objects,
         "LIGHT=SIZE: a disc of that share of the picture before the subject, under one light; may be repeated")
      ->allow_extra_args(false)
      ->group(group);
  sub->add_option("--shadow-offset-m", faults.shadow_offset_m,
                  "Metres: what casts the shadow is that much to the right")
      ->group(group);
  sub->add_option("--residue", faults.residue, "Times a specular lobe (GGX, alpha 0.2, F = 1) that the renders lack")
      ->group(group);
  sub->add_option("--full-well", faults.full_well,
                  "Electrons at 1: shot noise of standard deviation sqrt(x / full well)")
      ->group(group);
  sub->add_option("--read-noise", faults.read_noise,
                  "Electrons, standard deviation of a dark pixel (without --full-well: thousandths of 1)")
      ->group(group);
  sub->add_option("--black", faults.black, "Light that is subtracted and lost: what is below becomes 0")->group(group);
  sub->add_option("--dark", faults.dark, "What is below becomes 0, and nothing is subtracted")->group(group);
  sub->add_option("--dead", faults.dead, "Share of the pixels that are 0 under every light")->group(group);
  sub->add_option("--clip", faults.clip, "The sensor is full there; frames.json says so")->group(group);
  sub->add_option("--curve", asked->curve, "srgb, rec709 or gamma22 in photographs that frames.json calls linear")
      ->group(group);
  sub->add_option("--missing", asked->missing, "So many frames are left out")->group(group);
  sub->add_option("--duplicate", asked->duplicated, "So many frames stand twice")->group(group);
  sub->add_flag("--mirror", faults.is_mirrored, "x of every light in lights.json is turned round")->group(group);
  sub->footer(kCaptureFooter);
  sub->callback([asked, &exit_code] {
    try {
      run(*asked);
      exit_code = 0;
    } catch (const files::Interrupted&) {
      std::cerr << "likeness make capture: interrupted; " << asked->folder << " is no capture yet\n";
      exit_code = 130;
    }
  });
}

}  // namespace likeness::datasets_synthetic
