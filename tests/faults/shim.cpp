// Loaded before a program (LD_PRELOAD), it makes the outside world fail as set by the environment:
//   FAULT_AT=N      call number N that writes, syncs, renames or closes a file fails, and all that follow it where FAULT_STAYS is
//   set FAULT_SHORT=1   a write that fails writes half of its bytes first, and says so; the next one fails FAULT_CLOCK=1   the
//   clock of the day jumps by an hour to and fro FAULT_COUNT=F   at its end the program writes to file F how many such calls there
//   were
// Only regular files count: pipes and terminals have tests of their own.
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

long number_from(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::atol(text);
}

const long kAt = number_from("FAULT_AT");
const bool kStays = std::getenv("FAULT_STAYS") != nullptr, kShort = std::getenv("FAULT_SHORT") != nullptr,
           kClock = std::getenv("FAULT_CLOCK") != nullptr;
std::atomic<long> calls{0}, clock_calls{0};

struct AtExit {
  ~AtExit() {
    const char* path = std::getenv("FAULT_COUNT");
    if (path == nullptr) return;
    const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0644));
    char digits[24];
    int at = sizeof digits;
    for (long left = calls; at == sizeof digits || left > 0; left /= 10) digits[--at] = static_cast<char>('0' + left % 10);
    syscall(SYS_write, file, digits + at, sizeof digits - static_cast<unsigned>(at));
  }
} at_exit;

bool is_regular(int file) {
  struct stat status{};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

/// Whether this call is to fail; counts it.
bool fails() {
  const long call = ++calls;
  if (kAt == 0 || call < kAt || (call > kAt && !kStays)) return false;
  errno = kAt % 2 == 0 ? EIO : ENOSPC;
  return true;
}

template <typename Function>
Function next(Function, const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
  static const auto real = next(&write, "write");
  if (!is_regular(file) || !fails()) return real(file, bytes, size);
  return kShort && size > 1 && calls == kAt ? real(file, bytes, size / 2) : -1;
}

ssize_t writev(int file, const iovec* parts, int count) {
  static const auto real = next(&writev, "writev");
  return is_regular(file) && fails() ? -1 : real(file, parts, count);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  static const auto real = next(&pwrite, "pwrite");
  return is_regular(file) && fails() ? -1 : real(file, bytes, size, at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  static const auto real = next(&pwrite64, "pwrite64");
  return is_regular(file) && fails() ? -1 : real(file, bytes, size, at);
}

int fsync(int file) {
  static const auto real = next(&fsync, "fsync");
  return is_regular(file) && fails() ? -1 : real(file);
}

int fdatasync(int file) {
  static const auto real = next(&fdatasync, "fdatasync");
  return is_regular(file) && fails() ? -1 : real(file);
}

int ftruncate(int file, off_t size) {
  static const auto real = next(&ftruncate, "ftruncate");
  return is_regular(file) && fails() ? -1 : real(file, size);
}

int rename(const char* from, const char* to) {
  static const auto real = next(&rename, "rename");
  return fails() ? -1 : real(from, to);
}

int close(int file) {
  static const auto real = next(&close, "close");
  const bool written = is_regular(file) && (fcntl(file, F_GETFL) & O_ACCMODE) != O_RDONLY;
  if (!written || !fails()) return real(file);
  const int reason = errno;
  real(file);
  errno = reason;
  return -1;
}

size_t fwrite(const void* bytes, size_t size, size_t count, FILE* stream) {
  static const auto real = next(&fwrite, "fwrite");
  if (!is_regular(fileno(stream)) || !fails()) return real(bytes, size, count, stream);
  return kShort && count > 1 && calls == kAt ? real(bytes, size, count / 2, stream) : 0;
}

int fflush(FILE* stream) {
  static const auto real = next(&fflush, "fflush");
  return stream != nullptr && is_regular(fileno(stream)) && fails() ? EOF : real(stream);
}

int fclose(FILE* stream) {
  static const auto real = next(&fclose, "fclose");
  const int file = fileno(stream);
  const bool written = is_regular(file) && (fcntl(file, F_GETFL) & O_ACCMODE) != O_RDONLY;
  if (!written || !fails()) return real(stream);
  const int reason = errno;
  real(stream);
  errno = reason;
  return EOF;
}

int clock_gettime(clockid_t which, timespec* time) {
  static const auto real = next(&clock_gettime, "clock_gettime");
  const int result = real(which, time);
  if (kClock && which == CLOCK_REALTIME) time->tv_sec += (++clock_calls / 3) % 2 == 0 ? 3600 : -3600;
  return result;
}

int gettimeofday(timeval* __restrict time, void* __restrict) {
  timespec precise{};
  clock_gettime(CLOCK_REALTIME, &precise);
  time->tv_sec = precise.tv_sec;
  time->tv_usec = precise.tv_nsec / 1000;
  return 0;
}

time_t time(time_t* to) {
  timespec precise{};
  clock_gettime(CLOCK_REALTIME, &precise);
  if (to != nullptr) *to = precise.tv_sec;
  return precise.tv_sec;
}
}
