#include "olat/tev/send.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>

#include "olat/tev/packet.h"
#include "render/files/files.h"

namespace likeness::olat_tev {

std::pair<std::string, int> host_and_port(std::string_view address) {
  const std::size_t colon = address.rfind(':');
  const std::string_view host = address.substr(0, colon), digits = colon == address.npos
                                                                       ? kTevAddress.substr(kTevAddress.rfind(':') + 1)
                                                                       : address.substr(colon + 1);
  int port = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (host.empty() || error != std::errc() || end != digits.data() + digits.size() || port < 0 || port > 65535)
    throw files::UsageError(files::in_quotes(std::string(address)) + " is no HOST:PORT, for example " +
                            std::string(kTevAddress));
  return {std::string(host), port};
}

Sender::Sender(std::string_view address) : address_(address) {
  const auto [host, port] = host_and_port(address);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  std::string cause;
  if (const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); error != 0)
    cause = gai_strerror(error);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owned(found, [](addrinfo* a) {
    if (a) freeaddrinfo(a);
  });
  const timeval patience{10, 0};
  const int yes = 1;
  for (const addrinfo* at = found; at && socket_ < 0; at = at->ai_next) {
    socket_ = socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC, at->ai_protocol);
    if (socket_ < 0) continue;
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);  // of connect too
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    if (connect(socket_, at->ai_addr, at->ai_addrlen) == 0) break;
    cause = std::strerror(errno);
    close(socket_);
    socket_ = -1;
  }
  if (socket_ < 0)
    throw files::InputError(address_ + ": no tev listens there (" + cause +
                            "); start tev first, or name its HOST:PORT");
}

Sender::~Sender() {
  if (socket_ >= 0) close(socket_);
}

void Sender::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw files::InputError(address_ + ": tev took no more (" + std::strerror(errno) + ")");
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

void Sender::send(const std::string& name, const image::Picture& picture) {
  write(bytes_of(Create{name, picture.width, picture.height, {"R", "G", "B"}}));
  // Bands of lines, so that tev shows what has come.
  constexpr std::size_t kBand = std::size_t{1} << 20;  // floats
  const std::size_t row = 3 * static_cast<std::size_t>(picture.width);
  const int lines = static_cast<int>(std::max<std::size_t>(1, kBand / std::max<std::size_t>(1, row)));
  for (int y = 0; y < picture.height; y += lines) {
    Update band{name,      {"R", "G", "B"}, 0, y, picture.width, std::min(lines, picture.height - y),
                {0, 1, 2}, {3, 3, 3},       {}};
    const auto first = picture.rgb.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * row);
    band.values.assign(first, first + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(band.height) * row));
    write(bytes_of(band));
  }
}

}  // namespace likeness::olat_tev
