// Feeds mutated files to every reader, through the fuzzers' own checks, each batch in a process of its own: a crash, a hang and
// memory without end are found, kept, and gone on from.
//
//   mutations SEEDS [--count N] [--seed N] [--only NAME] [--seconds N] [--megabytes N] [--keep FOLDER]
//   mutations SEEDS --only NAME --file FILE      this file as it is, in this process, for a debugger
//
// SEEDS holds a folder NAME_fuzz of files for each reader, valid ones and those that were found once: they come first, as they are.
// File number i is the same for the same seed. Exits 1 where anything was found.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mutator.h"

using Reader = int (*)(const std::uint8_t*, std::size_t);
#define MAREY_READER(name) extern "C" int name##_fuzz(const std::uint8_t*, std::size_t);
#include "readers.inc"
#undef MAREY_READER

namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path seeds, keep, file;
  std::string only;
  std::uint64_t count = 2000, seed = 1;
  int seconds = 10, megabytes = 1024;
};

struct Kind {
  std::string name;
  Reader read;
  std::vector<std::string> files;
};

constexpr std::uint64_t kBatch = 400;

/// What a process that feeds a reader leaves for the one that watches it.
struct Slot {
  std::uint64_t file;
  bool done;
};

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<Kind> kinds_in(const Options& options) {
  const std::map<std::string, Reader> readers{
#define MAREY_READER(name) {#name, name##_fuzz},
#include "readers.inc"
#undef MAREY_READER
  };
  std::vector<Kind> kinds;
  for (const auto& [name, read] : readers) {
    if (!options.only.empty() && options.only != name) continue;
    Kind kind{name, read, {}};
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(options.seeds / (name + "_fuzz"))) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    for (const fs::path& path : paths) kind.files.push_back(contents(path));
    kinds.push_back(std::move(kind));
  }
  return kinds;
}

/// File number `index`, and who reads it: first the seeds themselves, then mutated ones. A kind has as many files as it has seeds,
/// so that each format has its share.
std::pair<const Kind*, std::string> file_of(const std::vector<Kind>& kinds, std::uint64_t seed, std::uint64_t index) {
  std::seed_seq sequence{seed, seed >> 32, index, index >> 32};
  std::mt19937_64 random(sequence);
  std::size_t all = 0;
  for (const Kind& kind : kinds) all += kind.files.size();
  std::size_t chosen = index % all;
  for (const Kind& kind : kinds) {
    if (chosen < kind.files.size()) {
      const std::string& file = kind.files[chosen];
      return {&kind, index < all ? file : marey::faults::mutated(file, kind.files, random)};
    }
    chosen -= kind.files.size();
  }
  std::abort();
}

/// Of the process that starts: addresses beyond what it has already, so that libraries do not count.
void limit_memory(int megabytes) {
  std::ifstream file("/proc/self/statm");
  rlim_t pages = 0;
  file >> pages;
  const rlim_t maximum = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (static_cast<rlim_t>(megabytes) << 20);
  const rlimit limit{maximum, maximum}, no_core{0, 0};
  setrlimit(RLIMIT_AS, &limit);
  setrlimit(RLIMIT_CORE, &no_core);
}

/// Never comes back.
[[noreturn]] void feed(const std::vector<Kind>& kinds, const Options& options, Slot* slot, std::uint64_t begin, std::uint64_t end) {
  limit_memory(options.megabytes);
  for (std::uint64_t index = begin; index < end; ++index) {
    slot->file = index;
    const auto [kind, file] = file_of(kinds, options.seed, index);
    // Of the processor's time, for other programs may be running; a wait that has no end is seen by the wall clock.
    const itimerval busy{{0, 0}, {options.seconds, 0}}, waiting{{0, 0}, {10 * options.seconds, 0}};
    setitimer(ITIMER_PROF, &busy, nullptr);
    setitimer(ITIMER_REAL, &waiting, nullptr);
    kind->read(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
  }
  slot->done = true;
  _exit(0);
}

std::string what_ended(int status) {
  if (WIFEXITED(status)) return "ended with exit code " + std::to_string(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  if (signal == SIGPROF || signal == SIGALRM) return "hung";
  return std::string("crashed: ") + strsignal(signal);
}

void keep(const Options& options, const std::vector<Kind>& kinds, std::uint64_t index, int status) {
  const auto [kind, file] = file_of(kinds, options.seed, index);
  std::printf("%s: file %llu (seed %llu, %zu bytes) %s\n", kind->name.c_str(), static_cast<unsigned long long>(index),
              static_cast<unsigned long long>(options.seed), file.size(), what_ended(status).c_str());
  std::fflush(stdout);
  if (options.keep.empty()) return;
  fs::create_directories(options.keep);
  std::ofstream(options.keep / (kind->name + "_" + std::to_string(options.seed) + "_" + std::to_string(index)), std::ios::binary)
      << file;
}

int campaign(const Options& options) {
  const std::vector<Kind> kinds = kinds_in(options);
  if (!options.file.empty()) {
    const std::string file = contents(options.file);
    return kinds.at(0).read(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
  }
  auto* slot = static_cast<Slot*>(mmap(nullptr, sizeof(Slot), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  int found = 0;
  long most_kilobytes = 0;
  for (std::uint64_t next = 0; next < options.count;) {
    *slot = {next, false};
    const pid_t process = fork();
    if (process == 0) feed(kinds, options, slot, next, std::min(next + kBatch, options.count));
    int status = 0;
    rusage used{};
    wait4(process, &status, 0, &used);
    most_kilobytes = std::max(most_kilobytes, used.ru_maxrss);
    if (!slot->done) {
      ++found;
      keep(options, kinds, slot->file, status);
    }
    next = slot->file + 1;
  }
  std::printf("%llu files: %d found; at most %ld MB in use\n", static_cast<unsigned long long>(options.count), found,
              most_kilobytes / 1024);
  return found == 0 ? 0 : 1;
}

std::optional<Options> parse(int argc, char** argv) {
  if (argc < 2 || argc % 2 != 0) return std::nullopt;
  Options options;
  options.seeds = argv[1];
  for (int i = 2; i < argc; i += 2) {
    const std::string_view name = argv[i];
    if (name == "--count") options.count = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--seed") options.seed = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--only") options.only = argv[i + 1];
    if (name == "--seconds") options.seconds = std::atoi(argv[i + 1]);
    if (name == "--megabytes") options.megabytes = std::atoi(argv[i + 1]);
    if (name == "--keep") options.keep = argv[i + 1];
    if (name == "--file") options.file = argv[i + 1];
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const std::optional<Options> options = parse(argc, argv);
  if (options) return campaign(*options);
  std::fprintf(stderr,
               "usage: mutations SEEDS [--count N] [--seed N] [--only NAME] [--seconds N] [--megabytes N] [--keep FOLDER]\n");
  return 2;
}
