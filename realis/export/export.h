#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "realis/export/planes.h"
#include "realis/export/terms.h"
#include "realis/subject.h"
#include "render/capture/capture.h"

// A bake, or the photographs themselves, in files that programs of reflectance transformation imaging read.
namespace likeness::realis {

enum class LightsFrom : unsigned char {
  kPhotographs,  // the photographs, under their lights
  kCapture,      // relit, under the lights of the photographs
  kDisc          // relit, under lights spread over the disc on which viewers move them
};

struct ExportOptions {
  std::filesystem::path out;
  std::string name = "bake";
  std::string camera;  // of photographs; empty: the bake's, or the only one
  Format format = Format::kRbf;
  std::optional<LightsFrom>
      lights{};                // absent: kPhotographs of kLp, else kDisc, which is all that planes are made from
  std::size_t count = 256;     // of kDisc
  std::optional<double> ev{};  // [stop]; absent: exposure_of() what is written
  int quality = 95;            // of JPEG, 1 to 100
  bool is_png = false;         // pictures of kLp without loss
  bool overwrites = false;
};

struct Exported {
  std::vector<std::filesystem::path> files;  // the one to begin with first
  std::size_t lights = 0, near = 0, bytes = 0;
  double ev = 0;
  std::size_t planes = 0;
  // Of planes, decoded, against likeness realis apply in display values, inside the subject [dB]: over the disc, and at the
  // lights of the photographs.
  std::optional<double> psnr_disc, psnr_photographed;
};

inline constexpr std::size_t kMostLights = 4096, kLeastLights = 16;

// All of it or nothing: what was written is taken away when the work is interrupted or fails. Throws files::UsageError (a
// folder that is not empty, no bake), files::InputError and files::Interrupted.
Exported export_capture(const capture::Capture& capture, const ExportOptions& options, const GoesOn& goes_on);

// The page that shows planes under a light which the reader moves: all is in it, nothing is asked of a network.
struct PageFacts {
  std::string capture;
  std::vector<glm::dvec3> photographed;
  std::optional<double> psnr_disc, psnr_photographed;
};
std::string page_of(const Planes& planes, const PageFacts& facts);

// That page of a bake, with the planes of ExportOptions as it is. Throws as export_capture() does.
std::string relight_page(const capture::Capture& capture, const std::string& name, const GoesOn& goes_on);

}  // namespace likeness::realis
