#include "batch_plan.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <sys/stat.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/core/whole_file.h"
#include "marey/format/input_hash.h"
#include "marey/format/register.h"
#include "marey/source/open_source.h"

#include "rig_inputs.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlanHead = "task\tname\tdo\tinputs\tstates\toptions\toutput\tmemory_mb";
constexpr std::size_t kMostArrayTasks = 1000;  // Slurm takes 1001 of them where nobody has changed it

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

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
  std::vector<std::string> parts = split(field, '|');
  for (std::string& part : parts) part = out_of_field(part);
  return parts;
}

std::int64_t whole_of(const std::string& text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) throw Error("\"{}\" is no whole number", text);
  return value;
}

/// Without its hash; nothing where there is no such file.
std::optional<PlannedInput> state_of(const std::string& path) {
  struct stat status{};
  if (stat(path.c_str(), &status) != 0) return std::nullopt;
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  return PlannedInput{path, status.st_size, status.st_mtim.tv_sec * kNanoseconds + status.st_mtim.tv_nsec, {}};
}

std::string fnv(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return fmt::format("{:016x}", hash);
}

BatchTask task_of(const std::string& line) {
  const std::vector<std::string> fields = split(line, '\t');
  if (fields.size() != 8) throw Error("{} columns in place of 8", fields.size());
  BatchTask task;
  task.number = static_cast<int>(whole_of(fields[0]));
  task.name = out_of_field(fields[1]);
  task.job = fields[2];
  const std::vector<std::string> paths = parts_of(fields[3]), states = parts_of(fields[4]);
  if (paths.empty() || paths.size() != states.size()) throw Error("{}", "inputs and states do not belong together");
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::vector<std::string> state = split(states[i], ':');
    if (state.size() != 3) throw Error("\"{}\" is no SIZE:TIME:HASH", states[i]);
    task.inputs.push_back({paths[i], whole_of(state[0]), whole_of(state[1]), state[2]});
  }
  task.options = parts_of(fields[5]);
  task.output = out_of_field(fields[6]);
  task.memory_mb = static_cast<int>(whole_of(fields[7]));
  return task;
}

bool is_film(const fs::path& path) {
  static const std::set<std::string> endings{".mp4",  ".avi",  ".mov", ".mkv", ".m4v", ".mpg",
                                             ".mpeg", ".webm", ".ts",  ".mts", ".wmv", ".mxf"};
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return endings.contains(ending);
}

/// Whether the job is done with such a file.
bool is_input_of(const std::string& job, const fs::path& path) {
  if (job == "track") return is_film(path);
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
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.input < b.input; });
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
  std::ifstream file(request.from);
  std::string line;
  if (!file || !std::getline(file, line))
    throw Error("{}: cannot be read; give a folder, or a table with a column \"input\"", request.from);
  const char separator = line.find('\t') != std::string::npos ? '\t' : ',';
  const auto fields_of = [&](std::string text) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    return split(text, separator);
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

std::string usual_ending(const std::string& job) {
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

const std::vector<std::string>& batch_jobs() {
  static const std::vector<std::string> jobs{"track", "ground", "reconstruct", "measure"};
  return jobs;
}

std::vector<std::string> words_of_job(const std::string& job) {
  if (job == "ground") return {"track", "--ground"};
  return {job};
}

std::string BatchTask::hash() const {
  std::string text = std::string(MAREY_VERSION) + '\n' + job + '\n' + list_of(options, [](const auto& word) { return word; });
  for (const PlannedInput& input : inputs) text += '\n' + input.hash;
  return fnv(text);
}

std::string BatchPlan::results() const {
  return path + ".results";
}

std::string BatchPlan::record_of(const BatchTask& task) const {
  return (fs::path(results()) / "tasks" / fmt::format("{:06}.tsv", task.number)).string();
}

BatchPlan read_plan(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error("{}: cannot be read; `marey batch plan` makes a plan", path);
  BatchPlan plan{path, {}};
  std::string line;
  if (!std::getline(file, line) || line != kPlanHead) throw Error("{}:1: this is no plan; `marey batch plan` makes one", path);
  for (int number = 2; std::getline(file, line); ++number) {
    try {
      plan.tasks.push_back(task_of(line));
      if (plan.tasks.back().number != std::ssize(plan.tasks)) throw Error("{}", "tasks are numbered from 1, one a line");
    } catch (const Error& error) {
      throw Error("{}:{}: {}; make the plan anew with `marey batch plan`", path, number, error.what());
    }
  }
  return plan;
}

void write_plan(const BatchPlan& plan) {
  std::string text = std::string(kPlanHead) + '\n';
  const auto same = [](const std::string& word) { return word; };
  for (const BatchTask& task : plan.tasks) {
    text += fmt::format(
        "{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", task.number, in_field(task.name), task.job,
        list_of(task.inputs, [](const PlannedInput& input) { return input.path; }),
        list_of(task.inputs,
                [](const PlannedInput& input) { return fmt::format("{}:{}:{}", input.size, input.mtime_ns, input.hash); }),
        list_of(task.options, same), in_field(task.output), task.memory_mb);
  }
  WholeFile file(plan.path);
  file.write(text);
  file.finish();
}

std::optional<TaskRecord> read_record(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  TaskRecord record;
  for (std::string line; std::getline(file, line);) {
    const std::size_t tab = line.find('\t');
    if (tab == std::string::npos) throw Error("{}: is no record of a task; remove it, and the task is done again", path);
    const std::string key = line.substr(0, tab), value = out_of_field(line.substr(tab + 1));
    if (key == "hash") record.hash = value;
    if (key == "state") record.done = value == "done";
    if (key == "exit") record.exit_code = static_cast<int>(whole_of(value));
    if (key == "seconds") record.seconds = std::stod(value);
    if (key == "peak_mb") record.peak_mb = static_cast<int>(whole_of(value));
    if (key == "host") record.host = value;
    if (key == "said") record.sentence = value;
  }
  return record;
}

void write_record(const std::string& path, const TaskRecord& record) {
  WholeFile file(path);
  file.write(fmt::format("hash\t{}\nstate\t{}\nexit\t{}\nseconds\t{:.3f}\npeak_mb\t{}\nhost\t{}\nsaid\t{}\n", record.hash,
                         record.done ? "done" : "failed", record.exit_code, record.seconds, record.peak_mb, record.host,
                         in_field(record.sentence)));
  file.finish();
}

BatchPlan make_plan(const PlanRequest& request) {
  BatchPlan plan{request.plan, {}};
  std::map<std::string, PlannedInput> before;
  std::map<std::string, int> memory_before;  // by the input's hash and the job: to ask a film for its size takes a while
  std::error_code error;
  if (fs::is_regular_file(request.plan, error)) {
    for (const BatchTask& task : read_plan(request.plan).tasks) {
      for (const PlannedInput& input : task.inputs) before[input.path] = input;
      memory_before[task.job + task.inputs.front().hash] = task.memory_mb;
    }
  }
  const std::string ending = request.ending.empty() ? usual_ending(request.job) : request.ending;
  std::set<std::string> names;
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
    const std::vector<std::string> inputs = inputs_of(request.job, found.input);
    for (const std::string& path : inputs) task.inputs.push_back(planned(path, before));
    task.output = (fs::path(plan.results()) / (task.name + ending)).string();
    const auto [known, is_new] = memory_before.try_emplace(task.job + task.inputs.front().hash, 0);
    if (is_new) known->second = expected_memory_mb(request.job, inputs);
    task.memory_mb = known->second;
  }
  return plan;
}

std::string changed_input(const BatchTask& task) {
  for (const PlannedInput& input : task.inputs) {
    const auto now = state_of(input.path);
    if (!now) return fmt::format("{}: is not there any more; put it back, or make the plan anew", input.path);
    if (now->size == input.size && now->mtime_ns == input.mtime_ns) continue;
    if (now->size != input.size || format::input_of(input.path).hash != input.hash)
      return fmt::format("{}: is another file than when the plan was made; make the plan anew", input.path);
  }
  return {};
}

int expected_memory_mb(const std::string& job, const std::vector<std::string>& inputs) {
  // What the program takes before its first frame, and what a pixel of a camera's pictures takes: frames that are read ahead, the
  // background model, the samples that it learns from (docs/batch.md has the measurements).
  constexpr double kProgramMb = 56, kPixelBytes = 47;
  double mb = kProgramMb;
  for (const std::string& path : inputs) {
    try {
      if (!is_film(path)) continue;
      const cv::Size size = source::open_source(path)->info().size;
      mb += kPixelBytes * size.area() / 1e6;
    } catch (const Error&) {
      continue;  // the task will say what is wrong with it
    }
  }
  // Figures of a whole match are held while it is measured: a row of text of some 60 bytes becomes about as many.
  std::error_code error;
  if (job == "measure") mb += 3.0 * static_cast<double>(fs::file_size(inputs.front(), error)) / 1e6;
  return static_cast<int>(mb);
}

BatchLines lines_of(const BatchPlan& plan, const std::string& program, int threads) {
  int memory = 0;
  for (const BatchTask& task : plan.tasks) memory = std::max(memory, task.memory_mb);
  const std::size_t parts = std::min(plan.tasks.size(), kMostArrayTasks);
  const std::string run = fmt::format("{} batch run {} -q --task-threads {}", quoted(program), quoted(plan.path), threads);
  const std::string reduce =
      fmt::format("{} batch reduce {} -o {}", quoted(program), quoted(plan.path), quoted(plan.path + ".csv"));
  constexpr double kSpare = 1.3;  // what is expected is right within 30 %
  const std::string log = quoted(plan.results() + "/log/%a.txt");
  BatchLines lines;
  lines.loop = run;
  lines.parallel = fmt::format("parallel --joblog {} --resume-failed {} --part {{}}/{} ::: $(seq {})",
                               quoted(plan.results() + "/jobs.log"), run, plan.tasks.size(), plan.tasks.size());
  lines.slurm_array = fmt::format(
      "sbatch --parsable --job-name=marey --array=1-{} --requeue --cpus-per-task={} --mem={}M --output={} --wrap={}", parts,
      threads, static_cast<int>(kSpare * memory), log, quoted(fmt::format("exec {} --part $SLURM_ARRAY_TASK_ID/{}", run, parts)));
  lines.slurm_reduce = fmt::format("sbatch --parsable --job-name=marey-reduce --dependency=afterany:ARRAY --output={} --wrap={}",
                                   quoted(plan.results() + "/log/reduce.txt"), quoted("exec " + reduce));
  return lines;
}

}  // namespace marey::cli
