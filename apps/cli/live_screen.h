#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "marey/pipeline/live.h"

namespace marey::cli {

/// How wide the terminal is that standard error goes to; 120 where it is none.
int terminal_columns();

/// The keys of a terminal while something live runs, read on a thread of its own: one at a time, without Enter. Where standard
/// input is no terminal nothing is read. The terminal is as before when this is gone.
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

/// What a live run says on standard error: a line that is written over where that is a terminal, and a sentence for each camera
/// whose state changes, everywhere.
class LiveScreen {
 public:
  explicit LiveScreen(bool quiet);
  ~LiveScreen();

  void begun(pipeline::LiveJob job, const Rig& rig, bool keys, bool records);
  void show(const pipeline::LiveStatus& status);

 private:
  void say(const std::string& sentence);
  std::string line(const pipeline::LiveStatus& status) const;

  bool quiet_, terminal_;
  bool shown_ = false;
  std::vector<FeedState> states_;
  std::vector<std::string> troubles_;
};

}  // namespace marey::cli
