#include "brdf/eval/columns.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "brdf/eval/csv.h"
#include "render/files/files.h"

namespace likeness::eval {
namespace {

using catalog::Entry;
using catalog::Form;
using files::in_quotes;
using files::number_text;

constexpr std::string_view kReference = "ref_";

// Output `name` of an evaluator, whole or by channel.
InputPlace output_named(const Entry& entry, std::string_view name) {
  std::size_t first = 0;
  for (const brdf::Output& output : entry.outputs) {
    const auto channels = static_cast<std::size_t>(output.channels);
    if (name == output.name) return {first, channels};
    for (std::size_t c = 0; channels == 3 && c < 3; ++c)
      if (name == std::string(output.name) + std::string(kChannelSuffixes[c])) return {first + c, 1};
    first += channels;
  }
  return {};
}

std::string list_of(std::span<const std::string> names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::vector<std::string> names_of(const Form& form) {
  std::vector<std::string> names;
  for (const brdf::Parameter& p : form.inputs) names.emplace_back(p.name);
  return names;
}

// The inputs of `form` that `other` has not: what tells the two apart.
std::string own_inputs(const Form& form, const Form& other) {
  std::vector<std::string> names;
  for (const brdf::Parameter& p : form.inputs)
    if (input_named(other, p.name).channels == 0) names.emplace_back(p.name);
  return list_of(names);
}

// "; did you mean roughness?", or nothing.
std::string did_you_mean(const Entry& entry, const Form& form, std::string_view wanted) {
  std::vector<std::string> known;
  const auto add = [&](std::string_view before, std::string_view name, int channels) {
    known.push_back(std::string(before) + std::string(name));
    if (channels == 3)
      for (const std::string_view suffix : kChannelSuffixes)
        known.push_back(std::string(before) + std::string(name) + std::string(suffix));
  };
  for (const brdf::Parameter& p : form.inputs) add("", p.name, p.channels);
  for (const Form& other : entry.forms)
    for (const brdf::Parameter& p : other.inputs) add("", p.name, p.channels);
  for (const brdf::Output& output : entry.outputs) add(kReference, output.name, output.channels);
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string near = files::nearest_name(wanted, views.data(), views.size());
  return near.empty() ? "" : "; did you mean " + near + "?";
}

// What to say of a name that the form does not know, without its place.
std::string unknown(const Entry& entry, const Form& form, std::string_view kind, std::string_view name,
                    std::span<const std::string> given) {
  // One that another form knows: two ways to name the same are mixed.
  for (const Form& other : entry.forms) {
    if (input_named(other, name).channels == 0) continue;
    for (const std::string& known : given)
      if (input_named(form, known).channels > 0 && input_named(other, known).channels == 0)
        return std::string(name) + " (of " + own_inputs(other, form) + ") and " + known + " (of " +
               own_inputs(form, other) + ") are two ways to name the same; keep one of them";
  }
  std::string text = "unknown " + std::string(kind) + " " + in_quotes(name);
  if (output_named(entry, name).channels > 0)
    return text + ": it is what " + std::string(entry.name) + " returns; name the column " + std::string(kReference) +
           std::string(name) + " to have it compared";
  if (name.find_first_of(";\t") != name.npos) return text + "; the cells of a row are separated by commas";
  std::vector<std::string> outputs;
  for (const brdf::Output& output : entry.outputs)
    outputs.push_back(std::string(kReference) + std::string(output.name));
  return text + did_you_mean(entry, form, name) + " (" + std::string(entry.name) + " takes " + list_of(names_of(form)) +
         (kind == "column" ? "; to compare with: " + list_of(outputs) : "") + ")";
}

// The form that knows most of the names; of several the one that knows most of the header's, which come first.
const Form& chosen_form(const Entry& entry, std::span<const std::string> given, std::size_t in_header) {
  const auto known = [&](const Form& form) {
    std::pair<int, int> count{0, 0};
    for (std::size_t i = 0; i < given.size(); ++i) {
      const bool is_known = input_named(form, given[i]).channels > 0;
      count.first += is_known;
      count.second += is_known && i < in_header;
    }
    return count;
  };
  return *std::max_element(entry.forms.begin(), entry.forms.end(),
                           [&](const Form& a, const Form& b) { return known(a) < known(b); });
}

std::vector<std::string> given_names(std::span<const std::string_view> header,
                                     std::span<const Assignment> assignments) {
  std::vector<std::string> given(header.begin(), header.end());
  for (const Assignment& a : assignments) given.push_back(a.name);
  return given;
}

// Puts the assignments into the inputs, of which `set` says which have been given.
void assign(const Entry& entry, const Form& form, std::span<const Assignment> assignments,
            std::span<const std::string> given, std::vector<double>& inputs, std::vector<bool>& set) {
  for (const Assignment& a : assignments) {
    const InputPlace to = input_named(form, a.name);
    if (to.channels == 0) throw files::UsageError("--set: " + unknown(entry, form, "input", a.name, given));
    if (a.values.size() != 1 && a.values.size() != to.channels)
      throw files::UsageError("--set " + a.name + " has " + std::to_string(a.values.size()) + " numbers; it takes " +
                              (to.channels == 3 ? "1, or 3: red, green, blue" : "1"));
    for (std::size_t c = 0; c < to.channels; ++c) {
      inputs[to.first + c] = a.values[a.values.size() == 1 ? 0 : c];
      set[to.first + c] = true;
    }
  }
}

std::vector<double> defaults_of(const Form& form) {
  std::vector<double> inputs;
  for (const brdf::Parameter& p : form.inputs)
    inputs.insert(inputs.end(), static_cast<std::size_t>(p.channels), p.initial);
  return inputs;
}

std::string channel_name(const brdf::Parameter& p, std::size_t channel) {
  return std::string(p.name) + std::string(kChannelSuffixes[channel]);
}

// The inputs that neither table nor command line gave, with their defaults.
std::string list_of_defaults(const Form& form, const std::vector<bool>& given) {
  std::vector<std::string> names;
  std::size_t first = 0;
  for (const brdf::Parameter& p : form.inputs) {
    const auto channels = static_cast<std::size_t>(p.channels);
    std::size_t missing = 0;
    for (std::size_t c = 0; c < channels; ++c) missing += !given[first + c];
    const std::string value = " = " + number_text(p.initial);
    if (missing == channels) names.push_back(std::string(p.name) + value);
    else
      for (std::size_t c = 0; c < channels; ++c)
        if (!given[first + c]) names.push_back(channel_name(p, c) + value);
    first += channels;
  }
  return list_of(names);
}

// True if the channels of every color are the same in every row, so that one column can hold an output's.
bool is_grey(const Columns& columns) {
  bool any_color = false;
  std::size_t first = 0;
  for (const brdf::Parameter& p : columns.form->inputs) {
    if (p.channels == 3) {
      any_color = true;
      const double* value = columns.fixed.data() + first;
      if (value[0] != value[1] || value[0] != value[2]) return false;
      for (const Columns::Input& input : columns.inputs)
        if (input.channels == 1 && input.first >= first && input.first < first + 3) return false;
    }
    first += static_cast<std::size_t>(p.channels);
  }
  return any_color;
}

void name_outputs(const Entry& entry, Columns& columns) {
  bool grey = is_grey(columns);
  std::size_t first = 0;
  for (const brdf::Output& output : entry.outputs) {
    for (const Columns::Reference& reference : columns.references)
      grey = grey && !(output.channels == 3 && reference.channels == 1 && reference.output >= first &&
                       reference.output < first + 3);
    first += static_cast<std::size_t>(output.channels);
  }
  columns.grey = grey;
  first = 0;
  for (const brdf::Output& output : entry.outputs) {
    const std::string name(output.name);
    if (output.channels == 3 && !grey)
      for (std::size_t c = 0; c < 3; ++c)
        columns.outputs.push_back({name + std::string(kChannelSuffixes[c]), first + c});
    else columns.outputs.push_back({name, first});
    first += static_cast<std::size_t>(output.channels);
  }
}

std::vector<std::size_t> directions_of(const Form& form) {
  std::vector<std::size_t> firsts;
  std::size_t at = 0, run = 0;
  for (const brdf::Parameter& p : form.inputs) {
    run = p.role == brdf::Role::kDirection && p.channels == 1 ? run + 1 : 0;
    at += static_cast<std::size_t>(p.channels);
    if (run == 3) {
      firsts.push_back(at - 3);
      run = 0;
    }
  }
  return firsts;
}

}  // namespace

InputPlace input_named(const Form& form, std::string_view name) {
  std::size_t first = 0;
  InputPlace by_channel;
  for (const brdf::Parameter& p : form.inputs) {
    const auto channels = static_cast<std::size_t>(p.channels);
    if (name == p.name) return {first, channels};
    if (channels == 3 && name.size() == p.name.size() + 2 && name.starts_with(p.name))
      for (std::size_t c = 0; c < 3; ++c)
        if (name.ends_with(kChannelSuffixes[c])) by_channel = {first + c, 1};
    first += channels;
  }
  return by_channel;
}

Assignment assignment_of(const std::string& text, const std::string& option) {
  const std::string way_out = "; write roughness=0.3 or base_color=0.5,0.2,0.1";
  const std::size_t equals = text.find('=');
  if (equals == text.npos) throw files::UsageError(option + " " + in_quotes(text) + " has no '='" + way_out);
  Assignment a{std::string(trimmed(std::string_view(text).substr(0, equals))), {}};
  std::string_view rest = std::string_view(text).substr(equals + 1);
  for (bool last = false; !last;) {
    const auto cell = take_cell(rest, last);
    const auto number = cell ? number_in(*cell) : std::nullopt;
    if (!number)
      throw files::UsageError(option + " " + in_quotes(text) + ": " + in_quotes(cell.value_or(rest)) +
                              " is not a number" + way_out);
    a.values.push_back(*number);
  }
  return a;
}

Columns columns_of(const Entry& entry, std::span<const std::string_view> header,
                   std::span<const Assignment> assignments, const std::string& place) {
  const std::vector<std::string> given = given_names(header, assignments);
  Columns columns;
  columns.form = &chosen_form(entry, given, header.size());
  columns.count = header.size();
  columns.fixed = defaults_of(*columns.form);
  std::vector<bool> set(columns.form->count, false);
  assign(entry, *columns.form, assignments, given, columns.fixed, set);
  const std::vector<bool> by_option = set;

  const auto refuse = [&](const std::string& text) { throw files::InputError(place + ": " + text); };
  std::vector<std::string_view> seen;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string_view name = header[i];
    if (name.empty()) refuse("column " + std::to_string(i + 1) + " has no name; expected the name of an input");
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) refuse("column " + in_quotes(name) + " stands twice");
    seen.push_back(name);
    if (const InputPlace to = input_named(*columns.form, name); to.channels > 0) {
      for (std::size_t c = 0; c < to.channels; ++c) {
        if (by_option[to.first + c])
          throw files::UsageError("--set and " + place + " both give " + std::string(name) + "; leave one of them out");
        if (set[to.first + c])
          refuse("column " + in_quotes(name) +
                 " gives again what a column before it gives; a color is one column or "
                 "one a channel");
        set[to.first + c] = true;
      }
      columns.inputs.push_back({i, to.first, to.channels});
      continue;
    }
    const InputPlace output =
        name.starts_with(kReference) ? output_named(entry, name.substr(kReference.size())) : InputPlace{};
    if (output.channels == 0) refuse(unknown(entry, *columns.form, "column", name, given));
    columns.references.push_back({std::string(name), i, output.first, output.channels});
  }
  columns.defaults = list_of_defaults(*columns.form, set);
  columns.directions = directions_of(*columns.form);
  name_outputs(entry, columns);
  return columns;
}

std::string table_of_defaults(const Entry& entry, std::span<const Assignment> assignments) {
  const std::vector<std::string> given = given_names({}, assignments);
  const Form& form = chosen_form(entry, given, 0);
  std::vector<double> inputs = defaults_of(form);
  std::vector<bool> set(form.count, false);
  assign(entry, form, assignments, given, inputs, set);
  std::string names, values;
  const auto add = [&](const std::string& name, double value) {
    names += (names.empty() ? "" : ",") + name;
    values += (values.empty() ? "" : ",") + number_text(value);
  };
  std::size_t first = 0;
  for (const brdf::Parameter& p : form.inputs) {
    const double* value = inputs.data() + first;
    if (p.channels == 3 && (value[0] != value[1] || value[0] != value[2]))
      for (std::size_t c = 0; c < 3; ++c) add(channel_name(p, c), value[c]);
    else add(std::string(p.name), value[0]);
    first += static_cast<std::size_t>(p.channels);
  }
  return names + "\n" + values + "\n";
}

}  // namespace likeness::eval
