#pragma once

#include <optional>
#include <string>
#include <vector>

#include "batch_plan.h"

namespace marey::cli {

/// What happened to one task.
struct TaskOutcome {
  enum class Kind { done, was_done, failed };
  Kind kind = Kind::done;
  std::string message_text;  ///< why it failed
};

/// Does a task by this program, in a process of its own: what it takes and how it ends is written into its record. Nothing is done
/// where the record says that it was done with the same hash and the result is there. Its output appears atomically.
/// Throws Error if another run does it now, or the record cannot be written; Stopped.
TaskOutcome run_task(const BatchPlan& plan, const BatchTask& task, std::optional<int> threads);

}  // namespace marey::cli
