#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

// A file of any size, or standard input, in blocks of whole lines.
namespace likeness::eval {

struct Block {
  std::string text;            // ends with a newline, but for the last of a file that does not
  std::size_t first_line = 1;  // in the file
  bool is_first = false;
};

class BlockReader {
 public:
  static constexpr std::size_t kBlock = std::size_t{1} << 18;        // bytes of a block, about
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;  // bytes

  // `file` is "-" for standard input. Throws files::InputError.
  explicit BlockReader(const std::string& file);
  BlockReader(const BlockReader&) = delete;
  BlockReader& operator=(const BlockReader&) = delete;
  ~BlockReader();

  // The next block; false at the end. Throws files::InputError, and files::Interrupted.
  bool next(Block& block);

  const std::string& name() const { return name_; }  // for messages
  std::uint64_t bytes_read() const { return bytes_read_; }
  std::uint64_t size() const { return size_; }  // of the file; 0 if that is not known

 private:
  std::size_t read_some(char* to, std::size_t room);

  std::string name_, rest_;  // rest_: the begin of a line whose end is not yet read
  int descriptor_ = -1;
  bool at_end_ = false, first_ = true;
  std::size_t line_ = 1;
  std::uint64_t bytes_read_ = 0, size_ = 0;
};

}  // namespace likeness::eval
