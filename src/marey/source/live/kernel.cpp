#include "marey/source/live/kernel.h"

#include <cerrno>
#include <ctime>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace marey::source::live {
namespace {

constexpr int kMaxDevices = 64;

class SystemKernel final : public Kernel {
 public:
  int open(const std::string& path) override {
    const int file = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return file >= 0 ? file : -errno;
  }
  void close(int file) override { ::close(file); }
  int control(int file, unsigned long request, void* argument) override {
    for (;;) {
      if (::ioctl(file, request, argument) == 0) return 0;
      if (errno != EINTR) return -errno;
    }
  }
  void* map(int file, std::size_t length, std::int64_t offset) override {
    void* memory = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, file, offset);
    return memory == MAP_FAILED ? nullptr : memory;
  }
  void unmap(void* memory, std::size_t length) override { ::munmap(memory, length); }
  int wait(int file, int milliseconds) override {
    pollfd waited{.fd = file, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&waited, 1, milliseconds);
    if (ready < 0) return errno == EINTR ? 0 : -errno;
    if (ready > 0 && (waited.revents & POLLHUP) != 0) return -ENODEV;
    return ready;
  }
  Duration now() override {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }
  std::vector<std::string> devices() override {
    std::vector<std::string> all;
    std::error_code ignored;
    for (int i = 0; i < kMaxDevices; ++i) {
      const std::string path = fmt::format("/dev/video{}", i);
      if (std::filesystem::exists(path, ignored)) all.push_back(path);
    }
    return all;
  }
};

}  // namespace

std::shared_ptr<Kernel> system_kernel() {
  return std::make_shared<SystemKernel>();
}

}  // namespace marey::source::live
