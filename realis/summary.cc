#include "realis/summary.h"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "render/baked/format.h"

namespace likeness::realis {
namespace {

std::string fixed(double value, int digits, int width = 0) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%*.*f", width, digits, value);
  return text.data();
}

}  // namespace

std::string text_of(const Summary& s) {
  std::string out = std::to_string(s.texels) + " texels under " + std::to_string(s.lights) + " lights";
  if (s.cameras > 1) out += " from " + std::to_string(s.cameras) + " cameras";
  out += ": " + std::to_string(s.lobes) + " lobes, " + std::to_string(s.bytes_of_texel) + " bytes a texel\n";
  out += "photo - render            " + fixed(s.plain_rms, 5) + " rms\n";
  out += "photo - (render + realis) " + fixed(s.left_rms, 5) + " rms\n";
  if (!s.ladder.empty()) out += "lobes  held out (luminance rms)\n";
  for (std::size_t i = 0; i < s.ladder.size(); ++i)
    out += fixed(static_cast<double>(s.ladder[i].basis.lobes.size()), 0, 5) + "  " + fixed(s.ladder[i].held_out, 6) +
           (i == s.chosen ? "  taken\n" : "\n");
  for (const std::string& line : s.noticed) out += "noticed: " + line + "\n";
  if (s.work_bytes > 0)
    out += "on disk while it lasted: " + fixed(static_cast<double>(s.work_bytes) / 1e6, 1) + " MB\n";
  return out + "read in " + fixed(s.reading_s, 1) + " s, baked in " + fixed(s.baking_s, 1) + " s: " + s.file.string() +
         "\n";
}

std::string json_of(const Summary& s) {
  nlohmann::ordered_json out;
  out["bake"] = s.file.string();
  out["space"] = baked::kSpaces[static_cast<std::size_t>(s.space)];
  out["texels"] = s.texels, out["lights"] = s.lights, out["cameras"] = s.cameras;
  out["lobes"] = s.lobes, out["bytes_of_texel"] = s.bytes_of_texel;
  out["render_rms"] = s.plain_rms, out["realis_rms"] = s.left_rms;
  auto& ladder = out["ladder"] = nlohmann::ordered_json::array();
  for (const Choice& choice : s.ladder)
    ladder.push_back({{"lobes", choice.basis.lobes.size()}, {"held_out_rms", choice.held_out}});
  if (!s.ladder.empty()) out["taken"] = s.chosen;
  out["reading_s"] = s.reading_s, out["baking_s"] = s.baking_s, out["work_bytes"] = s.work_bytes;
  out["noticed"] = s.noticed;
  return out.dump(1) + "\n";
}

}  // namespace likeness::realis
