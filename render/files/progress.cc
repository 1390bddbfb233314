#include "render/files/progress.h"

#include <unistd.h>

#include <cmath>
#include <iostream>
#include <string>

namespace likeness::files {

std::string duration_text(double seconds) {
  const long whole = std::lround(seconds);
  std::string text;
  if (whole >= 3600) text += std::to_string(whole / 3600) + " h ";
  if (whole >= 60) text += std::to_string(whole / 60 % 60) + " min ";
  return text + std::to_string(whole % 60) + " s";
}

Progress::Progress() : began_(Clock::now()), told_(began_), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (shown_) std::cerr << "\r\x1b[K" << std::flush;
}

void Progress::tell(std::string_view what, double share) {
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - began_).count();
  if (!terminal_ || seconds < 1 || std::chrono::duration<double>(now - told_).count() < 0.2) return;
  told_ = now;
  shown_ = true;
  std::cerr << "\r\x1b[K" << what;
  if (share > 0)
    std::cerr << "  " << std::lround(100 * share) << " %, about " << duration_text(seconds * (1 - share) / share)
              << " left";
  std::cerr << std::flush;
}

}  // namespace likeness::files
