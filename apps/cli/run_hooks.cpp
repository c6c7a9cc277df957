#include "run_hooks.h"

#include <atomic>
#include <csignal>

namespace marey::cli {
namespace {

std::atomic<bool> pressed = false;

void interrupt(int) {
  pressed = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
}

bool interrupted() {
  return pressed;
}

}  // namespace marey::cli
