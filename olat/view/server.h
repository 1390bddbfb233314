#pragma once

#include <memory>
#include <string>

#include "olat/view/answers.h"

// The viewer's server: HTTP on this machine's loopback and nowhere else.
//
// Who is heard   GET and HEAD. A Host (and an Origin, where there is one) whose name is localhost, 127.0.0.1 or [::1], so
//                that a foreign page whose name was made to point here is refused; any port, for `ssh -L`. What shows data
//                needs the token in the header X-Likeness-Token; the page takes it from the fragment of its address,
//                which browsers send to nobody. No CORS header is ever sent.
// Bounds         kThreads connections at a time, others wait; a header line of 8 kB; no body; 5 s to read or write.
namespace likeness::olat_view {

class Server {
 public:
  static constexpr int kThreads = 256;    // a client that says its request slowly holds one
  static constexpr int kMostBody = 1024;  // bytes of a request's body, which nobody reads
  static constexpr int kPatience = 5;     // seconds that a client may keep silent

  // Binds to 127.0.0.1; port 0: any that is free. Throws files::UsageError if the port is taken.
  Server(Answers& answers, int port);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const { return port_; }
  const std::string& token() const { return token_; }
  // The address to open, with the state's text and the token.
  std::string address(const std::string& state) const;

  void run();   // until stop()
  void stop();  // any thread

 private:
  struct Http;
  std::unique_ptr<Http> http_;
  int port_ = 0;
  std::string token_;
};

}  // namespace likeness::olat_view
