#include <algorithm>

#include "fit/measured/csv.h"
#include "fit/measured/mbsdf.h"
#include "fit/measured/measured.h"
#include "fit/measured/merl.h"
#include "fit/measured/refuse.h"
#include "fit/measured/rgl.h"

namespace likeness::measured {
namespace {

// Whether the first bytes could be lines of numbers: no control characters but blanks.
bool looks_like_text(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 4096);
  return std::all_of(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) >= ' ' || c == '\n' || c == '\r' || c == '\t';
  });
}

}  // namespace

std::unique_ptr<Material> parse(std::string bytes, const std::string& name) {
  const std::string extension = std::filesystem::path(name).extension().string();
  const std::string_view view = bytes;
  if (bytes.empty())
    refuse(name, "an empty file", "a measured material: MERL .binary, NVIDIA .mbsdf, RGL .bsdf or CSV");
  if (view.starts_with(kMbsdfMagic)) return parse_mbsdf(view, name);
  if (view.starts_with(kTensorMagic)) return parse_rgl(view, name);
  // No magic: the extension says what the file was meant to be, so that the message names what is wrong with it.
  if (extension == ".mbsdf") return parse_mbsdf(view, name);
  if (extension == ".bsdf") return parse_rgl(view, name);
  if (extension == ".binary" || bytes.size() == MerlSize{}.bytes()) return parse_merl(std::move(bytes), name);
  if (looks_like_text(view)) return parse_csv(view, name);
  const MerlSize merl;
  const std::string_view dimensions = view.substr(0, 2);
  if (bytes.size() >= 12 && dimensions == std::string_view("\x5a\0", 2)) return parse_merl(std::move(bytes), name);
  refuse(name, std::to_string(bytes.size()) + " bytes of an unknown kind",
         "MERL .binary (" + std::to_string(merl.bytes()) + " bytes), NVIDIA .mbsdf, RGL .bsdf or CSV");
}

std::unique_ptr<Material> read(const std::filesystem::path& file) {
  return parse(files::read_whole(file, kLargestFile), file.string());
}

}  // namespace likeness::measured
