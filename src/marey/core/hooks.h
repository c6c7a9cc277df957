// How something long talks to the one who started it, the same for every job: how far it is, and whether it is to end.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "marey/core/stop.h"

namespace marey {

/// How far something long is.
struct Progress {
  std::string_view step;              ///< "tracking", "drawing", …: what is being done
  std::int64_t done = 0;              ///< frames, images, …
  std::optional<std::int64_t> total;  ///< where it is known
};

enum class Continue { no, yes };

/// All may be empty.
struct Hooks {
  /// Called now and then, from one thread at a time.
  std::function<void(const Progress&)> progress = {};
  /// Asks to leave off. A run from cameras to files then writes what there is; anything else writes nothing and throws Stopped.
  std::stop_token stop = {};
  /// What the user asked for, by option: recordings keep it with the inputs' names and hashes, so that they can be made again.
  std::map<std::string, std::string> options = {};
  /// Called with what a user should know before the end, one sentence each, from the thread that calls `progress`.
  std::function<void(const std::string&)> news = {};

  Continue report(const Progress& now) const {
    if (progress) progress(now);
    return stop.stop_requested() ? Continue::no : Continue::yes;
  }
  /// For what is worth nothing before its end: throws Stopped where it is to leave off.
  void advance(const Progress& now) const {
    if (report(now) == Continue::no) throw Stopped();
  }
};

}  // namespace marey
