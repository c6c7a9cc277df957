#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "marey/pipeline/live/live.h"

namespace marey::cli {

/// The keys of a terminal while something live runs, read on a thread of its own: one at a time, without Enter. Where standard
/// input is not a terminal nothing is read. The terminal is as before when this is gone.
class Keys {
 public:
  explicit Keys(std::function<void(char)> pressed);
  ~Keys();
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  bool listens() const { return reader_.joinable(); }

 private:
  struct Terminal;
  std::unique_ptr<Terminal> terminal_;
  std::jthread reader_;
};

/// Standard error while something live runs: sentences everywhere, and under them, where that is a terminal, a line that is written
/// over. It is gone when this is.
class StatusLine {
 public:
  explicit StatusLine(bool quiet);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void announce(const std::string& message_text);
  /// As much of it as the terminal is wide.
  void show(const std::string& line);

 private:
  bool quiet_, terminal_, shown_ = false;
};

/// What a live run says: how it goes, and a sentence for each camera whose state changes.
class LiveScreen {
 public:
  explicit LiveScreen(bool quiet) : out_(quiet) {}

  void begun(pipeline::live::LiveJob job, const Rig& rig, bool keys, bool records);
  void show(const pipeline::corridor::LiveStatus& status);
  void announce(const std::string& sentence) { out_.announce(sentence); }

 private:
  StatusLine out_;
  std::vector<FeedState> states_;
  std::vector<std::string> troubles_;
  std::int64_t news_ = 0;  // how many were said
};

}  // namespace marey::cli
