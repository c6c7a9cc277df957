#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace marey::format {

/// A file's bytes as memory, without reading it: pages come when they are touched, and go when memory is short.
class MappedFile {
 public:
  /// Throws Error where it cannot be read, and for what is no file.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(data_), size_}; }
  std::string_view text() const { return {static_cast<const char*>(data_), size_}; }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace marey::format
