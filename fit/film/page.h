#pragma once

#include <string>

#include "fit/film/estimate.h"

namespace likeness::film {

// Everything of one run that is told: as text, JSON and a page. `follows_scale` says which of the two estimates the color,
// f0 and the material are of.
struct Told {
  Readings readings;
  Options options;
  Study study;
  bool follows_scale = true;

  const Estimate& chosen() const { return follows_scale ? study.scaled : study.absolute; }
};

std::string text_of(const Told& told);
std::string json_of(const Told& told);
std::string page_of(const Told& told);

}  // namespace likeness::film
