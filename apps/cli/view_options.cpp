#include "view_options.h"

#include <condition_variable>
#include <mutex>

#include <fmt/core.h>

#include "run_hooks.h"

namespace marey::cli {

void add_listen_address(Command& command, viewer::ListenAddress& location) {
  command.text(
      "--listen", location.listen,
      "address of this machine at which the page is had; 0.0.0.0: all of them, so that a phone in the same network may look");
  command.whole("--port", location.port, "N", 0, 65535,
                fmt::format("of the page; 0 takes one that is free ({}, or a free one where that is taken)", viewer::kDefaultPort));
}

void wait_for_stop() {
  const std::stop_token stop = stop_by_signals();
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  stopped.wait(lock, stop, [] { return false; });
}

}  // namespace marey::cli
