#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "olat/photograph/hdr.h"
#include "render/files/files.h"
#include "render/image/write.h"
#include "render/page/html.h"
#include "render/page/line_plot.h"
#include "render/page/svg.h"
#include "render/view/view.h"

namespace likeness::olat_photograph {
namespace {

using photograph::FrameReport;
using photograph::Merged;

constexpr int kLargestSide = 900;
constexpr std::array<const char*, 3> kChannelNames{"red", "green", "blue"}, kInks{"#b3261e", "#2e7d32", "#0b5394"};

// Every n-th pixel, so that no side is larger than kLargestSide.
template <class Color>
image::DisplayPicture thinned(int width, int height, const Color& color_at) {
  const int step = std::max(1, (std::max(width, height) + kLargestSide - 1) / kLargestSide);
  image::DisplayPicture out(std::max(1, width / step), std::max(1, height / step));
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto i =
          static_cast<std::size_t>(y * step) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x * step);
      const std::array<std::uint8_t, 3> color = color_at(i);
      std::ranges::copy(color, out.at(x, y).begin());
    }
  return out;
}

std::string figure_of(const image::DisplayPicture& picture, const std::string& text) {
  return "<figure><img src=\"" + page::png_data_url(image::png_bytes(picture)) + "\" width=\"" +
         std::to_string(picture.width) + "\" height=\"" + std::to_string(picture.height) +
         "\" style=\"max-width:100%;height:auto\" alt=\"" + page::escape(text) + "\"><figcaption>" +
         page::escape(text) + "</figcaption></figure>\n";
}

image::DisplayPicture shown(const Merged& merged, double ev) {
  scene::View view;
  view.ev = ev;
  const image::DisplayPicture all = view::show(merged.light, view);
  return thinned(all.width, all.height, [&](std::size_t i) {
    return std::array<std::uint8_t, 3>{all.rgb[3 * i], all.rgb[3 * i + 1], all.rgb[3 * i + 2]};
  });
}

// Grey for confidence; where there is none, what is known instead.
image::DisplayPicture confidence_picture(const Merged& m) {
  return thinned(m.light.width, m.light.height, [&](std::size_t i) -> std::array<std::uint8_t, 3> {
    if (m.bound[i] == photograph::Bound::kLower) return {230, 97, 1};
    if (m.bound[i] == photograph::Bound::kUpper) return {94, 60, 153};
    if (m.frames[i] == 0 && m.confidence[i] <= 0) return {0, 0, 0};
    const auto grey = static_cast<std::uint8_t>(std::lround(60 + 195 * std::clamp(m.confidence[i], 0.0f, 1.0f)));
    return {grey, grey, grey};
  });
}

image::DisplayPicture ghost_picture(const Merged& m, const image::DisplayPicture& lit) {
  image::DisplayPicture out = lit;
  const image::DisplayPicture marks =
      thinned(m.light.width, m.light.height,
              [&](std::size_t i) -> std::array<std::uint8_t, 3> { return {m.ghost[i], m.ghost[i], m.ghost[i]}; });
  for (std::size_t i = 0; i < out.rgb.size(); i += 3) {
    const auto grey = static_cast<std::uint8_t>((out.rgb[i] + 2 * out.rgb[i + 1] + out.rgb[i + 2]) / 8);
    const bool marked = marks.rgb[i] != 0;
    out.rgb[i] = marked ? 255 : grey;
    out.rgb[i + 1] = marked ? static_cast<std::uint8_t>(marks.rgb[i] == 2 ? 200 : 60) : grey;
    out.rgb[i + 2] = marked ? 60 : grey;
  }
  return out;
}

std::string response_plot(const photograph::Response& response) {
  page::LinePlot plot;
  plot.title = "Response: stops of exposure against code, for red, green and blue";
  double low = 0, high = 0;
  constexpr std::array<const char*, 3> kDashes{"", "7 3", "2 3"};
  for (std::size_t c = 0; c < 3; ++c) {
    page::PlotLine line;
    line.name = kChannelNames[c];
    line.color = kInks[c];
    line.dash = kDashes[c];
    for (std::size_t k = 0; k < photograph::kCodes; ++k) {
      const double v = response.log2_exposure[c][k];
      line.points.push_back({static_cast<double>(k), v});
      low = std::min(low, v), high = std::max(high, v);
    }
    plot.lines.push_back(std::move(line));
  }
  plot.across = {"code", 0, 255};
  plot.up = {"log2 exposure", std::floor(low), std::ceil(high + 0.01)};
  return page::drawing_of(plot);
}

// Bars of the three channels in one, of square roots, so that small counts show.
std::string histogram_of(const FrameReport& report) {
  std::uint64_t most = 1;
  for (const auto& channel : report.histogram) most = std::max(most, *std::max_element(channel.begin(), channel.end()));
  std::string out;
  for (std::size_t c = 0; c < 3; ++c) {
    std::string points;
    for (std::size_t b = 0; b < 64; ++b)
      points += page::number(2.0 * static_cast<double>(b) + 1, 4) + "," +
                page::number(
                    30 - 29 * std::sqrt(static_cast<double>(report.histogram[c][b]) / static_cast<double>(most)), 4) +
                " ";
    out += "<polyline fill=\"none\" stroke=\"" + std::string(kInks[c]) + "\" points=\"" + points + "\"/>";
  }
  return page::drawing("0 0 128 31", "histogram of codes",
                       out + page::svg_line(0, 30.5, 128, 30.5, "stroke=\"#777\" stroke-width=\"0.5\""));
}

std::string td(const std::string& text, bool is_warning = false) {
  return "<td class=\"n" + std::string(is_warning ? " warn" : "") + "\">" + page::escape(text) + "</td>";
}

std::string frames_table(const Merged& m) {
  std::string out =
      "<div class=\"scroll\"><table><thead><tr><th>frame</th><th>exposure, s</th><th style=\"min-width:150px\">codes, "
      "0 to "
      "255</th><th>well exposed</th><th>clipped</th><th>black</th><th>error of exposure, stops</th><th>shift, "
      "pixels</th></tr>"
      "</thead><tbody>\n";
  for (std::size_t k = 0; k < m.reports.size(); ++k) {
    const FrameReport& r = m.reports[k];
    const double error = m.judgement.errors[k];
    const bool is_shifted =
        r.shift && std::isfinite(r.shift->sigma) &&
        std::hypot(r.shift->dx, r.shift->dy) > std::max(photograph::kShiftWarning, 3 * r.shift->sigma);
    out +=
        "<tr><th>" + page::escape(r.bracket.file.filename().string()) +
        (k == m.reference ? " <span class=\"badge\">reference</span>" : "") + "</th>" +
        td(page::number(r.exposure, 4)) + "<td>" + histogram_of(r) + "</td>" +
        td(page::fixed(100 * r.well_exposed, 1) + " %") + td(page::fixed(100 * r.clipped, 1) + " %") +
        td(page::fixed(100 * r.black, 1) + " %") +
        td(page::fixed(error, 3), std::abs(error) > photograph::kTimeWarning) +
        td(r.shift && std::isfinite(r.shift->sigma) ? page::fixed(r.shift->dx, 2) + ", " + page::fixed(r.shift->dy, 2)
                                                    : "-",
           is_shifted) +
        "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string page_of(const Merged& m) {
  const double ev = sensible_ev(m);
  const image::DisplayPicture lit = shown(m, ev);
  const std::string count = std::to_string(m.reports.size());
  std::string out = page::page_head("Merged from " + count + " frames");
  out += page::element("h1", "Merged from " + count + " frames");
  const double all = static_cast<double>(m.confidence.size());
  out += "<p class=\"verdict\">" + std::to_string(m.light.width) + " x " + std::to_string(m.light.height) +
         " pixels. " + page::fixed(100 * static_cast<double>(m.clipped_in_all) / all, 2) +
         " % are clipped in every frame, " + page::fixed(100 * static_cast<double>(m.black_in_all) / all, 2) +
         " % black in every frame, " + page::fixed(100 * static_cast<double>(m.ghosts) / all, 2) + " % ghosts.</p>\n";
  for (const std::string& warning : m.warnings) out += "<p class=\"note\">" + page::escape(warning) + "</p>\n";
  out += "<div class=\"plots\">\n";
  out += figure_of(lit, "The merged picture at EV " + page::fixed(ev, 2) +
                            " through the tone curve gt: its brightest tenth begins at 0.5.");
  out += figure_of(
      confidence_picture(m),
      "Confidence, white: some frame shows every channel in the middle of its codes; dark grey: only near their ends. "
      "Orange: clipped in every frame, light is that or more. Violet: black in every frame, that or less. Black: no "
      "frame shows it.");
  out += figure_of(ghost_picture(m, lit),
                   "Ghosts, red: frames disagree beyond noise; yellow: the reference frame's light was taken.");
  out += "</div>\n" + page::element("h2", "Response");
  out += "<p>What exposure (light times time) made each code: " + page::escape(m.response.name) + ".";
  if (m.recovered) {
    out += " From " + std::to_string(m.recovered->used) + " pixels; it leaves ";
    for (std::size_t c = 0; c < 3; ++c) out += (c > 0 ? ", " : "") + page::fixed(m.recovered->rms_stops[c], 3);
    out += " stops of red, green and blue unexplained.";
  }
  out += "</p>\n<figure style=\"max-width:640px\">" + response_plot(m.response) + "</figure>\n" +
         page::element("h2", "Frames");
  out +=
      "<p>Shortest exposure first. Error: how much more light a frame shows than its stated exposure says, judged by "
      "its "
      "neighbors; brown beyond 0.1 stop. Shift: against the frame above; brown beyond half a pixel.</p>\n";
  out += frames_table(m);
  return out + page::page_foot();
}

}  // namespace likeness::olat_photograph
