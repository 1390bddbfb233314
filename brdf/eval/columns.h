#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/catalog/catalog.h"

// What the names in a table's header mean to an evaluator.
namespace likeness::eval {

// A value for every row: "roughness=0.3", "base_color=0.5,0.2,0.1" or "base_color_g=0.2".
struct Assignment {
  std::string name;
  std::vector<double> values;  // 1 or 3
};

// Throws files::UsageError that begins with `option`.
Assignment assignment_of(const std::string& text, const std::string& option = "--set");

// Inputs and outputs are counted by channel: a color is three of them.
struct Columns {
  struct Input {
    std::size_t column, first, channels;  // the column holds for `channels` inputs from `first`
  };
  struct Reference {
    std::string name;                      // of the column: "ref_f"
    std::size_t column, output, channels;  // is compared with `channels` outputs from `output`
  };
  struct Output {
    std::string name;
    std::size_t output;
  };
  const catalog::Form* form = nullptr;
  std::size_t count = 0;                // of columns in the table
  std::vector<Input> inputs;            // in the table's order
  std::vector<Reference> references;    // in the table's order
  std::vector<Output> outputs;          // what is appended
  std::vector<double> fixed;            // of every input: what --set gives, or the default
  std::vector<std::size_t> directions;  // the first input of each unit vector
  bool grey = false;                    // every color has one value, so one column holds an output's channels
  std::string defaults;                 // the inputs that neither gives, as "phi_d = 1.57, metallic = 0"
};

// Which column is which. The form is the one that knows most of the names; of several the one that knows most of the
// header's, and of these the first. `place` begins the messages: "table.csv:1". Throws files::InputError for a column,
// files::UsageError for an assignment.
Columns columns_of(const catalog::Entry& entry, std::span<const std::string_view> header,
                   std::span<const Assignment> assignments, const std::string& place);

// Where a name leads to in a form: `channels` inputs from `first`; 0 channels if it knows no such name.
struct InputPlace {
  std::size_t first = 0, channels = 0;
};
InputPlace input_named(const catalog::Form& form, std::string_view name);

// The channel suffixes of colors: "_r", "_g", "_b".
inline constexpr std::array<std::string_view, 3> kChannelSuffixes{"_r", "_g", "_b"};

// A table of one row: every input of the form that the assignments choose, at their values or the defaults.
std::string table_of_defaults(const catalog::Entry& entry, std::span<const Assignment> assignments);

}  // namespace likeness::eval
