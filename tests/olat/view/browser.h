#pragma once

#include <sys/types.h>

#include <array>
#include <filesystem>
#include <string>

#include "tests/render/temporary_folder.h"

// Chromium without a window, driven through a pipe in the words of its DevTools protocol: real key presses into a real
// page, drawn by its software GL.
namespace likeness::test {

class Browser {
 public:
  // The program, or empty where there is none.
  static std::string program();

  Browser(int width, int height);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& address);
  void resize(int width, int height, bool is_light_scheme = false, bool is_less_motion = false);

  // The value of an expression, awaited, as JSON. Throws std::runtime_error with the page's exception.
  std::string evaluate(const std::string& expression);
  // Until the expression is true, which may fail before; false after `seconds`.
  bool wait(const std::string& expression, double seconds = 30);

  // As the table of actions writes it: "Shift+e", "Ctrl+0", "ArrowRight", "Space".
  void press(const std::string& key);
  void key_down(const std::string& key) { dispatch_key(key, true, false); }
  void key_repeat(const std::string& key) { dispatch_key(key, true, true); }
  void key_up(const std::string& key) { dispatch_key(key, false, false); }
  void click(double x, double y);
  // With the left button from one place to another, while Shift is down or not.
  void drag(std::array<double, 2> from, std::array<double, 2> to, bool with_shift);
  void screenshot(const std::filesystem::path& png);
  // Errors that the page's console was given, and requests to other hosts than 127.0.0.1, one a line.
  std::string faults() const { return faults_; }

 private:
  void dispatch_key(const std::string& name, bool is_down, bool is_repeated);
  std::string call(const std::string& method, const std::string& parameters);
  std::string next_message();

  TemporaryFolder profile_;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;
  int id_ = 0;
  std::string session_, pending_, faults_;
};

}  // namespace likeness::test
