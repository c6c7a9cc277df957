#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "marey/pipeline/run.h"

#include "command_line.h"
#include "progress_bar.h"

namespace marey::cli {

/// Makes the first Ctrl-C ask the run to end and write what it has; the second ends the program as ever.
void catch_interrupts();
/// Whether it was pressed.
bool interrupted();
/// The exit code of a program that Ctrl-C ended, by the shell's convention.
inline constexpr int kInterrupted = 130;

/// Runs `track(hooks)` with a progress bar and a Ctrl-C that ends it in order; `report(summary, elapsed)` says what came of it,
/// elapsed in s. Warnings go to standard error before.
template <typename Track, typename Report>
void run_with_progress(bool quiet, Track&& track, Report&& report) {
  catch_interrupts();
  const auto begin = std::chrono::steady_clock::now();
  const auto summary = [&] {
    ProgressBar bar(quiet);
    pipeline::Hooks hooks;
    hooks.stop = [] { return interrupted(); };
    hooks.options = given_options();
    hooks.progress = [&](const pipeline::Progress& progress) { bar.show(progress.step, progress.done, progress.total); };
    return track(hooks);
  }();
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const std::string& warning : summary.warnings) fmt::print(stderr, "marey: warning: {}\n", warning);
  report(summary, elapsed);
  if (summary.stopped) {
    fmt::print(stderr, "marey: stopped after {} frames; what was tracked until then is written\n", summary.frames);
    throw EndWith{kInterrupted};
  }
}

}  // namespace marey::cli
