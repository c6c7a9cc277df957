// A method to end something long before its end: the one who starts it holds a std::stop_source and gives the token along; what is
// asked to end checks the token now and then. What waits for input waits in slices, so that it sees the token within a tenth of a
// second.
#pragma once

#include <chrono>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace marey {

/// How long something may wait before it checks its token again.
inline constexpr std::chrono::milliseconds kStopSlice{100};

/// Thrown out of something long that was asked to end before anything results from it: nothing is written. It is not an Error: who
/// tries another method where one fails must not try on.
class Stopped : public std::runtime_error {
 public:
  explicit Stopped(const std::string& message_text = "stopped; nothing was written") : std::runtime_error(message_text) {}
};

/// While it lives, what this thread reads and computes ends when `token` says so. Scopes nest: the innermost counts, and one of an
/// empty token shields what stands in it. Threads that are started do not inherit it; a reader on another one takes `current`
/// along.
class StopScope {
 public:
  explicit StopScope(std::stop_token token);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  /// The innermost scope's of this thread; without one a token that never says so.
  static const std::stop_token& current();

 private:
  std::stop_token token_;
  const std::stop_token* outer_;
};

/// Throws Stopped where this thread was asked to end.
void stop_point();

}  // namespace marey
