#include "olat/check/check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <set>

#include "olat/check/facts.h"
#include "olat/check/finder.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"

namespace likeness::olat_check {
namespace {

using capture::Capture;
using capture::Frame;
using capture::FrameKind;
using capture::kAbsent;

constexpr std::size_t kShiftLights = 24;  // of a camera, evenly drawn: they all see the same shift
constexpr std::size_t kFewestLights = 4;  // for what compares lights with each other

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string per_cent(double share) { return number(100 * share) + " %"; }

// The findings of one photo and its render.
void judge_pair(const Capture& capture, const Finder& finder, std::size_t camera, const Facts& f) {
  const Frame& frame = capture.frames[f.frame];
  const Finder::Place place{camera, f.light, frame.file.string()};
  const capture::Camera& of = capture.cameras[camera];
  if (!f.sha256.empty())
    finder.report(
        Rule::kSha256, place, 1,
        "its SHA-256 is " + f.sha256.substr(0, 12) + "..., frames.json has " + frame.sha256.substr(0, 12) + "...");
  if (f.attributes_ev > 0) finder.judge(Rule::kExposureAttributes, place, f.attributes_ev, f.attributes);
  if (f.size) {
    finder.report(Rule::kSize, place, std::abs((*f.size)[0] - of.width) + std::abs((*f.size)[1] - of.height),
                  "has " + std::to_string((*f.size)[0]) + " x " + std::to_string((*f.size)[1]) +
                      " pixels, the camera " + std::to_string(of.width) + " x " + std::to_string(of.height));
    return;
  }
  if (!f.unreadable.empty()) return finder.report(Rule::kUnreadable, place, 1, f.unreadable);
  finder.judge(Rule::kNotFinite, place, static_cast<double>(f.not_finite),
               std::to_string(f.not_finite) + " pixels are NaN or infinite");
  const double clipped = f.inside > 0 ? static_cast<double>(f.clipped) / static_cast<double>(f.inside) : 0;
  finder.judge(Rule::kClipped, place, clipped, per_cent(clipped) + " of the subject is clipped");
  if (!f.render_unreadable.empty()) finder.report(Rule::kUnreadable, place, 1, f.render_unreadable);
  if (!f.render_header.empty()) finder.report(Rule::kRenderOfOther, place, 1, f.render_header);
  finder.judge(Rule::kRenderNotFinite, place, static_cast<double>(f.render_not_finite),
               std::to_string(f.render_not_finite) + " pixels of the render are NaN or infinite");
}

// Everything about the photos of one camera.
struct Lights {
  const Capture& capture;
  const Finder& finder;
  std::size_t camera;
  const View& view;
  std::vector<const Facts*> facts;    // of the photos that were read
  std::set<std::size_t> misplaced{};  // lights whose photo is another's: what else is said of them is not theirs

  bool is_rendered() const { return std::ranges::any_of(facts, &Facts::has_render); }

  template <class Value>
  std::vector<double> values(const Value& value) const {
    std::vector<double> out;
    for (const Facts* f : facts)
      if (const std::optional<double> v = value(*f)) out.push_back(*v);
    return out;
  }

  void black_level() const {
    // Black is somewhere in some photo, or nowhere; the light that has most of it says how black it is.
    const std::vector<double> shares = values([](const Facts& f) -> std::optional<double> {
      double worst = 0;
      for (std::size_t c = 0; c < 3; ++c)
        if (f.darkness.bright[c] > 0) {
          const double share = f.darkness.level[c] / f.darkness.bright[c];
          if (std::abs(share) > std::abs(worst)) worst = share;
        }
      return worst;
    });
    if (shares.empty()) return;
    const double least = *std::ranges::min_element(shares, {}, [](double share) { return std::abs(share); });
    const bool is_below = least < -row_of(Rule::kBlackLevel).allowed;
    finder.measured(Rule::kBlackLevel, {camera}, std::abs(least),
                    "the darkest part of every photo is at least " + per_cent(least) + " of its brightest percent" +
                        (is_below ? ": too much was subtracted" : ""));
  }

  void noise_floor() const {
    if (camera >= capture.noise_floor.size()) return;
    for (int c = 0; c < 3; ++c) {
      const double stated = capture.noise_floor[camera][c];
      std::vector<double> measured =
          values([c](const Facts& f) { return std::optional(f.darkness.noise[static_cast<std::size_t>(c)]); });
      if (!(stated > 0) || measured.empty()) continue;
      const double found = median(measured);
      if (!(found > 0)) continue;
      const double off = std::log2(found / stated);
      finder.judge(Rule::kNoiseFloor, {camera}, std::abs(off),
                   std::string("of ") + "RGB"[c] + " is " + number(stated) + "; the photos have " + number(found));
    }
  }

  // Off the median light, in stops of red or blue over green: against the renders, or else of the mean color.
  void white_balance() const {
    const bool rendered = is_rendered();
    const auto tint = [&](const Facts& f, std::size_t c) -> std::optional<double> {
      if (misplaced.contains(f.light)) return {};
      if (f.gain.pixels > 0) return f.gain.stops[c] - f.gain.stops[1];
      if (!rendered && f.mean[c] > 0 && f.mean[1] > 0) return std::log2(f.mean[c] / f.mean[1]);
      return {};
    };
    for (const std::size_t c : {std::size_t{0}, std::size_t{2}}) {
      const std::vector<double> all = values([&](const Facts& f) { return tint(f, c); });
      if (all.size() < kFewestLights) continue;
      const double middle = median(all);
      for (const Facts* f : facts)
        if (const auto value = tint(*f, c)) {
          const double off = *value - middle;
          finder.judge(
              Rule::kWhiteBalance, {camera, f->light}, std::abs(off),
              std::string(c == 0 ? "red" : "blue") + " over green is " + number(off) + " stops off the median light");
        }
    }
  }

  void light_gain() const {
    const auto gain = [&](const Facts& f) {
      return f.gain.pixels > 0 && !misplaced.contains(f.light) ? std::optional(f.gain.all) : std::nullopt;
    };
    const std::vector<double> all = values(gain);
    if (all.empty()) return;
    const double middle = median(all);
    for (const Facts* f : facts)
      if (const auto value = gain(*f)) {
        const double off = *value - middle;
        finder.judge(Rule::kLightGain, {camera, f->light}, std::abs(off),
                     "the photo is " + number(std::abs(off)) + " stops " + (off > 0 ? "brighter" : "darker") +
                         " than under the median light, against the renders");
      }
  }

  void transfer_curve() const {
    const std::vector<double> all =
        values([](const Facts& f) { return f.curve.pixels > 0 ? std::optional(f.curve.exponent) : std::nullopt; });
    if (all.empty())
      return finder.leave_out(Rule::kTransferCurve, camera, "no renders, and no normals with directions of lights");
    const double middle = median(all);
    const double off = std::abs(middle - 1);
    const bool is_found = off > row_of(Rule::kTransferCurve).allowed;
    finder.measured(Rule::kTransferCurve, {camera}, off,
                    "photos go with the light to the power of " + number(middle) +
                        (!is_found    ? ""
                         : middle < 1 ? "; 0.45 is a curve that was not undone"
                                      : "; 2.2 is a curve undone twice"));
  }

  void mirrored() const {
    std::vector<registration::Sketch> photos;
    std::vector<std::array<double, 3>> directions;
    if (view.normals)
      for (const Facts* f : facts)
        if (const auto to_light = to_light_of(capture.lights[f->light])) {
          photos.push_back(f->sketch);
          directions.push_back(*to_light);
        }
    if (photos.size() < kFewestLights)
      return finder.leave_out(Rule::kMirrored, camera,
                              view.normals ? "fewer than 4 lights have a direction" : "the camera has no normals");
    const registration::Mirror mirror = registration::mirror_of(*view.normals, view.mask, photos, directions);
    finder.measured(
        Rule::kMirrored, {camera}, mirror.found - mirror.own,
        "photos correlate with N.L by " + number(mirror.own) +
            (mirror.flips == 0 ? ", and less with any sign turned over"
                               : "; with the sign of " + std::string(registration::flips_text(mirror.flips)) +
                                     " turned over by " + number(mirror.found)));
  }

  void light_order() {
    std::vector<registration::Sketch> photos, references;
    std::vector<std::size_t> lights;
    for (const Facts* f : facts)
      if (f->has_reference) {
        photos.push_back(f->sketch);
        references.push_back(f->reference);
        lights.push_back(f->light);
      }
    if (photos.size() < kFewestLights)
      return finder.leave_out(Rule::kLightOrder, camera,
                              "fewer than 4 lights have a render, or normals and a direction");
    // A cosine is a poor render: a highlight may make another light fit better.
    const double extra = is_rendered() ? 0 : 0.15;
    for (const auto& m : registration::misplaced(photos, references)) {
      const double gained = m.found - m.own;
      if (!(gained > row_of(Rule::kLightOrder).allowed + extra)) continue;
      misplaced.insert(lights[m.photo]);
      finder.report(Rule::kLightOrder, {camera, lights[m.photo]}, gained,
                    "the photo looks like light " + capture.lights[lights[m.render]].id + " (correlation " +
                        number(m.found) + ", with its own " + number(m.own) + ")");
    }
  }

  void renders() const {
    std::vector<std::string> missing, stale;
    std::vector<registration::Shift> shifts;
    std::size_t rendered = 0;
    for (const Facts* f : facts) {
      rendered += f->has_render ? 1 : 0;
      const std::string& id = capture.lights[f->light].id;
      if (!f->has_render && f->render_unreadable.empty()) missing.push_back(id);
      if (f->is_stale) stale.push_back(id);
      if (!misplaced.contains(f->light)) shifts.push_back(f->shift);
    }
    finder.judge(Rule::kMissingRender, {camera}, static_cast<double>(missing.size()),
                 std::to_string(missing.size()) + " of " + std::to_string(facts.size()) +
                     " photos have no render: " + some_of(missing));
    finder.judge(
        Rule::kStaleRender, {camera}, static_cast<double>(stale.size()),
        std::to_string(stale.size()) + " renders are older than cameras.json or lights.json: " + some_of(stale));
    if (rendered == 0) return;
    const registration::Shift shift = registration::combined(shifts);
    if (!shift.is_measured()) return finder.leave_out(Rule::kShift, camera, "nothing in the pictures shows one");
    // What may be chance is told, and is no finding.
    const double sure = shift.length() > 3 * shift.sigma() ? shift.length() : 0;
    finder.measured(Rule::kShift, {camera}, sure,
                    "photos lie " + number(std::abs(shift.x)) + " pixels to the " + (shift.x < 0 ? "left" : "right") +
                        " of and " + number(std::abs(shift.y)) + (shift.y < 0 ? " above" : " below") +
                        " their renders (sigma " + number(shift.sigma()) + ")");
  }
};

View view_of(const Capture& capture, const Finder& finder, std::size_t camera) {
  View view;
  const capture::Camera& of = capture.cameras[camera];
  const auto size = static_cast<std::size_t>(of.width) * static_cast<std::size_t>(of.height);
  view.mask.assign(size, 1.0f);
  const auto attempt = [&](const auto& read) {
    try {
      read();
    } catch (const files::InputError& error) {
      finder.report(Rule::kUnreadable, {camera}, 1, error.what());
    }
  };
  attempt([&] {
    const std::vector<std::uint8_t> mask = capture::read_mask(capture, camera);
    for (std::size_t i = 0; i < size; ++i) view.mask[i] = mask[i] != 0 ? 1.0f : 0.0f;
  });
  if (!capture::layer_file(capture, camera, capture::Layer::kNormal).empty())
    attempt([&] { view.normals = capture::read_normals(capture, camera); });
  view.inside = static_cast<std::size_t>(std::ranges::count(view.mask, 1.0f));
  if (view.inside == 0) finder.report(Rule::kEmptyMask, {camera}, 1, "no pixel is inside");
  return view;
}

}  // namespace

Report run_check(const Capture& capture, const Options& options) {
  Report report;
  const Finder finder(capture, report);
  const capture::Variant* variant = nullptr;
  if (!options.variant.empty()) {
    const std::size_t at = capture::variant_of(capture, options.variant);
    if (at == kAbsent) {
      std::vector<std::string_view> names;
      for (const auto& one : capture.variants) names.push_back(one.id);
      const std::string near = files::nearest_name(options.variant, names.data(), names.size());
      throw files::UsageError("the capture has no variant " + files::in_quotes(options.variant) +
                              (near.empty() ? "; capture.json lists what there is" : "; did you mean " + near + "?"));
    }
    variant = &capture.variants[at];
  } else if (const std::size_t at = capture::rendered_variant_of(capture); at != kAbsent) {
    variant = &capture.variants[at];
  }
  check_lists(capture, finder);

  const capture::FrameTable table(capture);
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  const auto all = static_cast<double>(std::max<std::size_t>(1, capture.frames.size()));
  bool any_render = false;
  for (std::size_t camera = 0; camera < capture.cameras.size() && !stop; ++camera) {
    const View view = view_of(capture, finder, camera);
    std::vector<Request> requests;
    for (std::size_t light = 0; light < capture.lights.size(); ++light)
      if (const std::size_t frame = table.frame(camera, light); frame != kAbsent)
        requests.push_back({frame, variant, options.reads_hashes, true});
    const std::size_t stride = (requests.size() + kShiftLights - 1) / kShiftLights;
    for (std::size_t i = 0; i < requests.size(); ++i) requests[i].measures_shift = i % stride == 0;
    std::vector<Facts> facts(requests.size());
    tbb::parallel_for(std::size_t{0}, requests.size(), [&](std::size_t i) {
      if (stop) return;
      facts[i] = facts_of(capture, view, requests[i]);
      const double share = static_cast<double>(++done) / all;
      const std::scoped_lock lock(mutex);
      if (options.keep_going && !options.keep_going("check " + capture.cameras[camera].id, share)) stop = true;
    });
    if (stop) break;
    Lights lights{capture, finder, camera, view, {}, {}};
    for (const Facts& f : facts) {
      judge_pair(capture, finder, camera, f);
      if (!f.unreadable.empty()) continue;
      lights.facts.push_back(&f);
      ++report.photos;
      report.renders += f.has_render ? 1 : 0;
    }
    any_render = any_render || lights.is_rendered();
    lights.black_level();
    lights.noise_floor();
    lights.light_order();
    lights.white_balance();
    lights.transfer_curve();
    lights.mirrored();
    if (lights.is_rendered()) {
      lights.light_gain();
      lights.renders();
    }
  }
  report.is_complete = !stop;
  if (any_render) report.variant = variant->id;
  if (!any_render && !stop)
    for (const RuleRow& row : kRules)
      if (row.needs == Needs::kRenders)
        finder.leave_out(
            static_cast<Rule>(&row - kRules.data()), kAbsent,
            variant == nullptr ? "the capture has no renders" : "variant " + variant->id + " has no renders");
  if (!options.reads_hashes)
    for (const Rule rule : {Rule::kSha256, Rule::kExposureAttributes}) finder.leave_out(rule, kAbsent, "--no-hash");
  std::ranges::stable_sort(report.findings, {}, [](const Finding& f) { return f.rule; });
  std::ranges::stable_sort(report.not_checked, {}, [](const NotChecked& n) { return n.rule; });
  return report;
}

}  // namespace likeness::olat_check
