#include "olat/photograph/chart_greys.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "brdf/lighting/zone.h"
#include "olat/calibrate/find_chart.h"
#include "olat/calibrate/perspective.h"
#include "render/exposure/overlay.h"
#include "render/exposure/text.h"
#include "render/files/files.h"

namespace likeness::olat_photograph {
namespace {

using olat_calibrate::kFirstGrey;
using olat_calibrate::kPatchColumns;
using olat_calibrate::kPatchRows;

double luminance_of(const std::array<double, 3>& rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

// Y of CIELAB, 1 for L* = 100.
double y_of(const image::Lab& lab) {
  const double f = (lab.l + 16) / 116;
  constexpr double kDelta = 6.0 / 29;
  return f > kDelta ? f * f * f : 3 * kDelta * kDelta * (f - 4.0 / 29);
}

double zone_of(double exposed) { return brdf::Zones::kGreyZone + std::log2(exposed / 0.18); }

std::string corner_text(const olat_calibrate::Corners& corners) {
  std::string out;
  for (const auto& [x, y] : corners)
    out +=
        " --corner " + files::number_text(std::round(10 * x) / 10) + "," + files::number_text(std::round(10 * y) / 10);
  return out;
}

// The zone that most pixels of a patch's middle are shown in.
void count_zones(const image::Picture& photo, const olat_calibrate::Corners& corners, std::size_t patch, double ev,
                 Grey& grey) {
  const std::array<olat_calibrate::Point, 4> cells{
      {{0, 0}, {kPatchColumns, 0}, {kPatchColumns, kPatchRows}, {0, kPatchRows}}};
  const auto seen = olat_calibrate::perspective_of(cells, corners);
  std::array<int, 17> counts{};
  constexpr int kSteps = 24;
  constexpr double kMiddle = 0.4;  // as patches_of
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const double x = static_cast<double>(patch % kPatchColumns) + 0.5 + kMiddle * ((i + 0.5) / kSteps - 0.5);
      const double y = static_cast<double>(patch / kPatchColumns) + 0.5 + kMiddle * ((j + 0.5) / kSteps - 0.5);
      const auto [u, v] = seen(x, y);
      const auto rgb = photo.at(std::clamp(static_cast<int>(u), 0, photo.width - 1),
                                std::clamp(static_cast<int>(v), 0, photo.height - 1));
      const double light = luminance_of({rgb[0], rgb[1], rgb[2]}) * std::exp2(ev);
      ++counts[static_cast<std::size_t>(exposure::zone_at(static_cast<float>(light)))];
    }
  const auto most = std::ranges::max_element(counts);
  grey.shown_zone = static_cast<int>(most - counts.begin());
  grey.shown_share = static_cast<double>(*most) / (kSteps * kSteps);
}

}  // namespace

olat_calibrate::Corners corners_of_texts(const std::vector<std::string>& texts) {
  if (texts.size() != 4)
    throw files::UsageError("a chart has four --corner x,y (of patch 1, 6, 24 and 19); without any it is looked for");
  olat_calibrate::Corners out{};
  for (std::size_t i = 0; i < 4; ++i) {
    int used = 0;
    if (std::sscanf(texts[i].c_str(), "%lf,%lf%n", &out[i][0], &out[i][1], &used) != 2 ||
        used != static_cast<int>(texts[i].size()) || !std::isfinite(out[i][0] + out[i][1]))
      throw files::UsageError("--corner " + files::in_quotes(texts[i]) + " is no x,y in pixels");
  }
  return out;
}

std::array<double, 3> gains_of_greys(const image::Picture& camera, const olat_calibrate::Corners& corners) {
  const auto patches = olat_calibrate::patches_of(camera, corners);
  std::array<double, 3> sum{}, gains{};
  for (std::size_t i = kFirstGrey + 1; i + 1 < olat_calibrate::kPatches; ++i)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += patches[i][c];
  if (!(std::ranges::min(sum) > 0))
    throw files::UsageError("the grey patches are black; are these the chart's corners?");
  for (std::size_t c = 0; c < 3; ++c) gains[c] = std::ranges::max(sum) / sum[c];
  return gains;
}

ChartReading read_chart(const image::Picture& photo, const std::vector<std::string>& corners,
                        const olat_calibrate::Reference& reference) {
  ChartReading out;
  out.seen = olat_calibrate::kPatches;
  if (!corners.empty()) {
    out.corners = corners_of_texts(corners);
  } else {
    const auto found = olat_calibrate::find_charts(photo, reference);
    if (found.empty())
      throw files::UsageError("no chart of 24 patches was found; say where it is by four --corner x,y");
    if (found.size() > 1)
      throw files::UsageError("there are " + std::to_string(found.size()) + " charts; say which:" +
                              corner_text(found[0].corners) + ", or" + corner_text(found[1].corners));
    out.corners = found[0].corners;
    out.seen = found[0].patches;
  }
  const auto patches = olat_calibrate::patches_of(photo, out.corners);
  for (std::size_t i = 0; i < kGreys; ++i) {
    Grey& grey = out.greys[i];
    grey.luminance = luminance_of(patches[kFirstGrey + i]);
    grey.reference = y_of(reference.lab[kFirstGrey + i]);
    if (!(grey.luminance > 0 && grey.reference > 0))
      throw files::UsageError("grey patch " + std::to_string(kFirstGrey + i + 1) +
                              " is black; are these the chart's corners?");
    grey.stops = std::log2(grey.luminance / out.greys[0].luminance);
    grey.reference_stops = std::log2(grey.reference / out.greys[0].reference);
    grey.error = grey.stops - grey.reference_stops;
    grey.is_within = std::abs(grey.error) <= kGreyLimits[i];
  }
  out.ev = std::log2(out.greys[0].reference / out.greys[0].luminance);
  for (std::size_t i = 0; i < kGreys; ++i) {
    Grey& grey = out.greys[i];
    grey.zone = zone_of(grey.luminance * std::exp2(out.ev));
    grey.expected_zone = zone_of(grey.reference);
    count_zones(photo, out.corners, kFirstGrey + i, out.ev, grey);
  }
  out.colors = olat_calibrate::fit_chart(patches, reference);
  return out;
}

std::string text_of_greys(const ChartReading& reading) {
  std::string out =
      "chart at" + corner_text(reading.corners) + " (" + std::to_string(reading.seen) +
      " of 24 patches seen)\n"
      "patch   Y of reference   stops below white   of reference   error   limit   zone        reference   shown as\n";
  std::array<char, 200> line{};
  for (std::size_t i = 0; i < kGreys; ++i) {
    const Grey& g = reading.greys[i];
    std::snprintf(line.data(), line.size(),
                  "%5zu   %14.4f   %17.3f   %12.3f   %+5.3f   %5.2f   %4.2f   %13.2f   %s (%.0f %%)%s\n",
                  kFirstGrey + i + 1, g.reference, 0.0 - g.stops, 0.0 - g.reference_stops, g.error, kGreyLimits[i],
                  g.zone, g.expected_zone, std::string(exposure::zone_numeral(g.shown_zone)).c_str(),
                  100 * g.shown_share, g.is_within ? "" : "   beyond the limit");
    out += line.data();
  }
  std::snprintf(line.data(), line.size(), "EV %+.2f puts the white patch at its reference\n", reading.ev);
  out += line.data();
  std::snprintf(line.data(), line.size(),
                "Delta E 2000, mean: %.1f as it is, %.1f white balanced, %.1f by the best matrix\n",
                reading.colors.stages[0].mean, reading.colors.stages[1].mean, reading.colors.stages[2].mean);
  return out + line.data();
}

}  // namespace likeness::olat_photograph
