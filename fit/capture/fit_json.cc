#include <cmath>

#include <nlohmann/json.hpp>

#include "fit/capture/report.h"

namespace likeness::capture_fit {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

}  // namespace

std::string fit_json(const capture::Capture& capture, const Fit& fit, const Asked& asked) {
  const Counts& c = fit.counts;
  const Residuals& r = fit.residuals;
  Json j{{"format", "likeness capture fit"},
         {"version", LIKENESS_VERSION},
         {"capture", asked.capture},
         {"camera", capture.cameras[fit.camera].id},
         {"command", asked.command},
         {"normals", kNormalSources[static_cast<std::size_t>(fit.normals_from)]},
         {"seed", asked.options.seed},
         {"exposure", fit.exposure},
         {"counts",
          {{"lights", c.lights},
           {"light_directions", c.light_directions},
           {"pixels", c.pixels},
           {"without_normal", c.without_normal},
           {"seen_by_none", c.seen_by_none},
           {"seen_by_few", c.seen_by_few},
           {"in_one_plane", c.in_one_plane},
           {"without_color", c.without_color},
           {"samples", c.samples},
           {"clipped", c.clipped},
           {"not_finite", c.not_finite},
           {"negative", c.negative},
           {"bands", c.bands}}},
         {"residuals",
          {{"lambert_loss", number(r.lambert_loss)},
           {"callisto_loss", number(r.callisto_loss)},
           {"lambert_rms", number(r.lambert_rms)},
           {"callisto_rms", number(r.callisto_rms)},
           {"scale", number(r.scale)}}},
         {"parameters", Json::array()},
         {"losses_of_steps", Json::array()},
         {"notes", fit.notes},
         {"seconds",
          {{"read", fit.read_seconds},
           {"curve", fit.normal_seconds},
           {"material", fit.material_seconds},
           {"pixels", fit.color_seconds}}}};
  for (const fit::Estimate& e : fit.estimates) {
    Json row{{"name", e.name},
             {"value", number(e.value)},
             {"fitted", e.fitted},
             {"sigma", number(e.sigma)},
             {"at_bound", e.at_bound}};
    if (e.channel >= 0) row["channel"] = e.channel;
    if (!e.why.empty()) row["why"] = e.why;
    j["parameters"].push_back(std::move(row));
  }
  for (const fit::Step& step : fit.convergence) j["losses_of_steps"].push_back(number(step.loss));
  // Names of files need not be UTF-8; what is not is replaced rather than refused.
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace likeness::capture_fit
