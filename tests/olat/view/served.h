#pragma once

#include <string>
#include <thread>
#include <utility>

#include "olat/view/answers.h"
#include "olat/view/server.h"

namespace likeness::test {

// A capture served in this process until the end of the scope.
class Served {
 public:
  explicit Served(capture::Capture capture, const olat_view::ViewOptions& options = {})
      : answers_(std::move(capture), options), server_(answers_, 0), thread_([this] { server_.run(); }) {}
  ~Served() {
    server_.stop();
    thread_.join();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  olat_view::Answers& answers() { return answers_; }
  const olat_view::Server& server() const { return server_; }
  std::string address(const std::string& state = "") const { return server_.address(state); }

 private:
  olat_view::Answers answers_;
  olat_view::Server server_;
  std::thread thread_;
};

}  // namespace likeness::test
