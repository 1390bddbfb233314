#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "olat/check/finder.h"

namespace likeness::olat_check {
namespace {

using capture::Capture;
using capture::Frame;
using capture::FrameKind;
using capture::kAbsent;

std::vector<std::vector<std::size_t>> frames_by_pair(const Capture& capture) {
  std::vector<std::vector<std::size_t>> by_pair(capture.cameras.size() * capture.lights.size());
  for (std::size_t i = 0; i < capture.frames.size(); ++i)
    if (const Frame& frame = capture.frames[i]; frame.kind == FrameKind::kOneLight)
      by_pair[frame.camera * capture.lights.size() + frame.light].push_back(i);
  return by_pair;
}

void check_pairs(const Capture& capture, const Finder& finder) {
  const std::size_t lights = capture.lights.size();
  const auto by_pair = frames_by_pair(capture);
  std::vector<std::size_t> uses(lights, 0);
  for (std::size_t i = 0; i < by_pair.size(); ++i) uses[i % lights] += by_pair[i].size();
  for (std::size_t camera = 0; camera < capture.cameras.size(); ++camera) {
    std::vector<std::string> missing;
    for (std::size_t light = 0; light < lights; ++light)
      if (by_pair[camera * lights + light].empty() && (uses[light] > 0 || capture.cameras.size() == 1))
        missing.push_back(capture.lights[light].id);
    finder.judge(Rule::kMissingFrame, {camera}, static_cast<double>(missing.size()),
                 std::to_string(missing.size()) + " of " + std::to_string(lights) +
                     " lights have no photo: " + some_of(missing));
  }
  for (std::size_t i = 0; i < by_pair.size(); ++i)
    if (by_pair[i].size() > 1) {
      std::vector<std::string> names;
      for (const std::size_t frame : by_pair[i]) names.push_back(capture.frames[frame].file.string());
      finder.judge(Rule::kDuplicateFrame, {i / lights, i % lights}, static_cast<double>(names.size()),
                   std::to_string(names.size()) + " photos: " + some_of(names));
    }
  std::map<std::string, std::vector<std::size_t>> by_file;
  for (std::size_t i = 0; i < capture.frames.size(); ++i)
    by_file[capture.frames[i].file.lexically_normal().generic_string()].push_back(i);
  for (const auto& [file, frames] : by_file)
    if (frames.size() > 1) {
      const Frame& frame = capture.frames[frames[1]];
      const std::size_t light = frame.kind == FrameKind::kOneLight ? frame.light : kAbsent;
      finder.judge(Rule::kSameFile, {frame.camera, light, file}, static_cast<double>(frames.size()),
                   std::to_string(frames.size()) + " rows of frames.json name it");
    }
  for (std::size_t light = 0; light < lights; ++light) {
    const bool placed = !std::holds_alternative<std::monostate>(capture.lights[light].place);
    if (uses[light] > 0 && !placed)
      finder.report(Rule::kLightWithoutPlace, {kAbsent, light}, 1,
                    std::to_string(uses[light]) + " photos use it; it has neither direction nor position");
    if (uses[light] == 0 && lights > 0 && capture.cameras.size() > 1)
      finder.report(Rule::kUnusedLight, {kAbsent, light}, 1, "no camera has a photo under it");
  }
}

// log2 of the light that a frame takes in, and of what its gain makes of it.
std::optional<double> exposure_ev(const Frame& frame) {
  if (!frame.exposure_s && !frame.iso && !frame.f_number) return {};
  const double n = frame.f_number.value_or(1);
  return std::log2(frame.exposure_s.value_or(1) * frame.iso.value_or(100) / 100 / (n * n) * frame.gain);
}

void check_exposures(const Capture& capture, const Finder& finder) {
  for (std::size_t camera = 0; camera < capture.cameras.size(); ++camera) {
    std::vector<double> all;
    for (const Frame& frame : capture.frames)
      if (frame.camera == camera && frame.kind == FrameKind::kOneLight)
        if (const auto ev = exposure_ev(frame)) all.push_back(*ev);
    if (all.empty()) continue;
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    for (const Frame& frame : capture.frames) {
      if (frame.camera != camera || frame.kind != FrameKind::kOneLight) continue;
      const auto ev = exposure_ev(frame);
      if (!ev) continue;
      const double off = *ev - *middle;
      finder.judge(Rule::kExposureGain, {camera, frame.light, frame.file.string()}, std::abs(off),
                   "exposure times gain is " + number(off) + " stops off the camera's median");
    }
  }
}

}  // namespace

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::string some_of(const std::vector<std::string>& ids) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(ids.size(), kShown); ++i) text += (i == 0 ? "" : ", ") + ids[i];
  return ids.size() > kShown ? text + " and " + std::to_string(ids.size() - kShown) + " more" : text;
}

void check_lists(const Capture& capture, const Finder& finder) {
  check_pairs(capture, finder);
  check_exposures(capture, finder);
}

}  // namespace likeness::olat_check
