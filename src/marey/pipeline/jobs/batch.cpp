#include "marey/pipeline/jobs/batch.h"

#include <algorithm>

#include "marey/pipeline/jobs/register.h"

namespace marey::pipeline::jobs {
namespace {

/// "--targets" decides which table describes the others; empty if none does.
std::string table_name(std::string_view batch_job, const std::vector<std::string>& words) {
  if (batch_job == "ground") return "track ground";
  if (batch_job != "track" && batch_job != "reconstruct") return {};
  std::string targets = batch_job == "track" ? "people" : "markers";
  const std::string option = "--targets";
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == option && i + 1 < words.size()) targets = words[i + 1];
    if (words[i].starts_with(option + '=')) targets = words[i].substr(option.size() + 1);
  }
  std::string name = std::string(batch_job) + ' ' + targets;
  const std::vector<std::string> names = job_names();
  return std::find(names.begin(), names.end(), name) != names.end() ? name : std::string();
}

/// Appends the canonical words of the option at `i` and returns the index after it.
std::size_t append_canonical(Option& option, const std::vector<std::string>& words, std::size_t i, std::vector<std::string>& to) {
  const std::size_t equals = words[i].find('=');
  const bool separate = option.kind != Kind::flag && equals == std::string::npos;
  if (separate && i + 1 == words.size())
    throw WrongOption("--{}: has no value; write --{} {}", option.name, option.name, option.value);
  const std::string text = option.kind == Kind::flag ? "true" : separate ? words[i + 1] : words[i].substr(equals + 1);
  try {
    option.given.reset();
    option.set(text);
  } catch (const Error& error) {
    throw WrongOption("--{}: {}", option.name, error.what());
  }
  to.push_back("--" + option.name);
  if (option.kind != Kind::flag) to.push_back(option.kind == Kind::texts ? text : *option.given);
  return i + (separate ? 2 : 1);
}

}  // namespace

const std::vector<std::string>& batch_jobs() {
  static const std::vector<std::string> jobs{"track", "ground", "reconstruct", "measure"};
  return jobs;
}

Table table_of(PlanBatch& job) {
  Table table;
  table.choice("job", job.job, batch_jobs(), "what each task does; ground: people on the ground that a rig's cameras face");
  table.text("job-options", job.job_options, "further options of that command, as one text: '--filter imm --measured-only'");
  table.text("extension", job.extension, "of the results, which states their format (default: .csv, of reconstruct .marey)");
  return table;
}

Table table_of(RunBatch& job) {
  Table table;
  table.whole("task", job.task, "N", 1, 1'000'000'000, "this one alone");
  table.text("shard", job.shard, "PART/PARTS: every PARTS-th task from the PART-th on");
  table.whole("task-threads", job.threads, "N", 1, 1024, "that each task computes with (default: one per core)");
  return table;
}

Table table_of(SubmitBatch& job) {
  Table table;
  table.choice("engine", job.engine, {"slurm", "parallel"}, "the program that runs the tasks");
  table.whole("cpus", job.cpus, "N", 1, 1024, "processors of each task");
  table.whole("max-jobs", job.max_jobs, "N", 1, kMaxArrayJobs,
              "of Slurm's array at most (default: as many as work a minute or more each, because it takes seconds to start one)");
  table.flag("dry-run", job.dry_run, "print the lines alone");
  return table;
}

std::vector<std::string> canonical_words(std::string_view batch_job, const std::vector<std::string>& words) {
  const std::string name = table_name(batch_job, words);
  if (name.empty()) return words;
  std::vector<std::string> canonical;
  with_table(name, [&](Table& table) {
    for (std::size_t i = 0; i < words.size();) {
      const std::string& word = words[i];
      Option* option = word.starts_with("--") ? table.find(word.substr(2, word.find('=') - 2)) : nullptr;
      if (option != nullptr) {
        i = append_canonical(*option, words, i, canonical);
      } else {
        canonical.push_back(word);
        ++i;
      }
    }
  });
  return canonical;
}

}  // namespace marey::pipeline::jobs
