#include "batch_run.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/files/file_lock.h"

#include "commands.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> command_of(const BatchTask& task, std::optional<int> threads) {
  std::vector<std::string> words{"marey"};
  for (const std::string& word : words_of_job(task.job)) words.push_back(word);
  words.push_back(task.inputs.front().path);
  words.insert(words.end(), {"-o", task.output, "-q"});
  if (threads) words.insert(words.end(), {"--threads", std::to_string(*threads)});
  words.insert(words.end(), task.options.begin(), task.options.end());
  return words;
}

/// What the process said on standard error, and how it ended.
struct Ended {
  int status = 0;
  rusage used{};
  std::string stated;
};

/// What the process that was forked off does: this program once more, without the time that loading it takes.
[[noreturn]] void run_words(std::vector<std::string> words, int stated, const sigset_t& signals) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    // Until it catches them itself: the other's handlers would not end this process. What nohup set stays.
    if (std::signal(number, SIG_DFL) == SIG_IGN) std::signal(number, SIG_IGN);
  }
  pthread_sigmask(SIG_SETMASK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);  // it takes its unfinished files away also when its output is no longer read
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDIN_FILENO), dup2(nowhere, STDOUT_FILENO), dup2(stated, STDERR_FILENO);
  close(stated);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  _exit(run_program(static_cast<int>(words.size()), arguments.data()));
}

/// A process that does the words and says on `pipe` what goes wrong; it ends when this one does, however that ends.
pid_t start_process(const std::vector<std::string>& words, const std::array<int, 2>& pipe) {
  std::fflush(nullptr);  // else both would write what waits
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t process = fork();
  if (process == 0) {
    close(pipe[0]);
    run_words(words, pipe[1], before);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (process < 0) throw Error("no further process can be started: {}", std::strerror(errno));
  return process;
}

/// Its standard error comes back, the last of it.
Ended run_process(const std::vector<std::string>& words) {
  constexpr std::size_t kMostSaid = 4000;  // bytes
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error("no pipe: {}", std::strerror(errno));
  const pid_t process = start_process(words, ends);
  close(ends[1]);
  const std::stop_callback<std::function<void()>> passed_on(StopScope::current(), [process] { kill(process, SIGTERM); });
  Ended ended;
  std::array<char, 1024> bytes{};
  for (;;) {
    const ssize_t count = read(ends[0], bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    ended.stated.append(bytes.data(), static_cast<std::size_t>(count));
    if (ended.stated.size() > 2 * kMostSaid) ended.stated.erase(0, ended.stated.size() - kMostSaid);
  }
  close(ends[0]);
  while (wait4(process, &ended.status, 0, &ended.used) < 0 && errno == EINTR) continue;
  return ended;
}

/// The last line that says what is wrong, without the program's name.
std::string message_of(const Ended& ended) {
  if (WIFSIGNALED(ended.status)) {
    const int number = WTERMSIG(ended.status);
    return fmt::format("was ended by signal {} ({}){}", number, strsignal(number), number == SIGKILL ? "; was memory short?" : "");
  }
  std::string text = ended.stated;
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  if (const std::size_t line = text.rfind('\n'); line != std::string::npos) text.erase(0, line + 1);
  if (text.starts_with("marey: ")) text.erase(0, 7);
  return text;
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

bool is_done(const std::optional<TaskRecord>& record, const BatchTask& task) {
  std::error_code error;
  return record && record->done && record->hash == task.hash() && fs::exists(task.output, error);
}

TaskOutcome do_task(const BatchPlan& plan, const BatchTask& task, std::optional<int> threads) {
  const auto begin = std::chrono::steady_clock::now();
  const Ended ended = run_process(command_of(task, threads));
  if (StopScope::current().stop_requested())
    throw Stopped("stopped; the task that ran is not done, and is done again by the next run");
  rusage own{};
  getrusage(RUSAGE_SELF, &own);  // the one who counts a job's memory counts who waits too
  TaskRecord record;
  record.hash = task.hash();
  record.exit_code = WIFEXITED(ended.status) ? WEXITSTATUS(ended.status) : 128 + WTERMSIG(ended.status);
  record.done = record.exit_code == 0;
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  constexpr double kKibi = 1024, kMegabyte = 1e6;  // the kernel counts KiB, a plan MB
  record.peak_mb = static_cast<int>(kKibi * static_cast<double>(ended.used.ru_maxrss + own.ru_maxrss) / kMegabyte);
  record.host = host_name();
  record.message_text = message_of(ended);
  write_record(plan.record_of(task), record);
  return {record.done ? TaskOutcome::Kind::done : TaskOutcome::Kind::failed, record.done ? "" : record.message_text};
}

}  // namespace

TaskOutcome run_task(const BatchPlan& plan, const BatchTask& task, std::optional<int> threads) {
  const std::string record = plan.record_of(task);
  const std::string changed = changed_input(task);
  if (changed.empty() && is_done(read_record(record), task)) return {TaskOutcome::Kind::was_done, {}};
  for (const fs::path& path : {fs::path(record), fs::path(task.output)}) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) throw Error("{}: this folder cannot be made ({})", path.parent_path().string(), error.message());
  }
  const FileLock lock(record + ".run");
  if (!changed.empty()) {
    TaskRecord stated;
    stated.exit_code = 1;
    stated.message_text = changed;
    write_record(record, stated);
    return {TaskOutcome::Kind::failed, changed};
  }
  if (is_done(read_record(record), task)) return {TaskOutcome::Kind::was_done, {}};  // by another run, while this one waited
  return do_task(plan, task, threads);
}

}  // namespace marey::cli
