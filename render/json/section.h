#pragma once

#include <span>
#include <string>
#include <string_view>

#include "brdf/parameter.h"

// The keys of a file in JSON, stated once: the reader (Fields) checks by these rows, and the tables of its page in docs
// are written from them.
namespace likeness::json {

enum class Form {
  kText,
  kFile,    // relative to the scene file's folder
  kChoice,  // one of the words in `choices`
  kFlag,    // true, false
  kWhole,   // an integer
  kNumber,
  kPair,        // [x, y]
  kVector,      // [x, y, z]
  kScale,       // a number, or [x, y, z]
  kColor,       // linear RGB: a number for all three, or [r, g, b]
  kMatrix,      // three or four rows of four numbers; the fourth is 0 0 0 1
  kNumbers,     // a list of any length
  kTexts,       // a list of texts
  kParameters,  // of a surface model: by name a number, [r, g, b], or a texture
  kNames,       // an object of texts
  kObject,      // of the one section
  kList,        // of objects of a section
  kMap          // names to objects of a section
};

struct Section;

struct Key {
  std::string_view name;
  Form form = Form::kNumber;
  std::string_view initial = {};  // default, as in the file (texts without quotes); empty: none
  brdf::Interval range = {-1e9, 1e9};
  bool above = false;  // the lower end of the range itself is not allowed
  std::string_view unit = {};
  bool required = false;
  std::span<const std::string_view> choices = {};
  std::span<const Section* const> sections = {};  // if many, an object's "type" says which
  std::string_view text;
};

struct Section {
  std::string_view name;  // in docs, and "type" of a light
  std::string_view text;
  std::span<const Key> keys;

  const Key* find(std::string_view key) const {
    for (const Key& row : keys)
      if (row.name == key) return &row;
    return nullptr;
  }
};

inline constexpr std::string_view kComment = "comment";  // a key that is allowed, and ignored, in every object

// The default as JSON; empty if there is none.
std::string default_text(const Key& key);

// A table of Markdown: key, value, default, unit, what it does.
std::string table_text(const Section& section);

// A text of plain letters as JSON.
std::string in_json(std::string_view text);

}  // namespace likeness::json
