#include "batch_plan.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <sys/stat.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/files/input_file.h"
#include "marey/files/natural_order.h"
#include "marey/format/input_hash.h"
#include "marey/format/register.h"
#include "marey/pipeline/jobs/batch.h"

#include "batch_fields.h"
#include "rig_inputs.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

/// Without its hash; nothing if there is no such file.
std::optional<PlannedInput> state_of(const std::string& path) {
  struct stat status{};
  if (stat(path.c_str(), &status) != 0) return std::nullopt;
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  return PlannedInput{path, status.st_size, status.st_mtim.tv_sec * kNanoseconds + status.st_mtim.tv_nsec, {}};
}

/// Whether the job is done with such a file.
bool is_input_of(const std::string& job, const fs::path& path) {
  if (job == "track") return is_video(path);
  if (job == "ground" || job == "reconstruct") return path.extension() == ".toml";
  const format::Format* format = format::format_of_content(path.string());
  return format != nullptr && format->holds.has(format::Content::ground) && format->is_read();
}

struct Found {
  std::string input, name;
  std::vector<std::string> options;
};

std::string stem_of(const fs::path& relative) {
  return (relative.parent_path() / relative.stem()).generic_string();
}

std::vector<Found> in_folder(const PlanRequest& request, const std::string& results) {
  std::vector<Found> found;
  const fs::path folder = request.from;
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator(); ++entry) {
    std::error_code ignored;
    if (entry->is_directory() && fs::equivalent(entry->path(), results, ignored)) entry.disable_recursion_pending();
    if (entry->path().filename().string().starts_with('.') || !entry->is_regular_file(ignored)) continue;
    if (fs::equivalent(entry->path(), request.plan, ignored) || !is_input_of(request.job, entry->path())) continue;
    found.push_back({entry->path().string(), stem_of(entry->path().lexically_relative(folder)), {}});
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return NaturalOrder()(a.input, b.input); });
  if (found.empty()) throw Error("{}: holds nothing that {} reads", request.from, request.job);
  return found;
}

std::vector<std::string> words_in(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// A column `input`, and if there are such `name` and `options`; paths are as seen from the table.
std::vector<Found> in_table(const PlanRequest& request) {
  InputStream file(request.from);
  std::string line;
  if (!file || !std::getline(file, line))
    throw Error("{}: cannot be read; give a folder, or a table with a column \"input\"", request.from);
  const char separator = line.find('\t') != std::string::npos ? '\t' : ',';
  const auto fields_of = [&](std::string text) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    return split_fields(text, separator);
  };
  const std::vector<std::string> head = fields_of(line);
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(head.begin(), head.end(), name) - head.begin());
  };
  const std::size_t input = column("input"), name = column("name"), options = column("options");
  if (input == head.size()) throw Error("{}:1: has no column \"input\", but {}", request.from, fmt::join(head, ", "));
  std::vector<Found> found;
  for (int number = 2; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() != head.size())
      throw Error("{}:{}: {} columns in place of {}", request.from, number, fields.size(), head.size());
    const fs::path path = fs::path(request.from).parent_path() / fields[input];
    Found& one = found.emplace_back();
    one.input = path.string();
    one.name = name < head.size() && !fields[name].empty() ? fields[name] : path.stem().string();
    if (options < head.size()) one.options = words_in(fields[options]);
  }
  if (found.empty()) throw Error("{}: names no recording", request.from);
  return found;
}

std::string default_extension(const std::string& job) {
  return job == "reconstruct" ? ".marey" : ".csv";
}

/// The recording, and behind a rig what its cameras read.
std::vector<std::string> inputs_of(const std::string& job, const std::string& input) {
  std::vector<std::string> paths{input};
  if (job != "ground" && job != "reconstruct") return paths;
  for (std::string& path : files_of_rig(input)) {
    if (!path.empty()) paths.push_back(std::move(path));
  }
  return paths;
}

/// As it was planned before, where it has not been touched since; else it is read.
PlannedInput planned(const std::string& path, const std::map<std::string, PlannedInput>& before) {
  auto state = state_of(path);
  if (!state) throw Error("{}: no such file", path);
  const auto known = before.find(path);
  if (known != before.end() && known->second.size == state->size && known->second.mtime_ns == state->mtime_ns) return known->second;
  state->hash = format::input_of(path).hash;
  return *state;
}

}  // namespace

std::vector<std::string> words_of_job(const std::string& job) {
  if (job == "ground") return {"track", "--ground"};
  return {job};
}

BatchPlan make_plan(const PlanRequest& request) {
  BatchPlan plan{request.plan, {}};
  std::map<std::string, PlannedInput> before;
  std::map<std::string, TaskCosts> costs_before;  // by the input's hash and the job: to ask a video for its size takes a while
  std::error_code error;
  if (fs::is_regular_file(request.plan, error)) {
    for (const BatchTask& task : read_plan(request.plan).tasks) {
      for (const PlannedInput& input : task.inputs) before[input.path] = input;
      costs_before[task.job + task.inputs.front().hash] = task.costs;
    }
  }
  const std::string ending = request.extension.empty() ? default_extension(request.job) : request.extension;
  std::set<std::string> names;
  OutputCheck outputs(plan.results());
  for (const Found& found : fs::is_directory(request.from, error) ? in_folder(request, plan.results()) : in_table(request)) {
    stop_point();
    BatchTask& task = plan.tasks.emplace_back();
    task.number = static_cast<int>(plan.tasks.size());
    task.name = found.name;
    if (!names.insert(task.name).second)
      throw Error("{}: two recordings are called \"{}\"; give a table with a column \"name\"", request.from, task.name);
    task.job = request.job;
    task.options = request.options;
    task.options.insert(task.options.end(), found.options.begin(), found.options.end());
    task.options = pipeline::jobs::canonical_words(task.job, task.options);
    const std::vector<std::string> inputs = inputs_of(request.job, found.input);
    for (const std::string& path : inputs) task.inputs.push_back(planned(path, before));
    task.output = (fs::path(plan.results()) / (task.name + ending)).string();
    outputs.check(task);
    const auto [known, is_new] = costs_before.try_emplace(task.job + task.inputs.front().hash);
    if (is_new) known->second = expected_costs(request.job, inputs);
    task.costs = known->second;
  }
  return plan;
}

std::string changed_input(const BatchTask& task) {
  for (const PlannedInput& input : task.inputs) {
    const auto now = state_of(input.path);
    if (!now) return fmt::format("{}: is not there any more; put it back, or make the plan again", input.path);
    if (now->size == input.size && now->mtime_ns == input.mtime_ns) continue;
    if (now->size != input.size || format::input_of(input.path).hash != input.hash)
      return fmt::format("{}: is another file than when the plan was made; make the plan again", input.path);
  }
  return {};
}

}  // namespace marey::cli
