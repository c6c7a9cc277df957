#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/edit/operation.h"
#include "marey/files/file_lock.h"
#include "marey/files/text_safety.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_cursor.h"
#include "marey/format/take/take_file.h"
#include "marey/format/take/take_schema.h"

namespace marey::format::take {
namespace {

constexpr std::string_view kLastCommitOfSchema1 = "6ee6ccf74";

namespace fs = std::filesystem;

constexpr std::string_view kMagic{"SQLite format 3\0", 16};
constexpr std::size_t kApplicationIdAt = 68;

/// The beginning of a SQLite file, up to the application's id.
std::optional<std::array<char, kApplicationIdAt + 4>> beginning_of(const std::string& path) {
  std::array<char, kApplicationIdAt + 4> bytes{};
  std::ifstream in(path, std::ios::binary);
  if (!in.read(bytes.data(), bytes.size())) return std::nullopt;
  return bytes;
}

void require_take(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw Error("{}: no such file", path);
  if (!fs::is_regular_file(status)) throw Error("{}: is not a file; name a take", path);
  if (!std::ifstream(path, std::ios::binary)) throw Error("{}: cannot be read; have you the right to?", path);
  if (!is_take(path)) throw Error("{}: is not a take of Marey's; see what it is with \"marey info\"", path);
}

/// One file again, where a killed recorder left a journal and its lock beside it. Does nothing if it still records, and nothing
/// where we may not write: the take can be read all the same.
void tidy_after_kill(const std::string& path) {
  if (!has_lock_file(path)) return;
  try {
    const FileLock lock(path);
    Database database(path, Database::Mode::create);
    // Reading rolls back what was half done; writing takes away the journal.
    const std::int64_t version = database.number("PRAGMA user_version");
    database.run("BEGIN IMMEDIATE");
    database.run(fmt::format("PRAGMA user_version = {}", version).c_str());
    database.commit();
  } catch (const Error&) {
    return;
  }
}

/// SQLite reads zeros where a file's last page ends too early.
void require_whole_pages(Database& database) {
  const ReadTransaction transaction(database);
  const std::int64_t pages = database.number("PRAGMA page_count"), bytes = database.number("PRAGMA page_size");
  std::error_code error;
  const auto size = fs::file_size(database.path(), error);
  if (!error && size < static_cast<std::uintmax_t>(pages) * static_cast<std::uintmax_t>(bytes))
    throw Error("{}: is damaged (it is cut off); restore it from a copy", database.path());
}

/// One instant that is far from all others: a follower of the take would walk through all between.
std::unique_ptr<TakeCursor> plausible(std::unique_ptr<TakeCursor> cursor, const std::string& path) {
  const RecordingSummary summary = cursor->summary();
  if (!summary.first_index || *summary.last_index - *summary.first_index < FrameNumbers::kMaxMissing) return cursor;
  FrameNumbers numbers;
  for (const Recording::TimeStep& time_step : cursor->time_steps()) numbers.add(time_step.index);
  numbers.check(path);
  return cursor;
}

std::unique_ptr<TakeCursor> open(const std::string& path, TakeReaderOptions options) {
  require_take(path);
  tidy_after_kill(path);
  auto database = std::make_unique<Database>(path, Database::Mode::read);
  require_whole_pages(*database);
  const std::int64_t version = database->number("PRAGMA user_version");
  if (version > kTakeSchemaVersion) {
    throw Error("{}: was written by a later version of Marey (schema {}, this one knows {}); bring Marey up to date", path, version,
                kTakeSchemaVersion);
  }
  if (version == 1)
    throw Error(
        "{}: is of schema 1, which no release wrote; commit {} is the last that reads it: marey convert there writes schema 2",
        path, kLastCommitOfSchema1);
  if (version == kTakeSchemaVersion) return plausible(open_schema_2(std::move(database), options), path);
  throw Error("{}: is damaged (schema version {})", path, version);
}

}  // namespace

TakeReader::TakeReader(const std::string& path, TakeReaderOptions options) : path_(path), cursor_(open(path, options)) {}
TakeReader::~TakeReader() = default;
TakeReader::TakeReader(TakeReader&&) noexcept = default;
TakeReader& TakeReader::operator=(TakeReader&&) noexcept = default;

const RecordingHeader& TakeReader::header() const {
  return cursor_->header();
}
RecordingSummary TakeReader::summary() const {
  return cursor_->summary();
}
std::vector<TrackName> TakeReader::tracks() const {
  std::vector<TrackName> tracks;
  for (RecordingSummary::TrackCount& count : cursor_->summary().tracks) tracks.push_back(std::move(count.name));
  return tracks;
}
std::vector<Edit> TakeReader::edits() const {
  return cursor_->edits();
}
std::optional<std::int64_t> TakeReader::head() const {
  return cursor_->head();
}

std::optional<std::int64_t> TakeReader::instant_count() const {
  const RecordingSummary summary = cursor_->summary();
  return summary.first_index ? *summary.last_index - *summary.first_index + 1 : 0;
}

std::vector<std::string> TakeReader::warnings() const {
  std::vector<std::string> warnings;
  if (!cursor_->summary().complete)
    warnings.push_back(path_ + ": its recording was cut off, or still continues; what there is was read");
  std::set<std::string> unknown;
  for (const Edit& edit : cursor_->edits()) {
    if (!edit::is_known(edit)) unknown.insert(plain_text(edit.operation.substr(0, 40)));
  }
  for (const std::string& operation : unknown) {
    warnings.push_back(
        fmt::format("{}: holds an edit \"{}\", which this version of Marey cannot do; it is kept, and omitted", path_, operation));
  }
  return warnings;
}

std::optional<Instant> TakeReader::next() {
  return cursor_->next();
}
void TakeReader::seek(std::int64_t index) {
  cursor_->seek(index);
}
std::vector<Recording::TimeStep> TakeReader::time_steps() const {
  return cursor_->time_steps();
}

TrackColumns TakeReader::read_track(TrackId id) const {
  TrackName name{.id = id, .label = {}, .team = {}};
  for (TrackName& each : tracks()) {
    if (each.id == id) name = std::move(each);
  }
  return cursor_->read_track(name);
}

bool is_take(const std::string& path) {
  const auto bytes = beginning_of(path);
  if (!bytes || std::string_view(bytes->data(), kMagic.size()) != kMagic) return false;
  std::int64_t id = 0;
  for (std::size_t i = 0; i < 4; ++i) id = id << 8 | static_cast<unsigned char>((*bytes)[kApplicationIdAt + i]);
  return id == kTakeApplicationId;
}

Recording read_recording(const std::string& path) {
  TakeReader reader(path);
  return read_all(reader);
}

}  // namespace marey::format::take
