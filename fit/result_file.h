#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fit/batch.h"

namespace likeness::fit {

// The result of a fit as JSON: every parameter with its tier, unit, bounds and uncertainty, the metrics of every
// candidate with their definitions' cut and grid, the input's hash, the options and the version. docs/fit.md lists
// the fields. Numbers have as many digits as bring back the same double; what is undefined (NaN) is null.
std::string result_json(const Result& result);

// The summary of a batch as JSON: a row a material with its files and metrics, and the files that failed.
std::string batch_json(const BatchResult& batch, const std::filesystem::path& out);

// What a resumed batch needs of a result file: whether it is of this input, these options and this version, and the
// row of the overview page. Empty where the file is absent, damaged or of something else: then the fit is done again.
std::optional<OverviewRow> finished_row(const std::filesystem::path& file, const std::string& sha256,
                                        const Options& options);

}  // namespace likeness::fit
