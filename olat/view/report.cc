#include "olat/view/report.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>

#include "olat/metric/metric.h"
#include "olat/pair/exposure.h"
#include "olat/pair/picture.h"
#include "olat/pair/tables.h"
#include "olat/view/answers.h"
#include "olat/view/half_picture.h"
#include "olat/view/page.h"
#include "olat/view/report_pair.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/page/html.h"
#include "render/view/view.h"

namespace likeness::olat_view {

extern const std::string_view k_index_html, k_report_html, k_viewer_css, k_viewer_js, k_view_glsl;

namespace {

using Json = nlohmann::ordered_json;
using olat_pair::Pair;
using olat_pair::State;

struct Compared {
  std::size_t camera = 0, light = 0;
  metric::Summary summary;
  int x = 0, y = 0;  // of the largest error
};

// High bytes of all halves, then low ones, deflated: neighbours are alike. Every `step`-th number is taken.
std::string packed(const HalfPicture& picture, std::size_t step = 1) {
  const std::size_t count = picture.rgba.size() / step;
  std::string planes(2 * count, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    planes[i] = static_cast<char>(picture.rgba[step * i] >> 8);
    planes[count + i] = static_cast<char>(picture.rgba[step * i] & 255);
  }
  uLongf size = compressBound(planes.size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(planes.data()),
                planes.size(), 9) != Z_OK)
    throw std::runtime_error("report: zlib failed");
  out.resize(size);
  return page::base64(out);
}

Compared compare(const State& state, const Pair& pair) {
  image::Picture render = pair.render;
  std::vector<float> weight(pair.flaws.size());
  for (std::size_t i = 0; i < weight.size(); ++i)
    weight[i] = (pair.flaws[i] & ~unsigned{capture::kBlack}) == 0 ? 1.0f : 0.0f;
  metric::Pair both{.photo = &pair.photo, .render = &render};
  both.weight = weight;
  both.noise_floor = {pair.noise, pair.noise, pair.noise};
  both.exposures = {pair.flip_exposures[0], pair.flip_exposures[1]};
  const metric::Map map = metric::map_of(metric::metric_of(state.metric), both);
  Compared out;
  out.summary = metric::summary_of(map, weight);
  float largest = -1;
  for (std::size_t i = 0; i < weight.size(); ++i)
    for (int c = 0; c < map.channels; ++c) {
      const float v = std::abs(map.values[i * static_cast<std::size_t>(map.channels) + static_cast<std::size_t>(c)]);
      if (weight[i] > 0 && v > largest) {
        largest = v;
        out.x = static_cast<int>(i) % map.width;
        out.y = static_cast<int>(i) / map.width;
      }
    }
  return out;
}

std::string replaced(std::string text, std::string_view mark, std::string_view with) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) throw std::runtime_error("report: the page has no " + std::string(mark));
  return text.replace(at, mark.size(), with);
}

// "1 camera", "3 cameras".
std::string counted(std::size_t count, std::string_view what) {
  return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

std::string signed_stops(double stops) {
  const std::string digits = page::fixed(std::abs(stops), 2);
  return (stops >= 0 || digits == "0.00" ? "+" : "−") + digits;
}

Json exposures_json(const Pair& pair) {
  Json out = Json::object();
  if (const auto found = olat_pair::exposures_of(pair.photo, pair.flaws, static_cast<double>(pair.noise)))
    out = {{"percentile", found->percentile}, {"average", found->average}};
  return out;
}

// In a script element nothing may look like its end.
std::string in_script(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) text.replace(at, 2, "<\\/");
  return text;
}

std::string viewer_markup() {
  const std::string_view from = "<!--viewer-->", to = "<!--/viewer-->";
  const std::size_t begin = k_index_html.find(from) + from.size();
  return std::string(k_index_html.substr(begin, k_index_html.find(to) - begin));
}

}  // namespace

ReportSummary write_report(const capture::Capture& capture, const ReportOptions& options,
                           const std::filesystem::path& out) {
  State state;
  state.variant = options.variant;
  state.metric = options.metric;
  const auto metric = metric::metric_of(options.metric);
  if (metric::row_of(metric).of == metric::Of::kDisplay)
    throw files::UsageError("--metric " + options.metric +
                            " depends on the display; a report ranks by a metric of light");
  const olat_pair::Place first = olat_pair::place_of(capture, state);
  if (first.variant == capture::kAbsent)
    throw files::InputError(capture.root.string() +
                            ": the capture has no renders to compare with (likeness olat render)");
  const auto state_at = [&](std::size_t camera, std::size_t light) {
    State at = state;
    at.camera = capture.cameras[camera].id;
    at.light = capture.lights[light].id;
    return at;
  };

  const capture::FrameTable frames(capture);
  std::vector<Compared> compared;
  files::Progress progress;
  const std::size_t lights = capture.lights.size(), all = capture.cameras.size() * lights;
  Json rows = Json::array();
  for (std::size_t camera = 0; camera < capture.cameras.size(); ++camera) {
    Json row = Json::array();
    for (std::size_t light = 0; light < lights; ++light) {
      if (files::interrupted()) throw files::Interrupted{};
      progress.tell("comparing", static_cast<double>(camera * lights + light) / static_cast<double>(all));
      Json value = nullptr;
      if (frames.frame(camera, light) != capture::kAbsent) {
        const Pair pair = olat_pair::load_pair(capture, state_at(camera, light));
        if (pair.photo.width > 0 && pair.render.width > 0) {
          Compared one = compare(state, pair);
          one.camera = camera;
          one.light = light;
          if (one.summary.pixels > 0) {
            value = std::round(one.summary.p95 * 1e4) / 1e4;
            compared.push_back(one);
          }
        }
      }
      row.push_back(value);
    }
    rows.push_back(row);
  }
  if (compared.empty())
    throw files::InputError(capture.root.string() +
                            ": no pair has a photo and a render of the same size with unmasked pixels");
  std::stable_sort(compared.begin(), compared.end(),
                   [](const Compared& a, const Compared& b) { return a.summary.p95 > b.summary.p95; });

  Answers answers(capture, {.cache_bytes = 1, .with_scores = false});
  Json data;
  data["capture"] = Json::parse(answers.answer("/api/capture", {}).body);
  data["capture"].erase("root");  // a path of this machine says nothing elsewhere
  data["tables"] = Json::parse(olat_pair::tables_json());
  data["shader"] = std::string(k_view_glsl);
  data["scores"] = {
      {{"metric", options.metric}, {"statistic", "p95"}, {"known", compared.size()}, {"all", all}, {"rows", rows}}};
  data["capture"]["variant"] = capture.variants[first.variant].id;
  for (Json& photos : data["capture"]["photos"]) photos = std::string(lights, '0');

  // How the page opens: as the capture says, or with an exposure for the worst photo.
  const Pair worst = olat_pair::load_pair(capture, state_at(compared[0].camera, compared[0].light));
  state.ev = capture.pipeline.ev;
  if (std::find(view::kOwnViews.begin(), view::kOwnViews.end(), capture.pipeline.view) != view::kOwnViews.end())
    state.view = capture.pipeline.view;
  if (const auto found = olat_pair::exposures_of(worst.photo, worst.flaws, static_cast<double>(worst.noise));
      state.ev == 0 && found) {
    state.ev = found->percentile;
    data["capture"]["pipeline"]["by"] = "percentile";
  }
  data["capture"]["pipeline"]["ev"] = state.ev;
  State matched = state_at(compared[0].camera, compared[0].light);
  matched.match = olat_pair::Match::kCapture;
  const std::array<double, 3> capture_gain = olat_pair::gain_of(capture, matched, worst);

  std::string cards;
  std::string table =
      "<div "
      "class=\"wide\"><table><tr><th>camera</th><th>light</th><th>p95</th><th>median</th><th>mean</th><th>pixels</th></"
      "tr>";
  const std::size_t held = std::min(compared.size(), static_cast<std::size_t>(options.pairs));
  for (std::size_t k = 0; k < held; ++k) {
    const Compared& one = compared[k];
    const State at = state_at(one.camera, one.light);
    const Pair pair = olat_pair::load_pair(capture, at);
    Crop crop{0, 0, std::min(pair.width(), options.side), std::min(pair.height(), options.side)};
    crop.x = std::clamp(one.x - crop.width / 2, 0, pair.width() - crop.width);
    crop.y = std::clamp(one.y - crop.height / 2, 0, pair.height() - crop.height);
    Json flips;
    for (const char* id : {"hdr_flip", "flip"}) {
      State shown = at;
      shown.metric = id;
      const std::vector<float> map = flip_inside(shown, pair, crop);
      flips[id] = {{"state", olat_pair::text_of(shown)}, {"map", packed(half_of_map(crop.width, crop.height, map), 4)}};
      if (id == std::string_view("flip")) cards += pair_card(at, pair, crop, map, one.summary);
    }
    const auto gain = olat_pair::match_gain(pair, false), gains = olat_pair::match_gain(pair, true);
    Json frame = Json::parse(answers.answer("/api/frame", {{"state", olat_pair::text_of(at)}}).body);
    // As for the root: of a path of this machine the name is left.
    if (const std::filesystem::path photo(frame.value("photo", "")); photo.is_absolute())
      frame["photo"] = photo.filename().string();
    data["pairs"].push_back(
        {{"camera", at.camera},
         {"light", at.light},
         {"width", crop.width},
         {"height", crop.height},
         {"noise", pair.noise},
         {"gains", {{"none", {1, 1, 1}}, {"capture", capture_gain}, {"light", gain}, {"channel", gains}}},
         {"exposures", exposures_json(pair)},
         {"frame", frame},
         {"crop", {crop.x, crop.y}},
         {"flips", flips},
         {"photo", packed(cropped(half_of(pair.photo, pair.flaws), crop))},
         {"render", packed(cropped(half_of(pair.render, {}), crop))}});
    std::string photos = data["capture"]["photos"][one.camera];
    photos[one.light] = '1';
    data["capture"]["photos"][one.camera] = photos;
    data["capture"]["cameras"][one.camera]["width"] = crop.width;
    data["capture"]["cameras"][one.camera]["height"] = crop.height;
    const auto cell = [](double v) { return page::element("td", page::number(v)); };
    table += "<tr>" + page::element("td", at.camera) + page::element("td", at.light) + cell(one.summary.p95) +
             cell(one.summary.median) + cell(one.summary.mean) +
             page::element("td", std::to_string(one.summary.pixels)) + "</tr>";
  }
  table += "</table></div>";

  const std::string title = (capture.name.empty() ? "Capture" : capture.name) + ": photographs against renders";
  std::string intro = page::element("h1", title);
  intro += "<p>" +
           page::escape(counted(compared.size(), "pair") + " of " + counted(capture.cameras.size(), "camera") +
                        " and " + counted(lights, "light") + " compared, renders \"" +
                        capture.variants[first.variant].id + "\", by " + options.metric + ": " +
                        std::string(metric::row_of(metric).text) + ". The worst " + std::to_string(held) +
                        " are below, as light, so that exposure and view can still be changed. Space flips, W wipes, D "
                        "subtracts, the arrows go on, ? lists the keys.") +
           "</p>" +
           page::element(
               "p",
               "The renders are compared as they are. One gain for the whole capture would bring them nearest to the "
               "photographs at " +
                   signed_stops(std::log2(capture_gain[1])) +
                   " stops (median of at most 16 pairs). Small pictures and FLIP: EV " + signed_stops(state.ev) +
                   (data["capture"]["pipeline"].contains("by") ? ", found for the worst photo" : "") + ", view " +
                   state.view + ".") +
           table + "<div class=\"pairs\">" + cards + "</div>";
  if (!capture.citation.empty()) intro += page::element("p", "Data: " + capture.citation);
  if (!capture.license.empty()) intro += page::element("p", "License of the data: " + capture.license);

  std::string html(k_report_html);
  html = replaced(std::move(html), "{{title}}", page::escape(title));
  html = replaced(std::move(html), "{{style}}", k_viewer_css);
  html = replaced(std::move(html), "{{intro}}", intro);
  html = replaced(std::move(html), "{{viewer}}", viewer_markup());
  html = replaced(std::move(html), "{{data}}", in_script(data.dump(-1, ' ', false, Json::error_handler_t::replace)));
  html = replaced(std::move(html), "{{script}}", k_viewer_js);
  files::write_whole(out, html);
  return {compared.size(), held, html.size()};
}

}  // namespace likeness::olat_view
