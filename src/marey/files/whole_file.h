#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "marey/files/file_lock.h"

namespace marey {

/// A file that appears atomically: the one who makes it writes to `temporary_path`, beside the name, and `finish` gives it the
/// name. While it lives the name is locked (files/file_lock.h): a second run that wants to write it is refused. Temporary files of
/// that name which killed runs left behind go away: those of this host whose process is gone, and any that are older than a day.
class UnfinishedFile {
 public:
  /// Throws Error, one sentence that names `path`, where it is a folder or a device, where another run writes it, and where nothing
  /// can be written. Where the name is a link, the file behind it is what is replaced.
  explicit UnfinishedFile(const std::string& path);
  /// Without `finish`, nothing is left behind, and a former file of the name is untouched.
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// PATH.HOST-PID-RANDOM.part: no other writer's, of this host or another that shares the folder. It need not exist yet.
  const std::string& temporary_path() const { return temporary_path_; }
  /// Another such name for a writer that needs two files. The caller removes or renames it; one that a killed run leaves goes away
  /// as temporary files do.
  std::string further_temporary_path() const;
  /// What `finish` renames the temporary file to: the name, or the file that a link of that name leads to.
  const std::string& target_path() const { return target_; }

  /// Call it when the temporary file is closed. Throws Error if the file cannot get its name.
  void finish();

 private:
  std::string path_;
  std::string target_;  // what it is renamed to: `path`, or what a link of that name leads to
  std::string temporary_path_;
  std::optional<FileLock> lock_;
};

/// A text file that appears atomically. What is not a file, such as a pipe or /dev/stdout, is written as it comes.
class WholeFile {
 public:
  /// Throws Error as UnfinishedFile does.
  explicit WholeFile(const std::string& path);
  /// Without `finish`, nothing is left behind, and a former file of the name is untouched.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Throws Error if the place is full, Stopped where this thread was asked to end.
  void write(std::string_view text);
  /// Throws Error if the place is full.
  void finish();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  std::optional<UnfinishedFile> unfinished_;  // none where the name is written directly
  std::unique_ptr<std::FILE, CloseFile> file_;
};

}  // namespace marey
