#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace marey::format {

/// A file's bytes as memory, without reading it: pages come when they are touched, and go when memory is short. What is not a file,
/// such as a pipe, is read to its end first.
class MappedFile {
 public:
  /// Throws Error if it cannot be read, and for a folder; Stopped where a pipe was waited for.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(text())); }
  std::string_view text() const { return data_ == nullptr ? read_ : std::string_view(static_cast<const char*>(data_), size_); }

 private:
  std::string read_;      // of what is not a file
  void* data_ = nullptr;  // of a file, unless it is empty
  std::size_t size_ = 0;
};

}  // namespace marey::format
