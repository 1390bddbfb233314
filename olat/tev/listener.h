#pragma once

#include <memory>
#include <string_view>

#include "olat/tev/images.h"

namespace likeness::olat_tev {

// Receives as tev does, on this machine's loopback and nowhere else. Nothing is ever answered. A connection that sends what is
// no packet is closed, and so is one that says nothing for kPatience seconds in the middle of a packet. kConnections at a
// time; the one that was silent the longest makes room for the next. A packet's memory grows as its bytes arrive.
class Listener {
 public:
  static constexpr int kConnections = 8;
  static constexpr int kPatience = 10;  // [s]

  // "127.0.0.1:14159"; port 0: any that is free. Throws files::UsageError: not an address of the loopback; a port that is
  // taken.
  Listener(Images& images, std::string_view address);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  int port() const;

 private:
  struct Sockets;
  std::unique_ptr<Sockets> sockets_;
};

}  // namespace likeness::olat_tev
