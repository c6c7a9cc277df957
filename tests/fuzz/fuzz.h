#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
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

/// A folder of files with these names, whose bytes are the parts of the input between zero bytes; one without any is not there.
/// Lives until the next call.
inline const std::string& folder_of_files(std::span<const char* const> names, std::string_view parts) {
  namespace fs = std::filesystem;
  static const std::string folder = (fs::temp_directory_path() / ("marey_fuzz_" + std::to_string(getpid()))).string();
  fs::remove_all(folder);
  for (const char* name : names) {
    const std::string_view part = parts.substr(0, parts.find('\0'));
    const fs::path path = fs::path(folder) / name;
    fs::create_directories(path.parent_path());
    if (!part.empty()) std::ofstream(path, std::ios::binary) << part;
    parts.remove_prefix(std::min(parts.size(), part.size() + 1));
  }
  return folder;
}

}  // namespace marey::fuzz
