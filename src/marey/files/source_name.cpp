#include "marey/files/source_name.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace marey {
namespace {

constexpr std::string_view kPlayed = "play:";
constexpr std::array<std::string_view, 10> kSchemes{"v4l2",  "gige", "rtsp",  "rtsps", "http",
                                                    "https", "play", "phone", "sim",   "node"};

}  // namespace

std::string_view scheme_of(std::string_view source) {
  const auto colon = source.find(':');
  if (colon == std::string_view::npos) return {};
  const std::string_view scheme = source.substr(0, colon);
  return std::find(kSchemes.begin(), kSchemes.end(), scheme) != kSchemes.end() ? scheme : std::string_view{};
}

std::string shown_source(std::string_view source) {
  const auto host = source.find("://");
  if (host == std::string_view::npos) return std::string(source);
  const auto end = std::min(source.find_first_of("/?#", host + 3), source.size());
  const auto user = source.substr(0, end).rfind('@');
  if (user == std::string_view::npos || user < host) return std::string(source);
  return std::string(source.substr(0, host + 3)) + std::string(source.substr(user + 1));
}

std::string source_in_folder(const std::string& folder, const std::string& source) {
  if (source.starts_with(kPlayed)) return std::string(kPlayed) + source_in_folder(folder, source.substr(kPlayed.size()));
  if (folder.empty() || source.empty() || !scheme_of(source).empty() || source.find("://") != std::string::npos) return source;
  return (std::filesystem::path(folder) / source).lexically_normal().string();
}

std::string path_of_source(std::string_view source) {
  if (source.starts_with(kPlayed)) return std::string(source.substr(kPlayed.size(), source.find('?') - kPlayed.size()));
  return scheme_of(source).empty() ? std::string(source) : std::string();
}

}  // namespace marey
