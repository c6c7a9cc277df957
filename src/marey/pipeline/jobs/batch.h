// `marey batch` as values: how recordings become the tasks of a plan, and how those are run and submitted.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/pipeline/jobs/option.h"

namespace marey::pipeline::jobs {

inline constexpr int kMaxArrayJobs = 1000;  ///< by definition: Slurm accepts 1001 unless its administrator changed that

/// What each task does, by name.
const std::vector<std::string>& batch_jobs();

struct PlanBatch {
  std::string job = "track";     ///< one of batch_jobs()
  std::string job_options = {};  ///< words with blanks between
  std::string extension = {};    ///< of the results; empty: the job's default one
};

struct RunBatch {
  std::optional<int> task = {}, threads = {};
  std::string shard = {};  ///< "3/8"; empty: all
};

struct SubmitBatch {
  std::string engine = "slurm";
  int cpus = 1;
  std::optional<int> max_jobs = {};
  bool dry_run = false;
};

Table table_of(PlanBatch& job);
Table table_of(RunBatch& job);
Table table_of(SubmitBatch& job);

/// The words of a task's options with each option that the job's table has in canonical notation ("--rate=20.0" → "--rate", "20"),
/// so that a task that was done is recognised however its options were written; other words as they are. Throws WrongOption, with
/// the option's name, for a value outside its domain.
std::vector<std::string> canonical_words(std::string_view batch_job, const std::vector<std::string>& words);

}  // namespace marey::pipeline::jobs
