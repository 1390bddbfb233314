#include "tests/fuzz/feed_photograph.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/files/files.h"
#include "render/photograph/brackets.h"
#include "render/photograph/raw.h"
#include "render/photograph/response.h"
#include "tests/fuzz/feed.h"

namespace likeness::measured::test {
namespace {

void hold_brackets(std::string_view bytes) {
  const auto brackets = photograph::brackets_of(bytes, "fuzz", "folder");
  hold(!brackets.empty() && brackets.size() <= photograph::kMostFrames, "there are frames, and not too many");
  for (const double exposure : photograph::exposures_of(brackets))
    hold(exposure > 0 && std::isfinite(exposure), "an exposure is above 0");
}

void hold_response(std::string_view bytes) {
  const photograph::Response response = photograph::response_of(bytes, "fuzz");
  for (const auto& curve : response.log2_exposure) hold(std::ranges::is_sorted(curve), "a response does not fall");
  const std::string text = photograph::csv_of(response);
  hold(photograph::csv_of(photograph::response_of(text, "again")) == text, "a text is that of the response it makes");
}

void hold_facts(std::string_view bytes) {
  const photograph::DngFacts facts = photograph::facts_of_dng(bytes, "fuzz");
  hold(photograph::is_bayer(facts.pattern), "the mosaic is Bayer's");
  for (const auto& row : facts.black)
    for (const double level : row) hold(level >= 0 && level < facts.white, "levels rise");
  if (facts.as_shot)
    for (const double gain : *facts.as_shot) hold(gain >= 1 && std::isfinite(gain), "the least gain is 1");
  for (const auto& row : facts.rec709_from_camera)
    hold(std::abs(row[0] + row[1] + row[2] - 1) < 1e-6, "a grey stays grey");
}

}  // namespace

bool feed_photograph(std::string_view format, std::string_view bytes) {
  try {
    if (format == "brackets") hold_brackets(bytes);
    else if (format == "response") hold_response(bytes);
    else hold_facts(bytes);
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    hold(message.starts_with("fuzz:"), "a message names the file");
    hold(message.find('\n') == message.npos, "a message is one line");
    return false;
  }
  return true;
}

}  // namespace likeness::measured::test
