// The command lines that do all of a plan: here, over GNU parallel, over Slurm.
#include <algorithm>

#include <fmt/format.h>

#include "marey/pipeline/jobs/batch.h"

#include "batch_plan.h"

namespace marey::cli {
namespace {

/// A word as a shell takes it.
std::string quoted(const std::string& word) {
  const bool plain =
      !word.empty() &&
      word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%") == std::string::npos;
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

int default_array_jobs(const BatchPlan& plan) {
  constexpr double kScoreWeight = 60;  // s of work: Slurm starts jobs every 3 s
  constexpr int kMinTasks = 8;
  double seconds = 0;
  for (const BatchTask& task : plan.tasks) seconds += task.costs.seconds;
  return static_cast<int>(std::clamp(seconds / kScoreWeight, double{kMinTasks}, double{pipeline::jobs::kMaxArrayJobs}));
}

BatchLines lines_of(const BatchPlan& plan, const std::string& program, int threads, int jobs) {
  int memory = 0;
  for (const BatchTask& task : plan.tasks) memory = std::max(memory, task.costs.memory_mb);
  const std::size_t parts = std::min(plan.tasks.size(), static_cast<std::size_t>(jobs));
  const std::string run = fmt::format("{} batch run {} -q --task-threads {}", quoted(program), quoted(plan.path), threads);
  const std::string reduce =
      fmt::format("{} batch reduce {} -o {}", quoted(program), quoted(plan.path), quoted(plan.path + ".csv"));
  constexpr double kSpare = 1.3;  // expected values are right within 30 %
  const std::string log = quoted(plan.results() + "/log/%a.txt");
  BatchLines lines;
  lines.loop = run;
  lines.parallel = fmt::format("parallel --joblog {} --resume-failed {} --shard {{}}/{} ::: $(seq {})",
                               quoted(plan.results() + "/jobs.log"), run, plan.tasks.size(), plan.tasks.size());
  lines.slurm_array =
      fmt::format("sbatch --parsable --job-name=marey --array=1-{} --requeue --cpus-per-task={} --mem={}M --output={} --wrap={}",
                  parts, threads, static_cast<int>(kSpare * memory_with_threads(memory, threads)), log,
                  quoted(fmt::format("exec {} --shard $SLURM_ARRAY_TASK_ID/{}", run, parts)));
  lines.slurm_reduce = fmt::format("sbatch --parsable --job-name=marey-reduce --dependency=afterany:ARRAY --output={} --wrap={}",
                                   quoted(plan.results() + "/log/reduce.txt"), quoted("exec " + reduce));
  return lines;
}

}  // namespace marey::cli
