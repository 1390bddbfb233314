#include "tests/fuzz/feed_studies.h"

#include <cmath>
#include <string>

#include "fit/film/readings.h"
#include "render/blood/table.h"
#include "render/bloom/kernel.h"
#include "render/files/files.h"
#include "tests/fuzz/feed.h"

namespace likeness::measured::test {
namespace {

void hold_readings(const film::Readings& readings) {
  hold(readings.wavelengths_nm.size() >= 2 && !readings.subjects.empty(), "there are wavelengths and subjects");
  for (std::size_t i = 1; i < readings.wavelengths_nm.size(); ++i)
    hold(readings.wavelengths_nm[i - 1] < readings.wavelengths_nm[i], "wavelengths increase");
  for (const film::Subject& subject : readings.subjects) {
    hold(subject.reflectance.size() == readings.wavelengths_nm.size(), "every reading is there");
    for (const double value : subject.reflectance) hold(value > 0 && value < 1, "a reflectance is in (0, 1)");
  }
}

void hold_table(const blood::Table& table) {
  for (const blood::Cell& cell : table.cells) {
    hold(cell.opacity >= 0 && cell.opacity <= 1 && cell.time >= 0 && std::isfinite(cell.time), "a cell has its place");
    for (const double value : cell.rgb) hold(value >= 0 && value <= 4, "a color is within its range");
  }
}

void hold_kernel(const bloom::Kernel& kernel) {
  hold(kernel.radius >= 1 && kernel.radius <= bloom::kMostRadius, "a radius is within its range");
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = kernel.direct[c];
    for (const bloom::Component& component : kernel.components) sum += component.weight[c];
    hold(std::abs(sum - 1) <= 1e-6, "no light is lost");
  }
  const std::string text = bloom::text_of(kernel);
  hold(bloom::text_of(bloom::kernel_of(text, "again")) == text, "a text is that of the kernel it makes");
}

}  // namespace

bool feed_studies(std::string_view format, std::string_view bytes) {
  try {
    if (format == "readings") hold_readings(film::readings_of(bytes, "fuzz"));
    else if (format == "blood_table") hold_table(blood::table_of(bytes, "fuzz", blood::Encoding::kSrgb));
    else hold_kernel(bloom::kernel_of(bytes, "fuzz"));
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    hold(message.starts_with("fuzz:"), "a message names the file");
    hold(message.find('\n') == message.npos, "a message is one line");
    return false;
  }
  return true;
}

}  // namespace likeness::measured::test
