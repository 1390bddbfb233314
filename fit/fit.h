#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "fit/interrupted.h"
#include "fit/measured/measured.h"
#include "fit/result/result.h"

namespace likeness::fit {

// Fits a model to a measured material, together with what it is to be held against: the poorer tiers, Lambert + GGX
// and Disney 2012, fitted with the same loss on the same samples, and the talk's hand set where there is one.
//
// Holds       full <= advanced <= base <= Lambert + GGX in the fitted loss: each tier also starts at the optimum of the
//             poorer one, and keeps it if nothing is better.
//             The same numbers, bit for bit, for any number of threads and any other work of the process.
// name        of the material: looked up among the talk's ten.
// Throws      files::UsageError for options that mean nothing, files::InputError where too few samples are valid,
//             Interrupted when stop() says so.
// begins      is told the label of each model or tier when its fit begins; empty: nobody.
Result fit_material(const measured::Material& material, const std::string& name, const Options& options,
                    const std::function<bool()>& stop = {}, const std::function<void(const std::string&)>& begins = {});

// Names of the models that can be fitted.
std::vector<std::string_view> fitted_models();

// Throws files::UsageError, naming the option, its value and what is allowed.
void check(const Options& options);

// How many starts Options::starts = 0 stands for.
int default_starts(const std::string& model, brdf::Tier tier);

}  // namespace likeness::fit
