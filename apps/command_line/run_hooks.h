#pragma once

#include <chrono>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/core/hooks.h"

#include "command_line.h"
#include "progress_bar.h"

namespace marey::cli {

/// The exit code of a program that was stopped, by the shell's convention for Ctrl-C.
inline constexpr int kInterrupted = 130;

/// From now on Ctrl-C, SIGTERM and SIGHUP ask what runs to end, by this token; a second Ctrl-C or SIGTERM ends the program as ever.
/// A process that was forked off has a token of its own.
std::stop_token stop_by_signals();

/// Hooks that show progress on the bar, which must outlive them, and end by signals.
Hooks hooks_over(ProgressBar& bar);

/// `work(hooks)`, with a progress bar.
template <typename Work>
auto with_progress(bool quiet, Work&& work) {
  ProgressBar bar(quiet);
  return std::forward<Work>(work)(hooks_over(bar));
}

/// A line on standard error for each; a terminal that is gone is skipped.
void warn(const std::vector<std::string>& sentences);

/// Runs `track(hooks)`, which ends in order when it is stopped; `report(summary, elapsed)` says the result, elapsed in s.
/// Warnings go to standard error before.
template <typename Track, typename Report>
void run_with_progress(bool quiet, Track&& track, Report&& report) {
  const auto begin = std::chrono::steady_clock::now();
  const auto summary = with_progress(quiet, track);
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  warn(summary.warnings);
  report(summary, elapsed);
  if (!summary.stopped) return;
  fmt::print(stderr, "marey: stopped after {} frames; what was tracked until then is written\n", summary.frames);
  throw EndWith{kInterrupted};
}

}  // namespace marey::cli
