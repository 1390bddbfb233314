#include "tests/fuzz/feed_bake.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "render/baked/bake_file.h"
#include "render/baked/residual.h"
#include "render/files/files.h"

namespace likeness::baked::test {
namespace {

constexpr int kWidth = 7, kHeight = 5;
constexpr std::size_t kCount = 35;
constexpr std::string_view kParted = "\n====\n";

void must(bool promise, const char* text) {
  if (!promise) throw std::logic_error(text);
}

// Every third texel unknown; the lobes' pictures name lobes 0 to 6.
image::Texels picture_of(const std::filesystem::path& file, std::size_t most) {
  must(most >= 1, "a limit is given");
  image::Texels out{kWidth, kHeight, 3, {}, {}};
  const bool is_lobes = file.filename().string().starts_with("lobes");
  for (std::size_t i = 0; i < 3 * kCount; ++i)
    out.bytes.push_back(static_cast<std::uint8_t>(is_lobes ? i % 7 : i / 3 % 3 == 0 ? 0 : 1 + 37 * i % 255));
  return out;
}

Access access_of(const std::array<std::string_view, 3>& parts) {
  return {
      [parts](const std::filesystem::path& file, std::size_t limit) {
        const std::string name = file.filename().string();
        const std::string_view text = name == "bake.json" ? parts[0] : name == "surface.json" ? parts[1] : parts[2];
        if (text.size() > limit) throw files::InputError(file.string() + ": too large");
        return std::string(text);
      },
      picture_of,
      [](const std::filesystem::path&, std::size_t most) {
        image::Layers out{kWidth, kHeight, {}, {}};
        for (std::size_t i = 0; i < most / kCount && i < 1024; ++i)
          out.layers.push_back(
              {"c" + std::to_string(i), {"Y"}, std::vector<float>(kCount, 0.01f * static_cast<float>(i % 9) - 0.04f)});
        return out;
      },
      [parts](const std::filesystem::path&) { return !parts[1].empty(); }};
}

bool is_accepted(const auto& read) {
  try {
    read();
    return true;
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    must(message.starts_with("fuzz/"), "a message names the file");
    must(message.find('\n') == message.npos, "a message is one line");
    return false;
  }
}

void check(const StoredBake& stored) {
  must(stored.width > 0 && stored.height > 0, "a bake has a size");
  must(stored.bake.basis.lobes.size() <= kMostLobes, "lobes have their limit");
  for (const std::uint32_t pixel : stored.pixels) must(pixel < kCount, "a texel lies in the picture");
  if (stored.pixels.empty()) must(stored.bake.coefficients.empty(), "no texel, no coefficient");
  else must(stored.bake.coefficients.size() % stored.pixels.size() == 0, "texels have as many coefficients each");
  for (const float c : stored.bake.coefficients) must(std::isfinite(c), "a coefficient is finite");
}

void check(const Residual& residual) {
  must(residual.luminance.size() + residual.rgb.size() == residual.groups * residual.count(), "every texel is there");
  if (residual.surface) must(residual.surface->normals.width == residual.width, "property maps are of the bake's size");
  const auto is_finite = [&](const auto& texels) {
    for (const auto& texel : texels) {
      const auto e = brdf::residual(residual.lobes, texel, brdf::Vec3<float>(0.6f, 0, 0.8f));
      if constexpr (requires { e.r; }) must(std::isfinite(e.r + e.g + e.b), "a residual is finite");
      else must(std::isfinite(e), "a residual is finite");
    }
  };
  is_finite(residual.luminance), is_finite(residual.rgb);
}

}  // namespace

bool feed_bake(std::string_view bytes) {
  std::array<std::string_view, 3> parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t at = i + 1 < parts.size() ? bytes.find(kParted) : bytes.npos;
    parts[i] = bytes.substr(0, at);
    bytes = at == bytes.npos ? std::string_view() : bytes.substr(at + kParted.size());
  }
  const Access access = access_of(parts);
  const bool is_bake = is_accepted([&] { check(read_bake("fuzz", access)); });
  const bool is_residual = is_accepted([&] { check(read_residual("fuzz", access)); });
  must(is_bake || !is_residual, "a renderer reads no bake that is none");
  return is_residual;
}

std::string small_bake(std::size_t lobes, std::size_t kept, std::string_view channels, std::string_view storage) {
  std::string out = R"({"type": "realis bake", "version": 1, "capture": "ball", "camera": "c0", "width": 7, "height": 5,
"channels": ")" + std::string(channels) +
                    R"(", "storage": ")" + std::string(storage) + R"(", "floor": 0.4, "kept": )" +
                    std::to_string(kept) + R"(, "lobes": [)";
  for (std::size_t k = 0; k < lobes; ++k)
    out += std::string(k == 0 ? "" : ",\n") + R"({"axis": [0.1, 0.)" + std::to_string(k % 10) +
           R"(, 1], "sharpness": 4.5, "spread": 1, "multiplier": )" +
           (channels == "rgb" ? "[0.1, 0.2, 0.3]}" : "[0.25]}");
  out += R"(], "inputs": {"photo.exr": "00ff"}, "metrics": [{"name": "render_rms", "value": 0.5}]})";
  out += kParted;
  out += R"({"scale": 0.75, "exposure": 1.5})";
  out += kParted;
  return out +
         R"({"format": "likeness material", "version": 1, "model": "callisto", "parameters": {"roughness": 0.4}})";
}

}  // namespace likeness::baked::test
