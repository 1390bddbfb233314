#pragma once

#include <filesystem>
#include <string>

#include "olat/pair/state.h"
#include "render/capture/capture.h"

// A comparison as one file that can be mailed: the viewer's own page, with the worst pairs in it as half floats.
namespace likeness::olat_view {

struct ReportOptions {
  std::string variant{};         // empty: the first
  std::string metric = "stops";  // by which pairs are ranked
  int pairs = 5;                 // that the report holds, the worst ones
  int side = 512;                // of their crops, at full resolution, around the largest error [pixel]
};

struct ReportSummary {
  std::size_t compared = 0, held = 0;  // pairs
  std::size_t bytes = 0;
};

// Compares every pair that has a photo and a render, and writes the page. It asks for nothing from a network and opens
// from a file. Throws files::InputError: nothing to compare, a damaged file; files::Interrupted, with nothing written.
ReportSummary write_report(const capture::Capture& capture, const ReportOptions& options,
                           const std::filesystem::path& out);

}  // namespace likeness::olat_view
