#include "realis/texture/texture_bake.h"

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "realis/texture/picture_planes.h"
#include "realis/texture/texel_surface.h"
#include "realis/texture/unwrap.h"
#include "render/baked/bake_file.h"
#include "render/baked/surface_maps.h"
#include "render/capture/sight.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "tests/realis/domes.h"
#include "tests/realis/texture/mesh_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::realis {
namespace {

using likeness::test::TemporaryFolder;
using test::make_mesh_capture;
using test::MeshCapture;
using test::MeshCaptureOptions;
using testing::Contains;
using testing::HasSubstr;

bool always(double, std::string_view) { return true; }

// Directions about +y.
std::vector<glm::dvec3> sky(std::size_t count) {
  std::vector<glm::dvec3> out;
  for (const glm::dvec3& d : test::dome(count)) out.emplace_back(d.x, d.z, d.y);
  return out;
}

TextureBakeOptions few_lobes(int resolution) {
  TextureBakeOptions out;
  std::vector<std::string> left_out;
  out.weights = streamed({}, left_out);
  out.bake.lobes = 12, out.bake.floor = 0.05, out.resolution = resolution, out.is_float = true;
  return out;
}

// A bake that was made and read again, with the truth beside it.
struct Baked {
  TextureBake made;
  baked::StoredBake stored;
  std::vector<glm::dvec3> positions, normals;  // of each pixel; normals (0, 0, 0): no texel
};
Baked bake_of(const MeshCapture& m, const TextureBakeOptions& options, const std::filesystem::path& folder) {
  Baked out{bake_texture(m.capture, m.scene, options, folder, always), baked::read_bake(folder), {}, {}};
  const world::World world(m.scene, plan::plan_of(m.scene, 0));
  const Unwrapped unwrapped = unwrap(m.scene.meshes[0], options.resolution, "object");
  const TexelSurface surface = surface_of(world, 0, unwrapped);
  const auto count = static_cast<std::size_t>(options.resolution) * static_cast<std::size_t>(options.resolution);
  out.positions.resize(count), out.normals.resize(count);
  for (std::size_t t = 0; t < unwrapped.pixels.size(); ++t)
    out.positions[unwrapped.pixels[t]] = glm::dvec3(surface.positions[t]),
    out.normals[unwrapped.pixels[t]] = glm::dvec3(surface.normals[t]);
  return out;
}

// What the bake adds at a pixel of the texture under a light, and what it should.
struct Added {
  double got = 0, want = 0;
};
Added added_at(const Baked& b, const MeshCapture& m, const capture::Light& light, std::size_t pixel,
               double difference = 0.2) {
  const capture::Shine shine = capture::shine_of(light, b.positions[pixel]);
  const double cosine = glm::dot(b.normals[pixel], shine.to_light);
  // Pixels of a bake of floats are all of the picture.
  const glm::dvec3 in_model =
      glm::normalize(glm::inverse(glm::dmat3(m.scene.instances[0].world_from_object)) * shine.to_light);
  const double e = Residual(b.stored.bake, in_model).at(pixel, cosine)[0] * shine.irradiance;
  return {e, difference / std::numbers::pi * std::max(cosine, 0.0) * shine.irradiance};
}

// Root mean square of what is wrong over lights and the pixels that `is_asked` holds for, over that of what is right.
double error_of(const Baked& b, const MeshCapture& m, const std::function<bool(std::size_t)>& is_asked) {
  double wrong = 0, right = 0;
  for (std::size_t pixel = 0; pixel < b.normals.size(); ++pixel) {
    if (!(glm::length(b.normals[pixel]) > 0) || !is_asked(pixel)) continue;
    for (const capture::Light& light : m.capture.lights) {
      const Added a = added_at(b, m, light, pixel);
      wrong += (a.got - a.want) * (a.got - a.want), right += a.want * a.want;
    }
  }
  return std::sqrt(wrong / right);
}

bool sees(const glm::dvec3& camera, const Baked& b, std::size_t pixel, double least) {
  return glm::dot(glm::normalize(camera - b.positions[pixel]), b.normals[pixel]) > least;
}

class OfABall : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    MeshCaptureOptions options;
    options.shape = "faceted_sphere", options.lights = sky(24);
    options.cameras = {{0, 0.6, 0.8}, {0.5, 0.6, 0.62}, {-0.8, 0.6, 0}};
    cameras_ = options.cameras;
    mesh_ = std::make_unique<MeshCapture>(make_mesh_capture(*folder_ / "c", options));
    baked_ = std::make_unique<Baked>(bake_of(*mesh_, few_lobes(160), *folder_ / "bake"));
  }
  static void TearDownTestSuite() { baked_.reset(), mesh_.reset(), folder_.reset(); }
  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline std::unique_ptr<MeshCapture> mesh_;
  static inline std::unique_ptr<Baked> baked_;
  static inline std::vector<glm::dvec3> cameras_;
};

TEST_F(OfABall, WhatOneCameraSawAndWhatSeveralSawAreBothRecovered) {
  const auto seen_by = [&](std::size_t pixel) {
    int count = 0;
    for (const glm::dvec3& camera : cameras_) count += sees(camera, *baked_, pixel, 0.3) ? 1 : 0;
    return count;
  };
  const auto hidden = [&](std::size_t pixel) {
    for (const glm::dvec3& camera : cameras_)
      if (sees(camera, *baked_, pixel, -0.1)) return false;  // a facet is tilted by 4 degrees
    return true;
  };
  const double one = error_of(*baked_, *mesh_, [&](std::size_t pixel) { return seen_by(pixel) == 1; });
  const double several = error_of(*baked_, *mesh_, [&](std::size_t pixel) { return seen_by(pixel) > 1; });
  // Twelve lobes do not hold the kink where a light sets; pixels are looked up between their middles.
  EXPECT_LT(one, 0.08);
  EXPECT_LT(several, 0.08);
  std::size_t count = 0;
  for (std::size_t pixel = 0; pixel < baked_->normals.size(); ++pixel) {
    if (!(glm::length(baked_->normals[pixel]) > 0) || !hidden(pixel)) continue;
    ++count;
    for (std::size_t k = 0; k < 12; ++k) ASSERT_EQ(baked_->stored.bake.coefficients[12 * pixel + k], 0);
  }
  EXPECT_GT(count, 1000u);
  EXPECT_THAT(noticed(baked_->made.census), Contains(HasSubstr("seen by no camera")));
}

TEST_F(OfABall, TexelsBeyondTheFirstTileAreSolvedToo) {
  ASSERT_GT(baked_->made.texels, 16384u);
  double largest = 0;
  for (std::size_t pixel = 20000; pixel < 25600; ++pixel)
    largest = std::max(largest, static_cast<double>(std::abs(baked_->stored.bake.coefficients[12 * pixel])));
  EXPECT_EQ(largest, 0) << "below the ball nothing is seen";
  largest = 0;
  for (std::size_t pixel = 16400; pixel < 17000; ++pixel)
    largest = std::max(largest, static_cast<double>(std::abs(baked_->stored.bake.coefficients[12 * pixel])));
  EXPECT_GT(largest, 0.001);
}

TEST_F(OfABall, BothSidesOfASeamSayTheSame) {
  int compared = 0;
  for (std::size_t y = 30; y < 70; ++y) {
    const std::size_t left = y * 160, right = y * 160 + 159;
    if (!sees(cameras_[2], *baked_, left, 0.3)) continue;
    ++compared;
    for (const capture::Light& light : mesh_->capture.lights) {
      // One texel is 2 % of a turn, so cosines differ by 0.04 at most; 0.2 / pi is what is added at most.
      EXPECT_NEAR(added_at(*baked_, *mesh_, light, left).got, added_at(*baked_, *mesh_, light, right).got, 0.004);
    }
  }
  EXPECT_GT(compared, 10);
}

TEST_F(OfABall, TheFileSaysWhatItIsAndWhatItWasMadeOf) {
  EXPECT_EQ(baked_->stored.about.space, baked::Space::kTexture);
  EXPECT_EQ(baked_->stored.about.object, "object");
  EXPECT_EQ(baked_->stored.about.mesh_sha256.size(), 64u);
  EXPECT_EQ(baked_->stored.about.scene_sha256.size(), 64u);
  const std::string text = files::read_whole(*folder_ / "bake" / "bake.json", 1 << 24);
  for (const char* name : {"capture.json", "lights.json", "photos/c1/l3.exr", "renders/c2/l7.exr"})
    EXPECT_THAT(text, HasSubstr(std::string("\"") + name + "\": \"" +
                                files::sha256(files::read_whole(mesh_->capture.root / name, 1 << 24)) + "\""));
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "bake" / "work"));
}

TEST_F(OfABall, PropertyMapsHoldTheMaterialAndTheNormals) {
  const baked::Surface surface = baked::read_surface(*folder_ / "bake");
  for (std::size_t pixel = 0; pixel < baked_->normals.size(); ++pixel) {
    if (!(glm::length(baked_->normals[pixel]) > 0)) continue;
    EXPECT_NEAR(surface.base_colors.rgb[3 * pixel], 0.5, 1e-3);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(surface.normals.rgb[3 * pixel + static_cast<std::size_t>(c)], baked_->normals[pixel][c], 0.01);
  }
}

std::map<std::string, std::string> bytes_below(const std::filesystem::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    out[entry.path().filename().string()] = files::read_whole(entry.path(), std::size_t{1} << 30);
  return out;
}

// Stopped at every question that it asks, in turn: what is there is kept, and the end is the same to the byte.
TEST(TextureBake, AnInterruptedOneEndsWithTheBytesOfTheUninterrupted) {
  const TemporaryFolder folder;
  MeshCaptureOptions small;
  small.lights = sky(5), small.size = 32, small.cameras = {{0, 1, 0.01}, {0.5, 0.8, 0.3}};
  const MeshCapture m = make_mesh_capture(folder / "c", small);
  TextureBakeOptions options = few_lobes(200);
  options.is_float = false, options.bake.lobes = 0, options.bake.most_lobes = 6, options.bake.dominant = 3;
  const TextureBake whole = bake_texture(m.capture, m.scene, options, folder / "whole", always);
  std::size_t stops = 0;
  TextureBake last;
  for (int most = 1;; ++most) {
    int asked = 0;
    try {
      last = bake_texture(m.capture, m.scene, options, folder / "stopped",
                          [&](double, std::string_view) { return ++asked < most; });
      break;
    } catch (const files::Interrupted&) {
      ++stops;
      EXPECT_FALSE(std::filesystem::exists(folder / "stopped" / "bake.json"));
    }
  }
  EXPECT_GT(stops, 10u);
  EXPECT_EQ(last.kept_lights, 5u);
  EXPECT_EQ(last.kept_tiles, 3u);
  EXPECT_EQ(last.plain_rms, whole.plain_rms);
  EXPECT_EQ(last.left_rms, whole.left_rms);
  EXPECT_EQ(bytes_below(folder / "stopped"), bytes_below(folder / "whole"));
}

TEST(TextureBake, WorkOfAnotherRequestIsNotTakenForThisOne) {
  const TemporaryFolder folder;
  MeshCaptureOptions small;
  small.lights = sky(5), small.size = 32;
  const MeshCapture m = make_mesh_capture(folder / "c", small);
  TextureBakeOptions options = few_lobes(64);
  const auto stopped = [&] {
    EXPECT_THROW(bake_texture(m.capture, m.scene, options, folder / "bake",
                              [](double, std::string_view what) { return what != "writing pictures"; }),
                 files::Interrupted);
  };
  stopped();
  EXPECT_EQ(bake_texture(m.capture, m.scene, options, folder / "bake", always).kept_lights, 5u);
  stopped();
  options.bake.floor = 0.3;
  EXPECT_EQ(bake_texture(m.capture, m.scene, options, folder / "bake", always).kept_lights, 0u);
  // A light's file that was cut off is made again.
  stopped();
  std::filesystem::resize_file(folder / "bake" / "work" / "light_00002", 1000);
  EXPECT_EQ(bake_texture(m.capture, m.scene, options, folder / "bake", always).kept_lights, 4u);
}

// A lamp 0.15 m above a plate of 0.2 m: its direction turns by 60 degrees over the plate, its irradiance by a factor of 3.
TEST(TextureBake, ANearLightHasItsDirectionAndItsIrradianceAtEachTexel) {
  const TemporaryFolder folder;
  MeshCaptureOptions options;
  options.is_near = true;
  for (const glm::dvec3& d : sky(16)) options.lights.push_back(0.15 * d + glm::dvec3(0, 0.05, 0));
  const MeshCapture m = make_mesh_capture(folder / "c", options);
  TextureBakeOptions bake = few_lobes(64);
  bake.bake.is_exact = true;
  const Baked b = bake_of(m, bake, folder / "bake");
  // e is 0.2 / pi wherever a light stands. The outermost texels are beside the plate's outline, which is not trusted.
  const auto is_inside = [](std::size_t pixel) {
    return std::min(pixel % 64, pixel / 64) > 1 && std::max(pixel % 64, pixel / 64) < 62;
  };
  EXPECT_LT(error_of(b, m, is_inside), 0.02);
}

// Cameras that contradict each other by a factor of two in the residual: the one that sees at a slant from afar loses.
TEST(TextureBake, ACameraThatSeesAtASlantCountsLess) {
  const TemporaryFolder folder;
  MeshCaptureOptions options;
  options.lights = sky(12), options.cameras = {{0, 1, 0.01}, {0, 0.6, 4}};
  options.fault = [](std::size_t camera, std::size_t, image::Picture& photo) {
    for (float& x : photo.rgb) x *= camera == 1 ? 9.0f / 7.0f : 1.0f;  // 0.9 in the place of 0.7
  };
  const MeshCapture m = make_mesh_capture(folder / "c", options);
  TextureBakeOptions bake = few_lobes(48);
  const auto mean = [&](const char* name) {
    const Baked b = bake_of(m, bake, folder / name);
    double got = 0, want = 0;
    for (std::size_t pixel = 0; pixel < b.normals.size(); ++pixel) {
      const Added a = added_at(b, m, m.capture.lights[0], pixel);
      got += a.got, want += a.want;
    }
    return got / want;
  };
  bake.weights.is_on[weight::weight_named("stretch")] = false;
  // The mean of 1 and 2, but for pixels beside the outline, of which the farther camera has more.
  EXPECT_NEAR(mean("without"), 1.5, 0.06);
  bake.weights.is_on[weight::weight_named("stretch")] = true, bake.weights.settings.stretch.b = 1;
  EXPECT_NEAR(mean("with"), 1, 0.1);
}

// Turned as a whole, object, cameras and lights bake to the same lobes and coefficients: model space is the object's.
TEST(TextureBake, LobesTurnWithTheObject) {
  const TemporaryFolder folder;
  MeshCaptureOptions options;
  options.lights = sky(8), options.size = 48;
  const MeshCapture plain = make_mesh_capture(folder / "plain", options);
  options.turn = glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0));
  const MeshCapture turned = make_mesh_capture(folder / "turned", options);
  const Baked a = bake_of(plain, few_lobes(24), folder / "a"), b = bake_of(turned, few_lobes(24), folder / "b");
  ASSERT_EQ(a.stored.bake.basis.lobes.size(), b.stored.bake.basis.lobes.size());
  for (std::size_t k = 0; k < a.stored.bake.basis.lobes.size(); ++k)
    EXPECT_NEAR(glm::length(a.stored.bake.basis.lobes[k].axis - b.stored.bake.basis.lobes[k].axis), 0, 1e-6);
  for (std::size_t i = 0; i < a.stored.bake.coefficients.size(); ++i)
    ASSERT_NEAR(a.stored.bake.coefficients[i], b.stored.bake.coefficients[i], 1e-4);
}

// ---- hard cases

struct Hard {
  const char* name;
  MeshCaptureOptions options;
  const char* says;      // of the lines of what was noticed
  double largest = 0.3;  // |photo - render|
};
std::vector<Hard> hard_cases() {
  std::vector<Hard> out;
  const auto add = [&](const char* name, const char* says) -> MeshCaptureOptions& {
    out.push_back({name, {}, says});
    out.back().options.lights = sky(8), out.back().options.size = 32;
    return out.back().options;
  };
  add("one light", "one light").lights.resize(1);
  add("few lights", "lobes and fewer lights (2 directions)").lights.resize(2);
  MeshCaptureOptions& plane = add("all lights in one plane", "in one plane");
  for (glm::dvec3& light : plane.lights) light = glm::normalize(glm::dvec3(light.x, light.y, 0));
  MeshCaptureOptions& same = add("identical lights", "lights from the same direction: l0 = l1");
  for (glm::dvec3& light : same.lights) light = same.lights[0];
  add("zero variance", "equal").photographed = 0.5;
  add("black photographs", "black").photographed = 0;
  add("NaN", "not finite").fault = [](std::size_t, std::size_t light, image::Picture& photo) {
    for (std::size_t i = light; i < photo.rgb.size(); i += 97) photo.rgb[i] = std::nanf("");
  };
  add("infinite", "not finite").fault = [](std::size_t, std::size_t, image::Picture& photo) {
    for (std::size_t i = 0; i < photo.rgb.size(); i += 3) photo.rgb[i] = std::numeric_limits<float>::infinity();
  };
  add("negative", "negative").fault = [](std::size_t, std::size_t, image::Picture& photo) {
    for (float& x : photo.rgb) x -= 1;
  };
  add("a light a hundred times as bright", "light l3 is").fault = [](std::size_t, std::size_t light,
                                                                     image::Picture& photo) {
    for (float& x : photo.rgb) x *= light == 3 ? 100.0f : 1.0f;
  };
  MeshCaptureOptions& behind = add("lights behind", "");
  for (std::size_t i = 0; i < 4; ++i) behind.lights[i].y *= -1;
  add("a camera behind", "100 % of the texels are seen by no camera").cameras = {{0, -1, 0.01}};
  for (Hard& hard : out)
    if (std::string_view(hard.name) == "negative") hard.largest = 1.3;
    else if (std::string_view(hard.name).find("hundred") != std::string_view::npos) hard.largest = 25;
  return out;
}

TEST(TextureBake, HardCasesAreFiniteBoundedAndSaid) {
  for (const Hard& hard : hard_cases()) {
    SCOPED_TRACE(hard.name);
    const TemporaryFolder folder;
    const MeshCapture m = make_mesh_capture(folder / "c", hard.options);
    const Baked b = bake_of(m, few_lobes(20), folder / "bake");
    // What is not known is kept small: |c| <= spread sqrt(sum w e^2), and w e^2 is at most the square of a residual.
    const std::size_t lobes = b.stored.bake.basis.lobes.size();
    for (std::size_t i = 0; i < b.stored.bake.coefficients.size(); ++i) {
      const double c = static_cast<double>(b.stored.bake.coefficients[i]),
                   spread = b.stored.bake.basis.spread[i % lobes];
      ASSERT_TRUE(std::isfinite(c));
      ASSERT_LE(std::abs(c), 1.01 * spread * std::sqrt(static_cast<double>(m.capture.lights.size())) * hard.largest);
    }
    if (*hard.says != 0) {
      EXPECT_THAT(noticed(b.made.census), Contains(HasSubstr(hard.says)));
    }
  }
}

// Half of the lights are below the plate: nothing is added there, and what is above is as it should be.
TEST(TextureBake, ALightBehindTheTexelAddsNothing) {
  const TemporaryFolder folder;
  MeshCaptureOptions options;
  options.lights = sky(16), options.size = 48;
  for (std::size_t i = 0; i < 16; i += 2) options.lights[i].y *= -1;
  const MeshCapture m = make_mesh_capture(folder / "c", options);
  TextureBakeOptions bake = few_lobes(24);
  bake.bake.is_exact = true;
  const Baked b = bake_of(m, bake, folder / "bake");
  for (std::size_t pixel = 0; pixel < b.normals.size(); ++pixel)
    for (const capture::Light& light : m.capture.lights) {
      const Added a = added_at(b, m, light, pixel);
      ASSERT_NEAR(a.got, a.want, 1e-4);
    }
}

TEST(TextureBake, PixelsThatAreNotFiniteAreLookedPast) {
  const TemporaryFolder folder;
  MeshCaptureOptions options;
  options.lights = sky(12);
  options.fault = [](std::size_t, std::size_t light, image::Picture& photo) {
    for (std::size_t i = light; i < photo.rgb.size(); i += 97) photo.rgb[i] = std::nanf("");
  };
  const MeshCapture m = make_mesh_capture(folder / "c", options);
  const Baked b = bake_of(m, few_lobes(48), folder / "bake");
  EXPECT_LT(error_of(b, m, [](std::size_t) { return true; }), 0.05);
}

// ---- what is refused

std::string refusal(const std::function<void()>& f) {
  try {
    f();
  } catch (const files::UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(TextureBake, WhatCannotBeBakedIsRefusedWithAWayOut) {
  const TemporaryFolder folder;
  MeshCaptureOptions small;
  small.lights = sky(3), small.size = 16;
  const MeshCapture m = make_mesh_capture(folder / "c", small);
  const auto with = [&](const TextureBakeOptions& options, const MeshCapture& mesh) {
    return refusal([&] { bake_texture(mesh.capture, mesh.scene, options, folder / "bake", always); });
  };
  TextureBakeOptions options = few_lobes(16);
  options.object = "objekt";
  EXPECT_THAT(with(options, m), HasSubstr("did you mean \"object\"?"));
  options.object = "";
  MeshCapture two = m;
  two.scene.instances.push_back(two.scene.instances[0]);
  two.scene.instances[1].name = "other";
  EXPECT_THAT(with(options, two), HasSubstr("--object says which one is baked; the scene has \"object\", \"other\""));
  MeshCapture bent = m;
  bent.capture.cameras[0].is_undistorted = false;
  EXPECT_THAT(with(options, bent), HasSubstr("--undistort"));
  TextureBakeOptions foreign = options;
  foreign.weights.is_on[weight::weight_named("foreign")] = true;
  EXPECT_THAT(with(foreign, m), HasSubstr("--with foreign"));
  options.resolution = 0;
  EXPECT_THAT(with(options, m), HasSubstr("--resolution = 0 is outside [1, 8192]"));
  options = few_lobes(16), options.scene_file = "s.json";
  std::filesystem::remove(capture::render_file(m.capture, m.capture.variants[0], 0, 1));
  EXPECT_THAT(with(options, m), HasSubstr("--scene s.json --variant render` makes it"));
}

TEST(TextureBake, ADiskWithoutRoomIsSaidBeforeAnythingIsRead) {
  EXPECT_THAT(refusal([] { must_have_room("/here", 3'000'000'000, 1'000'000'000); }),
              testing::AllOf(HasSubstr("/here: the bake needs 3.0 GB"), HasSubstr("1.0 GB are free")));
  EXPECT_EQ(refusal([] { must_have_room("/here", 3, 3); }), "");
}

}  // namespace
}  // namespace likeness::realis
