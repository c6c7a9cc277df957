#pragma once

#include <span>
#include <string>
#include <vector>

namespace marey::cli {

/// A file that a run reads or writes, and the option that names it.
struct NamedPath {
  std::string option;
  std::string path;
  std::string may_replace;  ///< of an output: the input that it may be; empty if there is no such input
};

/// Throws WrongUsage where an output is an input, by device and inode, or two outputs are one file. An input that is a folder or
/// a pattern of images stands for the images in it. What is not a file, such as "-", a pipe or /dev/null, is skipped.
void check_files(std::span<const NamedPath> inputs, std::span<const NamedPath> outputs);

/// Makes the folder, and those above it, where they are missing. Throws Error.
void make_folder(const std::string& path);

}  // namespace marey::cli
