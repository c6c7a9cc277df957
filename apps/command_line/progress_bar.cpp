#include "progress_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/core.h>
#include <unistd.h>

#include "marey/files/text_safety.h"

namespace marey::cli {
namespace {

constexpr int kWidth = 24;
constexpr auto kPause = std::chrono::milliseconds(100);

std::string minutes(double seconds) {
  const long whole = std::lround(std::max(0.0, seconds));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

ProgressBar::ProgressBar(bool quiet) : silent_(quiet || isatty(STDERR_FILENO) == 0) {}

ProgressBar::~ProgressBar() {
  if (!silent_ && !what_.empty()) fmt::print(stderr, "\r\x1b[K");
}

void ProgressBar::show(std::string_view what, std::int64_t done, std::optional<std::int64_t> total) {
  if (silent_) return;
  const auto now = Clock::now();
  if (what != what_) {
    what_ = what;
    begin_ = last_shown_ = now;
  }
  if (now - last_shown_ < kPause) return;
  last_shown_ = now;
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const double rate = static_cast<double>(done) / elapsed;
  std::string line = fmt::format("\r\x1b[K{} ", what_);
  if (total && *total >= done) {
    const double fraction = *total > 0 ? static_cast<double>(done) / static_cast<double>(*total) : 1.0;
    const int filled = static_cast<int>(fraction * kWidth);
    line += fmt::format("[{:#>{}}{:.>{}}] {:3.0f} %  ", "", filled, "", kWidth - filled, 100 * fraction);
    line += fmt::format("{:.0f} frames/s, {} left", rate, minutes(static_cast<double>(*total - done) / rate));
  } else {
    line += fmt::format("{} frames, {:.0f} frames/s", done, rate);
  }
  fmt::print(stderr, "{}", line);
  std::fflush(stderr);
}

void ProgressBar::announce(const std::string& message_text) {
  if (!silent_) fmt::print(stderr, "\r\x1b[Kmarey: {}\n", plain_text(message_text));
}

}  // namespace marey::cli
