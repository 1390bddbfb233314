#include "render/reference/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "render/files/files.h"

namespace likeness::reference {
namespace {

// The layers that are kept of the first surface, and their channels.
struct Row {
  std::string_view name, channels;
  image::Storage storage;
};
constexpr std::array kRows{
    Row{"depth", "Z", image::Storage::kFloat},      Row{"position", "XYZ", image::Storage::kFloat},
    Row{"normal", "XYZ", image::Storage::kHalf},    Row{"shading_normal", "XYZ", image::Storage::kHalf},
    Row{"uv", "UV", image::Storage::kFloat},        Row{"base_color", "RGB", image::Storage::kHalf},
    Row{"emitted", "RGB", image::Storage::kFloat},  Row{"direct", "RGB", image::Storage::kFloat},
    Row{"indirect", "RGB", image::Storage::kFloat}, Row{"diffuse", "RGB", image::Storage::kFloat},
    Row{"specular", "RGB", image::Storage::kFloat},
};
constexpr std::size_t kLayerFloats = [] {
  std::size_t count = 0;
  for (const Row& row : kRows) count += row.channels.size();
  return count;
}();

std::array<float, kLayerFloats> floats_of(const First& f) {
  std::array<float, kLayerFloats> out{};
  std::size_t at = 0;
  const auto put = [&](const glm::vec3& v) {
    for (int k = 0; k < 3; ++k) out[at++] = v[k];
  };
  out[at++] = f.depth;
  put(f.position), put(f.normal), put(f.shading_normal);
  out[at++] = f.uv.x, out[at++] = f.uv.y;
  put(f.base_color), put(f.emitted), put(f.direct), put(f.indirect), put(f.diffuse), put(f.specular);
  return out;
}

std::vector<std::string> channels_of(std::string_view letters) {
  std::vector<std::string> out;
  for (const char letter : letters) out.emplace_back(1, letter);
  return out;
}

constexpr std::string_view kFormat = "likeness film 1 ";

}  // namespace

Film::Film(int width, int height, bool has_layers) : width_(width), height_(height) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  counts_.resize(pixels), rejected_.resize(pixels), sums_.resize(3 * pixels), squares_.resize(3 * pixels);
  if (has_layers) layers_.resize(kLayerFloats * pixels);
}

void Film::add(std::size_t pixel, const glm::vec3& radiance, const First* first) {
  const std::uint32_t n = ++counts_[pixel];
  const bool is_sound = radiance.r >= 0 && radiance.g >= 0 && radiance.b >= 0 && std::isfinite(radiance.r) &&
                        std::isfinite(radiance.g) && std::isfinite(radiance.b);
  if (!is_sound) return void(++rejected_[pixel]);
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = static_cast<double>(radiance[static_cast<int>(k)]);
    sums_[3 * pixel + k] += x;
    squares_[3 * pixel + k] += x * x;
  }
  if (layers_.empty() || first == nullptr) return;
  const auto floats = floats_of(*first);
  float* means = layers_.data() + kLayerFloats * pixel;
  for (std::size_t k = 0; k < kLayerFloats; ++k)
    if (std::isfinite(floats[k])) means[k] += (floats[k] - means[k]) / static_cast<float>(n);
}

std::uint32_t Film::least_samples() const {
  return counts_.empty() ? 0 : *std::min_element(counts_.begin(), counts_.end());
}
std::uint64_t Film::rejected() const {
  std::uint64_t sum = 0;
  for (const std::uint32_t r : rejected_) sum += r;
  return sum;
}

image::Picture Film::picture() const {
  image::Picture out(width_, height_);
  for (std::size_t i = 0; i < out.rgb.size(); ++i)
    out.rgb[i] = static_cast<float>(sums_[i] / std::max(counts_[i / 3], 1u));
  return out;
}

double Film::relative_error() const {
  double mean = 0;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (counts_[i / 3] < 2) return std::numeric_limits<double>::infinity();
    mean += sums_[i] / counts_[i / 3];
  }
  mean /= static_cast<double>(sums_.size());
  if (!(mean > 0)) return 0;
  double error = 0;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const double n = counts_[i / 3], m = sums_[i] / n;
    error += std::max(squares_[i] / n - m * m, 0.0) / (n - 1) / (m * m + 0.01 * mean * mean);
  }
  return error / static_cast<double>(sums_.size());
}

image::Layers Film::layers() const {
  image::Layers out{width_, height_, {}, {}};
  out.layers.push_back({"", {"R", "G", "B"}, picture().rgb});
  image::Layer variance{"variance", {"R", "G", "B"}, std::vector<float>(sums_.size())};
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const double n = counts_[i / 3], m = n > 0 ? sums_[i] / n : 0;
    variance.data[i] = n > 1 ? static_cast<float>(std::max(squares_[i] / n - m * m, 0.0) / (n - 1))
                             : std::numeric_limits<float>::infinity();
  }
  out.layers.push_back(std::move(variance));
  if (layers_.empty()) return out;
  std::size_t first = 0;
  for (const Row& row : kRows) {
    image::Layer layer{std::string(row.name), channels_of(row.channels), {}, row.storage};
    layer.data.reserve(counts_.size() * row.channels.size());
    for (std::size_t pixel = 0; pixel < counts_.size(); ++pixel)
      for (std::size_t k = 0; k < row.channels.size(); ++k)
        layer.data.push_back(layers_[kLayerFloats * pixel + first + k]);
    first += row.channels.size();
    out.layers.push_back(std::move(layer));
  }
  return out;
}

image::Layers Film::state(const std::string& key) const {
  image::Layers out{width_, height_, {}, std::string(kFormat) + key};
  // A double is kept as two floats: 48 bits of it, more than sums of floats have.
  const auto pairs = [&](const char* name, const std::vector<double>& values) {
    image::Layer layer{name, {"R", "G", "B", "r", "g", "b"}, {}};
    for (std::size_t i = 0; i < values.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k) layer.data.push_back(static_cast<float>(values[i + k]));
      for (std::size_t k = 0; k < 3; ++k)
        layer.data.push_back(
            static_cast<float>(values[i + k] - static_cast<double>(static_cast<float>(values[i + k]))));
    }
    out.layers.push_back(std::move(layer));
  };
  pairs("sum", sums_), pairs("square", squares_);
  image::Layer counts{"count", {"N", "R"}, {}};
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts.data.push_back(static_cast<float>(counts_[i]));
    counts.data.push_back(static_cast<float>(rejected_[i]));
  }
  out.layers.push_back(std::move(counts));
  if (layers_.empty()) return out;
  image::Layer means{"means", {}, layers_};
  for (std::size_t k = 0; k < kLayerFloats; ++k) means.channels.push_back("c" + std::to_string(100 + k));
  out.layers.push_back(std::move(means));
  return out;
}

Film Film::of_state(const image::Layers& state, const std::string& key, const std::string& name) {
  if (!state.metadata.starts_with(kFormat))
    throw files::InputError(name + ": not the state of a render (delete it to start anew)");
  if (state.metadata != std::string(kFormat) + key)
    throw files::InputError(name + ": the state of another scene, camera or setting (delete it to start anew)");
  const auto layer = [&](std::string_view wanted, std::size_t channels) -> const image::Layer& {
    const image::Layer* found = state.find(wanted);
    if (found == nullptr || found->channels.size() != channels)
      throw files::InputError(name + ": the layer \"" + std::string(wanted) +
                              "\" is missing (delete it to start anew)");
    return *found;
  };
  const image::Layer* means = state.find("means");
  Film film(state.width, state.height, means != nullptr);
  // Channels come back in an order of their own: by name.
  const auto place = [](const image::Layer& l, std::string_view channel) {
    return static_cast<std::size_t>(std::find(l.channels.begin(), l.channels.end(), channel) - l.channels.begin());
  };
  const auto read = [&](const char* which, std::vector<double>& values) {
    const image::Layer& l = layer(which, 6);
    constexpr std::array<std::string_view, 6> kNames{"R", "G", "B", "r", "g", "b"};
    std::array<std::size_t, 6> at{};
    for (std::size_t k = 0; k < 6; ++k) {
      at[k] = place(l, kNames[k]);
      if (at[k] >= 6) throw files::InputError(name + ": the layer \"" + which + "\" has other channels");
    }
    for (std::size_t p = 0; p < film.counts_.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k)
        values[3 * p + k] = static_cast<double>(l.data[6 * p + at[k]]) + static_cast<double>(l.data[6 * p + at[k + 3]]);
  };
  read("sum", film.sums_), read("square", film.squares_);
  const image::Layer& counts = layer("count", 2);
  const std::size_t n = place(counts, "N"), r = place(counts, "R");
  if (n > 1 || r > 1) throw files::InputError(name + ": the layer \"count\" has other channels");
  for (std::size_t p = 0; p < film.counts_.size(); ++p) {
    film.counts_[p] = static_cast<std::uint32_t>(counts.data[2 * p + n]);
    film.rejected_[p] = static_cast<std::uint32_t>(counts.data[2 * p + r]);
  }
  if (means != nullptr) film.layers_ = layer("means", kLayerFloats).data;
  return film;
}

}  // namespace likeness::reference
