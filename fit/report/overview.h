#pragma once

#include <string>
#include <vector>

#include "fit/measured/measured.h"
#include "fit/result/result.h"

// The page that a batch ends with: what was fitted, sorted by the pattern of its slice.
namespace likeness::fit {

// One material of a batch. Plain values, so that a resumed batch can make it from a result file.
struct OverviewRow {
  std::string material;
  std::string label;  // of the fitted candidate
  Metrics metrics;    // of the fitted candidate
  Pattern pattern;
  std::string thumbnail_png;  // base64 of the slice's PNG, or (with a '.' in it) a file relative to the page
  std::string report_href;    // of the report, relative to the page
};

// A file that could not be fitted, and why.
struct FailedFile {
  std::string source, message;
};

// Base64 of the slice of a measured material as a PNG of 90 x 90 pixels, each at an exposure of its own, stated
// on the page.
std::string slice_thumbnail(const measured::Material& material, double cut_deg);

// One self-contained page: a summary, a card for every material, grouped by pattern and sorted by slice_error_pct
// (a script can sort by other measures; the page is whole without it), and the failed files with their messages.
std::string overview_html(const std::vector<OverviewRow>& rows, const std::vector<FailedFile>& failed = {});

}  // namespace likeness::fit
