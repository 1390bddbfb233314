#include "brdf/eval/table.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include <unistd.h>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "brdf/eval/block_reader.h"
#include "brdf/eval/csv.h"
#include "render/files/files.h"
#include "render/files/progress.h"

namespace likeness::eval {
namespace {

constexpr std::string_view kSaid = "likeness eval: ";

// Where rows go: a file that appears when it is whole, or standard output.
class Sink {
 public:
  explicit Sink(const std::string& file) {
    if (!file.empty()) file_.emplace(file);
  }
  void write(std::string_view bytes) {
    if (file_) return file_->append(bytes);
    while (!bytes.empty()) {
      const ssize_t count = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0)
        throw std::runtime_error(std::string("standard output: cannot be written (") + std::strerror(errno) + ")");
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }
  void finish() {
    if (file_) file_->commit();
  }

 private:
  std::optional<files::WholeFile> file_;
};

std::string three_digits(double value) {
  std::array<char, 32> digits{};
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 3);
  return {digits.data(), end};
}

void say(const std::string& text) { std::cerr << kSaid << text << "\n"; }

// What there is to say after the last row.
void summarize(const Rows& rows, const Outcome& all, const TableOptions& options, const std::string& name) {
  if (all.outside > 0)
    say("warning: " + std::to_string(all.outside) + (all.outside == 1 ? " row has" : " rows have") +
        " an input outside its range; computed all the same; the first: " +
        (options.in.empty() ? "" : name + ":" + std::to_string(all.outside_line) + ": ") + all.first_outside);
  if (all.colored > 0)
    say("warning: in " + std::to_string(all.colored) +
        " rows the channels differ, and only red is written; name an "
        "input by channel to have all three");
  for (std::size_t i = 0; i < all.worst.size(); ++i) {
    const Columns::Reference& reference = rows.columns().references[i];
    const Worst& worst = all.worst[i];
    std::string text = reference.name + ": ";
    if (worst.row == 0) text += "no difference in " + std::to_string(all.rows) + " rows";
    else
      text += "worst relative difference " + three_digits(worst.difference) + " of " + std::to_string(all.rows) +
              " rows, in row " + std::to_string(worst.row) + " (line " + std::to_string(worst.line) +
              "): " + files::number_text(worst.got) + " against " + files::number_text(worst.want);
    if (options.tolerance < std::numeric_limits<double>::infinity())
      text += std::string("; ") + (worst.difference <= options.tolerance ? "within" : "ABOVE") + " the tolerance " +
              three_digits(options.tolerance);
    say(text);
  }
}

// The header, taken from the first block.
Rows header_of(const catalog::Entry& entry, const TableOptions& options, const std::string& name, Block& block) {
  std::string_view text = block.text;
  const auto header = take_header(text, block.first_line);
  if (!header)
    throw files::InputError(name + ": is empty; expected a header that names inputs of " + std::string(entry.name));
  Rows rows(entry, *header, options.assignments, options.precision, name, block.first_line);
  block.text = std::string(text);
  ++block.first_line;
  return rows;
}

// A block on its way from the reader to the sink.
struct Work {
  Block block;
  Outcome outcome;
  std::exception_ptr failed;
  std::uint64_t bytes_read = 0;
};

// Reads, evaluates and writes what follows the header. The first fault in the order of the file ends it.
Outcome run_blocks(const Rows& rows, Block& first, BlockReader& reader, Sink& sink, int threads) {
  Outcome all;
  files::Progress progress;
  bool begun = false, ended = false;
  const auto read = [&](tbb::flow_control& flow) -> std::shared_ptr<Work> {
    auto work = std::make_shared<Work>();
    if (!begun) {
      begun = true;
      work->block = std::move(first);
    } else {
      try {
        ended = ended || !reader.next(work->block);
      } catch (...) {  // what was read before it may hold a fault that comes earlier in the file
        work->failed = std::current_exception();
        ended = true;
        return work;
      }
      if (ended) {
        flow.stop();
        return nullptr;
      }
    }
    work->bytes_read = reader.bytes_read();
    return work;
  };
  const auto evaluate = [&](std::shared_ptr<Work> work) {
    try {
      if (!work->failed) work->outcome = rows.evaluate(work->block.text, work->block.first_line);
    } catch (...) {
      work->failed = std::current_exception();
    }
    return work;
  };
  const auto write = [&](const std::shared_ptr<Work>& work) {
    if (work->failed) std::rethrow_exception(work->failed);
    sink.write(work->outcome.text);
    all.add(work->outcome);
    progress.tell(std::to_string(all.rows) + " rows",
                  reader.size() == 0 ? 0 : static_cast<double>(work->bytes_read) / static_cast<double>(reader.size()));
  };
  const int cores = threads > 0 ? threads : tbb::info::default_concurrency();
  const tbb::global_control as_many(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(cores));
  tbb::task_arena arena(cores);
  arena.execute([&] {
    tbb::parallel_pipeline(
        static_cast<std::size_t>(2 * cores + 1),
        tbb::make_filter<void, std::shared_ptr<Work>>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<std::shared_ptr<Work>, std::shared_ptr<Work>>(tbb::filter_mode::parallel, evaluate) &
            tbb::make_filter<std::shared_ptr<Work>, void>(tbb::filter_mode::serial_in_order, write));
  });
  return all;
}

}  // namespace

int run_table(const catalog::Entry& entry, const TableOptions& options) {
  Outcome all;
  std::optional<Rows> rows;
  std::string name = "--set";
  if (options.in.empty()) {
    const std::string table = table_of_defaults(entry, options.assignments);
    std::string_view text = table;
    try {
      rows.emplace(entry, take_line(text), std::span<const Assignment>{}, options.precision, name);
      all = rows->evaluate(text, 2);
    } catch (const files::InputError& error) {
      throw files::UsageError(error.what());
    }
    Sink sink(options.out);
    sink.write(rows->header() + all.text);
    sink.finish();
  } else {
    BlockReader reader(options.in);
    Block first;
    reader.next(first);
    name = reader.name();
    rows.emplace(header_of(entry, options, name, first));
    if (options.tolerance < std::numeric_limits<double>::infinity() && rows->columns().references.empty())
      throw files::UsageError("--tolerance has nothing to compare: no column of " + name + " begins with ref_");
    if (!rows->columns().defaults.empty()) say("defaults: " + rows->columns().defaults);
    Sink sink(options.out);
    sink.write(rows->header());
    all = run_blocks(*rows, first, reader, sink, options.threads);
    sink.finish();
  }
  summarize(*rows, all, options, name);
  const bool exceeds =
      std::any_of(all.worst.begin(), all.worst.end(), [&](const Worst& w) { return w.difference > options.tolerance; });
  return exceeds ? 1 : 0;
}

}  // namespace likeness::eval
