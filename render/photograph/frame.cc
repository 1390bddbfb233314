#include "render/photograph/frame.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/read_exr.h"
#include "render/photograph/raw.h"

namespace likeness::photograph {
namespace {

bool is_of_light(std::string_view bytes) {
  return image::is_exr(bytes) || bytes.starts_with("#?") || bytes.starts_with("PF") || bytes.starts_with("Pf");
}

Color8 color8(const float* rgb) {
  Color8 out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<int>(std::lround(255 * std::clamp(rgb[c], 0.0f, 1.0f)));
  return out;
}

void fill_codes(image::Texels texels, Frame& frame) {
  frame.width = texels.width, frame.height = texels.height;
  if (texels.channels == 3 && texels.bytes.empty()) {
    frame.codes = std::move(texels.floats);
    return;
  }
  const auto channels = static_cast<std::size_t>(texels.channels);
  frame.codes.resize(3 * texels.count());
  for (std::size_t i = 0; i < texels.count(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t from = i * channels + (channels < 3 ? 0 : c);
      frame.codes[3 * i + c] =
          texels.bytes.empty() ? texels.floats[from] : static_cast<float>(texels.bytes[from]) / 255;
    }
}

}  // namespace

Frame read_frame(const std::filesystem::path& file, const FrameOptions& options) {
  const std::string bytes = files::read_whole(file, image::kMostFileBytes);
  Frame out;
  if (image::is_dng(bytes)) {
    Developed raw = develop(bytes, file.string());
    out.width = raw.light.width, out.height = raw.light.height;
    out.is_light = true;
    out.codes = std::move(raw.light.rgb);
    out.states.resize(raw.is_clipped.size());
    for (std::size_t i = 0; i < out.states.size(); ++i)
      out.states[i] = raw.is_clipped[i] != 0 ? State::kClipped : State::kSeen;
  } else {
    out.is_light = is_of_light(bytes);
    fill_codes(image::decode_texels(bytes, file.string()), out);
    out.states.assign(out.codes.size() / 3, State::kSeen);
    if (out.is_light)
      for (float& v : out.codes) v = static_cast<float>(static_cast<double>(v) / options.white);
  }
  for (std::size_t i = 0; i < out.states.size(); ++i) {
    float* const rgb = out.codes.data() + 3 * i;
    if (!std::isfinite(rgb[0]) || !std::isfinite(rgb[1]) || !std::isfinite(rgb[2])) {
      out.states[i] = State::kIgnored;
      std::fill_n(rgb, 3, 0.0f);
    } else if (options.ignored && color8(rgb) == *options.ignored) {
      out.states[i] = State::kIgnored;
    }
  }
  return out;
}

Frame shifted(const Frame& frame, double dx, double dy) {
  Frame out;
  out.width = frame.width, out.height = frame.height;
  out.is_light = frame.is_light;
  out.codes.resize(frame.codes.size());
  out.states.assign(frame.states.size(), State::kIgnored);
  // A shift of less than a hundredth of a pixel beside whole ones is not worth what interpolation costs in sharpness.
  const auto parted = [](double d) {
    double whole = std::floor(d), part = d - whole;
    if (part > 0.99) whole += 1, part = 0;
    return std::pair(static_cast<int>(whole), part < 0.01 ? 0.0 : part);
  };
  const auto [left, fx] = parted(dx);
  const auto [top, fy] = parted(dy);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const int u = x + left, v = y + top, right = fx > 0 ? u + 1 : u, below = fy > 0 ? v + 1 : v;
      if (u < 0 || v < 0 || right >= frame.width || below >= frame.height) continue;
      const std::array<std::size_t, 4> from{frame.index(u, v), frame.index(right, v), frame.index(u, below),
                                            frame.index(right, below)};
      const std::array<double, 4> share{(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
      const std::size_t to = out.index(x, y);
      State state = State::kSeen;
      for (const std::size_t i : from)
        if (state != State::kIgnored && frame.states[i] != State::kSeen) state = frame.states[i];
      out.states[to] = state;
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        bool is_full = false, is_black = false;
        for (std::size_t k = 0; k < 4; ++k) {
          const double code = static_cast<double>(frame.codes[3 * from[k] + c]);
          sum += share[k] * code;
          is_full = is_full || code >= 1;
          is_black = is_black || code <= 0;
        }
        out.codes[3 * to + c] = static_cast<float>(is_full ? std::max(sum, 1.0) : is_black ? std::min(sum, 0.0) : sum);
      }
    }
  return out;
}

std::optional<Color8> border_color(const Frame& frame) {
  if (frame.is_light || frame.width < 8 || frame.height < 8) return std::nullopt;
  const auto of_side = [&](int count, const auto& at) -> std::optional<Color8> {
    std::map<Color8, int> seen;
    for (int i = 0; i < count; ++i) {
      const Color8 color = color8(frame.codes.data() + 3 * at(i));
      const int sum = color[0] + color[1] + color[2];
      if (std::ranges::all_of(color, [](int v) { return v == 0 || v == 255; }) && sum > 0 && sum < 765) ++seen[color];
    }
    for (const auto& [color, times] : seen)
      if (4 * times >= count) return color;
    return std::nullopt;
  };
  const int w = frame.width, h = frame.height;
  for (const int x : {0, w - 1})
    if (const auto found = of_side(h, [&](int i) { return frame.index(x, i); })) return found;
  for (const int y : {0, h - 1})
    if (const auto found = of_side(w, [&](int i) { return frame.index(i, y); })) return found;
  return std::nullopt;
}

}  // namespace likeness::photograph
