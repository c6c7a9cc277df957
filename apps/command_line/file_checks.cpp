#include "file_checks.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include <sys/stat.h>

#include "command_line.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

std::optional<struct stat> status_of(const std::string& path) {
  struct stat status{};
  if (path.empty() || stat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

bool is_folder(const struct stat& status) {
  return S_ISDIR(status.st_mode);
}

bool same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

bool is_picture(const fs::path& path) {
  constexpr std::array<std::string_view, 11> kEndings{".png",  ".jpg", ".jpeg", ".bmp", ".tif", ".tiff",
                                                      ".webp", ".pgm", ".ppm",  ".dat", ".exr"};
  return std::find(kEndings.begin(), kEndings.end(), path.extension().string()) != kEndings.end();
}

/// Whether writing `output`, which is there, changes what is read from `input`: the same file, or one of its pictures.
bool changes(const std::string& output, const struct stat& there, const std::string& input) {
  const auto read = status_of(input);
  if (read && same(*read, there)) return true;
  if (is_folder(there)) return false;
  const bool pattern = !read && input.find_first_of("%*?") != std::string::npos;
  if (!pattern && !(read && is_folder(*read))) return false;
  const auto folder = status_of(pattern ? folder_of(input) : input), place = status_of(folder_of(output));
  if (!folder || !place || !same(*folder, *place)) return false;
  return pattern ? fs::path(output).extension() == fs::path(input).extension() : is_picture(output);
}

bool one_file(const std::string& a, const std::string& b) {
  const auto there = status_of(a), also = status_of(b);
  if (there && also) return same(*there, *also);
  std::error_code error, other;
  const fs::path first = fs::weakly_canonical(fs::absolute(a), error), second = fs::weakly_canonical(fs::absolute(b), other);
  return !error && !other && first == second;
}

}  // namespace

bool is_stream(const std::string& path) {
  if (path == "-") return true;
  const auto status = status_of(path);
  return status && !S_ISREG(status->st_mode) && !S_ISDIR(status->st_mode);
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw Error("{}: the folder cannot be made ({})", path, error.message());
}

void check_files(std::span<const NamedPath> inputs, std::span<const NamedPath> outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const NamedPath& output = outputs[i];
    if (output.path.empty() || is_stream(output.path)) continue;
    if (const auto there = status_of(output.path)) {
      for (const NamedPath& input : inputs) {
        if (input.path.empty() || is_stream(input.path) || !changes(output.path, *there, input.path)) continue;
        if (!output.may_replace.empty() && one_file(output.may_replace, input.path)) continue;
        throw WrongUsage("{} {}: is an input too ({}) and would be destroyed; name another file", output.option, output.path,
                         input.path);
      }
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (outputs[k].path.empty() || is_stream(outputs[k].path) || !one_file(output.path, outputs[k].path)) continue;
      throw WrongUsage("{} {}: is written by {} too; name another file", output.option, output.path, outputs[k].option);
    }
  }
}

}  // namespace marey::cli
