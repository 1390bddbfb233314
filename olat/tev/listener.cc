#include "olat/tev/listener.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <list>
#include <string>
#include <thread>
#include <utility>

#include "olat/tev/send.h"
#include "render/files/files.h"

namespace likeness::olat_tev {
namespace {

using Clock = std::chrono::steady_clock;

struct Connection {
  int socket = -1;
  std::string bytes;  // that make no packet yet
  Clock::time_point heard = Clock::now();
};

// Hands whole packets on. False: the connection is to be closed.
bool take_packets(Connection& connection, Images& images) {
  std::size_t at = 0;
  try {
    while (connection.bytes.size() - at >= 4) {
      const std::string_view left = std::string_view(connection.bytes).substr(at);
      const std::size_t length = length_of(left);
      if (left.size() < length) break;
      images.take(packet_of(left.substr(0, length)));
      at += length;
    }
  } catch (const files::InputError&) {
    return false;
  }
  connection.bytes.erase(0, at);
  if (connection.bytes.empty()) connection.bytes.shrink_to_fit();
  return true;
}

// What has arrived, at most a part of it. False: the other side ended, or sent what is no packet.
bool read_some(Connection& connection, Images& images) {
  char part[1 << 16];
  for (int i = 0; i < 16; ++i) {
    const ssize_t count = recv(connection.socket, part, sizeof part, MSG_DONTWAIT);
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    if (count == 0) return false;
    connection.heard = Clock::now();
    connection.bytes.append(part, static_cast<std::size_t>(count));
    if (!take_packets(connection, images)) return false;
  }
  return true;
}

}  // namespace

struct Listener::Sockets {
  int listening = -1, stopping = -1, port = 0;
  std::thread thread;

  ~Sockets() {
    for (const int fd : {listening, stopping})
      if (fd >= 0) close(fd);
  }

  void run(Images& images) {
    std::list<Connection> connections;
    for (;;) {
      std::vector<pollfd> polled{{stopping, POLLIN, 0}, {listening, POLLIN, 0}};
      for (const Connection& c : connections) polled.push_back({c.socket, POLLIN, 0});
      poll(polled.data(), polled.size(), 1000);
      if (polled[0].revents != 0) break;
      std::size_t k = 2;
      const auto late = Clock::now() - std::chrono::seconds(kPatience);
      for (auto at = connections.begin(); at != connections.end(); ++k) {
        bool is_kept = polled[k].revents == 0 || read_some(*at, images);
        if (!at->bytes.empty() && at->heard < late) is_kept = false;
        if (!is_kept) close(at->socket);
        at = is_kept ? std::next(at) : connections.erase(at);
      }
      if (polled[1].revents == 0) continue;
      const int socket = accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
      if (socket < 0) continue;
      if (connections.size() == kConnections) {
        const auto silent = std::min_element(connections.begin(), connections.end(),
                                             [](const auto& a, const auto& b) { return a.heard < b.heard; });
        close(silent->socket);
        connections.erase(silent);
      }
      connections.push_back({socket, "", Clock::now()});
    }
    for (const Connection& c : connections) close(c.socket);
  }
};

Listener::Listener(Images& images, std::string_view address) : sockets_(std::make_unique<Sockets>()) {
  auto [host, port] = host_and_port(address);
  if (host == "localhost") host = "127.0.0.1";
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, host.c_str(), &at.sin_addr) != 1 || ntohl(at.sin_addr.s_addr) >> 24 != 127)
    throw files::UsageError("--tev-listen " + files::in_quotes(host) +
                            " is not of this machine's loopback; use 127.0.0.1, and ssh -R from elsewhere");
  sockets_->listening = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockets_->stopping = eventfd(0, EFD_CLOEXEC);
  const int yes = 1;
  setsockopt(sockets_->listening, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  socklen_t size = sizeof at;
  if (bind(sockets_->listening, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
      listen(sockets_->listening, kConnections) != 0 ||
      getsockname(sockets_->listening, reinterpret_cast<sockaddr*>(&at), &size) != 0)
    throw files::UsageError("--tev-listen: port " + std::to_string(port) +
                            " is taken or not allowed; 0 takes any that is free");
  sockets_->port = ntohs(at.sin_port);
  sockets_->thread = std::thread([this, &images] { sockets_->run(images); });
}

Listener::~Listener() {
  const std::uint64_t one = 1;
  if (write(sockets_->stopping, &one, sizeof one) == sizeof one) sockets_->thread.join();
}

int Listener::port() const { return sockets_->port; }

}  // namespace likeness::olat_tev
