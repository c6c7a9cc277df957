// Work on a frame that does not need what another step finds in the same frame, done at the same time.
#pragma once

#include <utility>

#include <tbb/task_group.h>

namespace marey::pipeline::corridor {

/// Tasks that run while their owner goes on: on another thread where one is free, else in `wait`. What they touch is theirs until
/// then. With one thread they run in `wait`, one after the other, and what comes of them is the same.
class Beside {
 public:
  Beside() = default;
  /// Waits, and drops what a task threw: its owner has failed before, and says why.
  ~Beside() {
    try {
      tasks_.wait();
    } catch (...) {
      return;
    }
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  template <typename Task>
  void run(Task&& task) {
    tasks_.run(std::forward<Task>(task));
  }

  /// Until all have ended. Throws what the first of those threw that failed.
  void wait() { tasks_.wait(); }

 private:
  tbb::task_group tasks_;
};

}  // namespace marey::pipeline::corridor
