#include "render/photograph/merge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/tone_curve.h"

namespace likeness::photograph {
namespace {

constexpr std::size_t kSamples = 8192;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Sums of one channel of a pixel. Where no frame has said anything, weight is 0, or kFull or kBlack, and `light` the bound.
struct Sum {
  float light = 0, weight = 0;
};
constexpr float kFull = -1, kBlack = -2;

struct Pixel {
  std::array<Sum, 3> sums{};
  std::array<float, 3> best{};               // hat of the frame that shows the channel best
  float low = -kInfinity, high = kInfinity;  // of log2 luminance, as all frames allow it
  std::uint16_t frames = 0;
};

std::string stops_text(double stops) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%+.2f", stops);
  return text.data();
}

class Merger {
 public:
  explicit Merger(const MergeOptions& options) : options_(options) {}

  Merged run() {
    order();
    survey();
    choose_response();
    weigh_evidence();
    add_frames();
    finish();
    return std::move(out_);
  }

 private:
  void tell(std::string_view what, std::size_t done) const {
    if (options_.keep_going &&
        !options_.keep_going(what, static_cast<double>(done) / static_cast<double>(2 * out_.reports.size())))
      throw files::Interrupted{};
  }
  void warn(std::string text) { out_.warnings.push_back(std::move(text)); }
  static std::string name_of(const FrameReport& report) { return report.bracket.file.filename().string(); }

  void order() {
    if (options_.brackets.empty()) throw files::UsageError("there is no frame to merge");
    if (options_.brackets.size() > kMostFrames)
      throw files::UsageError("more than " + std::to_string(kMostFrames) + " frames");
    if (!(options_.frame.white > 0 && std::isfinite(options_.frame.white)))
      throw files::UsageError("white = " + files::number_text(options_.frame.white) + " is not above 0");
    const std::vector<double> exposures = exposures_of(options_.brackets);
    std::vector<std::size_t> by_exposure(exposures.size());
    std::iota(by_exposure.begin(), by_exposure.end(), 0);
    std::ranges::stable_sort(by_exposure, {}, [&](std::size_t i) { return exposures[i]; });
    for (const std::size_t i : by_exposure) {
      FrameReport report;
      report.bracket = options_.brackets[i];
      report.exposure = exposures[i];
      exposures_.push_back(exposures[i]);
      out_.reports.push_back(std::move(report));
    }
    if (exposures_.size() == 1) warn("one frame is no bracket: light is known where that frame shows it");
    else if (exposures_.back() < 1.07 * exposures_.front())
      warn("all frames have the same exposure: they lower the noise and widen no range");
  }

  Frame read(std::size_t k) {
    Frame frame = read_frame(out_.reports[k].bracket.file, options_.frame);
    if (k == 0 && width_ == 0) width_ = frame.width, height_ = frame.height;
    if (frame.width != width_ || frame.height != height_)
      throw files::InputError(out_.reports[k].bracket.file.string() + ": has " + std::to_string(frame.width) + " x " +
                              std::to_string(frame.height) + " pixels; " + name_of(out_.reports[0]) + " has " +
                              std::to_string(width_) + " x " + std::to_string(height_));
    return frame;
  }

  // Reads every frame once: histograms, shifts, and the codes of a grid of pixels.
  void survey() {
    Samples& samples = samples_;
    image::Picture before;
    std::vector<float> shown_before;
    double x = 0, y = 0;
    std::vector<std::pair<int, int>> places;
    for (std::size_t k = 0; k < out_.reports.size(); ++k) {
      tell("frame " + name_of(out_.reports[k]), k);
      const Frame frame = read(k);
      FrameReport& report = out_.reports[k];
      report.is_light = frame.is_light;
      if (!out_.suggested_ignored && !options_.frame.ignored) out_.suggested_ignored = border_color(frame);
      count(frame, report);
      if (options_.shift_of && exposures_.size() > 1) {
        auto [picture, shown] = small_of(frame);
        if (k > 0) {
          for (std::size_t i = 0; i < shown.size(); ++i) shown_before[i] *= shown[i];
          FoundShift found = options_.shift_of(before, picture, shown_before);
          found.dx *= reduction_, found.dy *= reduction_, found.sigma *= reduction_;
          report.shift = found;
          if (std::isfinite(found.sigma)) x += found.dx, y += found.dy;
        }
        before = std::move(picture);
        shown_before = std::move(shown);
        if (options_.aligns) report.moved_x = x, report.moved_y = y;
      }
      if (k == 0) {
        const double pixels = static_cast<double>(width_) * height_, step = std::max(1.0, std::sqrt(pixels / kSamples));
        for (double v = step / 2; v < height_; v += step)
          for (double u = step / 2; u < width_; u += step)
            places.emplace_back(static_cast<int>(u), static_cast<int>(v));
        samples.pixels = places.size();
        samples.frames = exposures_.size();
        samples.codes.assign(3 * samples.pixels * samples.frames, std::numeric_limits<float>::quiet_NaN());
      }
      for (std::size_t i = 0; i < places.size(); ++i) {
        const int u = places[i].first + static_cast<int>(std::lround(report.moved_x));
        const int v = places[i].second + static_cast<int>(std::lround(report.moved_y));
        if (u < 0 || v < 0 || u >= width_ || v >= height_ || frame.states[frame.index(u, v)] == State::kIgnored)
          continue;
        float* const to = samples.codes.data() + 3 * (i * samples.frames + k);
        if (frame.states[frame.index(u, v)] == State::kClipped) std::fill_n(to, 3, 2.0f);
        else std::copy_n(frame.codes.data() + 3 * frame.index(u, v), 3, to);
      }
    }
    if (out_.suggested_ignored) {
      const Color8 c = *out_.suggested_ignored;
      warn("a border of pure color is in the frames; if it is no light, leave it out by --ignore-color " +
           std::to_string(c[0]) + "," + std::to_string(c[1]) + "," + std::to_string(c[2]));
    }
  }

  static void count(const Frame& frame, FrameReport& report) {
    for (std::size_t i = 0; i < frame.states.size(); ++i)
      for (std::size_t c = 0; c < 3 && frame.states[i] != State::kIgnored; ++c)
        ++report.histogram[c][static_cast<std::size_t>(std::clamp(64 * frame.codes[3 * i + c], 0.0f, 63.0f))];
  }

  // Shares of the sample, and the reference, which stays where it is.
  void judge_exposure(const std::vector<float>& worths) {
    for (std::size_t k = 0; k < out_.reports.size(); ++k) {
      FrameReport& report = out_.reports[k];
      std::size_t well = 0, clipped = 0, black = 0, ignored = 0;
      for (std::size_t i = 0; i < samples_.pixels; ++i) {
        bool is_full = false, is_black = false, is_well = true;
        for (std::size_t c = 0; c < 3; ++c) {
          const float code = samples_.at(i, k, c), value = worths[(i * samples_.frames + k) * 3 + c];
          is_full = is_full || code >= 1;
          is_black = is_black || (value <= 0 && code < 0.5f);
          is_well = is_well && static_cast<double>(value) >= kComparedHat;
        }
        ignored += std::isnan(samples_.at(i, k, 0));
        well += is_well, clipped += is_full, black += is_black;
      }
      const double all = static_cast<double>(samples_.pixels);
      report.well_exposed = static_cast<double>(well) / all;
      report.clipped = static_cast<double>(clipped) / all;
      report.black = static_cast<double>(black) / all;
      report.ignored = static_cast<double>(ignored) / all;
      if (report.well_exposed > out_.reports[out_.reference].well_exposed) out_.reference = k;
    }
    const double to_x = out_.reports[out_.reference].moved_x, to_y = out_.reports[out_.reference].moved_y;
    for (FrameReport& report : out_.reports) report.moved_x -= to_x, report.moved_y -= to_y;
  }

  // The frame as light by the sRGB curve, which shifts do not mind, at most a megapixel; and what of it is well exposed.
  std::pair<image::Picture, std::vector<float>> small_of(const Frame& frame) {
    const double pixels = static_cast<double>(width_) * height_;
    reduction_ = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / 1e6))));
    if (std::min(width_, height_) < 8 * reduction_) reduction_ = 1;
    image::Picture out(width_ / reduction_, height_ / reduction_);
    std::vector<float> shown(out.rgb.size() / 3);
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x) {
        float weight = 1;
        std::array<double, 3> sum{};
        for (int j = 0; j < reduction_; ++j)
          for (int i = 0; i < reduction_; ++i) {
            const std::size_t at = frame.index(x * reduction_ + i, y * reduction_ + j);
            if (frame.states[at] != State::kSeen) weight = 0;
            for (std::size_t c = 0; c < 3; ++c) {
              const double code = static_cast<double>(frame.codes[3 * at + c]);
              if (hat(code) < kComparedHat) weight = 0;
              sum[c] += frame.is_light ? code : image::srgb_decode(code);
            }
          }
        for (std::size_t c = 0; c < 3; ++c) out.at(x, y)[c] = static_cast<float>(sum[c] / (reduction_ * reduction_));
        shown[static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) + static_cast<std::size_t>(x)] = weight;
      }
    return {std::move(out), std::move(shown)};
  }

  void choose_response() {
    const bool all_light = std::ranges::all_of(out_.reports, &FrameReport::is_light);
    out_.weighting = options_.weighting.value_or(all_light ? Weighting::kNoise : Weighting::kDebevec);
    if (all_light) {
      if (options_.recovers) throw files::UsageError("all frames are light; there is no response to recover");
      out_.response = linear_response();
      return;
    }
    if (options_.response) {
      out_.response = *options_.response;
      return;
    }
    if (!options_.recovers && exposures_.back() < 1.07 * exposures_.front()) {
      warn("frames of one exposure do not show their response; sRGB is taken (--response says otherwise)");
      out_.response = srgb_response();
      return;
    }
    Samples codes = samples_;  // light has no response to recover
    for (std::size_t k = 0; k < codes.frames; ++k)
      for (std::size_t i = 0; out_.reports[k].is_light && i < codes.pixels; ++i)
        std::fill_n(codes.codes.data() + 3 * (i * codes.frames + k), 3, std::numeric_limits<float>::quiet_NaN());
    try {
      out_.recovered = recover_response(codes, exposures_);
      out_.response = out_.recovered->response;
    } catch (const files::UsageError& error) {
      if (options_.recovers) throw;
      warn("no response can be recovered (all is black, clipped or seen once); sRGB is taken");
      out_.response = srgb_response();
    }
  }

  std::array<double, 3> logs_of(const Frame& frame, const float* rgb) const {
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c)
      out[c] = log2_exposure(frame.is_light, c, static_cast<double>(rgb[c]), out_.response);
    return out;
  }

  void weigh_evidence() {
    std::vector<float> lights(samples_.codes.size()), worths(samples_.codes.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const bool is_light = out_.reports[i / 3 % samples_.frames].is_light;
      const double code = static_cast<double>(samples_.codes[i]);
      if (std::isnan(code)) continue;
      lights[i] = static_cast<float>(log2_exposure(is_light, i % 3, code, out_.response));
      worths[i] = static_cast<float>(worth(is_light, i % 3, code, out_.response));
    }
    judge_exposure(worths);
    out_.judgement = judge(samples_, lights, worths, exposures_);
    const std::vector<double>& errors = out_.judgement.errors;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const auto size = [&](std::size_t j) { return std::isnan(errors[j]) ? 0 : std::abs(errors[j]); };
      // A wrong time makes its neighbors look half as wrong: the largest of the three is named.
      const bool is_peak = size(k) > kTimeWarning && (k == 0 || size(k) >= size(k - 1)) &&
                           (k + 1 == errors.size() || size(k) > size(k + 1));
      if (is_peak)
        warn(name_of(out_.reports[k]) + " shows " + stops_text(errors[k]) + " stops against its stated exposure of " +
             files::number_text(out_.reports[k].exposure) + " s, judged by its neighbors");
    }
    for (const FrameReport& report : out_.reports)
      if (report.shift && std::isfinite(report.shift->sigma)) {
        const double length = std::hypot(report.shift->dx, report.shift->dy);
        if (length > std::max(kShiftWarning, 3 * report.shift->sigma) && !options_.aligns)
          warn(name_of(report) + " lies " + files::number_text(std::round(10 * length) / 10) +
               " pixels beside the frame before it; --align puts it back");
      }
  }

  // In place of `frame` if it moves.
  Frame placed(Frame frame, const FrameReport& report) const {
    if (report.moved_x == 0 && report.moved_y == 0) return frame;
    return shifted(frame, report.moved_x, report.moved_y);
  }

  void add_frames() {
    pixels_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (std::size_t k = 0; k < out_.reports.size(); ++k) {
      tell("merge " + name_of(out_.reports[k]), out_.reports.size() + k);
      const Frame frame = placed(read(k), out_.reports[k]);
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels_.size(), 1 << 14), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) add(frame, i, exposures_[k]);
      });
    }
  }

  void add(const Frame& frame, std::size_t i, double exposure) {
    if (frame.states[i] == State::kIgnored) return;
    Pixel& pixel = pixels_[i];
    const float* const rgb = frame.codes.data() + 3 * i;
    const bool is_full = frame.states[i] == State::kClipped;
    const std::array<double, 3> logs = logs_of(frame, rgb);
    const double log2_time = std::log2(exposure);
    double least = 1;
    std::array<double, 3> worths{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double code = static_cast<double>(rgb[c]);
      const double value = is_full ? 0 : worth(frame.is_light, c, code, out_.response);
      worths[c] = value;
      least = std::min(least, value);
      pixel.best[c] = std::max(pixel.best[c], static_cast<float>(value));
      Sum& sum = pixel.sums[c];
      const double log_light = logs[c] - log2_time;
      if (!(value > 0)) {
        // A bound, as long as nobody knows better. Of lower bounds the highest holds, of upper ones the lowest; where some
        // frames are black and longer ones full, the light is known to be above what is full.
        if (sum.weight > 0) continue;
        const auto bound = static_cast<float>(std::exp2(log_light));
        if (is_full || code >= 1) {
          sum.light = sum.weight == kFull ? std::max(sum.light, bound) : bound;
          sum.weight = kFull;
        } else if (sum.weight != kFull) {
          sum.light = sum.weight == kBlack ? std::min(sum.light, bound) : bound;
          sum.weight = kBlack;
        }
        continue;
      }
      if (sum.weight <= 0) sum = {};
      const bool is_noise = out_.weighting == Weighting::kNoise;
      const double weight = is_noise ? value * exposure : value;
      sum.light += static_cast<float>(weight * (is_noise ? std::exp2(log_light) : log_light));
      sum.weight += static_cast<float>(weight);
    }
    if (least > 0) ++pixel.frames;
    if (is_full) return;
    const double seen = log2_luminance(logs, worths, log2_time);
    if (!std::isfinite(seen)) return;
    const auto bin = static_cast<std::size_t>(std::clamp(16 * static_cast<double>(rgb[1]), 0.0, 15.0));
    const double reach = options_.ghost_sigmas * out_.judgement.noise[bin];
    pixel.low = std::max(pixel.low, static_cast<float>(seen - reach));
    pixel.high = std::min(pixel.high, static_cast<float>(seen + reach));
  }

  void finish() {
    out_.light = image::Picture(width_, height_);
    const std::size_t count = pixels_.size();
    out_.confidence.resize(count);
    out_.frames.resize(count);
    out_.bound.resize(count);
    out_.ghost.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Pixel& pixel = pixels_[i];
      out_.confidence[i] = std::ranges::min(pixel.best);
      out_.frames[i] = pixel.frames;
      bool is_unknown = true;
      for (std::size_t c = 0; c < 3; ++c) {
        const Sum& sum = pixel.sums[c];
        is_unknown = is_unknown && sum.weight == 0;
        if (sum.weight == kFull) out_.bound[i] = Bound::kLower;
        if (sum.weight == kBlack && out_.bound[i] == Bound::kNone) out_.bound[i] = Bound::kUpper;
        const float mean = sum.weight > 0 ? sum.light / sum.weight : sum.light;
        const float light = sum.weight > 0 && out_.weighting == Weighting::kDebevec ? std::exp2(mean) : mean;
        out_.light.rgb[3 * i + c] = std::isfinite(light) ? light : std::numeric_limits<float>::max();
      }
      out_.unknown += is_unknown;
      out_.clipped_in_all += out_.bound[i] == Bound::kLower;
      out_.black_in_all += out_.bound[i] == Bound::kUpper;
      out_.ghost[i] = pixel.low > pixel.high;
    }
    pixels_ = {};
    widen_ghosts();
    if (options_.deghosts && out_.ghosts > 0 && exposures_.size() > 1) take_reference();
    if (out_.clipped_in_all > 0)
      warn(std::to_string(out_.clipped_in_all) +
           " pixel(s) are clipped in every frame; a shorter exposure would show them");
    if (out_.black_in_all > 0)
      warn(std::to_string(out_.black_in_all) + " pixel(s) are black in every frame; a longer exposure would show them");
  }

  // Lone pixels are noise: what counts has four others among its eight neighbors, and its whole neighborhood is marked.
  void widen_ghosts() {
    const std::vector<std::uint8_t> seen = out_.ghost;
    std::ranges::fill(out_.ghost, 0);
    const auto at = [&](int x, int y) {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    };
    for (int y = 1; y + 1 < height_; ++y)
      for (int x = 1; x + 1 < width_; ++x) {
        if (seen[at(x, y)] == 0) continue;
        int around = 0;
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i) around += seen[at(x + i, y + j)];
        if (around < 5) continue;
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i) out_.ghost[at(x + i, y + j)] = 1;
      }
    out_.ghosts = static_cast<std::size_t>(std::ranges::count(out_.ghost, 1));
  }

  void take_reference() {
    const std::size_t k = out_.reference;
    const Frame frame = placed(read(k), out_.reports[k]);
    for (std::size_t i = 0; i < out_.ghost.size(); ++i) {
      if (out_.ghost[i] == 0 || frame.states[i] != State::kSeen) continue;
      const float* const rgb = frame.codes.data() + 3 * i;
      const double least = std::min(
          {hat(static_cast<double>(rgb[0])), hat(static_cast<double>(rgb[1])), hat(static_cast<double>(rgb[2]))});
      if (!(least > 0)) continue;
      const std::array<double, 3> logs = logs_of(frame, rgb);
      for (std::size_t c = 0; c < 3; ++c)
        out_.light.rgb[3 * i + c] = static_cast<float>(std::exp2(logs[c]) / exposures_[k]);
      out_.confidence[i] = static_cast<float>(least);
      out_.frames[i] = 1;
      out_.ghost[i] = 2;
      ++out_.taken_from_reference;
    }
  }

  const MergeOptions& options_;
  Merged out_;
  std::vector<double> exposures_;
  Samples samples_;
  std::vector<Pixel> pixels_;
  int width_ = 0, height_ = 0, reduction_ = 1;
};

}  // namespace

Merged merge(const MergeOptions& options) { return Merger(options).run(); }

}  // namespace likeness::photograph
