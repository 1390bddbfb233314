#include "olat/view/report_pair.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "render/image/flip.h"
#include "render/image/write.h"
#include "render/page/html.h"

namespace likeness::olat_view {
namespace {

using olat_pair::Mode;
using olat_pair::Pair;
using olat_pair::State;

Pair cropped(const Pair& from, const Crop& crop) {
  Pair out = from;
  const auto part = [&](const image::Picture& picture) {
    if (picture.width == 0) return picture;
    image::Picture to(crop.width, crop.height);
    for (int y = 0; y < crop.height; ++y)
      for (int x = 0; x < crop.width; ++x)
        for (std::size_t c = 0; c < 3; ++c) to.at(x, y)[c] = picture.at(crop.x + x, crop.y + y)[c];
    return to;
  };
  out.photo = part(from.photo);
  out.render = part(from.render);
  out.flaws.clear();
  for (int y = crop.y; y < crop.y + crop.height; ++y) {
    const auto row = from.flaws.begin() + static_cast<std::ptrdiff_t>(y) * from.width() + crop.x;
    out.flaws.insert(out.flaws.end(), row, row + crop.width);
  }
  return out;
}

// Means over squares of whole pixels, so that the longest side is at most kThumbSide.
image::DisplayPicture smaller(const image::DisplayPicture& from) {
  const int step = std::max(1, (std::max(from.width, from.height) + kThumbSide - 1) / kThumbSide);
  image::DisplayPicture out((from.width + step - 1) / step, (from.height + step - 1) / step);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        int sum = 0, count = 0;
        for (int v = y * step; v < std::min(from.height, (y + 1) * step); ++v)
          for (int u = x * step; u < std::min(from.width, (x + 1) * step); ++u, ++count) sum += from.at(u, v)[c];
        out.at(x, y)[c] = static_cast<std::uint8_t>((sum + count / 2) / count);
      }
  return out;
}

std::string figure(const image::DisplayPicture& picture, const std::string& caption) {
  const image::DisplayPicture small = smaller(picture);
  return "<figure><img width=\"" + std::to_string(small.width) + "\" height=\"" + std::to_string(small.height) +
         "\" alt=\"" + page::escape(caption) + "\" src=\"" + page::png_data_url(image::png_bytes(small)) + "\">" +
         page::element("figcaption", caption) + "</figure>";
}

}  // namespace

HalfPicture cropped(const HalfPicture& from, const Crop& crop) {
  HalfPicture out{crop.width, crop.height, {}};
  for (int row = crop.y; row < crop.y + crop.height; ++row) {
    const auto at = from.rgba.begin() + 4 * (static_cast<std::ptrdiff_t>(row) * from.width + crop.x);
    out.rgba.insert(out.rgba.end(), at, at + 4 * crop.width);
  }
  return out;
}

std::vector<float> flip_inside(const State& state, const Pair& pair, const Crop& crop) {
  constexpr int kReach = 32;  // more than the radius of FLIP's filters at 67 pixels a degree
  const int left = std::max(0, crop.x - kReach), top = std::max(0, crop.y - kReach),
            right = std::min(pair.width(), crop.x + crop.width + kReach),
            bottom = std::min(pair.height(), crop.y + crop.height + kReach);
  const Pair around = cropped(pair, {left, top, right - left, bottom - top});
  const std::vector<float> map = olat_pair::flip_map(state, around);
  std::vector<float> out;
  for (int y = crop.y - top; y < crop.y - top + crop.height; ++y) {
    const auto row = map.begin() + static_cast<std::ptrdiff_t>(y) * around.width() + (crop.x - left);
    out.insert(out.end(), row, row + crop.width);
  }
  return out;
}

std::string pair_card(const State& state, const Pair& pair, const Crop& crop, std::span<const float> flip,
                      const metric::Summary& summary) {
  const Pair part = cropped(pair, crop);
  const auto in_mode = [&](Mode mode) {
    State at = state;
    at.mode = mode;
    return olat_pair::picture_of(at, part);
  };
  const metric::MetricRow& row = metric::row_of(metric::metric_of(state.metric));
  const std::string scale = page::plain(olat_pair::scale_of(state.metric));
  const double mean = std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size());
  State link;
  link.camera = state.camera;
  link.light = state.light;
  const std::string name = state.camera + ", light " + state.light + ": 95 % within " + page::number(summary.p95) +
                           " " + (row.unit == "1" ? state.metric : std::string(row.unit));
  return "<a class=\"pair\" href=\"#" + page::escape(olat_pair::text_of(link)) + "\">" + page::element("b", name) +
         figure(in_mode(Mode::kPhoto), "photo") + figure(in_mode(Mode::kRender), "render") +
         figure(in_mode(Mode::kDifference), state.metric + (row.is_signed ? ", ±" : ", 0 to ") + scale) +
         figure(image::error_picture({crop.width, crop.height, std::vector<float>(flip.begin(), flip.end()), 0}),
                "FLIP, 0 to 1, mean " + page::number(mean)) +
         "</a>";
}

}  // namespace likeness::olat_view
