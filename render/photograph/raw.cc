#include "render/photograph/raw.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <Eigen/LU>
#include <tbb/parallel_for.h>

#include "render/files/files.h"
#include "render/image/read.h"

namespace likeness::photograph {
namespace {

using Directory = TiffTags::Directory;

enum Tag : std::uint16_t {
  kPhotometric = 262,
  kMake = 271,
  kModel = 272,
  kOrientation = 274,
  kCellSize = 33421,
  kCell = 33422,
  kBlackCell = 50713,
  kBlackLevel = 50714,
  kBlackAlong = 50715,
  kBlackDown = 50716,
  kWhiteLevel = 50717,
  kColorMatrix1 = 50721,
  kColorMatrix2 = 50722,
  kAsShotNeutral = 50728,
  kAsShotWhite = 50729,
  kBaselineExposure = 50730,
  kIlluminant1 = 50778,
  kIlluminant2 = 50779,
};
constexpr double kColorFilterArray = 32803, kD65 = 21;

Directory mosaic_of(const TiffTags& tags, const std::string& name) {
  for (const Directory directory : tags.directories())
    if (tags.number(directory, kPhotometric) == kColorFilterArray) return directory;
  throw files::InputError(name + ": has no mosaic (PhotometricInterpretation 32803); a DNG of finished colors is none");
}

Rgb3 least_is_1(const Rgb3& gains) {
  const double least = std::ranges::min(gains);
  return {gains[0] / least, gains[1] / least, gains[2] / least};
}

Eigen::Matrix3d camera_from_xyz(const TiffTags& tags, Directory first) {
  const std::vector<double> one = tags.numbers(first, kColorMatrix1), two = tags.numbers(first, kColorMatrix2);
  const bool takes_first = two.size() != 9 || (tags.number(first, kIlluminant1) == kD65 && one.size() == 9);
  const std::vector<double>& chosen = takes_first ? one : two;
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 9 && chosen.size() == 9; ++i)
    out(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = chosen[i];
  return out;
}

void fill_colors(const TiffTags& tags, Directory first, const std::string& name, DngFacts& facts) {
  const Eigen::Matrix3d from_xyz = camera_from_xyz(tags, first);
  if (!from_xyz.isZero()) {
    Eigen::Matrix3d xyz;
    for (std::size_t i = 0; i < 9; ++i)
      xyz(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = image::kXyzOfRec709[i / 3][i % 3];
    Eigen::Matrix3d camera = from_xyz * xyz;
    const Eigen::Vector3d white = camera.rowwise().sum();
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (!(white[i] > 1e-6)) throw files::InputError(name + ": ColorMatrix sees no light in white");
      camera.row(i) /= white[i];
    }
    const Eigen::Matrix3d inverse = camera.inverse();
    if (!inverse.allFinite() || inverse.cwiseAbs().maxCoeff() > 1e3)
      throw files::InputError(name + ": ColorMatrix has no inverse");
    for (std::size_t i = 0; i < 9; ++i)
      facts.rec709_from_camera[i / 3][i % 3] =
          inverse(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
    facts.daylight = least_is_1({1 / white[0], 1 / white[1], 1 / white[2]});
    facts.has_matrix = true;
  }
  std::vector<double> neutral = tags.numbers(first, kAsShotNeutral);
  if (const auto xy = tags.numbers(first, kAsShotWhite);
      neutral.empty() && xy.size() == 2 && xy[1] > 0 && facts.has_matrix) {
    const Eigen::Vector3d seen = from_xyz * Eigen::Vector3d(xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]);
    neutral = {seen[0], seen[1], seen[2]};
  }
  if (neutral.empty()) return;
  if (neutral.size() != 3 || !(std::ranges::min(neutral) > 0) ||
      !(std::ranges::max(neutral) < 1e3 * std::ranges::min(neutral)))
    throw files::InputError(name + ": AsShotNeutral is no white of three channels");
  facts.as_shot = least_is_1({1 / neutral[0], 1 / neutral[1], 1 / neutral[2]});
}

Rgb3 gains_of(const DngFacts& facts, const RawOptions& options) {
  switch (options.balance) {
    case Balance::kAsShot:
      return facts.as_shot.value_or(facts.daylight);
    case Balance::kDaylight:
      return facts.daylight;
    case Balance::kNone:
      return {1, 1, 1};
    case Balance::kGains:
      break;
  }
  for (const double gain : options.gains)
    if (!(gain > 1e-3 && gain < 1e3))
      throw files::UsageError("a gain of " + files::number_text(gain) + " is outside 0.001 to 1000");
  return least_is_1(options.gains);
}

// Where the pixel of the upright picture is in the stored one, by EXIF's orientation.
std::pair<int, int> stored_at(int x, int y, int orientation, int width, int height) {
  switch (orientation) {
    case 2:
      return {width - 1 - x, y};
    case 3:
      return {width - 1 - x, height - 1 - y};
    case 4:
      return {x, height - 1 - y};
    case 5:
      return {y, x};
    case 6:
      return {y, height - 1 - x};
    case 7:
      return {width - 1 - y, height - 1 - x};
    case 8:
      return {width - 1 - y, x};
    default:
      return {x, y};
  }
}

void turn_upright(Developed& out, int orientation) {
  if (orientation < 2 || orientation > 8) return;
  const int width = out.light.width, height = out.light.height;
  image::Picture light(orientation > 4 ? height : width, orientation > 4 ? width : height);
  std::vector<std::uint8_t> is_clipped(out.is_clipped.size());
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x) {
      const auto [u, v] = stored_at(x, y, orientation, width, height);
      std::ranges::copy(std::as_const(out.light).at(u, v), light.at(x, y).begin());
      is_clipped[static_cast<std::size_t>(y) * static_cast<std::size_t>(light.width) + static_cast<std::size_t>(x)] =
          out.is_clipped[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u)];
    }
  out.light = std::move(light);
  out.is_clipped = std::move(is_clipped);
}

}  // namespace

DngFacts facts_of_dng(std::string_view bytes, const std::string& name) {
  const std::optional<TiffTags> tags = TiffTags::of(bytes);
  if (!tags || tags->directories().empty() || !image::is_dng(bytes))
    throw files::InputError(name + ": is no DNG; camera raw files of other kinds are to be converted to it");
  const Directory first = tags->directories().front(), mosaic = mosaic_of(*tags, name);
  DngFacts facts;
  facts.camera = tags->text(first, kModel);
  if (const std::string make = tags->text(first, kMake); !facts.camera.starts_with(make))
    facts.camera = make + " " + facts.camera;
  facts.orientation = static_cast<int>(std::clamp(tags->number(first, kOrientation).value_or(1), 1.0, 8.0));
  facts.baseline_ev = tags->number(first, kBaselineExposure).value_or(0);
  facts.taken = taken_of(bytes, name);

  const std::vector<double> size = tags->numbers(mosaic, kCellSize), cell = tags->numbers(mosaic, kCell);
  if (size != std::vector<double>{2, 2} || cell.size() != 4)
    throw files::InputError(name + ": its mosaic is no cell of 2 x 2, and no other is read");
  for (std::size_t i = 0; i < 4; ++i)
    facts.pattern[i / 2][i % 2] = cell[i] >= 0 && cell[i] <= 2 ? static_cast<int>(cell[i]) : 9;
  if (!is_bayer(facts.pattern))
    throw files::InputError(name + ": its mosaic is not Bayer's: green on a diagonal, red and blue");

  for (const Tag tag : {kBlackAlong, kBlackDown})
    for (const double delta : tags->numbers(mosaic, tag))
      if (delta != 0) throw files::InputError(name + ": has a black level for each row or column, which is not read");
  std::vector<double> repeats = tags->numbers(mosaic, kBlackCell), black = tags->numbers(mosaic, kBlackLevel);
  if (repeats.size() != 2) repeats = {1, 1};
  if (black.empty()) black = {0};
  const auto down = static_cast<std::size_t>(std::clamp(repeats[0], 0.0, 9.0)),
             along = static_cast<std::size_t>(std::clamp(repeats[1], 0.0, 9.0));
  if (down < 1 || down > 2 || along < 1 || along > 2 || black.size() != down * along)
    throw files::InputError(name + ": its black levels are no cell of at most 2 x 2");
  for (std::size_t i = 0; i < 4; ++i) facts.black[i / 2][i % 2] = black[(i / 2 % down) * along + i % 2 % along];
  facts.white = tags->number(mosaic, kWhiteLevel).value_or(65535);
  for (const auto& row : facts.black)
    for (const double level : row)
      if (!(level >= 0 && level < facts.white && facts.white <= 65535))
        throw files::InputError(name + ": black level " + files::number_text(level) + " and white level " +
                                files::number_text(facts.white) + " do not rise within 0 to 65535");
  fill_colors(*tags, first, name, facts);
  return facts;
}

Developed develop(std::string_view bytes, const std::string& name, const RawOptions& options) {
  Developed out;
  out.facts = facts_of_dng(bytes, name);
  const DngFacts& facts = out.facts;
  if (options.balance == Balance::kNone && !options.is_camera_space)
    throw files::UsageError(
        "the camera's matrix is for balanced light; no white balance goes with --camera-space only");
  out.gains = gains_of(facts, options);
  // Without balance the mosaic is taken apart with it, and the gains are taken back afterwards.
  const Rgb3 inner = options.balance == Balance::kNone ? facts.as_shot.value_or(facts.daylight) : out.gains;
  image::Texels mosaic = image::decode_mosaic(bytes, name);
  const int width = mosaic.width, height = mosaic.height;
  if (width < 4 || height < 4)
    throw files::InputError(name + ": " + std::to_string(width) + " x " + std::to_string(height) +
                            " sites; 4 x 4 are needed");

  std::vector<std::uint8_t> is_full(mosaic.count());
  const auto row_of = [&](int y) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width); };
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto j = static_cast<std::size_t>(y % 2), i = static_cast<std::size_t>(x % 2);
      float& site = mosaic.floats[row_of(y) + static_cast<std::size_t>(x)];
      const double count = static_cast<double>(site), black = facts.black[j][i];
      is_full[row_of(y) + static_cast<std::size_t>(x)] = count >= facts.white;
      site = static_cast<float>((count - black) / (facts.white - black) *
                                inner[static_cast<std::size_t>(facts.pattern[j][i])]);
    }
  });
  out.light = demosaic(mosaic.floats, width, height, facts.pattern);
  mosaic = {};

  out.is_clipped.resize(is_full.size());
  image::Matrix3 matrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (!options.is_camera_space) matrix = facts.rec709_from_camera;
  if (options.balance == Balance::kNone)
    for (std::size_t c = 0; c < 3; ++c) matrix[c][c] = 1 / inner[c];
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      bool clipped = false;
      for (int v = std::max(0, y - 2); v <= std::min(height - 1, y + 2); ++v)
        for (int u = std::max(0, x - 2); u <= std::min(width - 1, x + 2); ++u)
          clipped = clipped || is_full[row_of(v) + static_cast<std::size_t>(u)] != 0;
      out.is_clipped[row_of(y) + static_cast<std::size_t>(x)] = clipped;
      const auto pixel = out.light.at(x, y);
      Rgb3 camera{};
      for (std::size_t c = 0; c < 3; ++c) {
        const double v = static_cast<double>(pixel[c]);
        camera[c] = clipped ? std::min(v, 1.0) : v;
      }
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = static_cast<float>(matrix[c][0] * camera[0] + matrix[c][1] * camera[1] + matrix[c][2] * camera[2]);
    }
  });
  out.clipped = static_cast<std::size_t>(std::ranges::count(out.is_clipped, 1));
  turn_upright(out, facts.orientation);
  return out;
}

}  // namespace likeness::photograph
