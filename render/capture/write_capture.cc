#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "render/capture/files_of_capture.h"
#include "render/capture/format.h"
#include "render/files/files.h"

namespace likeness::capture {
namespace {

using Json = nlohmann::ordered_json;

Json begin_of(std::string_view type) { return {{"type", type}, {"version", kFormatVersion}}; }

Json list_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// One row a line, so that a person can read the list and git can compare it.
std::string with_rows(Json head, const std::vector<std::pair<std::string, std::vector<Json>>>& lists) {
  std::string out = head.dump(1);
  out.resize(out.size() - 2);  // the last bracket and the line's end before it
  for (const auto& [name, rows] : lists) {
    out += ",\n \"" + name + "\": [";
    for (std::size_t i = 0; i < rows.size(); ++i) out += (i ? ",\n  " : "\n  ") + rows[i].dump();
    out += rows.empty() ? "]" : "\n ]";
  }
  return out + "\n}\n";
}

std::string whole_text(const Capture& capture) {
  Json out = begin_of(kCaptureType);
  if (!capture.name.empty()) out["name"] = capture.name;
  out["units"] = "m";
  out["axes"] = "opencv";
  out["up"] = list_of(capture.up);
  out["working_space"] = "lin_rec709_scene";
  Json variants = Json::array();
  for (const Variant& one : capture.variants) variants.push_back({{"id", one.id}, {"pattern", one.pattern}});
  out["variants"] = variants;
  out["pipeline"] = {
      {"match_gain", capture.pipeline.match_gain}, {"ev", capture.pipeline.ev}, {"view", capture.pipeline.view}};
  out["flip"] = {{"first_ev", capture.flip_first_ev}, {"last_ev", capture.flip_last_ev}};
  if (!capture.license.empty()) out["license"] = capture.license;
  if (!capture.citation.empty()) out["citation"] = capture.citation;
  if (!capture.source.empty()) out["source"] = capture.source;
  return out.dump(1) + "\n";
}

// Numbers of the lens: none if it is straight, five where version 1 has room for them, or all.
std::vector<double> terms_of(const Camera& camera) {
  std::size_t count = kLensTerms[static_cast<std::size_t>(camera.lens)];
  const auto first = camera.distortion.begin(), last = first + static_cast<std::ptrdiff_t>(count);
  if (std::all_of(first, last, [](double term) { return term == 0; })) return {};
  if (std::all_of(first + std::min<std::ptrdiff_t>(last - first, 5), last, [](double term) { return term == 0; }))
    count = std::min<std::size_t>(count, 5);
  return {first, first + static_cast<std::ptrdiff_t>(count)};
}

bool needs_version_2(const Camera& camera) { return camera.lens != Lens::kBrownConrady || terms_of(camera).size() > 5; }

Json row_of(const Camera& camera) {
  Json row{{"id", camera.id}};
  if (!camera.label.empty()) row["label"] = camera.label;
  row["width"] = camera.width;
  row["height"] = camera.height;
  if (camera.is_orthographic) row["orthographic"] = true;
  const glm::dmat3& k = camera.intrinsics;
  row["focal_px"] = {k[0][0], k[1][1]};
  row["center_px"] = {k[2][0], k[2][1]};
  if (k[1][0] != 0) row["skew"] = k[1][0];
  if (camera.lens != Lens::kBrownConrady) row["lens"] = kLenses[static_cast<std::size_t>(camera.lens)];
  if (const auto terms = terms_of(camera); !terms.empty()) row["distortion"] = terms;
  if (!camera.is_undistorted) row["undistorted"] = false;
  Json rows = Json::array();
  for (int r = 0; r < 4; ++r) {
    Json line = Json::array();
    for (int c = 0; c < 4; ++c) line.push_back(camera.world_from_camera[c][r]);
    rows.push_back(line);
  }
  row["world_from_camera"] = rows;
  if (camera.rec709_from_camera != glm::dmat3(1)) {
    Json m = Json::array();
    for (int i = 0; i < 9; ++i) m.push_back(camera.rec709_from_camera[i % 3][i / 3]);
    row["rec709_from_camera"] = m;
  }
  return row;
}

std::string cameras_text(const Capture& capture) {
  std::vector<Json> rows;
  for (const Camera& camera : capture.cameras) rows.push_back(row_of(camera));
  for (std::size_t i = 0; i < rows.size() && i < capture.noise_floor.size(); ++i)
    rows[i]["noise_floor"] = list_of(capture.noise_floor[i]);
  for (const LayerFile& one : capture.layers)
    if (one.camera < rows.size())
      rows[one.camera]["layers"][std::string(kLayers[static_cast<std::size_t>(one.layer)])] = one.file.string();
  Json head = begin_of(kCamerasType);
  if (std::any_of(capture.cameras.begin(), capture.cameras.end(), needs_version_2)) head["version"] = kCamerasVersion;
  return with_rows(std::move(head), {{"cameras", rows}});
}

std::string lights_text(const Capture& capture) {
  std::vector<Json> rows;
  for (const Light& light : capture.lights) {
    Json row{{"id", light.id}};
    if (!light.label.empty()) row["label"] = light.label;
    if (const auto* distant = std::get_if<DistantLight>(&light.place)) row["direction"] = list_of(distant->to_light);
    if (const auto* near = std::get_if<NearLight>(&light.place)) row["position"] = list_of(near->position);
    if (light.intensity != glm::dvec3(1)) row["intensity"] = list_of(light.intensity);
    if (!light.calibrated_by.empty()) row["calibrated_by"] = light.calibrated_by;
    rows.push_back(std::move(row));
  }
  return with_rows(begin_of(kLightsType), {{"lights", rows}});
}

Json encoding_of(const Frame& frame) {
  Json out{{"transfer", kTransfers[static_cast<std::size_t>(frame.transfer)]},
           {"primaries", kPrimaries[static_cast<std::size_t>(frame.primaries)]},
           {"black", frame.black},
           {"white", frame.white}};
  if (frame.clip == std::numeric_limits<double>::infinity()) out["never_clips"] = true;
  else out["clip"] = frame.clip;
  out["gain"] = frame.gain;
  return out;
}

// All frames are written with the first one's encoding where they have it; a row says what it has otherwise.
std::string frames_text(const Capture& capture) {
  Json head = begin_of(kFramesType);
  Json defaults = Json::object();
  if (!capture.frames.empty()) {
    defaults = encoding_of(capture.frames[0]);
    for (const Frame& frame : capture.frames)
      if (std::isinf(frame.clip)) defaults.erase("never_clips");  // a row could not take it back
    head["defaults"] = defaults;
  }
  std::vector<Json> rows;
  for (const Frame& frame : capture.frames) {
    const bool has_light = frame.light < capture.lights.size();
    if (frame.camera >= capture.cameras.size() || (is_of_one_light(frame.kind) && !has_light))
      throw std::invalid_argument("a frame's camera or light is not in the lists of the capture");
    Json row{{"camera", capture.cameras[frame.camera].id}};
    if (has_light && (is_of_one_light(frame.kind) || frame.kind == FrameKind::kGradient))
      row["light"] = capture.lights[frame.light].id;
    if (frame.kind != FrameKind::kOneLight) row["kind"] = kFrameKinds[static_cast<std::size_t>(frame.kind)];
    row["file"] = frame.file.string();
    const Json encoding = encoding_of(frame);
    for (const auto& [key, value] : encoding.items())
      if (const auto at = defaults.find(key); at == defaults.end() || *at != value) row[key] = value;
    if (frame.exposure_s) row["exposure_s"] = *frame.exposure_s;
    if (frame.iso) row["iso"] = *frame.iso;
    if (frame.f_number) row["f_number"] = *frame.f_number;
    if (!frame.sha256.empty()) row["sha256"] = frame.sha256;
    rows.push_back(std::move(row));
  }
  return with_rows(std::move(head), {{"frames", rows}});
}

}  // namespace

CaptureTexts texts_of(const Capture& capture) {
  return {whole_text(capture), cameras_text(capture), lights_text(capture), frames_text(capture)};
}

void write_capture(const Capture& capture) {
  CaptureTexts texts;
  try {
    texts = texts_of(capture);
    capture_of(texts, capture.root);
  } catch (const files::InputError& error) {
    throw std::invalid_argument(std::string("a capture that could not be read again: ") + error.what());
  } catch (const nlohmann::json::exception& error) {  // text that is not UTF-8
    throw std::invalid_argument(std::string("a capture that is no JSON: ") + error.what());
  }
  files::write_whole(capture.root / kCamerasFile, texts.cameras);
  files::write_whole(capture.root / kLightsFile, texts.lights);
  files::write_whole(capture.root / kFramesFile, texts.frames);
  files::write_whole(capture.root / kCaptureFile, texts.capture);
}

}  // namespace likeness::capture
