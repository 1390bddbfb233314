// The only file that knows cpp-httplib.
#include "olat/view/server.h"

#include <array>
#include <random>
#include <string_view>

#include <httplib.h>

#include "olat/view/page.h"
#include "render/files/files.h"

namespace likeness::olat_view {
namespace {

// What a browser may do with an answer: run this server's script and nothing else.
const httplib::Headers kHeaders{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' blob: data:; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-store"},
};

// "127.0.0.1:8080" to "127.0.0.1"; "[::1]:80" to "[::1]".
std::string_view name_of(std::string_view host) {
  const std::size_t bracket = host.find(']');
  const std::size_t colon = host.find(':', bracket == std::string_view::npos ? 0 : bracket);
  return host.substr(0, colon);
}

bool is_local(std::string_view host) {
  const std::string_view name = name_of(host);
  return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

// In a time that does not depend on where they differ.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

std::string random_token() {
  std::random_device device;
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (int i = 0; i < 32; ++i) out += kDigits[device() % 16];
  return out;
}

void refuse(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content("{\"error\":\"" + text + "\"}", "application/json");
}

void send(httplib::Response& response, Answer answer) {
  response.status = answer.status;
  if (!answer.pixels) {
    response.set_content(std::move(answer.body), answer.type);
    return;
  }
  response.set_header("X-Width", std::to_string(answer.pixels->width));
  response.set_header("X-Height", std::to_string(answer.pixels->height));
  // From the cache's own memory, in pieces, so that a client that goes away is noticed.
  response.set_content_provider(answer.pixels->bytes(), answer.type,
                                [pixels = answer.pixels](std::size_t at, std::size_t size, httplib::DataSink& sink) {
                                  constexpr std::size_t kPiece = std::size_t{1} << 20;
                                  const char* const from = reinterpret_cast<const char*>(pixels->rgba.data());
                                  return sink.write(from + at, std::min(size, kPiece));
                                });
}

}  // namespace

struct Server::Http {
  httplib::Server server;
  socket_t listening = INVALID_SOCKET;
};

Server::Server(Answers& answers, int port) : http_(std::make_unique<Http>()), token_(random_token()) {
  httplib::Server& server = http_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_read_timeout(kPatience);
  server.set_write_timeout(kPatience);
  server.set_keep_alive_timeout(kPatience);
  server.set_payload_max_length(kMostBody);
  server.set_tcp_nodelay(true);
  server.set_default_headers(kHeaders);
  // Not SO_REUSEPORT, which httplib would set: nobody else may listen beside us.
  server.set_socket_options([this](socket_t socket) { http_->listening = socket; });

  server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    using Next = httplib::Server::HandlerResponse;
    const std::string host = request.get_header_value("Host");
    if (request.get_header_value_count("Host") != 1 || !is_local(host)) {
      refuse(response, 403, "this Host is not served");
      return Next::Handled;
    }
    if (request.has_header("Origin") && request.get_header_value("Origin") != "http://" + host) {
      refuse(response, 403, "this Origin is not served");
      return Next::Handled;
    }
    if (request.method != "GET" && request.method != "HEAD") {
      refuse(response, 405, "only GET and HEAD are served");
      return Next::Handled;
    }
    const bool is_page = static_cast<bool>(page_file(request.path));
    if (!is_page && !same(request.get_header_value("X-Likeness-Token"), token_)) {
      refuse(response, 403, "the token is missing or wrong: open the address that the program printed");
      return Next::Handled;
    }
    return Next::Unhandled;
  });
  server.Get(".*", [&answers](const httplib::Request& request, httplib::Response& response) {
    if (const auto file = page_file(request.path)) {
      response.set_content(std::string(file->text), std::string(file->type));
      return;
    }
    Parameters parameters;
    for (const auto& [name, value] : request.params) parameters.emplace(name, value);
    send(response, answers.answer(request.path, parameters));
  });
  server.set_exception_handler(
      [](const auto&, httplib::Response& response, const std::exception_ptr&) { refuse(response, 500, "failed"); });

  constexpr const char* kLoopback = "127.0.0.1";
  if (port == 0) port_ = server.bind_to_any_port(kLoopback);
  else port_ = server.bind_to_port(kLoopback, port) ? port : -1;
  if (port_ <= 0)
    throw files::UsageError("--port " + std::to_string(port) + " is taken or not allowed; 0 takes any that is free");
  // httplib lets five connections wait, and the kernel drops the sixth for seconds: a page's first requests are more.
  constexpr int kWaiting = 512;
  ::listen(http_->listening, kWaiting);
}

Server::~Server() { stop(); }

std::string Server::address(const std::string& state) const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/" + (state.empty() ? "" : "?" + state) + "#" + token_;
}

void Server::run() { http_->server.listen_after_bind(); }

void Server::stop() { http_->server.stop(); }

}  // namespace likeness::olat_view
