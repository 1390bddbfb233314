#include "realis/layers.h"

#include <algorithm>
#include <array>
#include <string>

#include "render/capture/files_of_capture.h"
#include "render/files/interrupt.h"
#include "render/image/write.h"

namespace likeness::realis {
namespace {

using Color = std::array<float, 3>;

Color grey(float value) { return {value, value, value}; }

bool is_layer(std::string_view id) {
  return id == kRawErrorLayer || id == kDemodulatedLayer || id.starts_with(kWeightLayer) ||
         id.starts_with(kCoefficientLayer);
}

class Writer {
 public:
  Writer(capture::Capture& capture, const Subject& subject, const std::filesystem::path& folder)
      : capture_(capture), subject_(subject), pattern_((folder / "layers/{variant}/{camera}").generic_string()) {
    std::erase_if(capture.variants, [](const capture::Variant& variant) { return is_layer(variant.id); });
  }

  // `value` of a texel and a light, as Subject counts them.
  template <typename Value>
  void put(const std::string& id, const Value& value) {
    const capture::Variant& variant = capture_.variants.emplace_back(id, pattern_ + "/{light}.exr");
    for (std::size_t light = 0; light < subject_.lights.size(); ++light)
      write(variant, subject_.lights[light], [&](std::size_t texel) { return value(texel, light); });
  }
  // `value` of a texel.
  template <typename Value>
  void put_lightless(const std::string& id, const Value& value) {
    const capture::Variant& variant = capture_.variants.emplace_back(id, pattern_ + ".exr");
    write(variant, 0, value);
  }

 private:
  template <typename Value>
  void write(const capture::Variant& variant, std::size_t light, const Value& value) const {
    if (files::interrupted()) throw files::Interrupted();
    image::Picture picture(subject_.width, subject_.height);
    for (std::size_t texel = 0; texel < subject_.texels(); ++texel) {
      const Color color = value(texel);
      std::copy(color.begin(), color.end(), picture.rgb.data() + 3 * std::size_t{subject_.pixels[texel]});
    }
    image::write_exr(capture::render_file(capture_, variant, subject_.camera, light), picture);
  }

  capture::Capture& capture_;
  const Subject& subject_;
  std::string pattern_;
};

std::string numbered(std::size_t k) {
  const std::string digits = std::to_string(k);
  return std::string(kCoefficientLayer) + std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits;
}

}  // namespace

void write_layers(capture::Capture& capture, const Subject& subject, const baked::Bake& bake,
                  std::span<const weight::Layer> weights, const std::filesystem::path& folder) {
  Writer writer(capture, subject, folder);
  const auto error_over = [&](std::size_t texel, std::size_t light, double divisor) {
    const std::size_t at = subject.samples_of(texel) + light;
    Color out{};
    for (std::size_t c = 0; c < 3; ++c)
      out[c] = static_cast<float>(
          (static_cast<double>(subject.photo[at][c]) - static_cast<double>(subject.render[at][c])) / divisor);
    return out;
  };
  writer.put(std::string(kRawErrorLayer),
             [&](std::size_t texel, std::size_t light) { return error_over(texel, light, 1); });
  writer.put(std::string(kDemodulatedLayer), [&](std::size_t texel, std::size_t light) {
    const auto cosine = static_cast<double>(subject.cosine[subject.samples_of(texel) + light]);
    return error_over(texel, light, subject.irradiance_of(light) * std::max(cosine, bake.floor));
  });
  const auto put_weight = [&](std::string_view name, std::span<const float> values) {
    writer.put(std::string(kWeightLayer) + std::string(name),
               [&](std::size_t texel, std::size_t light) { return grey(values[subject.samples_of(texel) + light]); });
  };
  put_weight("all", subject.weight);
  for (const weight::Layer& layer : weights) put_weight(layer.name, layer.weights);
  const std::size_t size = bake.basis.size(), channels = bake.channel_count();
  const std::size_t shown =
      std::min(size, capture::kMostVariants - std::min(capture::kMostVariants, capture.variants.size()));
  for (std::size_t k = 0; k < shown; ++k)
    writer.put_lightless(numbered(k), [&](std::size_t texel) {
      const float* first = bake.coefficients.data() + texel * channels * size + k;
      return channels == 1 ? grey(first[0]) : Color{first[0], first[size], first[2 * size]};
    });
  capture::write_capture(capture);
}

}  // namespace likeness::realis
