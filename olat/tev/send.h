#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "render/image/picture.h"

namespace likeness::olat_tev {

// "HOST:PORT" to its two parts, "HOST" to the host and tev's port. Throws files::UsageError.
std::pair<std::string, int> host_and_port(std::string_view address);

// A connection to a running tev, or to whatever listens as it does. A picture appears under its name, or takes the place
// of the one that has it; R, G, B, linear.
class Sender {
 public:
  // Throws files::InputError: nobody listens there.
  explicit Sender(std::string_view address);
  ~Sender();
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  // Throws files::InputError: the other side went away, or took nothing for 10 s.
  void send(const std::string& name, const image::Picture& picture);

 private:
  void write(std::string_view bytes);
  std::string address_;
  int socket_ = -1;
};

}  // namespace likeness::olat_tev
