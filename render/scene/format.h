#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/json/fields.h"
#include "render/json/section.h"

// The keys of a scene file, stated once: the reader checks by these rows, and the JSON schema and the tables of
// docs/scene.md are written from them.
namespace likeness::scene {

using json::Fields;
using json::Form;
using json::kComment;
using json::Key;
using json::near_text;
using json::refuse_at;
using json::Section;

// The file as a whole; all others hang on it.
extern const Section kSceneSection;
extern const Section kTextureSection;  // within the parameters of a material

inline constexpr std::string_view kFormatName = "likeness scene";

// docs/schema/scene.schema.json, and the tables of docs/scene.md by section.
std::string schema_text();
std::string table_text(std::string_view section);
std::vector<std::string> section_names();

}  // namespace likeness::scene
