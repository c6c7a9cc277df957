#include "run_hooks.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <thread>

#include <fcntl.h>
#include <semaphore.h>
#include <sys/stat.h>
#include <unistd.h>

#include "marey/files/text_safety.h"

namespace marey::cli {
namespace {

sem_t signalled;

/// Output to a terminal that hung up would fail: it is discarded instead.
void leave_terminal() {
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat status{};
    if (fstat(stream, &status) != 0 || !S_ISCHR(status.st_mode)) continue;
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) dup2(nowhere, stream);
  }
}

/// Does nothing that a signal's handler must not; the thread that waits for it asks for the stop.
void on_signal(int number) {
  const int before = errno;
  if (number == SIGHUP) leave_terminal();
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  sem_post(&signalled);
  errno = before;
}

void catch_signal(int number) {
  struct sigaction now{}, before{};
  if (sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_IGN && number == SIGHUP) return;  // by nohup
  now.sa_handler = on_signal;  // without SA_RESTART: what waits comes back
  sigaction(number, &now, nullptr);
}

std::stop_source stopped_by_signals() {
  std::stop_source made;
  sem_init(&signalled, 0, 0);
  std::thread([made]() mutable {
    while (sem_wait(&signalled) != 0) {
    }
    made.request_stop();
  }).detach();
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) catch_signal(number);
  return made;
}

}  // namespace

std::stop_token stop_by_signals() {
  static std::stop_source source;
  static pid_t process = 0;  // that it is asked to end by signals
  if (process != getpid()) source = stopped_by_signals();
  process = getpid();
  return source.get_token();
}

Hooks hooks_over(ProgressBar& bar) {
  return {.progress = [&bar](const Progress& progress) { bar.show(progress.step, progress.done, progress.total); },
          .stop = stop_by_signals(),
          .options = given_options(),
          .news = [&bar](const std::string& message_text) { bar.announce(message_text); }};
}

void warn(const std::vector<std::string>& sentences) {
  for (const std::string& message_text : sentences) fmt::print(stderr, "marey: warning: {}\n", plain_text(message_text));
}

}  // namespace marey::cli
