#include "realis/export/planes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Dense>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/files/interrupt.h"
#include "render/image/read.h"
#include "render/image/write.h"

namespace likeness::realis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kRidge = 1e-6;    // of the mean square of a term: keeps few lights finite, costs 1e-6 of the rest
constexpr std::size_t kBatch = 4;  // pictures that are held at a time
constexpr std::size_t kMostSamples = 4096;  // texels that components are found on

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

// Terms x lights: what pictures are multiplied by to become terms.
Matrix solver(Format format, std::span<const glm::dvec3> to_lights) {
  Matrix a(index(to_lights.size()), index(row_of(format).terms));
  for (std::size_t i = 0; i < to_lights.size(); ++i) {
    const std::vector<double> row = terms_of(format, to_lights[i]);
    for (std::size_t t = 0; t < row.size(); ++t) a(index(i), index(t)) = row[t];
  }
  Matrix normal = a.transpose() * a;
  normal.diagonal().array() += kRidge * normal.trace() / static_cast<double>(normal.rows());
  return normal.ldlt().solve(a.transpose());
}

// All pictures one after the other, a few at a time: made side by side, then taken in order.
template <class Take>
void each_picture(const Lit& lit, const GoesOn& goes_on, double from, double to, std::string_view what, Take take) {
  const std::size_t count = lit.to_lights.size();
  for (std::size_t first = 0; first < count; first += kBatch) {
    if (!goes_on(from + (to - from) * static_cast<double>(first) / static_cast<double>(count), what))
      throw files::Interrupted();
    std::vector<image::Picture> pictures(std::min(kBatch, count - first));
    tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t i) { pictures[i] = lit.picture(first + i); });
    take(first, pictures);
  }
}

// A plane is a sum over lights of one color (or of all three) times a number, and a number.
struct Map {
  bool is_of_all_colors = false;
  Matrix weights;  // planes x lights, or planes x (3 lights + color)
  Vector offset;   // of each plane
};

Map map_of_terms(const Matrix& inverse) {
  Map out;
  out.weights = Matrix(3 * inverse.rows(), inverse.cols());
  for (Eigen::Index p = 0; p < out.weights.rows(); ++p) out.weights.row(p) = inverse.row(p / 3);
  out.offset = Vector::Zero(out.weights.rows());
  return out;
}

// Principal components of the terms of texels on a grid, outside of the subject too; as bytes, into `planes`.
Map map_of_components(const Lit& lit, const Matrix& inverse, const GoesOn& goes_on, Planes& planes) {
  const std::size_t texels = static_cast<std::size_t>(lit.width) * static_cast<std::size_t>(lit.height);
  const std::size_t step = std::max<std::size_t>(1, texels / kMostSamples) | 1;  // odd: no column by itself
  const std::size_t samples = (texels + step - 1) / step, terms = static_cast<std::size_t>(inverse.rows());
  Matrix records = Matrix::Zero(index(3 * terms), index(samples));
  each_picture(lit, goes_on, 0, 0.5, "finding components", [&](std::size_t first, const auto& pictures) {
    for (std::size_t i = 0; i < pictures.size(); ++i)
      for (std::size_t s = 0; s < samples; ++s)
        for (std::size_t t = 0; t < terms; ++t)
          for (std::size_t c = 0; c < 3; ++c)
            records(index(3 * t + c), index(s)) +=
                inverse(index(t), index(first + i)) * static_cast<double>(pictures[i].rgb[3 * s * step + c]);
  });
  // The mean is stored in [0, 1]; what it cannot say, components say.
  const Vector mean = records.rowwise().mean().cwiseMax(0).cwiseMin(1);
  records.colwise() -= mean;
  const Eigen::SelfAdjointEigenSolver<Matrix> solved(records * records.transpose());
  Matrix components(mean.size(), index(kComponents));
  Vector rounded(mean.size());
  for (Eigen::Index k = 0; k < mean.size(); ++k) {
    const double byte = std::round(255 * mean(k));
    planes.basis.push_back(static_cast<std::uint8_t>(byte));
    rounded(k) = byte / 255;
  }
  for (Eigen::Index p = 0; p < components.cols(); ++p) {
    const Vector component = solved.eigenvectors().col(mean.size() - 1 - p);
    const double range = 127 / std::max(component.cwiseAbs().maxCoeff(), 1e-9);
    planes.range.push_back(range);
    for (Eigen::Index k = 0; k < mean.size(); ++k) {
      const double byte = std::round(127 + range * component(k));
      planes.basis.push_back(static_cast<std::uint8_t>(byte));
      components(k, p) = (byte - 127) / range;
    }
  }
  // Coordinates in the components as they are stored.
  const Matrix coordinates = (components.transpose() * components).ldlt().solve(components.transpose());
  Map out;
  out.is_of_all_colors = true;
  out.offset = -coordinates * rounded;
  out.weights = Matrix::Zero(components.cols(), 3 * inverse.cols());
  for (Eigen::Index t = 0; t < inverse.rows(); ++t)
    for (Eigen::Index i = 0; i < inverse.cols(); ++i)
      for (Eigen::Index c = 0; c < 3; ++c) out.weights.col(3 * i + c) += coordinates.col(3 * t + c) * inverse(t, i);
  return out;
}

// Planes of floats, one after the other.
std::vector<float> mapped(const Lit& lit, const Map& map, double from, const GoesOn& goes_on) {
  const std::size_t texels = static_cast<std::size_t>(lit.width) * static_cast<std::size_t>(lit.height);
  const auto count = static_cast<std::size_t>(map.weights.rows());
  std::vector<float> out(count * texels);
  for (std::size_t p = 0; p < count; ++p)
    std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(p * texels), texels,
                static_cast<float>(map.offset(index(p))));
  each_picture(lit, goes_on, from, 1, "fitting planes", [&](std::size_t first, const auto& pictures) {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t p) {
      float* const plane = out.data() + p * texels;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        const float* const rgb = pictures[i].rgb.data();
        const auto weight = [&](std::size_t column) {
          return static_cast<float>(map.weights(index(p), index(column)));
        };
        if (map.is_of_all_colors) {
          const float r = weight(3 * (first + i)), g = weight(3 * (first + i) + 1), b = weight(3 * (first + i) + 2);
          for (std::size_t k = 0; k < texels; ++k) plane[k] += r * rgb[3 * k] + g * rgb[3 * k + 1] + b * rgb[3 * k + 2];
        } else {
          const float w = weight(first + i);
          for (std::size_t k = 0; k < texels; ++k) plane[k] += w * rgb[3 * k + p % 3];
        }
      }
    });
  });
  return out;
}

}  // namespace

Planes fit_planes(Format format, const Lit& lit, int quality, const GoesOn& goes_on) {
  Planes out;
  out.format = format, out.width = lit.width, out.height = lit.height, out.quality = quality;
  const bool has_components = row_of(format).has_components;
  const Matrix inverse = solver(format, lit.to_lights);
  const Map map = has_components ? map_of_components(lit, inverse, goes_on, out) : map_of_terms(inverse);
  const std::vector<float> floats = mapped(lit, map, has_components ? 0.5 : 0, goes_on);
  const std::size_t texels = static_cast<std::size_t>(lit.width) * static_cast<std::size_t>(lit.height);
  const auto count = static_cast<std::size_t>(map.weights.rows());
  image::DisplayPicture bytes(lit.width, lit.height);
  for (std::size_t p = 0; p < count; ++p) {
    const auto plane = std::span(floats).subspan(p * texels, texels);
    const auto [least, most] = std::ranges::minmax_element(plane);
    const double low = static_cast<double>(*least), high = static_cast<double>(*most);
    const double scale = std::max(high - low, 1e-6);
    out.scale.push_back(scale), out.bias.push_back(-low / scale);
    for (std::size_t k = 0; k < texels; ++k)
      bytes.rgb[3 * k + p % 3] =
          static_cast<std::uint8_t>(std::lround(255 * (static_cast<double>(plane[k]) - low) / scale));
    if (p % 3 == 2)
      out.jpegs.push_back(
          image::jpeg_bytes(bytes, quality, has_components ? image::JpegColors::kRgb : image::JpegColors::kYcc));
  }
  return out;
}

Viewer::Viewer(const Planes& planes) : planes_(planes) {
  for (const std::string& jpeg : planes.jpegs) {
    image::Texels texels = image::decode_texels(jpeg, "plane");
    image::DisplayPicture& picture = decoded_.emplace_back(texels.width, texels.height);
    picture.rgb = std::move(texels.bytes);
  }
}

image::Picture Viewer::picture(const glm::dvec3& to_light) const {
  const Planes& planes = planes_;
  const std::vector<double> terms = terms_of(planes.format, to_light);
  const bool has_components = !planes.basis.empty();
  // Of each color: a number, and what each plane counts for.
  std::array<double, 3> constant{};
  std::vector<std::array<double, 3>> weights(planes.count());
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      if (!has_components) {
        weights[3 * t + c][c] = terms[t];
        continue;
      }
      constant[c] += terms[t] * planes.basis[3 * t + c] / 255.0;
      for (std::size_t p = 0; p < planes.count(); ++p)
        weights[p][c] += terms[t] * (planes.basis[3 * ((p + 1) * terms.size() + t) + c] - 127.0) / planes.range[p];
    }
  image::Picture out(planes.width, planes.height);
  for (std::size_t k = 0; k < out.rgb.size() / 3; ++k) {
    std::array<double, 3> color = constant;
    for (std::size_t p = 0; p < planes.count(); ++p) {
      const double value = (decoded_[p / 3].rgb[3 * k + p % 3] / 255.0 - planes.bias[p]) * planes.scale[p];
      for (std::size_t c = 0; c < 3; ++c) color[c] += weights[p][c] * value;
    }
    for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * k + c] = static_cast<float>(std::clamp(color[c], 0.0, 1.0));
  }
  return out;
}

}  // namespace likeness::realis
