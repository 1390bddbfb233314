#include "tests/olat/view/browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

extern char** environ;

namespace likeness::test {
namespace {

using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;
constexpr int kMessageSeconds = 30;

std::string decoded_base64(const std::string& text) {
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const int v = c >= 'A' && c <= 'Z'   ? c - 'A'
                  : c >= 'a' && c <= 'z' ? c - 'a' + 26
                  : c >= '0' && c <= '9' ? c - '0' + 52
                  : c == '+'             ? 62
                  : c == '/'             ? 63
                                         : -1;
    if (v < 0) continue;
    bits = bits << 6 | static_cast<unsigned>(v);
    if ((count += 6) >= 8) out += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return out;
}

// Name, code and number of a key, as a keyboard of the United States sends them.
struct Key {
  std::string key, code, text;
  int number = 0;
};
Key key_of(const std::string& name, bool is_shifted) {
  if (name == "Space") return {" ", "Space", " ", 32};
  for (const auto& [named, number] : {std::pair{"ArrowLeft", 37},
                                      {"ArrowUp", 38},
                                      {"ArrowRight", 39},
                                      {"ArrowDown", 40},
                                      {"Home", 36},
                                      {"End", 35},
                                      {"Escape", 27},
                                      {"Enter", 13},
                                      {"Tab", 9}})
    if (name == named) return {name, name, name == std::string("Enter") ? "\r" : "", number};
  const char c = name.at(0);
  if (c >= 'a' && c <= 'z') {
    const char upper = static_cast<char>(c - 'a' + 'A');
    const std::string text(1, is_shifted ? upper : c);
    return {text, std::string("Key") + upper, text, upper};
  }
  if (c >= '0' && c <= '9') return {name, "Digit" + name, name, c};
  return {name, "", name, 0};
}

}  // namespace

std::string Browser::program() {
  for (const char* name : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"})
    if (access(name, X_OK) == 0) return name;
  return "";
}

Browser::Browser(int width, int height) {
  std::array<int, 2> in{}, out{};
  if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipes");
  // Above 4, so that neither end is overwritten by the other.
  const int child_in = fcntl(in[0], F_DUPFD_CLOEXEC, 10), child_out = fcntl(out[1], F_DUPFD_CLOEXEC, 10);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, child_in, 3);
  posix_spawn_file_actions_adddup2(&actions, child_out, 4);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  std::vector<std::string> words{program(),
                                 "--headless=new",
                                 "--no-sandbox",
                                 "--remote-debugging-pipe",
                                 "--user-data-dir=" + profile_.path().string(),
                                 "--use-angle=swiftshader",
                                 "--enable-unsafe-swiftshader",
                                 "--no-first-run",
                                 "--disable-background-networking",
                                 "--disable-component-update",
                                 "--disable-dev-shm-usage",
                                 "--hide-scrollbars",
                                 "--disable-extensions",
                                 "about:blank"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int failed = posix_spawn(&child_, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  for (const int fd : {in[0], out[1], child_in, child_out}) close(fd);
  to_ = in[1];
  from_ = out[0];
  if (failed != 0) throw std::runtime_error("chromium does not start");

  const Json target = Json::parse(call("Target.createTarget", R"({"url":"about:blank"})"));
  const Json attached =
      Json::parse(call("Target.attachToTarget", Json{{"targetId", target["targetId"]}, {"flatten", true}}.dump()));
  session_ = attached["sessionId"];
  call("Page.enable", "{}");
  call("Runtime.enable", "{}");
  call("Log.enable", "{}");
  call("Network.enable", "{}");
  resize(width, height);
}

Browser::~Browser() {
  try {
    session_.clear();
    call("Browser.close", "{}");
  } catch (const std::exception&) {
    // It is ended below.
  }
  close(to_);
  close(from_);
  const auto end = Clock::now() + std::chrono::seconds(3);
  while (Clock::now() < end) {
    if (waitpid(child_, nullptr, WNOHANG) == child_) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

std::string Browser::next_message() {
  const auto end = Clock::now() + std::chrono::seconds(kMessageSeconds);
  for (;;) {
    if (const std::size_t zero = pending_.find('\0'); zero != std::string::npos) {
      std::string out = pending_.substr(0, zero);
      pending_.erase(0, zero + 1);
      return out;
    }
    pollfd wait{from_, POLLIN, 0};
    std::array<char, 65536> part;
    const ssize_t count = poll(&wait, 1, 1000) > 0 ? read(from_, part.data(), part.size()) : -1;
    if (count == 0 || Clock::now() > end) throw std::runtime_error("chromium does not answer");
    if (count > 0) pending_.append(part.data(), static_cast<std::size_t>(count));
  }
}

std::string Browser::call(const std::string& method, const std::string& parameters) {
  const int id = ++id_;
  Json request{{"id", id}, {"method", method}, {"params", Json::parse(parameters)}};
  if (!session_.empty()) request["sessionId"] = session_;
  const std::string text = request.dump() + '\0';
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t count = write(to_, text.data() + at, text.size() - at);
    if (count <= 0) throw std::runtime_error("chromium does not listen");
    at += static_cast<std::size_t>(count);
  }
  for (;;) {
    const Json message = Json::parse(next_message());
    if (message.value("id", 0) == id) {
      if (message.contains("error")) throw std::runtime_error(method + ": " + message["error"].dump());
      return message["result"].dump();
    }
    const std::string event = message.value("method", "");
    if (event == "Runtime.exceptionThrown") faults_ += message["params"]["exceptionDetails"].dump() + "\n";
    if (event == "Log.entryAdded" && message["params"]["entry"]["level"] == "error" &&
        message["params"]["entry"].value("text", "").find("Failed to load resource") == std::string::npos)
      faults_ += message["params"]["entry"].dump() + "\n";
    if (event == "Network.requestWillBeSent") {
      const std::string url = message["params"]["request"]["url"];
      bool is_own = false;
      for (const char* own : {"http://127.0.0.1:", "about:", "data:", "blob:", "file:"}) is_own |= url.starts_with(own);
      if (!is_own) faults_ += "asks " + url + "\n";
    }
  }
}

void Browser::open(const std::string& address) {
  call("Page.navigate", Json{{"url", "about:blank"}}.dump());
  call("Page.navigate", Json{{"url", address}}.dump());
}

void Browser::resize(int width, int height, bool is_light_scheme, bool is_less_motion) {
  call("Emulation.setDeviceMetricsOverride",
       Json{{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}}.dump());
  call("Emulation.setEmulatedMedia",
       Json{{"features",
             {{{"name", "prefers-color-scheme"}, {"value", is_light_scheme ? "light" : "dark"}},
              {{"name", "prefers-reduced-motion"}, {"value", is_less_motion ? "reduce" : "no-preference"}}}}}
           .dump());
}

std::string Browser::evaluate(const std::string& expression) {
  const Json result = Json::parse(call(
      "Runtime.evaluate",
      Json{{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}, {"userGesture", true}}.dump()));
  if (result.contains("exceptionDetails"))
    throw std::runtime_error(expression + ": " + result["exceptionDetails"].dump());
  return result["result"].contains("value") ? result["result"]["value"].dump() : "undefined";
}

bool Browser::wait(const std::string& expression, double seconds) {
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end) {
    if (evaluate("(() => { try { return Boolean(" + expression + "); } catch { return false; } })()") == "true")
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(15));
  }
  return false;
}

void Browser::press(const std::string& name) {
  key_down(name);
  key_up(name);
}

void Browser::dispatch_key(const std::string& name, bool is_down, bool is_repeated) {
  int modifiers = 0;
  std::string rest = name;
  for (bool found = true; found;) {
    found = false;
    for (const auto& [word, bit] : {std::pair{std::string("Ctrl+"), 2}, std::pair{std::string("Shift+"), 8}})
      if (rest.size() > word.size() && rest.starts_with(word)) {
        rest.erase(0, word.size());
        modifiers |= bit;
        found = true;
      }
  }
  const Key key = key_of(rest, (modifiers & 8) != 0);
  const bool has_text = !key.text.empty() && (modifiers & 2) == 0;
  Json event{{"type", !is_down   ? "keyUp"
                      : has_text ? "keyDown"
                                 : "rawKeyDown"},
             {"modifiers", modifiers},
             {"key", key.key},
             {"code", key.code},
             {"windowsVirtualKeyCode", key.number}};
  if (has_text && is_down) event["text"] = key.text;
  if (is_repeated) event["autoRepeat"] = true;
  call("Input.dispatchKeyEvent", event.dump());
}

void Browser::click(double x, double y) {
  for (const char* type : {"mouseMoved", "mousePressed", "mouseReleased"})
    call("Input.dispatchMouseEvent",
         Json{{"type", type}, {"x", x}, {"y", y}, {"button", "left"}, {"clickCount", 1}}.dump());
}

void Browser::drag(std::array<double, 2> from, std::array<double, 2> to, bool with_shift) {
  const auto send = [&](const char* type, std::array<double, 2> at, int buttons) {
    call("Input.dispatchMouseEvent", Json{{"type", type},
                                          {"x", at[0]},
                                          {"y", at[1]},
                                          {"button", "left"},
                                          {"buttons", buttons},
                                          {"modifiers", with_shift ? 8 : 0},
                                          {"clickCount", 1}}
                                         .dump());
  };
  send("mousePressed", from, 1);
  send("mouseMoved", {(from[0] + to[0]) / 2, (from[1] + to[1]) / 2}, 1);
  send("mouseMoved", to, 1);
  send("mouseReleased", to, 0);
}

void Browser::screenshot(const std::filesystem::path& png) {
  const Json result = Json::parse(call("Page.captureScreenshot", R"({"format":"png"})"));
  std::ofstream(png, std::ios::binary) << decoded_base64(result["data"]);
}

}  // namespace likeness::test
