#include "marey/source/image_sequence.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/natural_order.h"
#include "marey/source/decoder.h"

namespace marey::source {
namespace {

namespace fs = std::filesystem;

constexpr std::array kEndings{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".pgm", ".ppm", ".pnm", ".webp", ".jp2", ".tga"};

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Length of a `%d`, `%4d` or `%04d` that begins at `at`; 0 if there is not one.
std::size_t number_mark(const std::string& text, std::size_t at) {
  if (text[at] != '%') return 0;
  std::size_t end = at + 1;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end < text.size() && text[end] == 'd' ? end - at + 1 : 0;
}

/// Whether the whole of `name` is what `pattern` describes. Exponential in the number of marks at worst; names are short.
bool matches(const std::string& pattern, std::size_t p, const std::string& name, std::size_t n) {
  if (p == pattern.size()) return n == name.size();
  if (pattern[p] == '*') return matches(pattern, p + 1, name, n) || (n < name.size() && matches(pattern, p, name, n + 1));
  if (const std::size_t length = number_mark(pattern, p); length > 0) {
    for (; n < name.size() && is_digit(name[n]); ++n) {
      if (matches(pattern, p + length, name, n + 1)) return true;
    }
    return false;
  }
  return n < name.size() && (pattern[p] == '?' || pattern[p] == name[n]) && matches(pattern, p + 1, name, n + 1);
}

/// "shot_0012.PNG" as "shot_#.png".
std::string without_numbers(const std::string& file) {
  const fs::path path(file);
  std::string name;
  for (const char c : path.stem().string()) {
    if (!is_digit(c)) {
      name += c;
    } else if (name.empty() || name.back() != '#') {
      name += '#';
    }
  }
  for (const char c : path.extension().string()) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

class ImageFiles final : public Source {
 public:
  ImageFiles(const std::string& name, std::vector<std::string> files, std::optional<double> rate_hz)
      : files_(std::move(files)), rate_hz_(rate_hz.value_or(kDefaultRate)) {
    info_.name = name;
    info_.rate_hz = rate_hz_;
    info_.frame_count = static_cast<std::int64_t>(files_.size());
    if (files_.empty())
      throw Error("{}: no images found; give a video file, a folder of images or a pattern such as 'shot_%04d.png'", name);
    if (!rate_hz && files_.size() > 1) {
      warnings_.push_back(fmt::format("{}: images do not specify their rate: {} a second were assumed; say otherwise with --rate",
                                      name, kDefaultRate));
    }
    for (const std::string& file : files_) {
      const Image image = read(file);
      if (image.empty()) continue;
      info_.size = image.size();
      return;
    }
    throw Error("{}: none of its {} images can be read{}{}", name, files_.size(),
                first_error_.empty() ? "" : "; of the first: ", first_error_);
  }

  const SourceInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return warnings_; }

  std::optional<Frame> next() override {
    while (at_ < files_.size()) {
      const std::size_t number = at_++;
      Image image = read(files_[number]);
      if (image.empty() || image.size() != info_.size) {
        exclude(files_[number], image.empty() ? "cannot be read" : "has another size");
        continue;
      }
      return Frame{CameraId{}, next_index_++, timestamp_from_seconds(static_cast<double>(number) / rate_hz_), std::move(image)};
    }
    report_the_end();
    return std::nullopt;
  }

 private:
  Image read(const std::string& file) {
    try {
      Decoder decoder(file, 1);
      auto decoded = decoder.next();
      return decoded ? std::move(decoded->image) : Image();
    } catch (const Error& error) {
      if (first_error_.empty()) first_error_ = error.what();
      return {};
    }
  }

  void exclude(const std::string& file, const char* why) {
    if (++excluded_ == 1) first_excluded_ = fmt::format("{} {}", fs::path(file).filename().string(), why);
  }

  void report_the_end() {
    if (std::exchange(ended_, true) || excluded_ == 0) return;
    warnings_.push_back(
        fmt::format("{}: {} of {} images omitted; the first: {}", info_.name, excluded_, files_.size(), first_excluded_));
  }

  std::vector<std::string> files_;
  double rate_hz_;
  SourceInfo info_;
  std::size_t at_ = 0;
  std::int64_t next_index_ = 0;
  std::int64_t excluded_ = 0;
  std::string first_excluded_, first_error_;
  std::vector<std::string> warnings_;
  bool ended_ = false;
};

}  // namespace

bool is_image_name(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

bool is_image_pattern(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  for (std::size_t at = 0; at < name.size(); ++at) {
    if (name[at] == '*' || name[at] == '?' || number_mark(name, at) > 0) return true;
  }
  return false;
}

std::vector<std::string> find_images(const std::string& path) {
  std::error_code error;
  const bool folder = fs::is_directory(path, error);
  const fs::path where = folder ? fs::path(path) : fs::path(path).parent_path();
  const std::string required = folder ? "*" : fs::path(path).filename().string();
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(where.empty() ? fs::path(".") : where, error)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file(error) || (folder && (!is_image_name(name) || name.starts_with('.')))) continue;
    if (matches(required, 0, name, 0)) found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end(), NaturalOrder());
  return found;
}

void require_sequence(const std::string& folder, const std::vector<std::string>& files) {
  std::map<std::string, std::string> kinds;  // the name without its numbers → the first such image
  for (const std::string& file : files) kinds.try_emplace(without_numbers(file), fs::path(file).filename().string());
  if (kinds.size() < 2) return;
  const auto second = std::next(kinds.begin());
  throw Error(
      "{}: its {} images are not sequence, which has one name with a number that counts: there are {} and {}; name those to be "
      "read, as '{}' or '{}'",
      folder, files.size(), kinds.begin()->second, second->second, (fs::path(folder) / "shot_%04d.png").string(),
      (fs::path(folder) / "*.png").string());
}

std::unique_ptr<Source> open_images(const std::string& name, std::vector<std::string> files, std::optional<double> rate_hz) {
  return std::make_unique<ImageFiles>(name, std::move(files), rate_hz);
}

}  // namespace marey::source
