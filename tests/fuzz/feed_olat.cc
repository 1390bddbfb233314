#include "tests/fuzz/feed_olat.h"

#include <cmath>
#include <string>

#include "olat/pair/state.h"
#include "olat/tev/images.h"
#include "olat/tev/packet.h"
#include "render/files/files.h"
#include "tests/fuzz/feed.h"

namespace likeness::olat_pair::test {
namespace {

using measured::test::hold;

bool feed_packets(std::string_view bytes) {
  constexpr std::size_t kMost = 1 << 20;
  olat_tev::Images images(kMost);
  try {
    while (!bytes.empty()) {
      const std::size_t length = olat_tev::length_of(bytes);
      images.take(olat_tev::packet_of(bytes.substr(0, length)));
      bytes.remove_prefix(length);
      hold(images.bytes() <= kMost, "the limit holds");
      std::size_t values = 0;
      for (const auto& known : images.list()) {
        const auto picture = images.picture(known.name);
        hold(picture && picture->width > 0 && picture->height > 0, "a picture that is listed is there");
        hold(picture->rgb.size() ==
                 3 * static_cast<std::size_t>(picture->width) * static_cast<std::size_t>(picture->height),
             "every pixel is there");
        values += picture->rgb.size();
      }
      hold(values * sizeof(float) == images.bytes(), "every byte is counted");
    }
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    hold(message.starts_with("tev: ") && message.find('\n') == message.npos, "a message is one line");
    return false;
  }
  return true;
}

bool feed_state(std::string_view text) {
  try {
    const State state = state_of(text);
    const std::string again = text_of(state);
    hold(text_of(state_of(again)) == again, "a text is that of the state it makes");
    for (const Field& field : fields())
      if (const auto* at = std::get_if<double State::*>(&field.at))
        hold(std::isfinite(state.*(*at)) && state.*(*at) >= field.range[0] && state.*(*at) <= field.range[1],
             "a number is within its range");
    hold(hash_of(pipeline_of(state)).size() == 8, "a pipeline has eight digits");
  } catch (const files::UsageError& error) {
    hold(std::string_view(error.what()).find('\n') == std::string_view::npos, "a message is one line");
    return false;
  }
  return true;
}

}  // namespace

bool feed_olat(std::string_view format, std::string_view bytes) {
  return format == "tev" ? feed_packets(bytes) : feed_state(bytes);
}

}  // namespace likeness::olat_pair::test
