#include "marey/files/overwriting.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include <sys/stat.h>

namespace marey {
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

bool is_image(const fs::path& path) {
  constexpr std::array<std::string_view, 11> kEndings{".png",  ".jpg", ".jpeg", ".bmp", ".tif", ".tiff",
                                                      ".webp", ".pgm", ".ppm",  ".dat", ".exr"};
  return std::find(kEndings.begin(), kEndings.end(), path.extension().string()) != kEndings.end();
}

}  // namespace

bool is_one_file(const std::string& a, const std::string& b) {
  const auto there = status_of(a), also = status_of(b);
  if (there && also) return same(*there, *also);
  std::error_code error, other;
  const fs::path first = fs::weakly_canonical(fs::absolute(a), error), second = fs::weakly_canonical(fs::absolute(b), other);
  return !error && !other && first == second;
}

bool is_stream(const std::string& path) {
  if (path == "-") return true;
  const auto status = status_of(path);
  return status && !S_ISREG(status->st_mode) && !S_ISDIR(status->st_mode);
}

bool overwrites(const std::string& output, const std::string& input) {
  if (input.empty() || is_stream(input) || is_stream(output)) return false;
  const auto there = status_of(output);
  if (!there) return false;
  const auto read = status_of(input);
  if (read && same(*read, *there)) return true;
  if (is_folder(*there)) return false;
  const bool pattern = !read && input.find_first_of("%*?") != std::string::npos;
  if (!pattern && !(read && is_folder(*read))) return false;
  const auto folder = status_of(pattern ? folder_of(input) : input), location = status_of(folder_of(output));
  if (!folder || !location || !same(*folder, *location)) return false;
  return pattern ? fs::path(output).extension() == fs::path(input).extension() : is_image(output);
}

}  // namespace marey
