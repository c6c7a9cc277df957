#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace marey::cli {

/// One line on standard error that shows how far a run is, its rate and the time left. Silent where standard error is no
/// terminal, or where asked to be.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  /// Takes the line away, so that what comes next stands on a clean one.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `what` names the step; a new name begins a new count.
  void show(std::string_view what, std::int64_t done, std::optional<std::int64_t> total);
  /// A line that stays, above.
  void announce(const std::string& message_text);

 private:
  using Clock = std::chrono::steady_clock;

  bool silent_;
  std::string what_;
  Clock::time_point begin_;
  Clock::time_point last_shown_;
};

}  // namespace marey::cli
