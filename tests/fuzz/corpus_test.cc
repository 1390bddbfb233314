#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <vector>

#include "olat/tev/packet.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"
#include "tests/fuzz/feed.h"
#include "tests/fuzz/feed_bake.h"
#include "tests/fuzz/feed_capture.h"
#include "tests/olat/import/small_colmap.h"
#include "tests/render/capture/small_capture.h"
#include "tests/render/scene/small_files.h"

// What the fuzzers run, without libFuzzer: every file of the corpus, and damaged copies of small valid files.
namespace likeness::measured::test {
namespace {

struct Seed {
  std::string format, bytes;
};

std::string small_table() {
  return "\xef\xbb\xbf cos_i ,\"x\",color_g,ref_f_g\r\n\r\n0.5,+1e0,\"0.25\",nan\r\n1,2,0.5,0.5";
}

std::string small_packets() {
  return olat_tev::bytes_of(olat_tev::Create{"a", 3, 2, {"R", "G", "B"}}) +
         olat_tev::bytes_of(olat_tev::Update{"a", {"R", "B"}, 1, 0, 2, 2, {0, 1}, {2, 2}, {1, 2, 3, 4, 5, 6, 7, 8}}) +
         olat_tev::bytes_of(olat_tev::Close{"b"});
}

std::vector<Seed> seeds() {
  return {{"merl", small_merl()},
          {"mbsdf", small_mbsdf()},
          {"rgl", small_rgl()},
          {"csv", small_csv()},
          {"table", small_table()},
          {"scene", scene::test::small_scene()},
          {"glb", scene::test::small_glb()},
          {"ply", scene::test::small_ply()},
          {"ply", scene::test::small_binary_ply()},
          {"obj", scene::test::small_obj()},
          {"ies", scene::test::small_ies()},
          {"bake", baked::test::small_bake(12, 8, "luminance", "8 bit")},
          {"bake", baked::test::small_bake(3, 3, "rgb", "float")},
          {"capture", capture::test::small_texts()},
          {"lights_csv", "# linear\nfile,lx,ly,lz,ir,ig,ib\na.png,0,0.6,0.8,1,2,3\n"},
          {"tev", small_packets()},
          {"state", "?camera=c0&light=012&mode=wipe&split=0.25&ev=-1.5&view=gt&gt_m=0.3&zebra=1&noise=0.001"},
          {"state", R"({"metric": "smape", "ev": 2, "wedge": true, "x": "0.1", "channel": "luma"})"},
          {"readings", "subject,500,700\n1,0.04,0.03\n"},
          {"blood_table", "drop,opacity,time_s,r,g,b\n01,0.35,0,200,120,90.5\n"},
          {"bloom_kernel", R"({"format": "likeness bloom", "version": 1, "radius": 2, "direct": [1, 1, 1],
                              "components": []})"},
          {"brackets", "# list\na.png 32 0.03125 8 0 0\nb.png 0.5 2 4 3 0.3\n"},
          {"brackets", "name,seconds\nmy room.png,1/250\nb.png,2\n"},
          {"lp", "2\na b.png 0 0 5\nb.png 3 0 4\n"},
          {"dome", R"({"lightConfiguration": "spherical", "positionsSphere": [{"x": 1, "y": 2, "z": 3}],
                       "ledAdjust": [{"r": 1, "g": 1, "b": 2}]})"},
          {"colmap",
           olat_import::test::small_cameras() + std::string(capture::test::kPart) + olat_import::test::small_images()},
          {"colmap_bin", olat_import::test::small_binary_cameras() + std::string(capture::test::kPart) +
                             olat_import::test::small_binary_images()}};
}

TEST(Corpus, EveryFileIsReadOrRefused) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(LIKENESS_CORPUS_DIR)) {
    if (!entry.is_regular_file()) continue;
    SCOPED_TRACE(entry.path().string());
    EXPECT_NO_THROW(
        feed(entry.path().parent_path().filename().string(), likeness::files::read_whole(entry.path(), 1 << 20)));
    ++files;
  }
  EXPECT_GE(files, 22);
}

TEST(Corpus, ValidSeedsAreAccepted) {
  for (const auto& [format, bytes] : seeds()) EXPECT_TRUE(feed(format, bytes)) << format;
}

TEST(Corpus, EveryTruncationIsReadOrRefused) {
  for (const auto& [format, bytes] : seeds())
    for (std::size_t size = 0; size < bytes.size(); ++size)
      ASSERT_NO_THROW(feed(format, std::string_view(bytes).substr(0, size))) << format << ", " << size << " bytes";
}

TEST(Corpus, EveryFlippedBitOfTheFirstKilobyteIsReadOrRefused) {
  for (const auto& [format, bytes] : seeds())
    for (std::size_t bit = 0; bit < 8 * std::min<std::size_t>(bytes.size(), 1024); ++bit) {
      std::string damaged = bytes;
      damaged[bit / 8] = char(damaged[bit / 8] ^ 1 << bit % 8);
      ASSERT_NO_THROW(feed(format, damaged)) << format << ", bit " << bit;
    }
}

TEST(Corpus, RandomDamageIsReadOrRefused) {
  std::mt19937 random(7);
  for (const auto& [format, bytes] : seeds())
    for (int i = 0; i < 500; ++i) {
      std::string damaged = bytes;
      for (unsigned n = 1 + random() % 8; n > 0; --n) damaged[random() % damaged.size()] = char(random());
      ASSERT_NO_THROW(feed(format, damaged)) << format << ", copy " << i;
    }
}

}  // namespace
}  // namespace likeness::measured::test
