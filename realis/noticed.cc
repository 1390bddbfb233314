#include "realis/noticed.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include "realis/weight/samples.h"
#include "render/files/files.h"

namespace likeness::realis {
namespace {

constexpr double kSame = 1e-4;    // distance of two unit vectors that are one direction
constexpr double kFlat = 0.01;    // rms distance from a plane: 0.6 degrees
constexpr double kBrighter = 30;  // times the median of the lights
constexpr double kManyNegative = 0.01;

std::string percent(std::size_t part, std::size_t whole) {
  const double share = 100 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
  return share < 0.1 ? "less than 0.1 %" : files::number_text(std::round(share * 10) / 10) + " %";
}

// Root mean square distance of the directions from the plane that fits them best.
double flatness(const std::vector<glm::dvec3>& directions) {
  glm::dvec3 mean(0);
  for (const glm::dvec3& d : directions) mean += d / static_cast<double>(directions.size());
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const glm::dvec3& d : directions) {
    const Eigen::Vector3d v(d.x - mean.x, d.y - mean.y, d.z - mean.z);
    sum += v * v.transpose() / static_cast<double>(directions.size());
  }
  return std::sqrt(std::max(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvalues()[0], 0.0));
}

void of_directions(const Census& c, std::vector<std::string>& out) {
  std::string same;
  std::size_t count = 0;
  for (std::size_t i = 0; i < c.to_lights.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (glm::length(c.to_lights[i] - c.to_lights[k]) < kSame) {
        if (++count <= 3) same += (same.empty() ? "" : ", ") + c.ids[k] + " = " + c.ids[i];
        break;
      }
  if (count > 0)
    out.push_back("lights from the same direction: " + same + (count > 3 ? ", ..." : "") +
                  "; their photographs are averaged");
  if (c.to_lights.size() == 1) out.push_back("one light: other directions are not known, and get what it shows, faded");
  else if (c.to_lights.size() == 2) out.push_back("two lights: little is known of other directions");
  else if (flatness(c.to_lights) < kFlat)
    out.push_back("all lights are in one plane: nothing is known of directions beside it");
  if (c.lobes > c.to_lights.size() - std::min(count, c.to_lights.size()) && !c.is_free)
    out.push_back(std::to_string(c.lobes) + " lobes and fewer lights (" + std::to_string(c.to_lights.size() - count) +
                  " directions): what lights do not decide is kept small");
}

void of_photographs(const Census& c, std::vector<std::string>& out) {
  LightCensus all;
  std::vector<double> means;
  for (std::size_t i = 0; i < c.lights.size(); ++i) {
    const LightCensus& l = c.lights[i];
    all.samples += l.samples, all.clipped += l.clipped, all.not_finite += l.not_finite, all.negative += l.negative;
    const std::size_t finite = l.samples - std::min(l.not_finite, l.samples);
    means.push_back(finite > 0 ? l.sum / static_cast<double>(finite) / c.irradiance[i] : 0);
  }
  if (all.not_finite > 0)
    out.push_back(percent(all.not_finite, all.samples) + " of the samples are not finite; they are not looked at");
  if (all.clipped > 0)
    out.push_back(percent(all.clipped, all.samples) + " of the samples are clipped; they are not looked at");
  if (static_cast<double>(all.negative) > kManyNegative * static_cast<double>(all.samples))
    out.push_back(percent(all.negative, all.samples) +
                  " of the samples are negative (noise about black, or a wrong black); taken as they are");
  std::vector<double> sorted = means;
  const double median = weight::quantile(sorted, 0.5);
  for (std::size_t i = 0; i < means.size() && means.size() > 2; ++i)
    if (median > 0 && means[i] > kBrighter * median)
      out.push_back("light " + c.ids[i] + " is " + files::number_text(std::round(means[i] / median)) +
                    " times as bright as the median: its intensity in lights.json may be wrong");
  if (!means.empty() && *std::max_element(means.begin(), means.end()) <= 0) out.push_back("the photographs are black");
  else if (c.plain_rms == 0) out.push_back("photographs and renders are equal: there is nothing to bake");
}

}  // namespace

std::vector<std::string> noticed(const Census& c) {
  std::vector<std::string> out;
  of_directions(c, out);
  of_photographs(c, out);
  if (c.unseen > 0)
    out.push_back(percent(c.unseen, c.texels) + " of the texels are seen by no camera; they get 0 and are marked");
  if (c.unlit > 0)
    out.push_back(percent(c.unlit, c.texels) +
                  " of the texels have no sample that can be trusted; they get 0 and are marked");
  return out;
}

Census census_of(const Subject& s, const capture::Capture& capture) {
  Census out;
  out.to_lights = s.to_lights, out.lights = s.census, out.texels = s.texels();
  for (std::size_t i = 0; i < s.lights.size(); ++i)
    out.ids.push_back(capture.lights[s.lights[i]].id), out.irradiance.push_back(s.irradiance_of(i));
  for (std::size_t texel = 0; texel < s.texels(); ++texel) {
    const auto first = s.weight.begin() + static_cast<std::ptrdiff_t>(s.samples_of(texel));
    if (std::none_of(first, first + static_cast<std::ptrdiff_t>(s.lights.size()), [](float w) { return w > 0; }))
      ++out.unlit;
  }
  return out;
}

}  // namespace likeness::realis
