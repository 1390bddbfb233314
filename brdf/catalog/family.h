#pragma once

#include <string_view>
#include <vector>

#include "brdf/catalog/loops.h"

// What the file of each family does to make its entries.
namespace likeness::catalog {

template <class E>
const void* tables_of() {
  if constexpr (brdf::HasTables<E>) return &E::tables();
  else return nullptr;
}

template <class F>
void prepare_row(const double* in, double* features) {
  F::prepare(in, features);
}

template <class E>
Entry entry_of(std::string_view family) {
  Entry entry{.name = E::kName,
              .family = family,
              .text = E::kText,
              .forms = {},
              .outputs = E::kOutputs,
              .features = brdf::feature_count<E>(),
              .output_count = brdf::output_count<E>(),
              .tables = &tables_of<E>,
              .in_double = {&scalar_loop<E, true, double>, &scalar_loop<E, false, double>},
              .in_float = {&scalar_loop<E, true, float>, &scalar_loop<E, false, float>},
              .in_batches = {},
              .one_by_one = brdf::OneByOne<E>};
  [&]<class... F>(std::type_identity<std::tuple<F...>>) {
    (entry.forms.push_back(Form{F::kInputs, brdf::input_count<F>(), &prepare_row<F>}), ...);
  }(std::type_identity<typename E::Forms>{});
  return entry;
}

template <class Evaluators>
void append(std::string_view family, std::vector<Entry>& entries) {
  [&]<class... E>(std::type_identity<std::tuple<E...>>) {
    (entries.push_back(entry_of<E>(family)), ...);
  }(std::type_identity<Evaluators>{});
}

}  // namespace likeness::catalog
