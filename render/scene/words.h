#pragma once

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>

namespace likeness::scene {

// The lines and words of a text file, with the number of the line.
class Words {
 public:
  explicit Words(std::string_view text, std::size_t line = 1)
      : at_(text.data()), end_(text.data() + text.size()), line_(line) {}

  std::size_t line() const { return line_; }
  bool is_at_end() const { return at_ == end_; }
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }

  // The next word of this line; empty at its end.
  std::string_view next() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    const char* begin = at_;
    while (at_ != end_ && !is_blank(*at_) && *at_ != '\n') ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  // To the next word of the file, or its end.
  void skip_blank_lines() {
    while (at_ != end_ && (is_blank(*at_) || *at_ == '\n')) line_ += *at_++ == '\n';
  }

  // What is left of this line, without blanks around it.
  std::string_view rest() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    const char* begin = at_;
    while (at_ != end_ && *at_ != '\n') ++at_;
    const char* last = at_;
    while (last != begin && is_blank(last[-1])) --last;
    return {begin, static_cast<std::size_t>(last - begin)};
  }

  void skip_line() {
    while (at_ != end_ && *at_ != '\n') ++at_;
    if (at_ != end_) {
      ++at_;
      ++line_;
    }
  }

  // A number written as C writes it, nan and inf too; false, and nothing taken, if the next word of the line is none.
  template <class T>
  bool number(T& out) {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    const char* begin = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [stop, error] = std::from_chars(begin, end_, out);
    if (error == std::errc::result_out_of_range && stop != begin) out = T{};
    else if (error != std::errc()) return false;
    if (stop != end_ && !is_blank(*stop) && *stop != '\n') return false;
    at_ = stop;
    return true;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  const char *at_, *end_;
  std::size_t line_;
};

}  // namespace likeness::scene
