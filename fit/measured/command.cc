#include "fit/measured/command.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "fit/measured/convert.h"

namespace likeness::measured {

void add_convert(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* convert =
      program.add_subcommand("convert", "Write a measured material as MERL .binary or CSV, and say what was lost");
  convert->footer(
      "Reads MERL .binary, NVIDIA .mbsdf, RGL .bsdf (isotropic, RGB) and CSV; the kind is told from the content.\n"
      "\n"
      "  likeness convert paint.mbsdf paint.binary    a table that most tools read: 90 x 90 x 180 bins, 35 MB\n"
      "  likeness convert leather.bsdf leather.csv    the stored samples, one a row, with their weights\n"
      "\n"
      "A .binary holds the source's interpolant at the centres of its bins, and 'not measured' where the source has\n"
      "no data. A .csv holds the samples as they were stored, in the columns\n"
      "\n"
      "  theta_i,theta_o,phi,r,g,b[,weight]           radians; theta_i_deg and so on for degrees\n"
      "\n"
      "in which you can also write your own measurements. The report reads the written file back at every sample of\n"
      "the source: a large difference near a sharp highlight means that the bins are wider than the highlight.\n"
      "\n"
      "Exit codes: 0 done, 2 usage, 3 the input cannot be used (nothing is written), 4 it cannot be written.");
  convert->add_option("IN", options->in, "The measured material")->required();
  convert->add_option("OUT", options->out, "What to write: a name that ends in .binary or .csv; replaced if it exists")
      ->required();
  convert->add_flag("--json", options->json, "Print the report as JSON");
  convert->callback([options, &exit_code] { exit_code = run_convert(*options); });
}

}  // namespace likeness::measured
