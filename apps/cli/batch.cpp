#include "marey/pipeline/jobs/batch.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/files/whole_file.h"

#include "batch_page.h"
#include "batch_plan.h"
#include "batch_reduce.h"
#include "batch_run.h"
#include "command_line.h"
#include "commands.h"
#include "file_checks.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

struct Reporting {
  bool json = false, quiet = false;
};

// ---- plan

struct PlanCommand : Reporting {
  std::string from, plan;
  pipeline::jobs::PlanBatch job;
};

std::string program_name() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? "marey" : program.string();
}

void print_lines(const BatchPlan& plan) {
  const BatchLines lines = lines_of(plan, program_name(), 1, default_array_jobs(plan));
  fmt::print(
      "here, one after the other:\n  {}\nhere, side by side (GNU parallel):\n  {}\non a cluster (Slurm), ARRAY is what the first "
      "line prints:\n  {}\n  {}\n",
      lines.loop, lines.parallel, lines.slurm_array, lines.slurm_reduce);
}

void plan_batch(const PlanCommand& command) {
  PlanRequest request{
      .from = command.from, .job = command.job.job, .options = {}, .extension = command.job.extension, .plan = command.plan};
  std::string word;
  for (const char c : command.job.job_options + " ") {
    if (c != ' ') {
      word += c;
    } else if (!word.empty()) {
      request.options.push_back(std::exchange(word, {}));
    }
  }
  const BatchPlan plan = make_plan(request);
  std::vector<NamedPath> its_files;
  for (const std::string& path : plan.files()) its_files.push_back({"FROM", path, {}});
  const NamedPath written{"--output", plan.path, {}};
  check_files(its_files, {&written, 1});
  write_plan(plan);
  int memory = 0;
  for (const BatchTask& task : plan.tasks) memory = std::max(memory, task.costs.memory_mb);
  if (command.json) {
    const BatchLines lines = lines_of(plan, program_name(), 1, default_array_jobs(plan));
    print({{"plan", plan.path},
           {"tasks", plan.tasks.size()},
           {"memory_mb", memory},
           {"results", plan.results()},
           {"loop", lines.loop},
           {"parallel", lines.parallel},
           {"slurm", {lines.slurm_array, lines.slurm_reduce}}});
  } else if (!command.quiet) {
    fmt::print("{}: {} tasks, each of at most about {} MB; results go to {}\n", plan.path, plan.tasks.size(), memory,
               plan.results());
    print_lines(plan);
  }
}

// ---- run

struct RunCommand : Reporting {
  std::string plan;
  pipeline::jobs::RunBatch job;
};

/// Which tasks are to be run: one, a share of them, or all.
struct Fraction {
  int first = 1, step = 1, last = 0;
};

Fraction fraction_of(const RunCommand& command, int count) {
  if (command.job.task && !command.job.shard.empty())
    throw WrongUsage("{}", "--task names one task, --shard a share of them: omit one of the two");
  if (command.job.task) {
    if (*command.job.task > count) throw WrongUsage("--task {}: {} has {} tasks", *command.job.task, command.plan, count);
    return {*command.job.task, 1, *command.job.task};
  }
  if (command.job.shard.empty()) return {1, 1, count};
  const std::size_t slash = command.job.shard.find('/');
  constexpr int kMaxCount = 1'000'000'000;
  if (slash == std::string::npos) throw WrongUsage("--shard {}: write PART/PARTS, as 3/8", command.job.shard);
  const auto parts = static_cast<int>(whole_number_in(command.job.shard.substr(slash + 1), "PARTS", 1, kMaxCount));
  const auto part = static_cast<int>(whole_number_in(command.job.shard.substr(0, slash), "PART", 1, parts));
  return {part, parts, count};
}

struct Counts {
  int done = 0, was_done = 0, failed = 0;
};

void run_one(const BatchPlan& plan, const BatchTask& task, const RunCommand& command, Counts& counts) {
  TaskOutcome outcome;
  try {
    outcome = run_task(plan, task, command.job.threads);
  } catch (const Error& error) {
    outcome = {TaskOutcome::Kind::failed, error.what()};
  }
  switch (outcome.kind) {
    case TaskOutcome::Kind::done:
      ++counts.done;
      break;
    case TaskOutcome::Kind::was_done:
      ++counts.was_done;
      break;
    case TaskOutcome::Kind::failed:
      ++counts.failed;
      fmt::print(stderr, "marey: task {} ({}): {}\n", task.number, task.name, outcome.message_text);
      break;
  }
}

void run_batch(const RunCommand& command) {
  const BatchPlan plan = read_plan(command.plan);
  const Fraction fraction = fraction_of(command, static_cast<int>(plan.tasks.size()));
  Counts counts;
  with_progress(command.quiet, [&](const Hooks& hooks) {
    int detected = 0;
    for (int number = fraction.first; number <= fraction.last; number += fraction.step) {
      hooks.advance({"tasks", detected++, (fraction.last - fraction.first) / fraction.step + 1});
      run_one(plan, plan.tasks[static_cast<std::size_t>(number) - 1], command, counts);
    }
    return 0;
  });
  if (command.json) {
    print({{"done", counts.done}, {"done_before", counts.was_done}, {"failed", counts.failed}});
  } else if (!command.quiet) {
    fmt::print("{} done, {} were done before, {} failed\n", counts.done, counts.was_done, counts.failed);
  }
  if (counts.failed > 0) throw EndWith{1};
}

// ---- reduce

struct ReduceCommand : Reporting {
  std::string plan, out, report;
};

std::string page_file(const ReduceCommand& command) {
  return (fs::path(command.report) / "report.html").string();
}

void reduce_batch(const ReduceCommand& command) {
  const BatchPlan plan = read_plan(command.plan);
  const Season season = reduce(plan);
  WholeFile file(command.out);
  file.write(season_csv(season));
  if (!command.report.empty()) {
    std::error_code error;
    fs::create_directories(command.report, error);
    if (error) throw Error("{}: this folder cannot be made ({})", command.report, error.message());
    WholeFile page(page_file(command));
    page.write(season_page(season, fs::path(plan.path).stem().string(), plan.tasks.size()));
    page.finish();
  }
  file.finish();
  if (command.json) {
    Json failures = Json::array();
    for (const Season::Failure& failure : season.failures)
      failures.push_back({{"task", failure.number}, {"name", failure.name}, {"why", failure.why}});
    print({{"planned", plan.tasks.size()},
           {"done", season.done},
           {"rows", season.rows.size()},
           {"seconds", season.seconds},
           {"peak_mb", season.peak_mb},
           {"expected_mb", season.planned_mb},
           {"failures", failures}});
  } else if (!command.quiet) {
    fmt::print("{} of {} tasks are done: {} rows in {}\n", season.done, plan.tasks.size(), season.rows.size(), command.out);
    if (season.done > 0)
      fmt::print("{:.1f} s of work; the largest task took {} MB, {} were expected\n", season.seconds, season.peak_mb,
                 season.planned_mb);
    for (const Season::Failure& failure : season.failures)
      fmt::print("not done: {} ({}): {}\n", failure.number, failure.name, failure.why);
    if (!command.report.empty()) fmt::print("report: {}\n", page_file(command));
  }
  if (!season.failures.empty()) throw EndWith{1};
}

// ---- submit

struct SubmitCommand : Reporting {
  std::string plan;
  pipeline::jobs::SubmitBatch job;
};

/// What the line printed, without its last newline. Throws Error if it failed.
std::string shell(const std::string& line) {
  std::FILE* output = popen(line.c_str(), "re");
  if (output == nullptr) throw Error("no shell can be started for: {}", line);
  std::string text;
  for (int c; (c = std::fgetc(output)) != EOF;) text += static_cast<char>(c);
  if (pclose(output) != 0) throw Error("this line failed: {}", line);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

void submit_batch(const SubmitCommand& command) {
  const BatchPlan plan = read_plan(command.plan);
  const bool parallel = command.job.engine == "parallel";
  BatchLines lines = lines_of(plan, program_name(), command.job.cpus, command.job.max_jobs.value_or(default_array_jobs(plan)));
  const auto give_job = [&](const std::string& job) {
    const std::string before = "afterany:ARRAY";
    lines.slurm_reduce.replace(lines.slurm_reduce.find(before), before.size(), "afterany:" + job);
  };
  if (command.job.dry_run) {
    fmt::print("{}\n", parallel ? lines.parallel : lines.slurm_array + "\n" + lines.slurm_reduce);
    return;
  }
  fs::create_directories(fs::path(plan.results()) / "log");
  if (parallel) {
    shell(lines.parallel);
    return;
  }
  std::string job = shell(lines.slurm_array);
  if (const std::size_t cluster = job.find(';'); cluster != std::string::npos) job.resize(cluster);
  give_job(job);
  const std::string reduce_job = shell(lines.slurm_reduce);
  if (command.json) {
    print({{"array", job}, {"reduce", reduce_job}});
  } else if (!command.quiet) {
    fmt::print("array: job {}; reduce: job {}, when the array has ended\n", job, reduce_job);
  }
}

// ---- what they take

void add_batch_plan(Command& batch) {
  auto options = std::make_shared<PlanCommand>();
  Command command = batch.subcommand("plan", "Find the recordings of a folder or a table, and write what is to be done with each");
  command
      .text("FROM", options->from,
            "a folder, which is searched with all below it, or a table (CSV or TSV) with a column input, and if need be name and "
            "options")
      .required();
  command.output_file("-o,--output", options->plan, "the plan; results go to PLAN.results").required().ends_in({".tsv"});
  command.also_reads([options] { return std::vector{options->from}; });
  const pipeline::jobs::Table& rows = command.rows(table_of(options->job));
  command.records([&rows] { return rows.given(); });
  command.reports(options->json, options->quiet, "lines to run it");
  command.runs([options] { plan_batch(*options); });
}

void add_run(Command& batch) {
  auto options = std::make_shared<RunCommand>();
  Command command = batch.subcommand("run", "Do a plan's tasks that are not done yet: all, one, or a share");
  command.input_file("PLAN", options->plan, "what `marey batch plan` wrote").required();
  command.rows(table_of(options->job));
  command.reports(options->json, options->quiet, "counts");
  command.runs([options] { run_batch(*options); });
}

void add_reduce(Command& batch) {
  auto options = std::make_shared<ReduceCommand>();
  Command command = batch.subcommand("reduce", "One table of every person in every recording, and what is missing and why");
  command.input_file("PLAN", options->plan, "what `marey batch plan` wrote").required();
  command.output_file("-o,--output", options->out, "CSV with a row a person and recording").required().ends_in({".csv"});
  command.output_folder("--report", options->report, "folder for a page with totals, curves over the season and the tables");
  command.also_reads([options] { return read_plan(options->plan).files(); });
  command.also_writes(
      [options] { return options->report.empty() ? std::vector<std::string>{} : std::vector{page_file(*options)}; });
  command.reports(options->json, options->quiet, "summary");
  command.runs([options] { reduce_batch(*options); });
}

void add_submit(Command& batch) {
  auto options = std::make_shared<SubmitCommand>();
  Command command = batch.subcommand("submit", "Hand a plan to Slurm or GNU parallel, by the lines that `plan` prints");
  command.input_file("PLAN", options->plan, "what `marey batch plan` wrote").required();
  command.rows(table_of(options->job));
  command.reports(options->json, options->quiet, "jobs");
  command.runs([options] { submit_batch(*options); });
}

}  // namespace

void add_batch(Command& program) {
  Command batch = program.subcommand("batch", "Do the same with many recordings: here, over GNU parallel, or over a cluster");
  add_batch_plan(batch);
  add_run(batch);
  add_reduce(batch);
  add_submit(batch);
}

}  // namespace marey::cli
