#include <cstdio>
#include <filesystem>

#include "render/files/files.h"
#include "tests/fit/measured_files.h"

// write_corpus FOLDER: the valid seeds from which the files of tests/fuzz/corpus begin.
int main(int count, char** arguments) {
  using namespace likeness;
  using namespace likeness::measured::test;
  if (count != 2) return std::fputs("usage: write_corpus FOLDER\n", stderr), 2;
  const std::filesystem::path folder = arguments[1];
  files::write_whole(folder / "merl" / "small.binary", small_merl());
  files::write_whole(folder / "mbsdf" / "small.mbsdf", small_mbsdf());
  files::write_whole(folder / "mbsdf" / "constant.mbsdf",
                     small_mbsdf(2, 2, [](auto&, auto&) { return measured::Rgb(0.5); }));
  files::write_whole(folder / "rgl" / "small.bsdf", small_rgl());
  files::write_whole(folder / "rgl" / "anisotropic.bsdf", small_rgl({.theta = 2, .map = 2, .colors = 2, .phi = 3}));
  files::write_whole(folder / "rgl" / "spectral.bsdf",
                     small_rgl({.theta = 2, .map = 2, .colors = 2, .color_name = "spectra"}));
  files::write_whole(folder / "csv" / "small.csv", small_csv());
  files::write_whole(folder / "csv" / "radians.csv",
                     "theta_i,theta_o,phi,r,g,b\n0.5,0.5,3.1,1,2,3\n0.5,0.6,3.1,1e-3,inf,+3\r\n");
}
