#pragma once

// Included by one source file per instruction set. Everything here is a template on the batch type, whose name
// carries the instruction set: a plain inline function compiled for AVX-512 could replace the baseline's copy
// when the program is linked. For the same reason nothing here uses a container.

#include "brdf/any_brdf.h"
#include "brdf/batch.h"
#include "brdf/jet.h"
#include "fit/kernel.h"

namespace likeness::fit::loops {

using brdf::Callisto;
using brdf::Geometry;
using brdf::Rgb;
using brdf::Vec3;

template <class B>
using NumberOf = typename B::value_type;

template <class B>
double sum_of(const B& b) {
  alignas(64) NumberOf<B> lanes[B::size];
  b.store_aligned(lanes);
  double sum = 0;
  for (std::size_t i = 0; i < B::size; ++i) sum += static_cast<double>(lanes[i]);
  return sum;
}

template <class B, class N>
Geometry<B> geometry_of(const N* const* l, const N* const* v, std::size_t i) {
  return Geometry<B>(Vec3<B>(B::load_unaligned(l[0] + i), B::load_unaligned(l[1] + i), B::load_unaligned(l[2] + i)),
                     Vec3<B>(B::load_unaligned(v[0] + i), B::load_unaligned(v[1] + i), B::load_unaligned(v[2] + i)));
}

// What one value g of the model adds: the loss, and the factors that turn dg into gradient (r dr/dg) and
// Gauss-Newton curvature ((dr/dg)^2).
template <class B>
struct Residual {
  B loss, slope, curvature;
};

template <class B, class N>
Residual<B> residual(const KernelInput<N>& in, int c, std::size_t i, const B& g, const B& cos_i) {
  const B w = B::load_unaligned(in.root_weight + i);
  const B target = B::load_unaligned(in.target[c] + i);
  const B y = g * cos_i;
  if (in.loss == Loss::kCubeRoot) {
    const B shifted = y + B(N(kCubeRootOffset));
    const B root = xsimd::cbrt(shifted);
    const B r = (target - root) * w, dr = -(root * cos_i * w) / (B(N(3)) * shifted);
    return {r * r, r * dr, dr * dr};
  }
  const B one(N(1)), shown_weight = B(N(kShownWeight)) * w;
  const B y1 = one + y;
  const B r = (target - xsimd::log(y1)) * w, dr = -(cos_i * w) / y1;
  const B q = (B::load_unaligned(in.shown[c] + i) - xsimd::min(g, one)) * shown_weight;
  const B dq = xsimd::select(g < one, -shown_weight, B(N(0)));
  return {r * r + q * q, r * dr + q * dq, dr * dr + dq * dq};
}

// Adds curvature d d^T and slope d to the running sums; `h` is a lower triangle, row by row.
template <int N, class B>
void accumulate(const Residual<B>& r, bool scatter, const B* d, B* g, B* h) {
  const B weight = scatter ? r.slope * r.slope : r.curvature;
  for (int p = 0; p < N; ++p) {
    g[p] = xsimd::fma(r.slope, d[p], g[p]);
    const B scaled = weight * d[p];
    for (int q = 0; q <= p; ++q, ++h) *h = xsimd::fma(scaled, d[q], *h);
  }
}

template <int N, class B>
struct Sums {
  B gradient[N], hessian[N * (N + 1) / 2];
  void clear() {
    for (B& b : gradient) b = B(NumberOf<B>(0));
    for (B& b : hessian) b = B(NumberOf<B>(0));
  }
  // Adds the sums to the output, whose channel of local derivative p is channel[p].
  void flush(const int* channel, KernelOutput& out) {
    const B* h = hessian;
    for (int p = 0; p < N; ++p) {
      out.gradient[channel[p]] += sum_of(gradient[p]);
      for (int q = 0; q <= p; ++q, ++h) {
        const double sum = sum_of(*h);
        out.hessian[channel[p]][channel[q]] += sum;
        if (p != q) out.hessian[channel[q]][channel[p]] += sum;
      }
    }
    clear();
  }
};

// Sums are kept in the batch's own number for this many samples, then added in double.
inline constexpr std::size_t kBlock = 4096;

// Any model: one Jet over all of its channels.
template <template <class> class M, class B>
void run_model(const KernelInput<NumberOf<B>>& in, KernelOutput& out) {
  using N = NumberOf<B>;
  constexpr int kChannels = brdf::channel_count<M<B>>();
  using Jet = ceres::Jet<B, kChannels>;
  B values[kChannels];
  Jet seeds[kChannels];
  int channel[kChannels];
  for (int p = 0; p < kChannels; ++p) {
    values[p] = B(static_cast<N>(in.channels[p]));
    seeds[p].a = values[p];
    for (int q = 0; q < kChannels; ++q) seeds[p].v[q] = B(N(p == q));
    channel[p] = p;
  }
  const M<B> plain = brdf::model_from_channels<M, B>(values);
  const M<Jet> seeded = brdf::model_from_channels<M, Jet>(seeds);
  Sums<kChannels, B> sums;
  sums.clear();
  for (std::size_t first = 0; first < in.count; first += kBlock) {
    const std::size_t last = first + kBlock < in.count ? first + kBlock : in.count;
    B loss(N(0));
    for (std::size_t i = first; i < last; i += B::size) {
      const Geometry<B> g = geometry_of<B>(in.to_light, in.to_view, i);
      if (in.derivatives) {
        const Rgb<Jet> f = seeded.eval(g);
        const Jet* f_of[3] = {&f.r, &f.g, &f.b};
        for (int c = 0; c < 3; ++c) {
          const Residual<B> r = residual<B>(in, c, i, f_of[c]->a, g.cos_i);
          loss += r.loss;
          accumulate<kChannels>(r, in.scatter, f_of[c]->v.data(), sums.gradient, sums.hessian);
        }
      } else {
        const Rgb<B> f = plain.eval(g);
        loss += residual<B>(in, 0, i, f.r, g.cos_i).loss + residual<B>(in, 1, i, f.g, g.cos_i).loss +
                residual<B>(in, 2, i, f.b, g.cos_i).loss;
      }
    }
    out.loss += sum_of(loss);
    if (in.derivatives) sums.flush(channel, out);
  }
}

// Callisto: each of its terms depends on at most three parameters and no two terms share one, so all terms are
// differentiated together in Jets of three slots; the combination of the terms is a Jet of eleven. The chain
// rule joins them. Against one Jet over all channels this is 4 to 8 times faster (docs/fit.md).
template <class B>
struct CallistoLoop {
  using N = NumberOf<B>;
  using Short = ceres::Jet<B, 3>;
  using Long = ceres::Jet<B, 11>;

  static constexpr int channel_of(std::string_view name) {
    int at = 0;
    for (const brdf::Parameter& row : Callisto<double>::kParameters) {
      if (row.name == name) return at;
      at += row.channels;
    }
    return -1;
  }
  static constexpr int kBase = channel_of("base_color"), kMetallic = channel_of("metallic"),
                       kSpecular = channel_of("specular"), kRoughness = channel_of("roughness"),
                       kFresnelFalloff = channel_of("diffuse_fresnel_falloff"),
                       kRetroFalloff = channel_of("retroreflection_falloff"),
                       kFresnelTint = channel_of("diffuse_fresnel_tint"),
                       kRetroTint = channel_of("retroreflection_tint"),
                       kTerminatorTint = channel_of("smooth_terminator_tint"),
                       kSpecularFalloff = channel_of("specular_fresnel_falloff"),
                       kScale = channel_of("dual_specular_roughness_scale"),
                       kOpacity = channel_of("dual_specular_opacity"),
                       kFresnelTangent = channel_of("diffuse_fresnel_tangent_falloff"),
                       kRetroTangent = channel_of("retroreflection_tangent_falloff"),
                       kLength = channel_of("smooth_terminator_length");

  static B value(const KernelInput<N>& in, int channel) { return B(static_cast<N>(in.channels[channel])); }
  template <class Jet>
  static Jet seed(const B& a, int slot) {
    Jet jet;
    jet.a = a;
    for (int q = 0; q < Jet::DIMENSION; ++q) jet.v[q] = B(N(q == slot));
    return jet;
  }

  static void run(const KernelInput<N>& in, KernelOutput& out) {
    const auto shaped = [&]<class S>(auto of) {
      Callisto<S> m;
      m.roughness = of(kRoughness, 0);
      m.dual_specular_roughness_scale = of(kScale, 1);
      m.dual_specular_opacity = of(kOpacity, 2);
      m.diffuse_fresnel_falloff = of(kFresnelFalloff, 0);
      m.diffuse_fresnel_tangent_falloff = of(kFresnelTangent, 1);
      m.retroreflection_falloff = of(kRetroFalloff, 0);
      m.retroreflection_tangent_falloff = of(kRetroTangent, 1);
      m.smooth_terminator_length = of(kLength, 0);
      m.specular_fresnel_falloff = of(kSpecularFalloff, 0);
      return m;
    };
    const Callisto<B> plain = shaped.template operator()<B>([&](int channel, int) { return value(in, channel); });
    const Callisto<Short> seeded =
        shaped.template operator()<Short>([&](int channel, int slot) { return seed<Short>(value(in, channel), slot); });
    const B metallic = value(in, kMetallic), specular = value(in, kSpecular);

    Sums<15, B> sums[3];
    for (auto& s : sums) s.clear();
    for (std::size_t first = 0; first < in.count; first += kBlock) {
      const std::size_t last = first + kBlock < in.count ? first + kBlock : in.count;
      B loss(N(0));
      for (std::size_t i = first; i < last; i += B::size) {
        const Geometry<B> g = geometry_of<B>(in.to_light, in.to_view, i);
        if (!in.derivatives) {
          const auto t = plain.terms(g);
          for (int c = 0; c < 3; ++c) {
            const B f = Callisto<B>::combine(t, metallic, specular, value(in, kBase + c), value(in, kFresnelTint + c),
                                             value(in, kRetroTint + c), value(in, kTerminatorTint + c));
            loss += residual<B>(in, c, i, f, g.cos_i).loss;
          }
          continue;
        }
        const auto t = seeded.terms(g);
        const typename Callisto<Long>::template Terms<Long> terms{seed<Long>(t.rise.a, 0), seed<Long>(t.retro.a, 1),
                                                                  seed<Long>(t.shade.a, 2), seed<Long>(t.lobe.a, 3),
                                                                  seed<Long>(t.fresnel.a, 4)};
        for (int c = 0; c < 3; ++c) {
          const Long f = Callisto<Long>::combine(
              terms, seed<Long>(metallic, 5), seed<Long>(specular, 6), seed<Long>(value(in, kBase + c), 7),
              seed<Long>(value(in, kFresnelTint + c), 8), seed<Long>(value(in, kRetroTint + c), 9),
              seed<Long>(value(in, kTerminatorTint + c), 10));
          const Residual<B> r = residual<B>(in, c, i, f.a, g.cos_i);
          loss += r.loss;
          const B d[15] = {f.v[5],
                           f.v[6],
                           f.v[3] * t.lobe.v[0],
                           f.v[3] * t.lobe.v[1],
                           f.v[3] * t.lobe.v[2],
                           f.v[0] * t.rise.v[0],
                           f.v[0] * t.rise.v[1],
                           f.v[1] * t.retro.v[0],
                           f.v[1] * t.retro.v[1],
                           f.v[2] * t.shade.v[0],
                           f.v[4] * t.fresnel.v[0],
                           f.v[7],
                           f.v[8],
                           f.v[9],
                           f.v[10]};
          accumulate<15>(r, in.scatter, d, sums[c].gradient, sums[c].hessian);
        }
      }
      out.loss += sum_of(loss);
      if (in.derivatives) {
        for (int c = 0; c < 3; ++c) {
          const int channel[15] = {kMetallic,        kSpecular,       kRoughness,         kScale,
                                   kOpacity,         kFresnelFalloff, kFresnelTangent,    kRetroFalloff,
                                   kRetroTangent,    kLength,         kSpecularFalloff,   kBase + c,
                                   kFresnelTint + c, kRetroTint + c,  kTerminatorTint + c};
          sums[c].flush(channel, out);
        }
      }
    }
  }
};

// Calls run<M>() for the model that an index of AnyBrdf names. Models that are not fitted have no code here.
template <class F>
void for_model(std::size_t model, F&& run) {
  const auto run_it = [&]<template <class> class M>(const M<double>*) { run.template operator()<M>(); };
  const auto run_if = [&]<std::size_t I>() {
    using Model = std::variant_alternative_t<I, brdf::AnyBrdf>;
    if constexpr (brdf::kFitted<Model>)
      if (model == I) run_it(static_cast<const Model*>(nullptr));
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (run_if.template operator()<I>(), ...);
  }(std::make_index_sequence<std::variant_size_v<brdf::AnyBrdf>>{});
}

template <class B>
void evaluate(const KernelInput<NumberOf<B>>& in, KernelOutput& out) {
  out.loss = 0;
  for (int p = 0; p < kMaxChannels; ++p) {
    out.gradient[p] = 0;
    for (int q = 0; q < kMaxChannels; ++q) out.hessian[p][q] = 0;
  }
  for_model(in.model, [&]<template <class> class M>() {
    if constexpr (std::is_same_v<M<B>, Callisto<B>>) CallistoLoop<B>::run(in, out);
    else run_model<M, B>(in, out);
  });
}

template <template <class> class M, class B>
void model_values(const ValueInput& in) {
  constexpr int kChannels = brdf::channel_count<M<B>>();
  B values[kChannels];
  for (int p = 0; p < kChannels; ++p) values[p] = B(static_cast<float>(in.channels[p]));
  const M<B> model = brdf::model_from_channels<M, B>(values);
  for (std::size_t i = 0; i < in.count; i += B::size) {
    const Rgb<B> f = model.eval(geometry_of<B>(in.to_light, in.to_view, i));
    f.r.store_unaligned(in.f[0] + i);
    f.g.store_unaligned(in.f[1] + i);
    f.b.store_unaligned(in.f[2] + i);
  }
}

template <template <class> class M, class B>
void table_model(const TableInput& in, TableOutput& out) {
  constexpr int kChannels = brdf::channel_count<M<B>>();
  B values[kChannels];
  for (int p = 0; p < kChannels; ++p) values[p] = B(static_cast<float>(in.channels[p]));
  const M<B> model = brdf::model_from_channels<M, B>(values);
  const B one(1.0f);
  for (std::size_t first = 0; first < in.count; first += kBlock) {
    const std::size_t last = first + kBlock < in.count ? first + kBlock : in.count;
    B squares(0.0f), flux[3] = {squares, squares, squares};
    for (std::size_t i = first; i < last; i += B::size) {
      const Geometry<B> g = geometry_of<B>(in.to_light, in.to_view, i);
      const Rgb<B> f = model.eval(g);
      const B* f_of[3] = {&f.r, &f.g, &f.b};
      const B weight = B::load_unaligned(in.weight + i), cosines = weight * g.cos_i * g.cos_o;
      for (int c = 0; c < 3; ++c) {
        const B r = B::load_unaligned(in.target[c] + i) - xsimd::log(one + *f_of[c] * g.cos_i);
        squares = xsimd::fma(weight * r, r, squares);
        flux[c] = xsimd::fma(cosines, *f_of[c], flux[c]);
      }
    }
    out.log_squares += sum_of(squares);
    for (int c = 0; c < 3; ++c) out.flux[c] += sum_of(flux[c]);
  }
}

template <class B>
void table(const TableInput& in, TableOutput& out) {
  out = {};
  for_model(in.model, [&]<template <class> class M>() { table_model<M, B>(in, out); });
}

template <class B>
void values(const ValueInput& in) {
  for_model(in.model, [&]<template <class> class M>() { model_values<M, B>(in); });
}

// The kernels of the instruction set that the including file is compiled for.
template <class Arch>
Kernels kernels_of(const char* name) {
  return {&evaluate<xsimd::batch<float, Arch>>, &evaluate<xsimd::batch<double, Arch>>,
          &values<xsimd::batch<float, Arch>>, &table<xsimd::batch<float, Arch>>, name};
}

}  // namespace likeness::fit::loops
