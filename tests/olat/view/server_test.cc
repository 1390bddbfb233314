#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/olat/small_capture.h"
#include "tests/olat/view/served.h"
#include "tests/render/temporary_folder.h"

// The server as a stranger meets it, byte by byte.
namespace likeness::olat_view {
namespace {

using testing::HasSubstr;
using testing::Not;

int connected(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  timeval patience{20, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) {
    close(fd);
    return -1;
  }
  return fd;
}

// Sends bytes, and reads until the other side ends or says so by Content-Length.
std::string exchange(int port, const std::string& bytes, int patience_s = 20) {
  const int fd = connected(port);
  if (fd < 0) return "";
  const timeval patience{patience_s, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t sent = send(fd, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (sent <= 0) break;
    at += static_cast<std::size_t>(sent);
  }
  std::string out;
  char part[65536];
  for (ssize_t count; (count = recv(fd, part, sizeof part, 0)) > 0;) out.append(part, static_cast<std::size_t>(count));
  close(fd);
  return out;
}

class ServerTest : public testing::Test {
 protected:
  ServerTest() : served_(test::write_small_capture(folder_.path()), {.cache_bytes = 1 << 20, .with_scores = false}) {}

  std::string request(const std::string& path, const std::string& more = "", const std::string& method = "GET",
                      bool with_token = true, std::string host = "") {
    if (host.empty()) host = "127.0.0.1:" + std::to_string(port());
    return exchange(port(), method + " " + path + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n" +
                                (with_token ? "X-Likeness-Token: " + served_.server().token() + "\r\n" : "") + more +
                                "\r\n");
  }
  int port() const { return served_.server().port(); }

  test::TemporaryFolder folder_;
  test::Served served_;
};

constexpr const char* kOk = "HTTP/1.1 200";
constexpr const char* kForbidden = "HTTP/1.1 403";

TEST_F(ServerTest, GivesThePageToAnyoneHereAndDataToWhoHasTheToken) {
  EXPECT_THAT(request("/", "", "GET", false), HasSubstr(kOk));
  EXPECT_THAT(request("/viewer.js", "", "GET", false), HasSubstr(kOk));
  EXPECT_THAT(request("/", "", "GET", false), Not(HasSubstr(served_.server().token())));
  EXPECT_THAT(request("/api/capture"), HasSubstr(kOk));
  for (const char* path : {"/api/capture", "/api/pixels?kind=photo", "/render", "/nothing"})
    EXPECT_THAT(request(path, "", "GET", false), HasSubstr(kForbidden)) << path;
  EXPECT_THAT(request("/api/capture", "X-Likeness-Token: 0\r\n", "GET", false), HasSubstr(kForbidden));
}

TEST_F(ServerTest, RefusesForeignHostsAndOrigins) {
  for (const char* host :
       {"evil.example", "127.0.0.1.evil.example", "evil.example:80", "localhost.evil", "[::2]:80", " "})
    EXPECT_THAT(request("/api/capture", "", "GET", true, host), Not(HasSubstr(kOk))) << host;
  for (const char* host : {"localhost:1", "127.0.0.1:9", "[::1]:8080", "127.0.0.1"})
    EXPECT_THAT(request("/api/capture", "", "GET", true, host), HasSubstr(kOk)) << host << ": ssh -L has other ports";
  EXPECT_THAT(request("/api/capture", "Origin: http://evil.example\r\n"), HasSubstr(kForbidden));
  EXPECT_THAT(request("/api/capture", "Origin: null\r\n"), HasSubstr(kForbidden));
  EXPECT_THAT(request("/api/capture", "Origin: http://127.0.0.1:" + std::to_string(port()) + "\r\n"), HasSubstr(kOk));
  EXPECT_THAT(exchange(port(), "GET / HTTP/1.1\r\nConnection: close\r\n\r\n"), HasSubstr(kForbidden)) << "no Host";
}

TEST_F(ServerTest, SendsNoCorsAndForbidsForeignScripts) {
  const std::string page = request("/", "Origin: http://127.0.0.1:" + std::to_string(port()) + "\r\n");
  EXPECT_THAT(page, Not(HasSubstr("Access-Control")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(page, HasSubstr("nosniff"));
}

TEST_F(ServerTest, ServesNoFileThatARequestNames) {
  for (const char* path : {"/../../../../etc/passwd", "/..%2f..%2fetc/passwd", "/capture.json", "/photos/c0/l0.exr",
                           "//etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/./capture.json", "/api/../capture.json"}) {
    const std::string answer = request(path);
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 404")) << path;
    EXPECT_THAT(answer, Not(HasSubstr("root:"))) << path;
  }
  for (const char* state : {"camera=..%2F..%2Fetc&light=passwd", "camera=/etc/passwd", "variant=../../x", "light=%00"})
    EXPECT_THAT(request(std::string("/api/pixels?kind=photo&state=") + state), HasSubstr("HTTP/1.1 400")) << state;
}

TEST_F(ServerTest, TakesOnlyGetAndHead) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH"})
    EXPECT_THAT(request("/api/capture", "Content-Length: 0\r\n", method), HasSubstr("HTTP/1.1 405")) << method;
  EXPECT_THAT(request("/api/capture", "", "HEAD"), HasSubstr(kOk));
}

TEST_F(ServerTest, OutlivesRequestsThatAreNone) {
  const std::string big(100'000, 'x');
  exchange(port(), "\r\n\r\n", 1);
  exchange(port(), std::string(1000, '\0') + "\r\n\r\n", 1);
  exchange(port(), "GET\r\n\r\n", 1);
  exchange(port(), "GET / HTTP/9.9\r\n\r\n", 1);
  exchange(port(), "GET /" + big + " HTTP/1.1\r\nHost: localhost\r\n\r\n", 1);
  exchange(port(), "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + big + "\r\nConnection: close\r\n\r\n", 1);
  exchange(port(), "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n" + big, 1);
  exchange(port(), "POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nffffffffff\r\n", 1);
  exchange(port(), "GET / HTTP/1.1\r\nHost: localhost\r\nRange: bytes=9-1,-,x\r\nConnection: close\r\n\r\n", 1);
  for (const char* path :
       {"/api/pixels", "/api/pixels?kind=photo&level=99", "/api/pixels?kind=photo&level=-1", "/api/pixels?kind=x",
        "/render?state=mode%3Dx", "/render?state=%7B%22ev%22%3A1e999%7D", "/api/scores?metric=x"})
    EXPECT_THAT(request(path), HasSubstr("HTTP/1.1 400")) << path;
  EXPECT_THAT(request("/api/pixels?kind=render&state=camera%3Dc1%26light%3Dl4"), HasSubstr("HTTP/1.1 404"));
  EXPECT_THAT(request("/api/capture"), HasSubstr(kOk)) << "still there";
}

// 200 clients at once. True if all were answered.
bool all_are_answered(const std::function<std::string(const std::string&)>& request) {
  std::atomic<int> ok{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < 200; ++i)
    clients.emplace_back([&, i] {
      const std::string state = "camera%3Dc" + std::to_string(i % 2) + "%26light%3Dl" + std::to_string(i % 4);
      const std::string answer =
          i % 10 == 0 ? request("/render?state=" + state)
                      : request("/api/pixels?kind=photo&level=" + std::to_string(i % 3) + "&state=" + state);
      if (answer.starts_with(kOk) && answer.find("Content-Length: 0") == std::string::npos) ++ok;
    });
  for (std::thread& client : clients) client.join();
  return ok == 200;
}

TEST_F(ServerTest, AnswersTwoHundredAtOnce) {
  EXPECT_TRUE(all_are_answered([&](const std::string& path) { return request(path); }));
}

// Each says a byte now and then, and never the end of its request.
TEST_F(ServerTest, AnswersBesideAHundredAndFiftySlowClients) {
  const std::string words = "GET /api/capture HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(10'000, 'x');
  std::vector<int> slow;
  for (int i = 0; i < 150; ++i) slow.push_back(connected(port()));
  std::atomic<bool> stop{false};
  std::thread dripping([&] {
    for (std::size_t at = 0; !stop && at < words.size(); ++at) {
      for (const int fd : slow) send(fd, &words[at], 1, MSG_NOSIGNAL | MSG_DONTWAIT);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until each of them has a thread
  for (int i = 0; i < 5; ++i) {
    const auto began = std::chrono::steady_clock::now();
    EXPECT_THAT(request("/api/capture"), HasSubstr(kOk));
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(), 2);
  }
  EXPECT_TRUE(all_are_answered([&](const std::string& path) { return request(path); }));
  stop = true;
  dripping.join();
  for (const int fd : slow) close(fd);
}

// A client that reads nothing of a large answer gives its thread back.
TEST_F(ServerTest, LeavesClientsThatDoNotRead) {
  const int fd = connected(port());
  const std::string ask =
      "GET /api/tables HTTP/1.1\r\nHost: localhost\r\nX-Likeness-Token: " + served_.server().token() + "\r\n\r\n";
  for (int i = 0; i < 200; ++i)
    if (send(fd, ask.data(), ask.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0) break;
  EXPECT_THAT(request("/api/capture"), HasSubstr(kOk));
  close(fd);
}

}  // namespace
}  // namespace likeness::olat_view
