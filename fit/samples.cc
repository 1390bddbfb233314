#include "fit/samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/files/files.h"

namespace likeness::fit {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

// A number in [0, 1) from a sample's place in the file: which samples stand for the table in the coarse sets.
double scattered(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

// Columns and rows of the slice that the coarse set keeps, and how many each stands for. The first degrees of theta_h
// are all kept: a mirror-like peak lives in them.
struct Kept {
  int bin, width;
};
std::vector<Kept> kept_bins(int all_below, int step) {
  std::vector<Kept> kept;
  for (int bin = 0; bin < all_below; ++bin) kept.push_back({bin, 1});
  for (int bin = all_below; bin < kSliceGrid; bin += step) {
    const int width = std::min(step, kSliceGrid - bin);
    kept.push_back({bin + width / 2, width});
  }
  return kept;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

template <class N>
void SampleArrays<N>::add(const measured::Direction& l, const measured::Direction& v, const measured::Rgb& f,
                          double weight) {
  const double direction[2][3] = {{l.x, l.y, l.z}, {v.x, v.y, v.z}};
  const double value[3] = {f.r, f.g, f.b};
  for (int c = 0; c < 3; ++c) {
    to_light_[c].push_back(static_cast<N>(direction[0][c]));
    to_view_[c].push_back(static_cast<N>(direction[1][c]));
    const double y = value[c] * l.z;
    target_[c].push_back(static_cast<N>(loss_ == Loss::kLog ? std::log1p(y) : std::cbrt(y + kCubeRootOffset)));
    shown_[c].push_back(static_cast<N>(std::min(value[c], 1.0)));
  }
  root_weight_.push_back(static_cast<N>(std::sqrt(weight)));
  weight_sum_ += weight;
  ++count_;
}

template <class N>
void SampleArrays<N>::finish() {
  while (root_weight_.size() % kLane != 0) {
    for (int c = 0; c < 3; ++c) {
      to_light_[c].push_back(N(c == 2));
      to_view_[c].push_back(N(c == 2));
      target_[c].push_back(0);
      shown_[c].push_back(0);
    }
    root_weight_.push_back(0);
  }
}

template <class N>
KernelInput<N> SampleArrays<N>::input(std::size_t model, const double* channels, bool derivatives, std::size_t first,
                                      std::size_t last, bool scatter) const {
  KernelInput<N> in{};
  for (int c = 0; c < 3; ++c) {
    in.to_light[c] = to_light_[c].data() + first;
    in.to_view[c] = to_view_[c].data() + first;
    in.target[c] = target_[c].data() + first;
    in.shown[c] = shown_[c].data() + first;
  }
  in.root_weight = root_weight_.data() + first;
  in.count = last - first;
  in.model = model;
  in.loss = loss_;
  in.derivatives = derivatives;
  in.scatter = scatter;
  in.channels = channels;
  return in;
}

template class SampleArrays<float>;
template class SampleArrays<double>;

std::vector<SlicePoint> slice_points(const measured::Material& material, double cut_deg) {
  const double least_cosine = std::cos(cut_deg * kDegree);
  std::vector<SlicePoint> points;
  for (int h = 0; h < kSliceGrid; ++h) {
    for (int d = 0; d < kSliceGrid; ++d) {
      const auto g = brdf::geometry_at((h + 0.5) * kDegree, (d + 0.5) * kDegree, std::numbers::pi / 2);
      SlicePoint point{h, d, {}, g, g};
      if (g.cos_i < least_cosine || g.cos_o < least_cosine || !material.nearest(g, point.f, point.at_stored)) continue;
      points.push_back(point);
    }
  }
  return points;
}

SampleSet sample_set(const measured::Material& material, const std::vector<SlicePoint>& slice, const Options& options,
                     Reading reading) {
  SampleSet set{options.loss,
                SampleArrays<float>(options.loss),
                SampleArrays<float>(options.loss),
                SampleArrays<double>(options.loss),
                SampleArrays<float>(options.loss),
                {}};
  std::size_t used = slice.size();
  if (options.on == Domain::kSlice) {
    std::vector<int> width_h(kSliceGrid), width_d(kSliceGrid);
    for (const Kept& k : kept_bins(4, 4)) width_h[k.bin] = k.width;
    for (const Kept& k : kept_bins(0, 4)) width_d[k.bin] = k.width;
    const auto add = [&](const SlicePoint& p, const brdf::Geometry<double>& g, double weight) {
      const int stands_for = width_h[p.h] * width_d[p.d];
      if (stands_for > 0) set.coarse.add(g.to_light, g.to_view, p.f, weight * stands_for);
      set.single.add(g.to_light, g.to_view, p.f, weight);
      set.exact.add(g.to_light, g.to_view, p.f, weight);
    };
    for (const SlicePoint& p : slice) {
      if (reading == Reading::kStored) {
        add(p, p.at_stored, 1);
      } else {
        add(p, p.at_stored, 0.5);
        add(p, p.at_grid, 0.5);
      }
    }
  } else {
    const double least_cosine = std::cos(options.cut_deg * kDegree);
    const double stored = static_cast<double>(std::max<std::size_t>(material.coverage().valid, 1));
    std::uint64_t index = 0;
    material.for_each_sample([&](const measured::Sample& s) {
      if (s.to_light.z < least_cosine || s.to_view.z < least_cosine) return;
      const double u = scattered(index++);
      if (u * stored < 1500) set.coarse.add(s.to_light, s.to_view, s.f, s.weight);
      if (u * stored < 24000) set.single.add(s.to_light, s.to_view, s.f, s.weight);
      set.table.add(s.to_light, s.to_view, s.f, s.weight);
    });
    used = set.table.count();
  }
  constexpr std::size_t kLeast = 100;  // four times the variables of the richest model
  if (used < kLeast)
    throw files::InputError(material.source + ": " + std::to_string(used) + " valid samples within the cut of " +
                            std::to_string(options.cut_deg) + " deg; a fit needs at least " + std::to_string(kLeast));
  for (auto* arrays : {&set.coarse, &set.single, &set.table}) arrays->finish();
  set.exact.finish();

  std::vector<double> levels[3];
  for (const SlicePoint& p : slice) {
    levels[0].push_back(p.f.r);
    levels[1].push_back(p.f.g);
    levels[2].push_back(p.f.b);
  }
  const auto level = [&](int c) { return std::clamp(std::numbers::pi * percentile(levels[c], 0.3), 0.01, 0.9); };
  set.diffuse_level = {level(0), level(1), level(2)};
  return set;
}

}  // namespace likeness::fit
