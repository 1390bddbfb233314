#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

// What every reader and writer of Likeness shares: the error for bad input, and files that are whole or absent.
namespace likeness::files {

// A file, or a part of one, that cannot be used. what() is one line: the file (and line or field, if there is
// one), what was found, what was expected. The program ends with exit code 3.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A request that cannot be met as it was put (an unknown model, a cut of 100 degrees). Exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The bytes of a file of at most `limit` bytes. Throws InputError if it is absent, unreadable or larger.
std::string read_whole(const std::filesystem::path& file, std::size_t limit);

// Writes a file so that a reader sees the old content or the new, never a part: to a temporary name in the same
// folder, then renamed. Makes missing parent folders. Throws std::runtime_error naming the file and the cause.
void write_whole(const std::filesystem::path& file, std::string_view bytes);

// The same piece by piece, for what does not fit into memory: nothing is at `file` before commit(), and nothing of it is
// left if that is never reached. What is no file, /dev/stdout or a named pipe, is not replaced but written to. All but
// the destructor throw as write_whole does.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path file);
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  ~WholeFile();

  void append(std::string_view bytes);
  void commit();

 private:
  std::filesystem::path file_;
  std::string temporary_;  // its name; empty once it has become `file_`, and for what is no file
  int descriptor_ = -1;
};

// The name among `names` that is nearest to `wanted` (edit distance), for 'did you mean'; empty if none is near.
std::string nearest_name(std::string_view wanted, const std::string_view* names, std::size_t count);

// A user's text in quotes, on one line and of bounded length, for messages.
std::string in_quotes(std::string_view text);

// The shortest decimal that reads back as the same double (at most 17 significant digits).
std::string number_text(double value);

// The SHA-256 of some bytes, in hexadecimal, as sha256sum prints it: identifies an input in a result file.
// sha256_portable gives the same without the processor's SHA instructions.
std::string sha256(std::string_view bytes);
std::string sha256_portable(std::string_view bytes);

}  // namespace likeness::files
