#include "live_screen.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "marey/files/text_safety.h"

#include "camera_health.h"

namespace marey::cli {
namespace {

constexpr int kPoll = 100;  // ms

bool is_silent(FeedState state) {
  return state == FeedState::stalled || state == FeedState::lost || state == FeedState::connecting;
}

/// How wide the terminal is that standard error goes to; 120 where it is not one.
int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 120;
}

/// "12.4 s  cam1 100 Hz 40  cam2 lost | 40 targets | dropped 3 | 4.1 / 9.8 ms | REC"
std::string line_of(const pipeline::corridor::LiveStatus& status) {
  std::string text = fmt::format("{:.0f} s ", status.seconds);
  for (const auto& camera : status.cameras) {
    text += " " + short_line_of(camera, fmt::format("{:.0f} Hz {}", camera.rate_hz.value_or(0), camera.detections));
    if (camera.dropped() > 0) text += fmt::format(" -{}", camera.dropped());
  }
  const pipeline::corridor::LiveDrops& drops = status.drops;
  text += fmt::format(" | {} targets | dropped {}", status.targets, drops.superseded + drops.incomplete + drops.late_frames);
  if (status.latency_median_s)
    text += fmt::format(" | {:.1f} / {:.1f} ms", 1000 * *status.latency_median_s, 1000 * status.latency_p99_s.value_or(0));
  if (status.recording) text += " | REC";
  return text;
}

}  // namespace

/// Letters come one by one and are not shown; Ctrl-C stays what it is.
struct Keys::Terminal {
  Terminal() {
    tcgetattr(STDIN_FILENO, &before);
    termios now = before;
    now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    now.c_cc[VMIN] = 0;
    now.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &now);
  }
  ~Terminal() { tcsetattr(STDIN_FILENO, TCSANOW, &before); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  termios before{};
};

Keys::Keys(std::function<void(char)> pressed) {
  // A program in the background that touches the terminal would be stopped.
  if (isatty(STDIN_FILENO) == 0 || tcgetpgrp(STDIN_FILENO) != getpgrp()) return;
  terminal_ = std::make_unique<Terminal>();
  reader_ = std::jthread([pressed = std::move(pressed)](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd waited{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
      if (poll(&waited, 1, kPoll) <= 0) continue;
      char key = 0;
      if (read(STDIN_FILENO, &key, 1) != 1) return;
      pressed(key);
    }
  });
}

Keys::~Keys() {
  if (!reader_.joinable()) return;
  reader_.request_stop();
  reader_.join();
}

StatusLine::StatusLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

StatusLine::~StatusLine() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
}

void StatusLine::announce(const std::string& message_text) {
  if (quiet_) return;
  fmt::print(stderr, "{}{}\n", shown_ ? "\r\x1b[K" : "", plain_text(message_text));
  shown_ = false;
}

void StatusLine::show(const std::string& line) {
  if (quiet_ || !terminal_) return;
  fmt::print(stderr, "\r\x1b[K{}", line.substr(0, static_cast<std::size_t>(std::max(20, terminal_columns() - 1))));
  std::fflush(stderr);
  shown_ = true;
}

void LiveScreen::begun(pipeline::live::LiveJob job, const Rig& rig, bool keys, bool records) {
  out_.announce(fmt::format("{} of {} {}{}", to_string(job), rig.cameras.size(), rig.cameras.size() == 1 ? "camera" : "cameras",
                            job == pipeline::live::LiveJob::preview ? "; calibrate the rig to track (marey calibrate wand)" : ""));
  if (keys) out_.announce(records ? "r: record, or pause; q: end" : "q: end");
}

void LiveScreen::show(const pipeline::corridor::LiveStatus& status) {
  states_.resize(status.cameras.size(), FeedState::live);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const auto& camera = status.cameras[i];
    if (states_[i] == camera.state) continue;
    const bool waits = camera.state == FeedState::connecting && camera.trouble.empty();  // as every camera does at first
    if (waits) continue;
    const bool reported = is_silent(camera.state) || is_silent(states_[i]);
    states_[i] = camera.state;
    const std::string why = is_silent(camera.state) && !camera.trouble.empty() ? ": " + camera.trouble : "";
    if (reported) out_.announce(fmt::format("camera \"{}\" is {}{}", camera.name, to_string(camera.state), why));
  }
  for (const std::string& trouble : status.troubles) {
    if (std::find(troubles_.begin(), troubles_.end(), trouble.substr(0, trouble.find(':'))) != troubles_.end()) continue;
    troubles_.push_back(trouble.substr(0, trouble.find(':')));
    out_.announce("marey: warning: " + trouble);
  }
  const auto left = std::min<std::int64_t>(status.news_count - news_, std::ssize(status.news));
  for (auto message_text = status.news.end() - left; message_text != status.news.end(); ++message_text)
    out_.announce(*message_text);
  news_ = status.news_count;
  out_.show(line_of(status));
}

}  // namespace marey::cli
