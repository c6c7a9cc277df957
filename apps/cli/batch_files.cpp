// The plan as a table, a task's record as a list: the written files are read again.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/input_file.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/pipeline/jobs/batch.h"

#include "batch_fields.h"
#include "batch_plan.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlanHead = "task\tname\tdo\tinputs\tstates\toptions\toutput\tmemory_mb\tseconds";

/// Tabs, newlines and the separators of lists within a field.
std::string in_field(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\t':
        out += "\\t";
        break;
      case '\n':
        out += "\\n";
        break;
      case '|':
        out += "\\p";
        break;
      case '\\':
        out += "\\\\";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string out_of_field(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      out += text[i];
      continue;
    }
    const char c = text[++i];
    out += c == 't' ? '\t' : c == 'n' ? '\n' : c == 'p' ? '|' : c;
  }
  return out;
}

template <typename Range, typename Shown>
std::string list_of(const Range& range, Shown shown) {
  std::string text;
  bool first = true;
  for (const auto& each : range) {
    if (!std::exchange(first, false)) text += '|';
    text += in_field(shown(each));
  }
  return text;
}

std::vector<std::string> parts_of(const std::string& field) {
  if (field.empty()) return {};
  std::vector<std::string> parts = split_fields(field, '|');
  for (std::string& part : parts) part = out_of_field(part);
  return parts;
}

std::int64_t whole_of(const std::string& text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) throw Error("\"{}\" is not a whole number", text);
  return value;
}

/// A number that is small, and not below 0.
int count_of(const std::string& text) {
  constexpr std::int64_t kMaxCount = 1'000'000'000;
  const std::int64_t value = whole_of(text);
  if (value < 0 || value > kMaxCount) throw Error("{} is not within 0 and {}", text, kMaxCount);
  return static_cast<int>(value);
}

std::string fnv(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return fmt::format("{:016x}", hash);
}

double seconds_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0)) throw Error("\"{}\" are not seconds", text);
  return value;
}

BatchTask task_of(const std::string& line) {
  const std::vector<std::string> fields = split_fields(line, '\t');
  if (fields.size() != 9) throw Error("{} columns in place of 9", fields.size());
  BatchTask task;
  task.number = count_of(fields[0]);
  task.name = out_of_field(fields[1]);
  task.job = fields[2];
  const std::vector<std::string>& jobs = pipeline::jobs::batch_jobs();
  if (std::find(jobs.begin(), jobs.end(), task.job) == jobs.end()) throw Error("\"{}\" is not a job", plain_text(task.job));
  const std::vector<std::string> paths = parts_of(fields[3]), states = parts_of(fields[4]);
  if (paths.empty() || paths.size() != states.size()) throw Error("{}", "inputs and states do not belong together");
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::vector<std::string> state = split_fields(states[i], ':');
    if (state.size() != 3) throw Error("\"{}\" is not a SIZE:TIME:HASH", states[i]);
    task.inputs.push_back({paths[i], whole_of(state[0]), whole_of(state[1]), state[2]});
  }
  task.options = parts_of(fields[5]);
  task.output = out_of_field(fields[6]);
  task.costs = {count_of(fields[7]), seconds_of(fields[8])};
  return task;
}

/// A line of a record.
void take_in(const std::string& line, TaskRecord& record) {
  const std::size_t tab = line.find('\t');
  if (tab == std::string::npos) throw Error("\"{}\"", plain_text(line.substr(0, 40)));
  const std::string key = line.substr(0, tab), value = out_of_field(line.substr(tab + 1));
  if (key == "hash") record.hash = value;
  if (key == "state") record.done = value == "done";
  if (key == "exit") record.exit_code = static_cast<int>(whole_of(value));
  if (key == "seconds") record.seconds = seconds_of(value);
  if (key == "peak_mb") record.peak_mb = static_cast<int>(whole_of(value));
  if (key == "host") record.host = value;
  if (key == "said") record.message_text = value;
}

}  // namespace

std::vector<std::string> split_fields(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

std::string BatchTask::hash() const {
  std::string text = std::string(MAREY_VERSION) + '\n' + job + '\n' + list_of(options, [](const auto& word) { return word; });
  for (const PlannedInput& input : inputs) text += '\n' + input.hash;
  return fnv(text);
}

std::string BatchPlan::results() const {
  return path + ".results";
}

OutputCheck::OutputCheck(std::string results) : results_(std::move(results)) {}

bool OutputCheck::is_within(const std::string& path) const {
  std::error_code error;
  const fs::path allowed = fs::weakly_canonical(fs::absolute(results_), error);
  const fs::path below = fs::weakly_canonical(fs::absolute(path), error).lexically_relative(allowed);
  return !error && !below.empty() && *below.begin() != "..";
}

void OutputCheck::check(const BatchTask& task) {
  const std::size_t slash = task.output.rfind('/');
  const std::string name = task.output.substr(slash + 1);  // of a path without one: all of it
  const auto [folder, is_new] = folders_.try_emplace(slash == std::string::npos ? "." : task.output.substr(0, slash + 1), false);
  if (is_new) folder->second = is_within(folder->first);
  const bool is_name = !name.empty() && name != "." && name != "..";
  std::error_code error;
  if (!folder->second || !is_name || (fs::is_symlink(task.output, error) && !is_within(task.output)))
    throw Error("\"{}\" would be written to {}, outside of {}", plain_text(task.name), plain_text(task.output), results_);
}

std::vector<std::string> BatchPlan::files() const {
  std::vector<std::string> paths;
  for (const BatchTask& task : tasks) {
    for (const PlannedInput& input : task.inputs) paths.push_back(input.path);
    paths.push_back(task.output);
  }
  return paths;
}

std::string BatchPlan::record_of(const BatchTask& task) const {
  return (fs::path(results()) / "tasks" / fmt::format("{:06}.tsv", task.number)).string();
}

BatchPlan read_plan(const std::string& path) {
  InputStream file(path);
  if (!file) throw Error("{}: cannot be read; `marey batch plan` makes a plan", path);
  BatchPlan plan{path, {}};
  OutputCheck outputs(plan.results());
  std::string line;
  if (!std::getline(file, line) || line != kPlanHead) throw Error("{}:1: this is not a plan; `marey batch plan` makes one", path);
  for (int number = 2; std::getline(file, line); ++number) {
    try {
      plan.tasks.push_back(task_of(line));
      if (plan.tasks.back().number != std::ssize(plan.tasks)) throw Error("{}", "tasks are numbered from 1, one a line");
      outputs.check(plan.tasks.back());
    } catch (const Error& error) {
      throw Error("{}:{}: {}; make the plan again with `marey batch plan`", path, number, error.what());
    }
  }
  return plan;
}

void write_plan(const BatchPlan& plan) {
  std::string text = std::string(kPlanHead) + '\n';
  const auto same = [](const std::string& word) { return word; };
  for (const BatchTask& task : plan.tasks) {
    text += fmt::format(
        "{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.3g}\n", task.number, in_field(task.name), task.job,
        list_of(task.inputs, [](const PlannedInput& input) { return input.path; }),
        list_of(task.inputs,
                [](const PlannedInput& input) { return fmt::format("{}:{}:{}", input.size, input.mtime_ns, input.hash); }),
        list_of(task.options, same), in_field(task.output), task.costs.memory_mb, task.costs.seconds);
  }
  WholeFile file(plan.path);
  file.write(text);
  file.finish();
}

std::optional<TaskRecord> read_record(const std::string& path) {
  InputStream file(path);
  if (!file) return std::nullopt;
  TaskRecord record;
  for (std::string line; std::getline(file, line);) {
    try {
      take_in(line, record);
    } catch (const Error& error) {
      throw Error("{}: is not a record of a task ({}); remove it, and the task is done again", path, error.what());
    }
  }
  return record;
}

void write_record(const std::string& path, const TaskRecord& record) {
  WholeFile file(path);
  file.write(fmt::format("hash\t{}\nstate\t{}\nexit\t{}\nseconds\t{:.3f}\npeak_mb\t{}\nhost\t{}\nsaid\t{}\n", record.hash,
                         record.done ? "done" : "failed", record.exit_code, record.seconds, record.peak_mb, record.host,
                         in_field(record.message_text)));
  file.finish();
}

}  // namespace marey::cli
