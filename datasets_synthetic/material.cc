#include "datasets_synthetic/material.h"

#include <span>
#include <vector>
#include <nlohmann/json.hpp>

#include "datasets_synthetic/random.h"
#include "render/files/files.h"
#include "render/material/material_file.h"
#include "render/material/parameters.h"

namespace likeness::datasets_synthetic {
namespace {

using Json = nlohmann::ordered_json;
using measured::Format;

constexpr std::uint64_t kParameterStream = 1000;  // far from the streams of the faults, which count from 0

std::span<const double> channels_of(const material::Entry& entry) {
  return std::span(entry.value).first(static_cast<std::size_t>(entry.row.channels));
}

Json parameters_of(const brdf::AnyBrdf& brdf) {
  Json out = Json::object();
  for (const material::Entry& entry : material::entries(brdf)) {
    Json& value = out[std::string(entry.row.name)];
    if (entry.row.channels == 1) value = entry.value[0];
    else value = channels_of(entry);
  }
  return out;
}

// Each fault with its setting and the samples it changed; those that were not asked for are there with zeros.
Json faults_of(const Faults& faults, const Counts& counts) {
  Json out = Json::object();
  const auto add = [&](const char* name, auto setting, std::size_t samples) -> Json& {
    return out[name] = {{"setting", setting}, {"samples", samples}};
  };
  add("invalid", faults.invalid, counts.invalid);
  add("invalid-above", faults.invalid_above, counts.invalid_above);
  add("nan", faults.nan, counts.nan);
  add("negative", faults.negative, counts.negative);
  Json& noise = add("noise", faults.noise, counts.noise);
  noise["by_angle"] = faults.noise_by_angle;
  noise["negative_by_noise"] = counts.negative_by_noise;
  add("flare", faults.flare, counts.flare)["flare-angle"] = faults.flare_angle;
  add("clip", faults.clip, counts.clip);
  out["truncate"] = {{"setting", faults.truncate}};
  out["half-bin"] = {{"setting", faults.half_bin}};
  return out;
}

// Empty if `truth` is the manifest of `file`, so that both may be replaced; otherwise why they must stay.
std::string why_kept(const std::filesystem::path& file, const std::filesystem::path& truth) {
  constexpr std::size_t kLargestManifest = 1 << 20;
  const std::string way_out = "; remove it or choose another name";
  if (!std::filesystem::exists(truth))
    return std::filesystem::exists(file) ? file.string() + " exists and was not made by likeness make (no " +
                                               truth.filename().string() + " beside it)" + way_out
                                         : "";
  const Json manifest = Json::parse(files::read_whole(truth, kLargestManifest), nullptr, false);
  if (!manifest.is_object() || !manifest.contains("file") || !manifest["file"].is_string())
    return truth.string() + " exists and is not a manifest" + way_out;
  const std::string owner = manifest["file"];
  return owner == file.filename() ? "" : truth.string() + " belongs to " + material::in_quotes(owner) + way_out;
}

}  // namespace

std::string_view extension_of(Format format) {
  return format == Format::kMbsdf ? ".mbsdf" : format == Format::kCsv ? ".csv" : ".binary";
}

Made make(const Material& material) {
  Grid grid = material.grid;
  if (material.faults.half_bin) grid.within = 0;
  Table table = tabulate(material.brdf, grid);
  Made made;
  made.counts = apply(material.faults, material.brdf, material.seed, table);
  made.bytes = bytes_of(table);
  if (material.faults.truncate >= made.bytes.size() && material.faults.truncate > 0)
    throw files::UsageError("truncate = " + std::to_string(material.faults.truncate) + " leaves nothing of a file of " +
                            std::to_string(made.bytes.size()) + " bytes; cut fewer");
  made.bytes.resize(made.bytes.size() - material.faults.truncate);
  return made;
}

brdf::AnyBrdf drawn(const brdf::AnyBrdf& model, std::uint64_t seed) {
  brdf::AnyBrdf out = model;
  Random random(seed, kParameterStream);
  for (material::Entry entry : material::entries(model)) {
    const brdf::Interval& usual = entry.row.typical;
    for (int c = 0; c < entry.row.channels; ++c)
      entry.value[static_cast<std::size_t>(c)] = usual.low + (usual.high - usual.low) * random.uniform();
    material::assign(out, entry.row.name, channels_of(entry));
  }
  return out;
}

std::string manifest_of(const Material& material, const Made& made, const std::string& file) {
  const Counts& counts = made.counts;
  const Json manifest{
      {"format", "likeness truth"},
      {"version", 1},
      {"made_by", "likeness " LIKENESS_VERSION},
      {"file", file},
      {"bytes", made.bytes.size()},
      {"sha256", files::sha256(made.bytes)},
      {"table",
       {{"format", measured::kFormatNames[static_cast<std::size_t>(material.grid.format)]},
        {"bins", material.grid.bins},
        {"samples", material.grid.size()},
        {"below_horizon", counts.below_horizon},
        {"measured", counts.measured}}},
      {"model", material::model_name(material.brdf)},
      {"parameters", parameters_of(material.brdf)},
      {"seed", material.seed},
      {"faults", faults_of(material.faults, counts)},
  };
  return manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string write(const Material& material, const std::filesystem::path& file) {
  const auto beside = [&](std::string_view extension) {
    std::filesystem::path other = file;
    return other.replace_extension(extension);
  };
  const std::filesystem::path truth = beside(".truth.json");
  if (const std::string why = why_kept(file, truth); !why.empty()) throw files::UsageError(why);
  const Made made = make(material);
  const std::string manifest = manifest_of(material, made, file.filename().string());
  files::write_whole(truth, manifest);
  material::write_material(beside(material::kExtension), {file.stem().string(), material.brdf});
  files::write_whole(file, made.bytes);  // last: where it is, the other two are
  return manifest;
}

}  // namespace likeness::datasets_synthetic
