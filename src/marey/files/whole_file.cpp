#include "marey/files/whole_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

constexpr auto kOldestTemporary = std::chrono::hours(24);
constexpr std::string_view kEnding = ".part";

/// This host's name as a part of a file's name: letters, digits and points, at most 32 of them.
std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  std::string text(name.data());
  text.resize(std::min<std::size_t>(text.size(), 32));
  for (char& c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.';
    if (!plain) c = '_';
  }
  return text;
}

std::string temporary_name(const std::string& path) {
  std::random_device random;
  const std::uint64_t number = (std::uint64_t{random()} << 32) | random();
  return fmt::format("{}.{}-{}-{:016x}{}", path, host_name(), getpid(), number, kEnding);
}

/// Who writes the temporary file `name` of the file `of`; nothing if it is not one.
struct Writer {
  std::string_view host;
  pid_t process = 0;
};
std::optional<Writer> writer_of(std::string_view name, std::string_view of) {
  if (!name.starts_with(of) || !name.ends_with(kEnding) || name.size() < of.size() + 1 + kEnding.size()) return std::nullopt;
  std::string_view middle = name.substr(of.size(), name.size() - of.size() - kEnding.size());
  if (middle.front() != '.') return std::nullopt;
  middle.remove_prefix(1);
  const auto before_random = middle.rfind('-');
  if (before_random == std::string_view::npos || middle.size() - before_random != 17) return std::nullopt;
  if (middle.find_first_not_of("0123456789abcdef", before_random + 1) != std::string_view::npos) return std::nullopt;
  middle = middle.substr(0, before_random);
  const auto before_process = middle.rfind('-');
  if (before_process == std::string_view::npos) return std::nullopt;
  Writer writer{middle.substr(0, before_process), 0};
  const char* const end = middle.data() + middle.size();
  const auto [parsed, error] = std::from_chars(middle.data() + before_process + 1, end, writer.process);
  if (error != std::errc() || parsed != end || writer.process <= 0) return std::nullopt;
  return writer;
}

bool is_older_than_a_day(const fs::path& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  return !error && fs::file_time_type::clock::now() - written > kOldestTemporary;
}

/// Removes what runs that were killed left of `target`. What cannot be removed stays: it does no harm.
void remove_stale(const fs::path& target) {
  const std::string name = target.filename().string(), host = host_name();
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string other = entry->path().filename().string();
    const auto writer = writer_of(other, name);
    if (!writer) continue;
    const bool dead = writer->host == host && kill(writer->process, 0) != 0 && errno == ESRCH;
    std::error_code ignored;
    if (dead || is_older_than_a_day(entry->path())) fs::remove(entry->path(), ignored);
  }
}

bool is_special(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

[[noreturn]] void fail_to_write(const std::string& path, int error) {
  throw Error("{}: cannot be written ({})", path, std::generic_category().message(error));
}

}  // namespace

UnfinishedFile::UnfinishedFile(const std::string& path) : path_(path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw Error("{}: is a folder; name a file", path);
  if (is_special(path)) throw Error("{}: is not a file; name one", path);
  target_ = fs::is_regular_file(status) ? fs::canonical(path, error).string() : path;
  lock_.emplace(target_);
  remove_stale(target_);
  temporary_path_ = temporary_name(target_);
}

UnfinishedFile::~UnfinishedFile() {
  if (!lock_) return;
  std::error_code ignored;
  fs::remove(temporary_path_, ignored);
}

std::string UnfinishedFile::further_temporary_path() const {
  return temporary_name(target_);
}

void UnfinishedFile::finish() {
  std::error_code error;
  fs::rename(temporary_path_, target_, error);
  if (error) fail_to_write(path_, error.value());
  lock_.reset();
}

WholeFile::WholeFile(const std::string& path) : path_(path) {
  if (!is_special(path)) unfinished_.emplace(path);
  file_.reset(std::fopen(unfinished_ ? unfinished_->temporary_path().c_str() : path.c_str(), "wb"));
  if (file_ == nullptr) fail_to_write(path_, errno);
}

WholeFile::~WholeFile() = default;

void WholeFile::write(std::string_view text) {
  stop_point();
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail_to_write(path_, errno);
}

void WholeFile::finish() {
  if (std::fflush(file_.get()) != 0) fail_to_write(path_, errno);
  if (std::fclose(file_.release()) != 0) fail_to_write(path_, errno);
  if (unfinished_) unfinished_->finish();
}

}  // namespace marey
