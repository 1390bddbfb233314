#include "render/files/interrupt.h"

#include <atomic>
#include <csignal>

namespace likeness::files {
namespace {

std::atomic<bool> asked_to_stop{false};
extern "C" void on_signal(int signal) {
  if (asked_to_stop.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void catch_interrupts() {
  struct sigaction action{};
  action.sa_handler = on_signal;  // without SA_RESTART: a read that waits for a terminal or a pipe returns
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return asked_to_stop.load(); }

}  // namespace likeness::files
