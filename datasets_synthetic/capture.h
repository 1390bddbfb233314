#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "brdf/any_brdf.h"
#include "render/capture/capture.h"
#include "render/image/picture.h"

// A capture with known truth (docs/make_capture.md): a ball of radius 0.1 m about the origin on a round floor, lit by one
// light at a time, seen by cameras on a circle; direct light with exact shadows and nothing else. Renders of the variant
// "truth" are without faults, photographs have those that are asked for.
namespace likeness::datasets_synthetic {

// Faults of photographs, or of what the capture's files say of them. A pair's faults act in this order: where the shadow
// falls, residue, mirror and shift (the geometry of the picture), object, light gain, noise, black, dark, clip, dead, curve,
// swap.
struct CaptureFaults {
  struct LightGain {
    std::size_t light = 0;
    double ev = 0;  // [stop]
  };
  double shift_x = 0, shift_y = 0;  // [pixel]: the photograph shows the subject that much to the right and down
  std::vector<LightGain> gains;     // the light was brighter than lights.json says
  std::vector<std::array<std::size_t, 2>> swaps;  // each one's photographs are called by the other's id
  // A disc before the subject while one light shines, as wide as that share of the picture's shorter side. Its middle is
  // at (x, y) of the picture's width and height, unless asked otherwise left of the picture's middle and above it.
  struct Object {
    std::size_t light = 0;
    double size = 0;
    double x = 0.35, y = 0.35;
    double gain = 1;  // of its radiance
  };
  std::vector<Object> objects;
  double shadow_offset_m = 0;  // the shadow is cast by a ball that much to the right (world's x)
  double residue = 0;          // times a GGX lobe of alpha 0.2 and F = 1 that the renders do not have
  double read_noise = 0;       // standard deviation of a dark pixel [electron]
  double full_well = 0;        // electrons at 1, for shot noise; 0: none, and read noise is in thousandths of 1
  double black = 0;            // is subtracted, and what is below becomes 0: light that is lost
  double dark = 0;             // what is below becomes 0, nothing is subtracted: a sensor that sees no less
  double dead = 0;             // share of the pixels that are 0 under every light, drawn with the seed
  double clip = 0;             // what is above becomes it, and frames.json says so; 0: nothing is clipped
  capture::Transfer curve = capture::Transfer::kLinear;  // is in the photographs; frames.json calls them linear
  std::size_t missing = 0, duplicated = 0;               // frames, drawn with the seed
  bool is_mirrored = false;                              // lights.json has x of every light turned round
};

struct CaptureOptions {
  std::filesystem::path folder;
  int width = 256, height = 256, cameras = 1, lights = 16;
  bool has_near_lights = false;  // at 0.6 m, or else distant
  bool is_bumpy = false;         // the ball's normals wave
  bool has_floats = false;       // 32 bit in the place of half
  bool has_pairs = false;        // each photograph a second time through crossed polarizers: without the residue
  // Cameras and lights only, no picture: photographs will be the renders of the variant "photos", of any scene.
  bool is_template = false;
  std::uint64_t seed = 0;
  brdf::AnyBrdf brdf;
  CaptureFaults faults;
};

inline constexpr double kBallRadius = 0.1, kFloorRadius = 0.3;  // [m]

// What was planted, as truth.json has it, and the capture. Writes capture files, photos/, renders/truth/, aux/ (mask,
// normal, position) and truth.json. Deterministic: the same options give the same bytes. Throws files::Interrupted.
struct MadeCapture {
  capture::Capture capture;
  std::string truth;
};
MadeCapture make_capture(const CaptureOptions& options);

// Without noise, gains, swaps and the like: the light of one pair that reaches the camera, [W/(m^2 sr)] for an irradiance of
// 1 (distant) or an intensity of 1 W/sr (near). Exposed for tests.
struct Shot {
  double shift_x = 0, shift_y = 0, shadow_offset_m = 0, residue = 0;
};
image::Picture shoot(const CaptureOptions& options, const capture::Camera& camera, const capture::Light& light,
                     const Shot& shot);

}  // namespace likeness::datasets_synthetic
