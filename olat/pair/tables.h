#pragma once

#include <string>

namespace likeness::olat_pair {

// The lists that the page needs, as one JSON object: fields of a state, metrics, views with the limits of their curves,
// colors of maps and zones, actions, and the shader of ACES. What the page knows of them, it knows from here.
std::string tables_json();

// The keys as a table in Markdown, for docs/olat_view.md.
std::string keys_table();

}  // namespace likeness::olat_pair
