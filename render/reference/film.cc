#include "render/reference/film.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include <tbb/parallel_for.h>

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

constexpr std::size_t kLightFloats = 15;  // the last of them: light, by what it was

constexpr std::string_view kFormat = "likeness film 2 ";

// The bits of a double as three whole numbers that floats hold.
constexpr std::array<std::string_view, 9> kPieces{"a", "b", "c", "d", "e", "f", "g", "h", "i"};
constexpr unsigned kPieceBits = 22;
std::array<float, 3> pieces_of(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  constexpr std::uint64_t kMask = (1u << kPieceBits) - 1;
  return {static_cast<float>(bits & kMask), static_cast<float>((bits >> kPieceBits) & kMask),
          static_cast<float>(bits >> (2 * kPieceBits))};
}
// False: it is none that a film has.
bool number_of(float piece, std::uint32_t limit, std::uint32_t& out) {
  if (!(piece >= 0 && piece <= static_cast<float>(limit) && piece == std::floor(piece))) return false;
  out = static_cast<std::uint32_t>(piece);
  return true;
}
bool of_pieces(const std::array<float, 3>& pieces, double& x) {
  std::uint64_t bits = 0;
  for (unsigned k = 0; k < 3; ++k) {
    std::uint32_t piece = 0;
    if (!number_of(pieces[k], (1u << kPieceBits) - 1, piece)) return false;
    bits |= static_cast<std::uint64_t>(piece) << (k * kPieceBits);
  }
  x = std::bit_cast<double>(bits);
  return x >= 0 && std::isfinite(x);
}

// Of rows of pixels, in the order of rows whichever thread sums one: the same bits on any number of them.
template <class SumOfRow>
double sum_of_rows(std::size_t rows, SumOfRow&& sum_of_row) {
  std::vector<double> sums(rows);
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t y) { sums[y] = sum_of_row(y); });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace

Film::Film(int width, int height, bool has_layers) : width_(width), height_(height) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  counts_ = image::Plane<std::uint32_t>(pixels), rejected_ = image::Plane<std::uint32_t>(pixels);
  sums_ = image::Plane<double>(3 * pixels), squares_ = image::Plane<double>(3 * pixels);
  if (has_layers) layers_ = image::Plane<float>(kLayerFloats * pixels);
}

void Film::add(std::size_t pixel, const glm::vec3& radiance, const First* first) {
  const std::uint32_t n = ++counts_[pixel];
  const bool is_sound = radiance.r >= 0 && radiance.g >= 0 && radiance.b >= 0 && std::isfinite(radiance.r) &&
                        std::isfinite(radiance.g) && std::isfinite(radiance.b);
  if (!is_sound) ++rejected_[pixel];
  for (std::size_t k = 0; is_sound && k < 3; ++k) {
    const double x = static_cast<double>(radiance[static_cast<int>(k)]);
    sums_[3 * pixel + k] += x;
    squares_[3 * pixel + k] += x * x;
  }
  if (layers_.empty() || first == nullptr) return;
  auto floats = floats_of(*first);
  if (!is_sound) std::fill(floats.end() - kLightFloats, floats.end(), 0.0f);
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
  tbb::parallel_for(std::size_t{0}, counts_.size(), [&](std::size_t pixel) {
    const double n = std::max(counts_[pixel], 1u);
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) out.rgb[i] = static_cast<float>(sums_[i] / n);
  });
  return out;
}

double Film::relative_error() const {
  const std::size_t rows = static_cast<std::size_t>(height_), width = static_cast<std::size_t>(width_);
  const auto values = static_cast<double>(sums_.size());
  const double mean = sum_of_rows(rows,
                                  [&](std::size_t y) {
                                    double sum = 0;
                                    for (std::size_t pixel = y * width; pixel < (y + 1) * width; ++pixel) {
                                      if (counts_[pixel] < 2) return std::numeric_limits<double>::infinity();
                                      for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
                                        sum += sums_[i] / counts_[pixel];
                                    }
                                    return sum;
                                  }) /
                      values;
  if (!std::isfinite(mean)) return mean;
  if (!(mean > 0)) return 0;
  return sum_of_rows(rows,
                     [&](std::size_t y) {
                       double sum = 0;
                       for (std::size_t pixel = y * width; pixel < (y + 1) * width; ++pixel)
                         for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
                           const double n = counts_[pixel], m = sums_[i] / n;
                           sum += std::max(squares_[i] / n - m * m, 0.0) / (n - 1) / (m * m + 0.01 * mean * mean);
                         }
                       return sum;
                     }) /
         values;
}

image::Layers Film::layers() const {
  image::Layers out{width_, height_, {}, {}};
  out.layers.push_back({"", {"R", "G", "B"}, picture().rgb});
  image::Layer variance{"variance", {"R", "G", "B"}, std::vector<float>(sums_.size())};
  constexpr double kMost = std::numeric_limits<float>::max();
  tbb::parallel_for(std::size_t{0}, sums_.size(), [&](std::size_t i) {
    const double n = counts_[i / 3], m = n > 0 ? sums_[i] / n : 0;
    // That of samples near the largest float has none: the picture is finite, and so is this.
    variance.data[i] = n > 1 ? static_cast<float>(std::min(std::max(squares_[i] / n - m * m, 0.0) / (n - 1), kMost))
                             : std::numeric_limits<float>::infinity();
  });
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
  const auto exactly = [&](const char* name, const image::Plane<double>& values) {
    image::Layer layer{name, {kPieces.begin(), kPieces.end()}, {}};
    layer.data.reserve(3 * values.size());
    for (const double x : values)
      for (const float piece : pieces_of(x)) layer.data.push_back(piece);
    out.layers.push_back(std::move(layer));
  };
  exactly("sum", sums_), exactly("square", squares_);
  image::Layer counts{"count", {"N", "R"}, {}};
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts.data.push_back(static_cast<float>(counts_[i]));
    counts.data.push_back(static_cast<float>(rejected_[i]));
  }
  out.layers.push_back(std::move(counts));
  if (layers_.empty()) return out;
  image::Layer means{"means", {}, {layers_.begin(), layers_.end()}};
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
  const auto damaged = [&](const char* which) {
    return files::InputError(name + ": the layer \"" + which + "\" is damaged (delete it to start anew)");
  };
  const auto read = [&](const char* which, image::Plane<double>& values) {
    const image::Layer& l = layer(which, kPieces.size());
    std::array<std::size_t, kPieces.size()> at{};
    for (std::size_t k = 0; k < at.size(); ++k) {
      at[k] = place(l, kPieces[k]);
      if (at[k] >= at.size()) throw files::InputError(name + ": the layer \"" + which + "\" has other channels");
    }
    for (std::size_t p = 0; p < film.counts_.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k) {
        const float* pixel = l.data.data() + kPieces.size() * p;
        if (!of_pieces({pixel[at[3 * k]], pixel[at[3 * k + 1]], pixel[at[3 * k + 2]]}, values[3 * p + k]))
          throw damaged(which);
      }
  };
  read("sum", film.sums_), read("square", film.squares_);
  const image::Layer& counts = layer("count", 2);
  const std::size_t n = place(counts, "N"), r = place(counts, "R");
  if (n > 1 || r > 1) throw files::InputError(name + ": the layer \"count\" has other channels");
  for (std::size_t p = 0; p < film.counts_.size(); ++p) {
    if (!number_of(counts.data[2 * p + n], 1u << 24, film.counts_[p]) ||
        !number_of(counts.data[2 * p + r], 1u << 24, film.rejected_[p]))
      throw damaged("count");
  }
  if (means != nullptr) {
    const image::Layer& kept = layer("means", kLayerFloats);
    std::copy(kept.data.begin(), kept.data.end(), film.layers_.begin());
  }
  return film;
}

}  // namespace likeness::reference
