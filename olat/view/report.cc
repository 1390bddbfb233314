#include "olat/view/report.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>

#include "olat/metric/metric.h"
#include "olat/pair/picture.h"
#include "olat/pair/tables.h"
#include "olat/view/answers.h"
#include "olat/view/half_picture.h"
#include "olat/view/page.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/page/html.h"

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

// High bytes of all halves, then low ones, deflated: neighbours are alike.
std::string packed(const HalfPicture& picture) {
  const std::size_t count = picture.rgba.size();
  std::string planes(2 * count, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    planes[i] = static_cast<char>(picture.rgba[i] >> 8);
    planes[count + i] = static_cast<char>(picture.rgba[i] & 255);
  }
  uLongf size = compressBound(planes.size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(planes.data()),
                planes.size(), 9) != Z_OK)
    throw std::runtime_error("report: zlib failed");
  out.resize(size);
  return page::base64(out);
}

HalfPicture cropped(const HalfPicture& from, int x, int y, int width, int height) {
  HalfPicture out{width, height, {}};
  for (int row = y; row < y + height; ++row) {
    const auto at = from.rgba.begin() + 4 * (static_cast<std::ptrdiff_t>(row) * from.width + x);
    out.rgba.insert(out.rgba.end(), at, at + 4 * width);
  }
  return out;
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

  std::string table =
      "<table><tr><th>camera</th><th>light</th><th>p95</th><th>median</th><th>mean</th><th>pixels</th></tr>";
  const std::size_t held = std::min(compared.size(), static_cast<std::size_t>(options.pairs));
  for (std::size_t k = 0; k < held; ++k) {
    const Compared& one = compared[k];
    const State at = state_at(one.camera, one.light);
    const Pair pair = olat_pair::load_pair(capture, at);
    const int width = std::min(pair.width(), options.side), height = std::min(pair.height(), options.side);
    const int x = std::clamp(one.x - width / 2, 0, pair.width() - width),
              y = std::clamp(one.y - height / 2, 0, pair.height() - height);
    const auto gain = olat_pair::match_gain(pair, false), gains = olat_pair::match_gain(pair, true);
    Json frame = Json::parse(answers.answer("/api/frame", {{"state", olat_pair::text_of(at)}}).body);
    // As for the root: of a path of this machine the name is left.
    if (const std::filesystem::path photo(frame.value("photo", "")); photo.is_absolute())
      frame["photo"] = photo.filename().string();
    data["pairs"].push_back({{"camera", at.camera},
                             {"light", at.light},
                             {"width", width},
                             {"height", height},
                             {"noise", pair.noise},
                             {"gains", {{"none", {1, 1, 1}}, {"light", gain}, {"channel", gains}}},
                             {"frame", frame},
                             {"crop", {x, y}},
                             {"photo", packed(cropped(half_of(pair.photo, pair.flaws), x, y, width, height))},
                             {"render", packed(cropped(half_of(pair.render, {}), x, y, width, height))}});
    std::string photos = data["capture"]["photos"][one.camera];
    photos[one.light] = '1';
    data["capture"]["photos"][one.camera] = photos;
    data["capture"]["cameras"][one.camera]["width"] = width;
    data["capture"]["cameras"][one.camera]["height"] = height;
    const auto cell = [](double v) { return page::element("td", page::number(v)); };
    table += "<tr>" + page::element("td", at.camera) + page::element("td", at.light) + cell(one.summary.p95) +
             cell(one.summary.median) + cell(one.summary.mean) +
             page::element("td", std::to_string(one.summary.pixels)) + "</tr>";
  }
  table += "</table>";

  const std::string title = (capture.name.empty() ? "Capture" : capture.name) + ": photographs against renders";
  std::string intro = page::element("h1", title);
  intro += "<p>" +
           page::escape(counted(compared.size(), "pair") + " of " + counted(capture.cameras.size(), "camera") +
                        " and " + counted(lights, "light") + " compared, renders \"" +
                        capture.variants[first.variant].id + "\", by " + options.metric + ": " +
                        std::string(metric::row_of(metric).text) + ". The worst " + std::to_string(held) +
                        " are below, as light, so that exposure and view can still be changed. Space flips, W wipes, D "
                        "subtracts, the arrows go on, ? lists the keys.") +
           "</p>" + table;
  if (!capture.citation.empty() || !capture.license.empty())
    intro +=
        page::element("p", "Data: " + capture.citation + (capture.license.empty() ? "" : " (" + capture.license + ")"));

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
