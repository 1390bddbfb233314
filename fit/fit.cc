#include "fit/fit.h"

#include <array>
#include <cmath>
#include <sstream>

#include "fit/coordinates.h"
#include "fit/cpu_clock.h"
#include "fit/hand_sets.h"
#include "fit/metrics.h"
#include "fit/multi_start.h"
#include "fit/pattern.h"
#include "fit/uncertainty.h"
#include "render/files/files.h"

namespace likeness::fit {

namespace {

using brdf::AnyBrdf;
using brdf::Tier;

std::string list_of(const std::vector<std::string_view>& names) {
  std::string list;
  for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

AnyBrdf model_named(const std::string& name) {
  AnyBrdf model;
  const std::vector<std::string_view> known = fitted_models();
  if (!brdf::model_of_name(name, model)) {
    const std::string near = files::nearest_name(name, known.data(), known.size());
    throw files::UsageError("--model " + name + " is not one of " + list_of(known) +
                            (near.empty() ? "" : "; did you mean " + near + "?"));
  }
  if (!brdf::kFittedModels[model.index()])
    throw files::UsageError("--model " + name + " is a model that is not fitted; those that are: " + list_of(known));
  return model;
}

std::string label_of(const AnyBrdf& model, Tier tier) {
  const std::string name(brdf::kModelNames[model.index()]);
  if (name == "callisto")
    return tier == Tier::kPlain
               ? "Lambert + GGX"
               : "Callisto, " + std::string(brdf::kTierNames[static_cast<std::size_t>(tier)]) + " tier";
  if (name == "disney2012") return "Disney 2012";
  if (name == "ggx") return "GGX";
  if (name == "lambert") return "Lambert";
  if (name == "oren_nayar") return "Oren-Nayar, Fujii";
  if (name == "oren_nayar_1994") return "Oren-Nayar 1994";
  if (name == "proxima") return "Proxima";
  return "Burley diffuse";
}

// One model or tier fitted; also its folded channels, from which a richer tier starts.
struct Fitted {
  Candidate candidate;
  std::vector<double> channels;
};

// What is fitted: the chain from Lambert + GGX up to what was asked for, then the baselines outside the chain.
struct Task {
  AnyBrdf model;
  Tier tier;
  int starts;
  bool in_chain;  // starts at the optimum of the one before, and is never worse
};

struct Work {
  const SampleSet& samples;
  const std::function<bool()>& stop;
  const std::function<void(const std::string&)>& begins;

  // `poorer`: the optimum this one may not fall behind. `before`: its own optimum on another reading of the same
  // samples, from which it goes on without drawing starts again.
  Fitted fit(const Task& task, const Fitted* poorer, const Fitted* before) const {
    if (begins && before == nullptr) begins(label_of(task.model, task.tier));
    const Coordinates coordinates = coordinates_of(task.model, task.tier);
    MultiStart how{.starts = before == nullptr ? task.starts : 0, .warm = {}, .stop = stop};
    if (poorer != nullptr) how.warm.push_back(poorer->channels);
    if (before != nullptr) how.warm.push_back(before->channels);
    Optimum optimum = minimise(samples, coordinates, how);
    // Equal to the poorer tier within rounding: keep that one's very numbers.
    if (poorer != nullptr && !(optimum.loss < poorer->candidate.loss)) {
      optimum.channels = poorer->channels;
      optimum.loss = poorer->candidate.loss;
    }
    Fitted out;
    out.channels = optimum.channels;
    Candidate& c = out.candidate;
    if (before != nullptr) c = before->candidate;
    c.label = label_of(task.model, task.tier);
    c.brdf = unfolded(task.model.index(), optimum.channels);
    c.loss = optimum.loss;
    c.convergence = std::move(optimum.steps);
    if (before == nullptr) {
      c.start_losses = std::move(optimum.start_losses);
      c.best_start = optimum.best_start;
    }
    c.cpu_seconds += optimum.cpu_seconds;
    c.estimates = estimates_of(samples, coordinates, optimum.channels);
    return out;
  }

  std::vector<Fitted> fit_all(const std::vector<Task>& tasks, const std::vector<Fitted>* before) const {
    std::vector<Fitted> out;
    for (std::size_t i = 0; i < tasks.size(); ++i)
      out.push_back(fit(tasks[i], tasks[i].in_chain && i > 0 ? &out.back() : nullptr,
                        before == nullptr ? nullptr : &(*before)[i]));
    return out;
  }
};

Candidate by_hand(const SampleSet& samples, const std::string& label, const AnyBrdf& model) {
  Candidate c;
  c.label = label;
  c.brdf = model;
  c.loss = exact_loss(samples, model.index(), folded(model));
  return c;
}

std::vector<Task> tasks_of(const AnyBrdf& model, const Options& options) {
  std::vector<Tier> tiers{Tier::kPlain};
  const bool tiered = has_tier(model, Tier::kFull);
  if (tiered)
    for (const Tier tier : {Tier::kBase, Tier::kAdvanced, Tier::kFull})
      if (static_cast<int>(tier) <= static_cast<int>(options.tier)) tiers.push_back(tier);
  std::vector<Task> tasks;
  for (const Tier tier : tiers) {
    const int own = default_starts(options.model, tier);
    const int asked = options.starts == 0 ? own : options.starts;
    tasks.push_back({model, tier, tier == tiers.back() ? asked : std::min(own, asked), true});
  }
  if (!tiered)
    tasks.push_back({brdf::Callisto<double>{}, Tier::kPlain, default_starts("callisto", Tier::kPlain), false});
  if (options.model != "disney2012")
    tasks.push_back({brdf::Disney2012<double>{}, Tier::kPlain, default_starts("disney2012", Tier::kPlain), false});
  return tasks;
}

// What the fitted samples did not show. The standard slice ends half a degree from the mirror direction: a lobe that is
// narrower is known from its foot alone, and may carry more light, or less, than the material's.
std::vector<std::string> notes_of(const Result& result) {
  std::vector<std::string> notes;
  const Metrics& m = result.best.metrics;
  const double model[3] = {m.albedo_model.r, m.albedo_model.g, m.albedo_model.b};
  const double reference[3] = {m.albedo_reference.r, m.albedo_reference.g, m.albedo_reference.b};
  int worst = 0;
  for (int c = 1; c < 3; ++c)
    if (std::abs(model[c] - reference[c]) > std::abs(model[worst] - reference[worst])) worst = c;
  if (std::abs(model[worst] - reference[worst]) > 0.2 * reference[worst] + 0.01) {
    std::ostringstream text;
    text.precision(2);
    text << "The fit reflects " << model[worst] << " of the light where the material reflects " << reference[worst]
         << " (" << std::array{"red", "green", "blue"}[static_cast<std::size_t>(worst)] << ", bihemispherical).";
    if (result.options.on == Domain::kSlice)
      text << " The standard slice does not see the last half degree around the mirror direction; to render with this"
              " material, fit every sample: --on table.";
    notes.push_back(text.str());
  }
  if (m.slice_samples * 2 < m.slice_grid)
    notes.push_back("Only " + std::to_string(m.slice_samples) + " of the slice's " + std::to_string(m.slice_grid) +
                    " samples have valid data within the cut.");
  return notes;
}

}  // namespace

std::vector<std::string_view> fitted_models() {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < brdf::kModelNames.size(); ++i)
    if (brdf::kFittedModels[i]) names.push_back(brdf::kModelNames[i]);
  return names;
}

void check(const Options& options) {
  const AnyBrdf model = model_named(options.model);
  if (options.tier != Tier::kPlain && options.tier != Tier::kFull && !has_tier(model, options.tier))
    coordinates_of(model, options.tier);  // says what is wrong
  if (!(options.cut_deg >= 20 && options.cut_deg <= 90))
    throw files::UsageError("--cut " + std::to_string(options.cut_deg) + " is outside [20, 90] degrees; 80 is usual");
  if (options.starts < 0 || options.starts > 100000)
    throw files::UsageError("--starts " + std::to_string(options.starts) +
                            " is outside [0, 100000]; 0 takes the model's own number");
  if (options.threads < 0 || options.threads > 1024)
    throw files::UsageError("--threads " + std::to_string(options.threads) +
                            " is outside [0, 1024]; 0 takes one a core");
}

int default_starts(const std::string& model, Tier tier) {
  if (model == "callisto" && tier == Tier::kFull) return 64;
  if (model == "callisto" && tier == Tier::kAdvanced) return 24;
  return 12;
}

Result fit_material(const measured::Material& material, const std::string& name, const Options& options,
                    const std::function<bool()>& stop, const std::function<void(const std::string&)>& begins) {
  check(options);
  const AnyBrdf model = model_named(options.model);
  Result result;
  result.material = name;
  result.source = material.source;
  result.format = material.format();
  result.coverage = material.coverage();
  result.options = options;

  double began = thread_cpu_seconds();
  const auto lap = [&] {
    const double now = thread_cpu_seconds(), spent = now - began;
    began = now;
    return spent;
  };
  const Reference reference(material, options.cut_deg);
  SampleSet samples = sample_set(material, reference.slice(), options, Reading::kStored);
  result.timing.load += lap();

  const std::vector<Task> tasks = tasks_of(model, options);
  std::size_t asked_for = 0;
  while (asked_for + 1 < tasks.size() && tasks[asked_for + 1].in_chain) ++asked_for;
  std::vector<Fitted> fitted = Work{samples, stop, begins}.fit_all(tasks, nullptr);

  // A table of bins says what f is at a bin's centre, and is asked at the grid's directions, up to half a bin away. A
  // model that comes nearer to the table than the half bins are wide is held against the centres alone, and can be
  // exact; any other is held against both, so that neither way of measuring it finds it at a loss.
  if (options.on == Domain::kSlice) {
    const AnyBrdf& best = fitted[asked_for].candidate.brdf;
    const double half_bins = half_bin_error_pct(reference.slice(), best);
    if (half_bins > 0 && slice_metrics(reference.slice(), best).slice_error_pct > half_bins) {
      samples = sample_set(material, reference.slice(), options, Reading::kBoth);
      fitted = Work{samples, stop, begins}.fit_all(tasks, &fitted);
    }
  }
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    Candidate& c = fitted[i].candidate;
    (i == asked_for ? result.timing.fit : result.timing.baselines) += c.cpu_seconds;
    if (i == asked_for) result.best = std::move(c);
    else result.baselines.push_back(std::move(c));
  }
  if (const auto hand = hand_set_of(name)) {
    result.hand_set = by_hand(samples, "Callisto, talk's hand set", hand->callisto);
    result.hand_set_disney = by_hand(samples, "Disney 2012, talk's hand set", hand->disney);
  }

  lap();
  result.best.metrics = reference.of(result.best.brdf);
  for (Candidate& c : result.baselines) c.metrics = reference.of(c.brdf);
  if (result.hand_set) result.hand_set->metrics = reference.of(result.hand_set->brdf);
  if (result.hand_set_disney) result.hand_set_disney->metrics = reference.of(result.hand_set_disney->brdf);
  result.pattern = pattern_of(result.best.brdf);
  result.notes = notes_of(result);
  result.timing.metrics = lap();
  return result;
}

}  // namespace likeness::fit
