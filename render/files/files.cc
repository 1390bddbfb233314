#include "render/files/files.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace likeness::files {
namespace {

struct Descriptor {
  int number;
  explicit Descriptor(int number_) : number(number_) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

std::string cause() { return std::strerror(errno); }

std::string megabytes(std::size_t bytes) {
  return bytes < 1000000 ? std::to_string(bytes) + " bytes" : std::to_string(bytes / 1000000) + " MB";
}

// Asks for the string's unused memory in pages of 2 MB, which saves most of the time that a table of 35 MB takes.
void in_large_pages(std::string& reserved) {
  constexpr std::uintptr_t kPage = 4096;
  const std::uintptr_t to_page = (0 - reinterpret_cast<std::uintptr_t>(reserved.data())) % kPage;
  if (reserved.capacity() > to_page + (std::size_t{4} << 20))
    ::madvise(reserved.data() + to_page, reserved.capacity() - to_page, MADV_HUGEPAGE);
}

[[noreturn]] void cannot_write(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": cannot be written (" + why + ")");
}

}  // namespace

std::string read_whole(const std::filesystem::path& file, std::size_t limit) {
  const std::string name = file.string();
  const Descriptor in(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
  if (in.number < 0) throw InputError(name + ": cannot be read (" + cause() + "); expected a readable file");
  struct stat facts{};
  if (::fstat(in.number, &facts) != 0) throw InputError(name + ": cannot be read (" + cause() + ")");
  if (S_ISDIR(facts.st_mode)) throw InputError(name + ": is a folder; expected a file");
  const auto too_large = [&](const std::string& found) {
    throw InputError(name + ": " + found + "; expected at most " + megabytes(limit));
  };
  std::string bytes;
  if (S_ISREG(facts.st_mode)) {
    const auto size = static_cast<std::size_t>(facts.st_size);
    if (size > limit) too_large(megabytes(size));
    bytes.reserve(size);
    in_large_pages(bytes);
    bytes.resize(size);
  }
  // A pipe has no size, and a file may grow or shrink while it is read.
  std::size_t filled = 0;
  for (;;) {
    if (filled == bytes.size()) {
      char beyond[4096];
      const ssize_t count = ::read(in.number, beyond, sizeof beyond);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) throw InputError(name + ": cannot be read (" + cause() + ")");
      if (count == 0) break;
      if (filled + static_cast<std::size_t>(count) > limit) too_large("more than " + megabytes(limit));
      bytes.append(beyond, static_cast<std::size_t>(count));
      filled = bytes.size();
      continue;
    }
    const ssize_t count = ::read(in.number, bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(name + ": cannot be read (" + cause() + ")");
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  bytes.resize(filled);
  return bytes;
}

WholeFile::WholeFile(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code failed;
  const std::filesystem::path folder = file_.parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) cannot_write(file_, "its folder: " + failed.message());
  if (std::filesystem::is_directory(file_, failed)) cannot_write(file_, "it is a folder");
  if (std::filesystem::exists(file_, failed) && !std::filesystem::is_regular_file(file_, failed)) {
    descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) cannot_write(file_, cause());
    return;
  }

  std::string pattern = (folder / ("." + file_.filename().string() + ".XXXXXX")).string();
  descriptor_ = ::mkostemp(pattern.data(), O_CLOEXEC);
  if (descriptor_ < 0) cannot_write(file_, cause());
  temporary_ = std::move(pattern);
  // mkostemp gives 0600; the file gets what an ordinary one gets.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor_, 0666 & ~mask);
}

WholeFile::~WholeFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void WholeFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) cannot_write(file_, cause());
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void WholeFile::commit() {
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), file_.c_str()) != 0) cannot_write(file_, cause());
  temporary_.clear();
}

void write_whole(const std::filesystem::path& file, std::string_view bytes) {
  WholeFile out(file);
  out.append(bytes);
  out.commit();
}

std::string nearest_name(std::string_view wanted, const std::string_view* names, std::size_t count) {
  // Levenshtein 1966, one row at a time. 'Near' is at most a third of the letters, at least one.
  const auto distance = [](std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t kept = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
        diagonal = row[j];
        row[j] = std::min({kept, row[j] + 1, row[j - 1] + 1});
      }
    }
    return row[b.size()];
  };
  if (wanted.size() > 100) return {};
  std::size_t best = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  std::string_view nearest;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t d = distance(wanted, names[i]);
    if (d < best) best = d, nearest = names[i];
  }
  return std::string(nearest);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;  // characters that a message repeats
  std::string out = "\"";
  for (const char c : text.substr(0, kLongest)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return out + (text.size() > kLongest ? "...\"" : "\"");
}

std::string number_text(double value) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end};
}

}  // namespace likeness::files
