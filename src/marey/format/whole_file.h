#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace marey::format {

/// A text file that appears whole or not at all: it is written beside its name (core/part_name.h) and gets its name in
/// `finish`. What is no file, such as a pipe or /dev/stdout, is written as it comes.
class WholeFile {
 public:
  /// Throws Error, one sentence that names `path`, where nothing can be written there.
  explicit WholeFile(const std::string& path);
  /// Without `finish`, nothing is left behind, and what bore the name before is untouched.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Throws Error where the place is full.
  void write(std::string_view text);
  /// Throws Error where the place is full.
  void finish();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail(int error) const;

  std::string path_;
  std::string target_;  // what it is renamed to: `path`, or what a link of that name leads to
  std::string part_;    // empty where the name is written directly
  std::unique_ptr<std::FILE, CloseFile> file_;
};

}  // namespace marey::format
