// Work on a frame that does not need what another step finds in the same frame, done at the same time.
#pragma once

#include <utility>

#include <tbb/task_group.h>

namespace marey::pipeline::corridor {

/// Tasks that run while their owner continues: on another thread where one is free, else in `wait`. What they touch is theirs until
/// then. With one thread they run in `wait`, one after the other, and the result is the same.
class ParallelTasks {
 public:
  ParallelTasks() = default;
  /// Waits, and drops what a task threw: its owner has failed before, and says why.
  ~ParallelTasks() {
    try {
      tasks_.wait();
    } catch (...) {
      return;
    }
  }
  ParallelTasks(const ParallelTasks&) = delete;
  ParallelTasks& operator=(const ParallelTasks&) = delete;

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
