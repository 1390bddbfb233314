#include "brdf/eval/block_reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::eval {

BlockReader::BlockReader(const std::string& file) : name_(file == "-" ? "standard input" : file) {
  descriptor_ = file == "-" ? STDIN_FILENO : ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0)
    throw files::InputError(name_ + ": cannot be read (" + std::strerror(errno) + "); expected a readable CSV file");
  struct stat facts{};
  if (::fstat(descriptor_, &facts) == 0 && S_ISREG(facts.st_mode)) size_ = static_cast<std::uint64_t>(facts.st_size);
}

BlockReader::~BlockReader() {
  if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
}

std::size_t BlockReader::read_some(char* to, std::size_t room) {
  for (;;) {
    const ssize_t count = ::read(descriptor_, to, room);
    if (files::interrupted()) throw files::Interrupted{};
    if (count >= 0) {
      bytes_read_ += static_cast<std::uint64_t>(count);
      return static_cast<std::size_t>(count);
    }
    if (errno != EINTR) throw files::InputError(name_ + ": cannot be read (" + std::strerror(errno) + ")");
  }
}

bool BlockReader::next(Block& block) {
  block.text = std::move(rest_);
  rest_.clear();
  std::size_t filled = block.text.size(), whole = 0;  // whole: bytes up to and with the last newline
  while (!at_end_ && (whole == 0 || filled < kBlock)) {
    if (filled - whole > kLongestLine)
      throw files::InputError(name_ + ":" + std::to_string(line_) + ": a line of more than " +
                              std::to_string(kLongestLine) + " bytes; expected a table, one row a line");
    block.text.resize(std::max(kBlock, filled + kBlock / 2));
    const std::size_t count = read_some(block.text.data() + filled, block.text.size() - filled);
    at_end_ = count == 0;
    if (const void* newline = count == 0 ? nullptr : ::memrchr(block.text.data() + filled, '\n', count))
      whole = static_cast<std::size_t>(static_cast<const char*>(newline) - block.text.data()) + 1;
    filled += count;
    // A pipe gives what there is: whoever writes it a line at a time gets a line at a time.
    if (whole > 0 && size_ == 0) break;
  }
  block.text.resize(filled);
  if (!at_end_) {
    rest_ = block.text.substr(whole);
    block.text.resize(whole);
  }
  block.first_line = line_;
  block.is_first = first_;
  first_ = false;
  line_ += static_cast<std::size_t>(std::count(block.text.begin(), block.text.end(), '\n'));
  return !block.text.empty();
}

}  // namespace likeness::eval
