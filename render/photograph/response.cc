#include "render/photograph/response.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "render/columns/columns.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"

namespace likeness::photograph {
namespace {

constexpr std::size_t kMiddle = 128;
constexpr double kWellShown = 0.05;  // hat
// Smoothness, of each code, against the mean weight of the data of a code: a hundredth of it smooths nothing that 8 bits show.
constexpr double kSmoothness = 4, kLeastSmoothness = 0.02;

template <class Light>
Response response_by(std::string name, const Light& light) {
  Response out;
  out.name = std::move(name);
  for (std::size_t k = 0; k < kCodes; ++k)
    for (auto& curve : out.log2_exposure)
      curve[k] = std::log2(light(std::max(0.5, static_cast<double>(k)) / (kCodes - 1)));
  return out;
}

// The nearest curve that does not fall, by weight. Returns how many steps fell.
int made_rising(std::array<double, kCodes>& curve, const std::array<double, kCodes>& weight) {
  struct Block {
    double mean, weight;
    std::size_t count;
  };
  std::vector<Block> blocks;
  int fell = 0;
  for (std::size_t k = 0; k < kCodes; ++k) {
    fell += k > 0 && curve[k] < curve[k - 1];
    blocks.push_back({curve[k], weight[k], 1});
    while (blocks.size() > 1 && blocks.back().mean < blocks[blocks.size() - 2].mean) {
      const Block last = blocks.back();
      blocks.pop_back();
      Block& to = blocks.back();
      to.mean = (to.mean * to.weight + last.mean * last.weight) / (to.weight + last.weight);
      to.weight += last.weight;
      to.count += last.count;
    }
  }
  std::size_t at = 0;
  for (const Block& block : blocks)
    for (std::size_t i = 0; i < block.count; ++i) curve[at++] = block.mean;
  return fell;
}

struct Term {
  std::size_t code;
  double weight, time;  // hat^2, log2 of exposure
};

// The frames that show the pixel, or nothing if fewer than two do.
void terms_of(const Samples& samples, std::size_t pixel, std::size_t channel, std::span<const double> log_times,
              const Response& response, std::vector<Term>& out) {
  out.clear();
  for (std::size_t j = 0; j < samples.frames; ++j) {
    const double code = static_cast<double>(samples.at(pixel, j, channel)), w = response.worth(channel, code);
    if (w > kWellShown)
      out.push_back({static_cast<std::size_t>(std::lround(code * (kCodes - 1))), w * w, log_times[j]});
  }
  if (out.size() < 2) out.clear();
}

}  // namespace

double Response::at(std::size_t channel, double code) const {
  const double x = std::clamp(code, 0.0, 1.0) * (kCodes - 1);
  const auto low = std::min(static_cast<std::size_t>(x), kCodes - 2);
  const auto& curve = log2_exposure[channel];
  return curve[low] + (x - static_cast<double>(low)) * (curve[low + 1] - curve[low]);
}

Response linear_response() {
  return response_by("linear", [](double code) { return code; });
}
Response srgb_response() {
  return response_by("srgb", [](double code) { return image::srgb_decode(code); });
}

std::string csv_of(const Response& response) {
  std::string out = "# log2 of exposure at each code of 8 bits\ncode,red,green,blue\n";
  for (std::size_t k = 0; k < kCodes; ++k) {
    out += std::to_string(k);
    for (const auto& curve : response.log2_exposure) out += "," + files::number_text(curve[k]);
    out += "\n";
  }
  return out;
}

Response response_of(std::string_view text, const std::string& name) {
  const columns::Columns table = columns::parse(text, name, {});
  if (table.rows.size() != kCodes)
    throw files::InputError(name + ": has " + std::to_string(table.rows.size()) +
                            " rows; a response has 256 (code 0 to 255)");
  const std::size_t code = table.index_of("code");
  const std::array<std::size_t, 3> at{table.index_of("red"), table.index_of("green"), table.index_of("blue")};
  Response out;
  out.name = name;
  for (std::size_t k = 0; k < kCodes; ++k) {
    const columns::Row& row = table.rows[k];
    if (row.numbers[code] != static_cast<double>(k))
      table.refuse(row, "code " + std::to_string(k) + " is expected here");
    for (std::size_t c = 0; c < 3; ++c) {
      out.log2_exposure[c][k] = row.numbers[at[c]];
      if (std::abs(row.numbers[at[c]]) > 100) table.refuse(row, "exposures are within 100 stops of 1");
      if (k == 0) continue;
      if (out.log2_exposure[c][k] < out.log2_exposure[c][k - 1]) table.refuse(row, "the curve falls");
      if (k + 1 < kCodes && out.log2_exposure[c][k] == out.log2_exposure[c][0])
        out.black[c] = static_cast<double>(k) / (kCodes - 1);
    }
  }
  return out;
}

std::array<double, 3> black_of(const Samples& samples, std::span<const double> exposures) {
  constexpr std::size_t kHighest = 64, kMargin = 8, kFewest = 20;
  constexpr double kStop = 1.8;  // a stop, and times that were rounded
  std::array<double, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<std::vector<double>, kHighest> growth;
    for (std::size_t j = 0; j < samples.frames; ++j) {
      std::size_t longer = j + 1;
      while (longer < samples.frames && exposures[longer] < kStop * exposures[j]) ++longer;
      for (std::size_t i = 0; longer < samples.frames && i < samples.pixels; ++i) {
        const double code = 255 * static_cast<double>(samples.at(i, j, c)),
                     after = 255 * static_cast<double>(samples.at(i, longer, c));
        if (code >= 0 && code < kHighest - 1 && !std::isnan(after))
          growth[static_cast<std::size_t>(std::lround(code))].push_back(after - code);
      }
    }
    // From above: below the base codes are noise, which grows back to it.
    for (std::size_t k = kHighest; k-- > 1;) {
      if (growth[k].size() < kFewest) continue;
      const auto middle = growth[k].begin() + static_cast<std::ptrdiff_t>(growth[k].size() / 2);
      std::ranges::nth_element(growth[k], middle);
      if (*middle > std::max(1.0, 0.1 * static_cast<double>(k))) continue;
      if (k < kHighest - kMargin)
        out[c] = static_cast<double>(k) / (kCodes - 1);  // else times are wrong, not codes black
      break;
    }
  }
  return out;
}

Recovered recover_response(const Samples& samples, std::span<const double> exposures) {
  std::vector<double> log_times;
  for (const double t : exposures) log_times.push_back(std::log2(t));
  if (log_times.empty() || std::ranges::max(log_times) - std::ranges::min(log_times) < 0.1)
    throw files::UsageError(
        "a response is recovered from frames whose exposures differ; say which it is by --response");
  Recovered out;
  out.response.name = "recovered";
  out.response.black = black_of(samples, exposures);
  std::vector<Term> terms;
  for (std::size_t c = 0; c < 3; ++c) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kCodes, kCodes);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(kCodes);
    std::array<double, kCodes> known{};
    std::size_t used = 0;
    for (std::size_t pixel = 0; pixel < samples.pixels; ++pixel) {
      terms_of(samples, pixel, c, log_times, out.response, terms);
      if (terms.empty()) continue;
      ++used;
      double sum = 0, mean_time = 0;
      for (const Term& t : terms) sum += t.weight, mean_time += t.weight * t.time;
      mean_time /= sum;
      // ln E = mean of g - mean of ln t, put in: the rest is about how each frame differs from the mean.
      for (const Term& a : terms) {
        const auto i = static_cast<Eigen::Index>(a.code);
        normal(i, i) += a.weight;
        right[i] += a.weight * (a.time - mean_time);
        known[a.code] += a.weight;
        for (const Term& b : terms) normal(i, static_cast<Eigen::Index>(b.code)) -= a.weight * b.weight / sum;
      }
    }
    if (used == 0)
      throw files::UsageError(
          "no pixel is shown well by two frames, so no response is recovered; say which it is by --response");
    out.used = std::max(out.used, used);
    const double scale = normal.trace() / kCodes;
    for (std::size_t k = 1; k + 1 < kCodes; ++k) {
      const double w = hat(static_cast<double>(k) / (kCodes - 1)), s = scale * kSmoothness * (w * w + kLeastSmoothness);
      const auto i = static_cast<Eigen::Index>(k);
      const Eigen::Vector3d second(1, -2, 1);
      normal.block<3, 3>(i - 1, i - 1) += s * second * second.transpose();
    }
    normal(kMiddle, kMiddle) += 1e3 * scale;  // g(128) = 0
    const Eigen::VectorXd solved = normal.ldlt().solve(right);
    auto& curve = out.response.log2_exposure[c];
    for (std::size_t k = 0; k < kCodes; ++k) curve[k] = solved[static_cast<Eigen::Index>(k)];
    std::array<double, kCodes> weight{};
    for (std::size_t k = 0; k < kCodes; ++k) weight[k] = known[k] + 1e-6 * scale;
    out.flattened[c] = made_rising(curve, weight);
    const auto black = static_cast<std::size_t>(std::lround(out.response.black[c] * (kCodes - 1)));
    std::fill_n(curve.begin(), black, curve[black]);

    double square = 0, total = 0;
    for (std::size_t pixel = 0; pixel < samples.pixels; ++pixel) {
      terms_of(samples, pixel, c, log_times, out.response, terms);
      double sum = 0, mean = 0;
      for (const Term& t : terms) sum += t.weight, mean += t.weight * (curve[t.code] - t.time);
      for (const Term& t : terms) {
        const double rest = curve[t.code] - t.time - mean / sum;
        square += t.weight * rest * rest, total += t.weight;
      }
    }
    out.rms_stops[c] = std::sqrt(square / total);
    const double shift = std::log2(image::srgb_decode(kMiddle / 255.0)) - curve[kMiddle];
    for (double& v : curve) v += shift;
  }
  return out;
}

}  // namespace likeness::photograph
