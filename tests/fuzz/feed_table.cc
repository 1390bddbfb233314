#include <algorithm>
#include <stdexcept>
#include <string>

#include "brdf/eval/csv.h"
#include "brdf/eval/rows.h"
#include "render/files/files.h"
#include "tests/brdf/eval/toy_evaluators.h"
#include "tests/fuzz/feed.h"

namespace likeness::measured::test {
bool feed_table(std::string_view bytes) {
  static const catalog::Entry kToy = eval::test::toy();
  try {
    std::string_view text = bytes;
    std::size_t line = 1;
    const auto header = eval::take_header(text, line);
    if (!header) return false;
    const eval::Rows rows(kToy, *header, {}, eval::Precision::kDouble, "fuzz", line);
    const eval::Outcome whole = rows.evaluate(text, line + 1);
    hold(std::size_t(std::count(whole.text.begin(), whole.text.end(), '\n')) == whole.rows, "every row is a line");
    hold(whole.outside <= whole.rows && whole.worst.size() == rows.columns().references.size(),
         "rows are counted once");
    // In two pieces it is the same.
    const std::size_t middle = std::min(text.find('\n', text.size() / 2), text.size());
    const std::size_t cut = std::min(middle + 1, text.size());
    const auto before = static_cast<std::size_t>(std::count(text.begin(), text.begin() + long(cut), '\n'));
    const eval::Outcome first = rows.evaluate(text.substr(0, cut), line + 1);
    const eval::Outcome second = rows.evaluate(text.substr(cut), line + 1 + before);
    hold(first.text + second.text == whole.text, "rows do not depend on one another");
    // What was written is a table again, with as many numbers in each row.
    std::string_view written = whole.text;
    const std::size_t columns = rows.columns().count + rows.columns().outputs.size();
    std::vector<double> numbers(columns);
    while (!written.empty()) {
      const eval::Numbers found = eval::read_numbers(eval::take_line(written), numbers);
      hold(!found.wrong && found.cells == columns, "a written row is a row");
    }
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    hold(message.starts_with("fuzz:"), "a message names the file");
    hold(message.find('\n') == message.npos, "a message is one line");
    return false;
  }
  return true;
}

}  // namespace likeness::measured::test
