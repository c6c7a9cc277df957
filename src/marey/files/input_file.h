#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>

#include "marey/core/stop.h"

namespace marey {

/// Bytes from front to back: of a file, of what is not one (a pipe, a device), or with "-" of standard input. A pipe that no
/// process writes to is waited for, from its opening on, and left when `stop` says so.
class InputFile {
 public:
  /// Throws Error, one sentence that names `path`, where it cannot be opened.
  explicit InputFile(const std::string& path, std::stop_token stop = StopScope::current());
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Reads into the front of `room` and returns how much, 0 at the end. Throws Error if the reading fails, Stopped where it was
  /// asked to end.
  std::size_t read(std::span<char> room);

 private:
  void wait() const;

  std::string path_;
  std::stop_token stop_;
  int file_ = -1;
  bool own_ = true;     // to be closed
  bool waits_ = false;  // it is not a file
};

/// An InputFile as a stream of the standard library. What cannot be opened fails as std::ifstream does; what InputFile::read throws
/// comes through.
class InputStream : public std::istream {
 public:
  explicit InputStream(const std::string& path);
  ~InputStream() override;

 private:
  class Buffer;
  std::unique_ptr<Buffer> buffer_;
};

}  // namespace marey
