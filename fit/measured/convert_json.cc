#include <nlohmann/json.hpp>

#include "fit/measured/convert.h"

namespace likeness::measured {

std::string json_of(const Conversion& c, const ConvertOptions& options) {
  const auto side = [](const std::filesystem::path& file, Format format, const Coverage& k, double share) {
    return nlohmann::ordered_json{{"file", file.string()},  {"format", kFormatNames[int(format)]},
                                  {"stored", k.stored},     {"valid", k.valid},
                                  {"negative", k.negative}, {"not_finite", k.not_finite},
                                  {"padding", k.padding},   {"clipped", k.clipped},
                                  {"repeats", k.repeats},   {"directions", share}};
  };
  const nlohmann::ordered_json report{
      {"from", side(options.in, c.from, c.in, c.directions_in)},
      {"to", side(options.out, c.to, c.out, c.directions_out)},
      {"resampled", c.resampled},
      {"read_back",
       {{"compared", c.compared}, {"lost", c.lost}, {"median_pct", c.median_pct}, {"worst_pct", c.worst_pct}}}};
  // A file name need not be UTF-8.
  return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace likeness::measured
