#include "render/image/layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "render/files/files.h"
#include "render/image/read.h"
#include "tests/render/exr_files.h"
#include "tests/render/temporary_folder.h"

namespace likeness::image {
namespace {

using files::InputError;
using likeness::test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

Layer layer(const std::string& name, std::vector<std::string> channels, int pixels, float from,
            Storage storage = Storage::kFloat) {
  Layer out{name, std::move(channels), {}, storage};
  out.data.resize(static_cast<std::size_t>(pixels) * out.channels.size());
  for (std::size_t i = 0; i < out.data.size(); ++i) out.data[i] = from + static_cast<float>(i % 2000);  // exact in half
  return out;
}

Layers three_layers(int width, int height) {
  const int pixels = width * height;
  return {width,
          height,
          {layer("", {"R", "G", "B"}, pixels, -3), layer("depth", {"Z"}, pixels, 1e6f),
           layer("normal", {"X", "Y", "Z"}, pixels, 1, Storage::kHalf)},
          R"({"samples": 64})"};
}

void expect_equal(const Layers& back, const Layers& layers) {
  EXPECT_EQ(back.width, layers.width);
  EXPECT_EQ(back.height, layers.height);
  EXPECT_EQ(back.metadata, layers.metadata);
  ASSERT_EQ(back.layers.size(), layers.layers.size());
  for (std::size_t i = 0; i < back.layers.size(); ++i) {
    EXPECT_EQ(back.layers[i].name, layers.layers[i].name);
    EXPECT_EQ(back.layers[i].channels, layers.layers[i].channels);
    EXPECT_EQ(back.layers[i].storage, layers.layers[i].storage);
    EXPECT_TRUE(back.layers[i].data == layers.layers[i].data) << layers.layers[i].name;
  }
}

TEST(ExrLayers, ComeBackAsTheyWereWritten) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{7, 5}, std::pair{1, 700}, std::pair{511, 3}}) {
    const Layers layers = three_layers(width, height);
    write_layers(folder / "layers.exr", layers);
    expect_equal(read_layers(folder / "layers.exr"), layers);
  }
}

TEST(ExrLayers, AreWrittenInBlocksThatJoin) {
  const TemporaryFolder folder;
  const Layers layers = three_layers(3, 600);  // three blocks of lines
  write_layers(folder / "layers.exr", layers);
  expect_equal(read_layers(folder / "layers.exr"), layers);
}

TEST(ExrLayers, ArePicturesForOtherReadersToo) {
  const TemporaryFolder folder;
  const Layers layers = three_layers(4, 2);
  write_layers(folder / "layers.exr", layers);
  EXPECT_EQ(read_texels(folder / "layers.exr").floats, layers.layers[0].data);
  EXPECT_EQ(read_texels(folder / "layers.exr", {.layer = "normal"}).floats, layers.layers[2].data);
  EXPECT_EQ(read_texels(folder / "layers.exr", {.layer = "depth"}).floats, layers.layers[1].data);
}

TEST(ExrLayers, OfHalvesStayFiniteAndKeepWhatIsNoNumber) {
  const TemporaryFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  Layers layers{6, 1, {Layer{"", {"Y"}, {1e9f, -1e9f, infinity, -infinity, NAN, 0.1f}, Storage::kHalf}}, ""};
  write_layers(folder / "half.exr", layers);
  const Layers read = read_layers(folder / "half.exr");
  const std::vector<float>& back = read.layers[0].data;
  EXPECT_EQ(back[0], 65504);
  EXPECT_EQ(back[1], -65504);
  EXPECT_EQ(back[2], infinity);
  EXPECT_EQ(back[3], -infinity);
  EXPECT_TRUE(std::isnan(back[4]));
  EXPECT_NEAR(back[5], 0.1, 0.1 / 2048);  // 11 bits
  EXPECT_EQ(read.metadata, "");
}

TEST(ExrLayers, OfFloatsKeepEveryBit) {
  const TemporaryFolder folder;
  Layers layers{2, 2, {Layer{"", {"Y"}, {1e38f, -1e-40f, NAN, -0.0f}}}, std::string(100'000, 'x')};
  write_layers(folder / "deep/float.exr", layers);
  const Layers back = read_layers(folder / "deep/float.exr");
  EXPECT_EQ(back.layers[0].data[0], 1e38f);
  EXPECT_EQ(back.layers[0].data[1], -1e-40f);
  EXPECT_TRUE(std::isnan(back.layers[0].data[2]));
  EXPECT_TRUE(std::signbit(back.layers[0].data[3]));
  EXPECT_EQ(back.metadata.size(), 100'000u);
}

TEST(ExrLayers, CanBeMany) {
  const TemporaryFolder folder;
  Layers layers{2, 1, {}, "{}"};
  for (int i = 100; i < 300; ++i)
    layers.layers.push_back(
        layer("light " + std::to_string(i) + std::string(60, 'n'), {"R", "G", "B"}, 2, static_cast<float>(i)));
  write_layers(folder / "many.exr", layers);
  expect_equal(read_layers(folder / "many.exr"), layers);
}

TEST(ExrLayers, FindLayersByName) {
  const Layers layers = three_layers(1, 1);
  ASSERT_TRUE(layers.find("normal"));
  EXPECT_EQ(layers.find("normal")->channels.size(), 3u);
  EXPECT_EQ(layers.find(""), &layers.layers[0]);
  EXPECT_EQ(layers.find("Normal"), nullptr);
}

TEST(ExrLayers, RefuseWhatMakesNoFile) {
  const TemporaryFolder folder;
  const auto message = [&](auto change) -> std::string {
    Layers layers = three_layers(2, 2);
    change(layers);
    try {
      write_layers(folder / "no.exr", layers);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "written";
  };
  EXPECT_THAT(message([](Layers& l) { l.width = 0; }), HasSubstr("the picture is 0 x 2"));
  EXPECT_THAT(message([](Layers& l) { l.layers.clear(); }), HasSubstr("there is none"));
  EXPECT_THAT(message([](Layers& l) { l.layers[1].channels.clear(); }), HasSubstr("\"depth\" has no channels"));
  EXPECT_THAT(message([](Layers& l) { l.layers[1].data.pop_back(); }), HasSubstr("has 3 values; expected 4"));
  EXPECT_THAT(message([](Layers& l) {
                l.layers[1].name = "";
                l.layers[1].channels[0] = "R";
              }),
              HasSubstr("\"R\" comes twice"));
  EXPECT_THAT(message([](Layers& l) { l.layers[1].channels[0] = "a.b"; }), HasSubstr("is no name"));
  EXPECT_THAT(message([](Layers& l) { l.layers[1].channels[0] = ""; }), HasSubstr("is no name"));
  EXPECT_THAT(message([](Layers& l) { l.layers[1].name = std::string(300, 'n'); }), HasSubstr("is no name"));
  EXPECT_FALSE(std::filesystem::exists(folder / "no.exr"));
}

TEST(ExrLayers, AreReadFromFilesOfOthers) {
  test::ExrPart part;
  part.channels = {"A",    "B",   "G", "R", "View.Combined.A", "View.Combined.B", "View.Combined.G", "View.Combined.R",
                   "uv.U", "uv.V"};
  part.left = 1;  // the first column is bare
  part.tile = 2;
  const Layers layers = decode_layers(test::exr_bytes({part}), "others");
  ASSERT_EQ(layers.layers.size(), 3u);
  EXPECT_THAT(layers.layers[0].channels, ElementsAre("R", "G", "B", "A"));
  EXPECT_EQ(layers.layers[1].name, "View.Combined");
  EXPECT_THAT(layers.layers[2].channels, ElementsAre("U", "V"));
  EXPECT_EQ(layers.layers[1].data[0], 0);
  EXPECT_EQ(layers.layers[1].data[4], test::exr_value(7, 1, 0));
  EXPECT_EQ(layers.layers[2].data[3], test::exr_value(9, 1, 0));
}

TEST(ExrLayers, RefuseHostileFiles) {
  const std::string bytes = test::exr_bytes({test::ExrPart{}});
  EXPECT_THROW(decode_layers(test::with_window(bytes, "displayWindow", 0, 0, 999'999'999, 999'999'999), "x"),
               InputError);
  EXPECT_THROW(decode_layers(test::with_window(bytes, "dataWindow", 0, 0, 60'000, 60'000), "x"), InputError);
  EXPECT_THROW(decode_layers(bytes, "x", 44), InputError) << "15 pixels, 3 channels";
  EXPECT_NO_THROW(decode_layers(bytes, "x", 45));
  EXPECT_THROW(decode_layers("", "x"), InputError);
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_THROW(decode_layers(bytes.substr(0, size), "x"), InputError);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x40);
    try {
      decode_layers(changed, "x", 1 << 16);
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace likeness::image
