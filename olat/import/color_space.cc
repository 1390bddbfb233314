#include "olat/import/color_space.h"

#include <algorithm>
#include <cctype>

#include "render/files/files.h"

namespace likeness::olat_import {
namespace {

struct Ending {
  std::string_view name;
  bool is_linear;
  std::string_view reason;
};
constexpr std::array kEndings{
    Ending{".exr", true, "EXR holds light"},
    Ending{".pfm", true, "PFM holds light"},
    Ending{".hdr", true, "HDR holds light"},
    Ending{".dng", true, "DNG is linear when it is read"},
    Ending{".png", false, ""},
    Ending{".jpg", false, ""},
    Ending{".jpeg", false, ""},
    Ending{".tif", false, ""},
    Ending{".tiff", false, ""},
    Ending{".tga", false, ""},
};

const Ending* ending_of(const std::filesystem::path& file) {
  const std::string ending = lower(file.extension().string());
  const auto at = std::ranges::find(kEndings, ending, &Ending::name);
  return at == kEndings.end() ? nullptr : &*at;
}

}  // namespace

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

const ColorSpace& color_space_named(const std::string& name) {
  std::vector<std::string_view> names;
  std::string all;
  for (const ColorSpace& one : kColorSpaces) {
    if (one.name == name) return one;
    names.push_back(one.name);
    all += (all.empty() ? "" : ", ") + std::string(one.name);
  }
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw files::UsageError("--color-space " + files::in_quotes(name) + " is unknown" +
                          (near.empty() ? "" : "; did you mean " + near + "?") + " (there are " + all + ")");
}

std::optional<Known> known_by_format(const std::filesystem::path& file) {
  const Ending* ending = ending_of(file);
  if (!ending || !ending->is_linear) return std::nullopt;
  return Known{&kColorSpaces[0], std::string(ending->reason)};
}

std::optional<Known> known_by_remark(std::string_view remarks, const std::string& name) {
  const std::string text = lower(std::string(remarks));
  const auto is_letter = [&](std::size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '-');
  };
  constexpr std::string_view kWord = "linear";
  for (std::size_t at = text.find(kWord); at != text.npos; at = text.find(kWord, at + 1))
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + kWord.size()))
      return Known{&kColorSpaces[0], name + " calls its pixels linear"};
  return std::nullopt;
}

bool is_photograph(const std::filesystem::path& file) { return ending_of(file) != nullptr; }

}  // namespace likeness::olat_import
