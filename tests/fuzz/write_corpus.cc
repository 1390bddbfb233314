#include <cstdio>
#include <filesystem>

#include "olat/tev/packet.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"
#include "tests/fuzz/feed_bake.h"
#include "tests/fuzz/feed_capture.h"
#include "tests/olat/import/small_colmap.h"
#include "tests/render/capture/small_capture.h"
#include "tests/render/scene/small_files.h"

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
  files::write_whole(folder / "table" / "angles.csv", "cos_i,color_r,x,ref_f_r\n1,0.5,2,0.5\n0,1,3,0\n");
  files::write_whole(folder / "table" / "excel.csv",
                     "\xef\xbb\xbf\"light_x\",light_y, light_z ,color\r\n0.6,0,0.8,\"0.25\"\r\n\r\n0,0,+1e0,1\r\n");
  files::write_whole(folder / "table" / "extremes.csv", "x,ref_g\nnan,inf\n1e999,-1e-999\n4.9e-324,-0\n");
  files::write_whole(folder / "table" / "not_unit.csv", "light_x\n0.5\n");
  files::write_whole(folder / "scene" / "small.json", scene::test::small_scene());
  files::write_whole(folder / "glb" / "square.glb", scene::test::small_glb());
  files::write_whole(folder / "glb" / "ring.glb", scene::test::small_glb("\"children\": [1]", "\"children\": [0]"));
  files::write_whole(folder / "glb" / "far_index.glb", scene::test::small_glb("\"count\": 6", "\"count\": 600000000"));
  files::write_whole(folder / "ply" / "text.ply", scene::test::small_ply());
  files::write_whole(folder / "ply" / "binary.ply", scene::test::small_binary_ply());
  files::write_whole(folder / "obj" / "square.obj", scene::test::small_obj());
  files::write_whole(folder / "ies" / "quadrant.ies", scene::test::small_ies());
  files::write_whole(folder / "ies" / "side.ies", scene::test::small_ies("90 180 270"));
  files::write_whole(folder / "bake" / "dominant.txt", baked::test::small_bake(12, 8, "luminance", "8 bit"));
  files::write_whole(folder / "bake" / "rgb.txt", baked::test::small_bake(3, 3, "rgb", "8 bit"));
  files::write_whole(folder / "bake" / "float.txt", baked::test::small_bake(2, 2, "rgb", "float"));
  files::write_whole(folder / "bake" / "empty.txt", baked::test::small_bake(0, 0, "luminance", "8 bit"));
  const std::string part(capture::test::kPart);
  files::write_whole(folder / "capture" / "small.txt", capture::test::small_texts());
  files::write_whole(folder / "lights_csv" / "small.csv",
                     "# linear\nfile,lx,ly,lz,ir,ig,ib\na.png,0,0.6,0.8,1,2,3\nb.png,1,0,0,1,1,1\n");
  files::write_whole(
      folder / "tev" / "packets.bin",
      olat_tev::bytes_of(olat_tev::Create{"a", 3, 2, {"R", "G", "B"}}) +
          olat_tev::bytes_of(olat_tev::Update{"a", {"R", "B"}, 1, 0, 2, 2, {0, 1}, {2, 2}, {1, 2, 3, 4, 5, 6, 7, 8}}) +
          olat_tev::bytes_of(olat_tev::Close{"b"}));
  files::write_whole(folder / "state" / "text.txt", "?camera=c0&mode=wipe&split=0.25&ev=-1.5&view=gt&gt_m=0.3&zebra=1");
  files::write_whole(folder / "state" / "object.json", R"({"metric": "smape", "ev": 2, "wedge": true, "x": "0.1"})");
  files::write_whole(folder / "lp" / "small.lp", "2\na b.png 0 0 5\nb.png 3 0 4\n");
  files::write_whole(
      folder / "dome" / "small.dome",
      R"({"lightConfiguration": "spherical", "positionsSphere": [{"x": 1, "y": 2, "z": 3}], "ledAdjust": [{"r": 1, "g": 1, "b": 2}]})");
  files::write_whole(
      folder / "dome" / "calibrated.dome",
      R"({"directions": [[0, 0, 1]], "lightsCalibration": [{"intensity": 2, "whiteBalance": [1, 1, 2]}]})");
  files::write_whole(folder / "colmap" / "small.txt",
                     olat_import::test::small_cameras() + part + olat_import::test::small_images());
  files::write_whole(folder / "colmap_bin" / "small.bin",
                     olat_import::test::small_binary_cameras() + part + olat_import::test::small_binary_images());
  files::write_whole(folder / "ies" / "tilted.ies", scene::test::small_ies("0", "TILT=INCLUDE\n1\n2\n0 90\n1 0.8\n"));
}
