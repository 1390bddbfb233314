#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// Reflectances of the film of tears on eyes, measured at a few wavelengths.
namespace likeness::film {

struct Subject {
  std::string name;
  std::vector<double> reflectance;  // at each wavelength, in (0, 1)
};

struct Readings {
  std::string source;
  std::vector<double> wavelengths_nm;  // two or more, in [300, 1100], increasing
  std::vector<Subject> subjects;       // at least one

  std::vector<double> mean() const;
  // Of the sample (n - 1); 0 for one subject.
  std::vector<double> deviation() const;
};

// Ten normal subjects at 500 and 700 nm.
// Source  T. Olsen, "Reflectometry of the precorneal film", Acta Ophthalmologica 63(4), 1985, table 1.
Readings olsen();

// A CSV file with the column `subject` and one column a wavelength, named by it in nanometres ("500", "700"); each
// cell a reflectance in (0, 1). Throws files::InputError.
Readings readings_of(std::string_view bytes, const std::string& source);
Readings read_readings(const std::filesystem::path& file);

// One subject from texts "500:0.0406". Throws files::UsageError.
Readings readings_of(const std::vector<std::string>& pairs);

}  // namespace likeness::film
