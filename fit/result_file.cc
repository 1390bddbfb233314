#include "fit/result_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "render/files/files.h"

namespace likeness::fit {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLargestFile = 16 << 20;  // bytes; a result takes about sixty thousand

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json color(const measured::Rgb& c) { return {number(c.r), number(c.g), number(c.b)}; }

const char* name_of(Domain d) { return d == Domain::kSlice ? "slice" : "table"; }
const char* name_of(Loss l) { return l == Loss::kLog ? "log" : "cuberoot"; }

// What decides the numbers of a fit. Threads do not.
Json options_json(const Options& o) {
  return {{"model", o.model},     {"tier", brdf::kTierNames[static_cast<std::size_t>(o.tier)]},
          {"on", name_of(o.on)},  {"loss", name_of(o.loss)},
          {"cut_deg", o.cut_deg}, {"starts", o.starts}};
}

Json metrics_json(const Metrics& m) {
  return {{"slice_error_pct", number(m.slice_error_pct)},
          {"slice_log_rms", number(m.slice_log_rms)},
          {"slice_error_pct_at_grid", number(m.slice_error_pct_at_grid)},
          {"slice_log_rms_at_grid", number(m.slice_log_rms_at_grid)},
          {"log_rms_3d", number(m.log_rms_3d)},
          {"albedo_reference", color(m.albedo_reference)},
          {"albedo_model", color(m.albedo_model)},
          {"albedo_error", color({m.albedo_model.r - m.albedo_reference.r, m.albedo_model.g - m.albedo_reference.g,
                                  m.albedo_model.b - m.albedo_reference.b})},
          {"sphere_psnr_db", number(m.sphere_psnr)},
          {"sphere_ssim", number(m.sphere_ssim)},
          {"slice_samples", m.slice_samples},
          {"slice_grid", m.slice_grid},
          {"table_samples", m.table_samples},
          {"table_stored", m.table_stored}};
}

Metrics metrics_of(const Json& j) {
  Metrics m;
  const auto get = [&](const char* name) { return j.at(name).is_number() ? j.at(name).get<double>() : std::nan(""); };
  const auto rgb = [&](const char* name) {
    const Json& c = j.at(name);
    return measured::Rgb{c.at(0).get<double>(), c.at(1).get<double>(), c.at(2).get<double>()};
  };
  m.slice_error_pct = get("slice_error_pct");
  m.slice_log_rms = get("slice_log_rms");
  m.slice_error_pct_at_grid = get("slice_error_pct_at_grid");
  m.slice_log_rms_at_grid = get("slice_log_rms_at_grid");
  m.log_rms_3d = get("log_rms_3d");
  m.albedo_reference = rgb("albedo_reference");
  m.albedo_model = rgb("albedo_model");
  m.sphere_psnr = get("sphere_psnr_db");
  m.sphere_ssim = get("sphere_ssim");
  m.slice_samples = j.at("slice_samples").get<std::size_t>();
  m.slice_grid = j.at("slice_grid").get<std::size_t>();
  m.table_samples = j.at("table_samples").get<std::size_t>();
  m.table_stored = j.at("table_stored").get<std::size_t>();
  return m;
}

// Every parameter of the model in table order; what a hand set does not estimate is left out.
Json parameters_json(const Candidate& candidate) {
  return std::visit(
      [&](const auto& model) {
        Json out = Json::array();
        brdf::for_each_parameter(model, [&]<class V>(const brdf::Parameter& row, const V& value) {
          Json p{{"name", row.name},
                 {"value", nullptr},
                 {"unit", row.unit},
                 {"bounds", {row.range.low, row.range.high}},
                 {"tier", brdf::kTierNames[static_cast<std::size_t>(row.tier)]}};
          if constexpr (std::is_same_v<V, double>) {
            p["value"] = value;
          } else {
            p["value"] = color(value);
          }
          Json sigma = Json::array(), at_bound = Json::array(), matters = Json::array();
          std::string why;
          bool fitted = false;
          for (const Estimate& e : candidate.estimates) {
            if (e.name != row.name) continue;
            sigma.push_back(number(e.sigma));
            at_bound.push_back(e.at_bound);
            matters.push_back(e.matters);
            fitted = fitted || e.fitted;
            if (!e.why.empty()) why = e.why;
          }
          if (!sigma.empty()) {
            const bool one = sigma.size() == 1;
            p["fitted"] = fitted;
            p["sigma"] = one ? sigma[0] : sigma;
            p["at_bound"] = one ? at_bound[0] : at_bound;
            p["matters"] = one ? matters[0] : matters;
            if (!why.empty()) p["does_not_matter_because"] = why;
          }
          out.push_back(std::move(p));
        });
        return out;
      },
      candidate.brdf);
}

Json candidate_json(const Candidate& c) {
  Json steps = Json::array(), starts = Json::array();
  for (const Step& s : c.convergence) steps.push_back(number(s.loss));
  for (const double loss : c.start_losses) starts.push_back(number(loss));
  return {{"label", c.label},
          {"model", brdf::kModelNames[c.brdf.index()]},
          {"loss", number(c.loss)},
          {"metrics", metrics_json(c.metrics)},
          {"parameters", parameters_json(c)},
          {"best_start", c.best_start},
          {"losses_of_starts", starts},
          {"losses_of_steps", steps},
          {"cpu_seconds", c.cpu_seconds}};
}

}  // namespace

std::string result_json(const Result& r) {
  Json j{{"format", "likeness fit result"},
         {"version", LIKENESS_VERSION},
         {"material", r.material},
         {"input",
          {{"file", r.source},
           {"sha256", r.sha256},
           {"format", measured::kFormatNames[static_cast<std::size_t>(r.format)]},
           {"samples_stored", r.coverage.stored},
           {"samples_valid", r.coverage.valid},
           {"samples_negative", r.coverage.negative},
           {"samples_not_finite", r.coverage.not_finite}}},
         {"options", options_json(r.options)},
         {"best", candidate_json(r.best)},
         {"pattern",
          {{"group", r.pattern.group},
           {"fresnel_stops", number(r.pattern.fresnel_stops)},
           {"retroreflection_stops", number(r.pattern.retroreflection_stops)},
           {"corner_stops", number(r.pattern.corner_stops)}}},
         {"notes", r.notes},
         {"baselines", Json::array()},
         {"hand_sets", Json::array()},
         {"cpu_seconds",
          {{"load", r.timing.load},
           {"fit", r.timing.fit},
           {"baselines", r.timing.baselines},
           {"metrics", r.timing.metrics},
           {"report", r.timing.report}}}};
  for (const Candidate& c : r.baselines) j["baselines"].push_back(candidate_json(c));
  for (const auto* c : {&r.hand_set, &r.hand_set_disney})
    if (c->has_value()) j["hand_sets"].push_back(candidate_json(**c));
  // Names of files need not be UTF-8; what is not is replaced rather than refused.
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string batch_json(const BatchResult& batch, const std::filesystem::path& out) {
  Json materials = Json::array(), failed = Json::array();
  for (const OverviewRow& row : batch.rows)
    materials.push_back({{"material", row.material},
                         {"label", row.label},
                         {"metrics", metrics_json(row.metrics)},
                         {"pattern", row.pattern.group},
                         {"result", (out / (row.material + ".fit.json")).string()},
                         {"report", (out / (row.material + ".html")).string()}});
  for (const FailedFile& f : batch.failed) failed.push_back({{"file", f.source}, {"error", f.message}});
  const Json j{{"format", "likeness fit batch"}, {"version", LIKENESS_VERSION},
               {"materials", materials},         {"failed", failed},
               {"taken_over", batch.taken_over}, {"overview", (out / "index.html").string()}};
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<OverviewRow> finished_row(const std::filesystem::path& file, const std::string& sha256,
                                        const Options& options) {
  std::error_code missing;
  if (!std::filesystem::is_regular_file(file, missing)) return std::nullopt;
  try {
    const Json j = Json::parse(files::read_whole(file, kLargestFile));
    if (j.at("version") != LIKENESS_VERSION || j.at("input").at("sha256") != sha256 ||
        j.at("options") != options_json(options))
      return std::nullopt;
    OverviewRow row;
    row.material = j.at("material").get<std::string>();
    row.label = j.at("best").at("label").get<std::string>();
    row.metrics = metrics_of(j.at("best").at("metrics"));
    const Json& p = j.at("pattern");
    row.pattern.group = p.at("group").get<std::string>();
    row.pattern.fresnel_stops = p.at("fresnel_stops").get<double>();
    row.pattern.retroreflection_stops = p.at("retroreflection_stops").get<double>();
    row.pattern.corner_stops = p.at("corner_stops").get<double>();
    return row;
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const files::InputError&) {
    return std::nullopt;
  }
}

}  // namespace likeness::fit
