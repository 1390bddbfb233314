#include "tests/fuzz/feed_exr.h"

#include <functional>
#include <stdexcept>
#include <string>

#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/read_exr.h"
#include "tests/fuzz/feed.h"

namespace likeness::image::test {
namespace {

using measured::test::hold;

constexpr std::size_t kMost = 1 << 16;

bool is_accepted(const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    hold(message.starts_with("fuzz: "), "a message names the file");
    hold(message.find('\n') == message.npos, "a message is one line");
    return false;
  }
}

}  // namespace

bool feed_exr(std::string_view bytes) {
  if (!is_exr(bytes)) return false;
  const bool is_picture = is_accepted([&] {
    const Texels texels = decode_exr(bytes, "fuzz", {.most_texels = kMost});
    hold(texels.width > 0 && texels.height > 0 && texels.channels > 0 && texels.channels <= 4, "a picture has texels");
    hold(texels.count() <= kMost, "the limit holds");
    hold(texels.floats.size() == texels.count() * static_cast<std::size_t>(texels.channels), "every texel is there");
  });
  const bool is_layers = is_accepted([&] {
    const Layers layers = decode_layers(bytes, "fuzz", kMost);
    std::size_t values = 0;
    for (const Layer& layer : layers.layers) {
      const auto pixels = static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
      hold(layer.data.size() == pixels * layer.channels.size(), "every value is there");
      values += layer.data.size();
    }
    hold(values > 0 && values <= kMost, "the limit holds");
  });
  return is_picture || is_layers;
}

}  // namespace likeness::image::test
