// What is to be done with many recordings, and the result: a table with a row a task, and beside it, in a folder of results, a
// record a task. The one who runs a task needs nothing else, so that tasks run anywhere, in any order, twice, or again after a node
// was lost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace marey::cli {

/// A file that a task reads, as it was when the plan was made.
struct PlannedInput {
  std::string path;
  std::int64_t size = 0;      ///< bytes
  std::int64_t mtime_ns = 0;  ///< when it was changed last
  std::string hash;           ///< format/input_hash.h

  bool operator==(const PlannedInput&) const = default;
};

/// Of a task with one thread.
struct TaskCosts {
  int memory_mb = 0;   ///< at most at once
  double seconds = 0;  ///< roughly: machines differ
};

struct BatchTask {
  int number = 0;                    ///< from 1
  std::string name;                  ///< of the recording: unique in the plan
  std::string job;                   ///< "track", "ground", "reconstruct", "measure"
  std::vector<PlannedInput> inputs;  ///< the first is the recording; those of a rig follow
  std::vector<std::string> options;  ///< further words of the command
  std::string output;                ///< a path
  TaskCosts costs;                   ///< that are expected

  /// What it comes out the same by: the program's version, the job, its options and its inputs' bytes.
  std::string hash() const;
};

struct BatchPlan {
  std::string path;
  std::vector<BatchTask> tasks;

  std::string results() const;  ///< the folder beside it: PLAN.results
  std::string record_of(const BatchTask& task) const;
  /// All that tasks read and write.
  std::vector<std::string> files() const;
};

/// Keeps tasks from writing outside of a folder of results: plans and tables may come from untrusted clients. It follows the links
/// of each folder once, which takes longer than all other checks of a plan of thousands.
class OutputCheck {
 public:
  explicit OutputCheck(std::string results);
  /// Throws Error.
  void check(const BatchTask& task);

 private:
  bool is_within(const std::string& path) const;

  std::string results_;
  std::map<std::string, bool> folders_;  // whether they are within
};

/// What results from a task that was run.
struct TaskRecord {
  std::string hash;  ///< the task's, when it was run
  bool done = false;
  int exit_code = 0;
  double seconds = 0;
  int peak_mb = 0;
  std::string host;
  std::string message_text;  ///< why it failed; what the run warned of
};

/// The words of the command that does a job; its input follows.
std::vector<std::string> words_of_job(const std::string& job);

/// Throws Error with the line where it is not a plan.
BatchPlan read_plan(const std::string& path);
/// Atomically.
void write_plan(const BatchPlan& plan);

/// Nothing if the task was never run to an end. Throws Error if there is something else in its place.
std::optional<TaskRecord> read_record(const std::string& path);
void write_record(const std::string& path, const TaskRecord& record);

struct PlanRequest {
  std::string from;  ///< a folder, or a table with a column `input`
  std::string job = "track";
  std::vector<std::string> options;
  std::string extension;  ///< of the results; empty: the job's default one
  std::string plan;       ///< the file that is written; what it says of inputs that are as they were is kept
};

/// Finds the recordings, in the order of their names. Throws Error if there are no recordings, or where two would have one name.
BatchPlan make_plan(const PlanRequest& request);

/// What differs from the plan, one sentence: the input is gone, or its bytes are others. Compares size and time of change, and
/// reads only where they differ. Empty if all is as planned.
std::string changed_input(const BatchTask& task);

bool is_video(const std::filesystem::path& path);

/// What the job will take with such inputs, from measurements (docs/batch.md).
TaskCosts expected_costs(const std::string& job, const std::vector<std::string>& inputs);
int memory_with_threads(int mb, int threads);

/// The command lines that do all of a plan.
struct BatchLines {
  std::string loop, parallel, slurm_array, slurm_reduce;
};
/// `jobs`: of the array; each does as many of the tasks as it takes.
BatchLines lines_of(const BatchPlan& plan, const std::string& program, int threads, int jobs);
/// This many jobs that each works a minute or more, because a cluster takes seconds to start one; but not fewer than eight.
int default_array_jobs(const BatchPlan& plan);

}  // namespace marey::cli
