#pragma once

#include <string>
#include <string_view>

namespace marey {

/// A file that appears whole or not at all: it is written under a temporary name in the same folder, and `commit` gives it its
/// own. Without `commit` (an error, an exception on the way) the temporary is removed and an older file of that name stays.
///
/// `-` is standard output, and a path that is a device or a pipe is written as it is: these cannot be renamed.
class WholeFile {
 public:
  /// Throws Error where the place cannot be written: at the start of a long job, not at its end.
  explicit WholeFile(std::string path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Adds to the file's end. Throws Error where the disk is full.
  void write(std::string_view text);

  /// Hands on what is buffered. Only needed where somebody reads along: a pipe, a terminal.
  void flush();

  /// For a library that opens its file itself, such as a video encoder: where to write, with the same extension as the path
  /// given. Do not mix with `write`; finish writing before `commit`.
  const std::string& part_path() const { return part_path_; }

  /// The file is complete: gives it its name. Throws Error where that fails; call once, last.
  void commit();

 private:
  void open_part();
  void close_descriptor();
  [[noreturn]] void fail(int code) const;

  std::string path_;       ///< as the user gave it, for messages
  std::string target_;     ///< what is renamed to: symbolic links are followed
  std::string part_path_;  ///< what is written; the same as `target_` where nothing is renamed
  std::string buffer_;
  int descriptor_ = -1;
  bool owns_descriptor_ = true;
  bool renames_ = true;
  bool committed_ = false;
};

}  // namespace marey
