#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <sys/mman.h>
#include <unistd.h>

namespace marey::fuzz {

inline void check(bool holds) {
  if (!holds) std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A message is one line that begins with the file's name and is fit for a terminal.
inline void check_message(std::string_view message, std::string_view name) {
  check(message.starts_with(name));
  for (const char c : message) check(static_cast<unsigned char>(c) >= ' ' && c != '\x7f');
}

/// The input as a file in memory, for readers that read files only. Lives until the next call.
inline const std::string& memory_file(std::string_view text) {
  static const int file = memfd_create("input", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  check(ftruncate(file, 0) == 0 && pwrite(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()));
  return path;
}

}  // namespace marey::fuzz
