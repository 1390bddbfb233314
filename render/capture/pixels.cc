#include "render/capture/pixels.h"

#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/tone_curve.h"

namespace likeness::capture {
namespace {

// Linear Rec. 709 (D65) from linear AP1 (ACES white), Bradford adapted: as render/view has it from OpenColorIO.
const glm::dmat3 kRec709FromAcesCg = glm::transpose(glm::dmat3(  //
    1.70505099, -0.62179212, -0.08325887,                        //
    -0.13025642, 1.14080474, -0.01054832,                        //
    -0.02400336, -0.12896898, 1.15297233));

glm::dmat3 rec709_from(const Frame& frame, const Camera& camera) {
  switch (frame.primaries) {
    case Primaries::kRec709:
      return glm::dmat3(1);
    case Primaries::kAcesCg:
      return kRec709FromAcesCg;
    case Primaries::kCamera:
      return camera.rec709_from_camera;
  }
  return glm::dmat3(1);
}

void must_fit(const std::filesystem::path& file, int width, int height, const Camera& camera) {
  if (width == camera.width && height == camera.height) return;
  throw files::InputError(file.string() + ": has " + std::to_string(width) + " x " + std::to_string(height) +
                          " pixels; its camera " + files::in_quotes(camera.id) + " has " +
                          std::to_string(camera.width) + " x " + std::to_string(camera.height));
}

// Channel c of texel i as a number, bytes divided by 255; grey stands for all three.
struct Encoded {
  const image::Texels& texels;
  float operator()(std::size_t i, std::size_t c) const {
    const auto channels = static_cast<std::size_t>(texels.channels);
    const std::size_t at = i * channels + (channels < 3 ? 0 : c);
    return texels.bytes.empty() ? texels.floats[at] : static_cast<float>(texels.bytes[at]) / 255.0f;
  }
};

// f(first, last) over the pixels, in parallel.
template <class F>
void over_pixels(std::size_t count, const F& f) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1 << 14),
                    [&](const tbb::blocked_range<std::size_t>& range) { f(range.begin(), range.end()); });
}

constexpr double kRec709Linear = 0.018053968510807, kRec709Scale = 1.099296826809442;  // BT.2020's digits of BT.709

}  // namespace

float linear_of(Transfer transfer, float value) {
  const double y = std::abs(static_cast<double>(value));
  double x = y;
  switch (transfer) {
    case Transfer::kLinear:
      return value;
    case Transfer::kSrgb:
      return static_cast<float>(image::srgb_decode(value));
    case Transfer::kRec709:
      x = y < 4.5 * kRec709Linear ? y / 4.5 : std::pow((y + kRec709Scale - 1) / kRec709Scale, 1 / 0.45);
      break;
    case Transfer::kGamma22:
      x = std::pow(y, 2.2);
      break;
  }
  return static_cast<float>(std::copysign(x, value));
}

float encoded_of(Transfer transfer, float light) {
  const double x = std::abs(static_cast<double>(light));
  double y = x;
  switch (transfer) {
    case Transfer::kLinear:
      return light;
    case Transfer::kSrgb:
      return static_cast<float>(image::srgb_encode(light));
    case Transfer::kRec709:
      y = x < kRec709Linear ? 4.5 * x : kRec709Scale * std::pow(x, 0.45) - (kRec709Scale - 1);
      break;
    case Transfer::kGamma22:
      y = std::pow(x, 1 / 2.2);
      break;
  }
  return static_cast<float>(std::copysign(y, light));
}

image::Picture read_encoded(const std::filesystem::path& file) {
  const image::Texels texels = image::read_texels(file);
  const Encoded encoded{texels};
  image::Picture out(texels.width, texels.height);
  for (std::size_t i = 0; i < texels.count(); ++i)
    for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * i + c] = encoded(i, c);
  return out;
}

CameraLayers read_camera_layers(const Capture& capture, std::size_t camera) {
  CameraLayers out;
  if (const auto file = layer_file(capture, camera, Layer::kFlatField); !file.empty()) {
    out.flat_field = image::read_texels(file);
    must_fit(file, out.flat_field.width, out.flat_field.height, capture.cameras[camera]);
  }
  out.mask = read_mask(capture, camera);
  return out;
}

Photo read_photo(const Capture& capture, std::size_t at) {
  return read_photo(capture, at, read_camera_layers(capture, capture.frames[at].camera));
}

Photo read_photo(const Capture& capture, std::size_t at, const CameraLayers& layers) {
  const Frame& frame = capture.frames[at];
  const Camera& camera = capture.cameras[frame.camera];
  const std::filesystem::path file = photo_file(capture, frame);
  image::Texels texels = image::read_texels(file);
  must_fit(file, texels.width, texels.height, camera);
  const image::Texels& flat = layers.flat_field;
  const std::vector<std::uint8_t>& mask = layers.mask;

  // Three floats a pixel become its light in their own place.
  Photo out;
  out.light.width = texels.width;
  out.light.height = texels.height;
  const bool is_in_place = texels.channels == 3 && texels.bytes.empty();
  if (!is_in_place) out.light.rgb.resize(3 * texels.count());
  std::vector<float>& rgb = is_in_place ? texels.floats : out.light.rgb;
  out.flaws.resize(texels.count());
  const Encoded encoded{texels}, flat_of{flat};
  const glm::dmat3 to_rec709 = rec709_from(frame, camera);
  const bool is_linear = frame.transfer == Transfer::kLinear;
  const bool turns_colors = to_rec709 != glm::dmat3(1);
  const double scale = 1 / (frame.white - frame.black);
  glm::dvec3 gain_of(frame.gain);
  if (is_of_one_light(frame.kind)) gain_of /= capture.lights[frame.light].intensity;
  const std::array<double, 3> gain{gain_of.x, gain_of.y, gain_of.z};
  std::array<float, 256> of_byte{};  // a byte's value after black, white and curve
  for (std::size_t k = 0; k < 256 && !texels.bytes.empty(); ++k)
    of_byte[k] = linear_of(frame.transfer, static_cast<float>((double(k) / 255 - frame.black) * scale));
  const auto channels = static_cast<std::size_t>(texels.channels);

  over_pixels(texels.count(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      std::uint8_t flaws = mask[i] != 0 ? 0 : kMasked;
      bool is_black = true, is_finite = true;
      std::array<double, 3> light;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto x = static_cast<float>((static_cast<double>(encoded(i, c)) - frame.black) * scale);
        if (!std::isfinite(x)) is_finite = false;
        if (x >= frame.clip) flaws |= kClipped;
        if (x > 0) is_black = false;
        if (!texels.bytes.empty()) light[c] = of_byte[texels.bytes[i * channels + (channels < 3 ? 0 : c)]];
        else light[c] = is_linear ? x : linear_of(frame.transfer, x);
      }
      if (turns_colors) {
        const glm::dvec3 turned = to_rec709 * glm::dvec3(light[0], light[1], light[2]);
        light = {turned.x, turned.y, turned.z};
      }
      for (std::size_t c = 0; c < 3; ++c) light[c] *= gain[c];
      for (std::size_t c = 0; c < 3 && !flat.is_empty(); ++c) light[c] /= static_cast<double>(flat_of(i, c));
      for (const double v : light)
        if (!std::isfinite(static_cast<float>(v))) is_finite = false;
      if (!is_finite) {
        flaws |= kNotFinite;
        light = {0, 0, 0};
        is_black = false;
      }
      if (is_black) flaws |= kBlack;
      for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = static_cast<float>(light[c]);
      out.flaws[i] = flaws;
    }
  });
  if (is_in_place) out.light.rgb = std::move(texels.floats);
  return out;
}

image::Picture read_render(const Capture& capture, const Variant& variant, std::size_t camera, std::size_t light) {
  const std::filesystem::path file = render_file(capture, variant, camera, light);
  image::Picture out = image::read_picture(file);
  must_fit(file, out.width, out.height, capture.cameras[camera]);
  return out;
}

std::vector<std::uint8_t> read_mask(const Capture& capture, std::size_t camera) {
  const Camera& of = capture.cameras[camera];
  const std::filesystem::path file = layer_file(capture, camera, Layer::kMask);
  if (file.empty())
    return std::vector<std::uint8_t>(static_cast<std::size_t>(of.width) * static_cast<std::size_t>(of.height), 1);
  const image::Texels texels = image::read_texels(file);
  must_fit(file, texels.width, texels.height, of);
  const Encoded encoded{texels};
  std::vector<std::uint8_t> out(texels.count());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = encoded(i, 1) >= 0.5f ? 1 : 0;
  return out;
}

image::Picture read_normals(const Capture& capture, std::size_t camera) {
  const std::filesystem::path file = layer_file(capture, camera, Layer::kNormal);
  if (file.empty())
    throw files::InputError(capture.root.string() + ": camera " + files::in_quotes(capture.cameras[camera].id) +
                            " has no layer of normals (cameras.json: \"layers\": {\"normal\": FILE})");
  const image::Texels texels = image::read_texels(file);
  must_fit(file, texels.width, texels.height, capture.cameras[camera]);
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool is_signed = ending == ".exr" || ending == ".pfm";
  const Encoded encoded{texels};
  image::Picture out(texels.width, texels.height);
  for (std::size_t i = 0; i < texels.count(); ++i) {
    glm::dvec3 n(encoded(i, 0), encoded(i, 1), encoded(i, 2));
    if (!is_signed) n = 2.0 * n - 1.0;
    const double length = glm::length(n);
    // Half a unit: what is stored as no normal is 0, or grey within a rounding of 8 bits.
    n = std::isfinite(length) && length > 0.5 ? n / length : glm::dvec3(0);
    for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * i + c] = static_cast<float>(n[int(c)]);
  }
  return out;
}

}  // namespace likeness::capture
