#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "marey/core/time.h"

namespace marey::source::live {

/// The system calls behind V4L2, so that a test has a kernel of its own. What fails returns −errno.
class Kernel {
 public:
  virtual ~Kernel() = default;
  virtual int open(const std::string& path) = 0;
  virtual void close(int file) = 0;
  virtual int control(int file, unsigned long request, void* argument) = 0;
  /// Null where it fails.
  virtual void* map(int file, std::size_t length, std::int64_t offset) = 0;
  virtual void unmap(void* memory, std::size_t length) = 0;
  /// 1 where a frame can be taken, 0 where none came for this long.
  virtual int wait(int file, int milliseconds) = 0;
  /// By the clock that frames are stamped with (CLOCK_MONOTONIC).
  virtual Duration now() = 0;
  /// The devices that may be cameras: "/dev/video0", …
  virtual std::vector<std::string> devices() = 0;
};

std::shared_ptr<Kernel> system_kernel();

}  // namespace marey::source::live
