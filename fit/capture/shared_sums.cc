#include "fit/capture/shared_sums.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "brdf/jet.h"

namespace likeness::capture_fit {
namespace {

using Callisto = brdf::Callisto<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Jet = ceres::Jet<double, kSharedParameters>;
using JetCallisto = brdf::Callisto<Jet>;

constexpr std::size_t kGrain = 16;  // faces that are summed in order, so that threads do not change the numbers

// What a thread works in.
struct Room {
  FaceShading shading;
  Colored colored;
  MatrixXd slopes;  // rows: derivatives of D for each variable, then of S
  MatrixXd product, weighted;
};

template <unsigned kParts>
void slopes_by(const Callisto& material, const Face& face, const std::vector<std::size_t>& variables, Room& room) {
  JetCallisto m;
  Callisto plain = material;
  m.specular_fresnel_falloff = Jet(material.specular_fresnel_falloff);
  for (std::size_t i = 0; i < kSharedParameters; ++i) member(m, i) = Jet(member(plain, i));
  for (std::size_t i = 0; i < variables.size(); ++i) member(m, variables[i]).v[Index(i)] = 1;
  m.base_color = {Jet(1.0), Jet(0.0), Jet(0.0)};
  const auto n = static_cast<Index>(variables.size());
  room.slopes.resize(2 * n, static_cast<Index>(face.angles.size()));
  for (std::size_t k = 0; k < face.angles.size(); ++k) {
    const auto f = m.eval<kParts>(face.angles[k]);
    room.shading.diffuse[k] = (f.r.a - f.g.a) * face.shine[k];
    room.shading.specular[k] = f.g.a * face.shine[k];
    const auto column = static_cast<Index>(k);
    room.slopes.col(column).head(n) = ((f.r.v - f.g.v) * face.shine[k]).head(n);
    room.slopes.col(column).tail(n) = (f.g.v * face.shine[k]).head(n);
  }
}

void slopes_of(const Callisto& material, const Face& face, Groups groups, const std::vector<std::size_t>& variables,
               Room& room) {
  room.shading.diffuse.resize(face.angles.size());
  room.shading.specular.resize(face.angles.size());
  with_parts((groups & 1u) != 0, (groups & 2u) != 0, (groups & ~3u) != 0,
             [&]<unsigned kParts>() { slopes_by<kParts>(material, face, variables, room); });
}

// What one face adds. The sums of D' and S' are made once and mixed by the color of each channel.
void add_face(const Face& face, double scale, const std::vector<std::size_t>& variables, Room& room, Sums& sums) {
  const auto n = static_cast<Index>(variables.size());
  const auto count = static_cast<Index>(face.angles.size());
  const double unit = 1 / (3 * face.level * face.level * scale * scale);
  const Eigen::Map<const VectorXd> weights(room.colored.weights.data(), count);
  const Eigen::Map<const VectorXd> diffuse(room.shading.diffuse.data(), count);
  const Eigen::Map<const VectorXd> specular(room.shading.specular.data(), count);
  room.weighted = room.slopes * weights.asDiagonal();
  room.product = room.weighted * room.slopes.transpose();
  const VectorXd with_d = room.weighted * diffuse;
  const double squares_of_d = (weights.array() * diffuse.array().square()).sum();
  VectorXd gradient = VectorXd::Zero(n);
  for (std::size_t c = 0; c < 3; ++c) {
    const double color = room.colored.color[c];
    const auto& p = room.product;
    const VectorXd along = color * with_d.head(n) + with_d.tail(n);
    sums.hessian += unit * (color * color * p.topLeftCorner(n, n) +
                            color * (p.topRightCorner(n, n) + p.bottomLeftCorner(n, n)) + p.bottomRightCorner(n, n));
    // Kaufman: what the color answers to is no change of the loss. A color that is held at 0 answers to nothing.
    if (color > 0 && squares_of_d > 0) sums.hessian -= (unit / squares_of_d) * along * along.transpose();
    for (Index k = 0; k < count; ++k) {
      const double r = face.light[static_cast<std::size_t>(k)][c] - color * diffuse[k] - specular[k];
      gradient -= (unit * r) * (color * room.weighted.col(k).head(n) + room.weighted.col(k).tail(n));
    }
  }
  sums.gradient += gradient;
  sums.scatter += gradient * gradient.transpose();
}

void add_loss(const Face& face, double scale, const Colored& colored, Sums& sums) {
  for (std::size_t k = 0; k < face.angles.size(); ++k) {
    sums.loss += std::log1p(colored.squares[k] / (scale * scale));
    sums.squares += colored.weights[k] * colored.squares[k];
  }
  sums.weights += colored.weight;
  sums.samples += static_cast<double>(face.angles.size());
}

}  // namespace

Sums sums_of(const std::vector<Face>& faces, const Callisto& material, double scale, Groups groups,
             const std::vector<std::size_t>& variables) {
  const std::size_t grains = (faces.size() + kGrain - 1) / kGrain;
  std::vector<Sums> parts(grains);
  tbb::parallel_for(std::size_t{0}, grains, [&](std::size_t at) {
    Room room;
    Sums& sums = parts[at];
    sums.clear(static_cast<Index>(variables.size()));
    for (std::size_t i = at * kGrain; i < std::min((at + 1) * kGrain, faces.size()); ++i) {
      const Face& face = faces[i];
      if (variables.empty()) shade(material, face, room.shading);
      else slopes_of(material, face, groups, variables, room);
      color_of(face, room.shading, scale, room.colored);
      if (!room.colored.is_known) continue;
      add_loss(face, scale, room.colored, sums);
      if (!variables.empty()) add_face(face, scale, variables, room, sums);
    }
  });
  Sums out;
  out.clear(static_cast<Index>(variables.size()));
  for (const Sums& part : parts) {
    out.loss += part.loss;
    out.squares += part.squares;
    out.weights += part.weights;
    out.samples += part.samples;
    out.gradient += part.gradient;
    out.hessian += part.hessian;
    out.scatter += part.scatter;
  }
  const double count = std::max(out.samples, 1.0);
  out.loss /= count;
  out.gradient /= count;
  out.hessian /= count;
  out.scatter /= count * count;
  return out;
}

}  // namespace likeness::capture_fit
