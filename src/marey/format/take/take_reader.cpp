// Frames are fetched some at a time, each time by a query of its own: between them nothing is locked, so that a slow reader does
// not hold up the program that writes the take, and what it has written since is found by the next query.
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/file_lock.h"
#include "marey/core/frame_numbers.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_file.h"
#include "marey/format/take/take_records.h"

namespace marey::format::take {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFramesAtOnce = 64;
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
  if (!fs::is_regular_file(status)) throw Error("{}: is no file; name a take", path);
  if (!std::ifstream(path, std::ios::binary)) throw Error("{}: cannot be read; have you the right to?", path);
  if (!is_take(path)) throw Error("{}: is no take of Marey's; see what it is with \"marey info\"", path);
}

void require_tables(const Database& database) {
  Statement tables(database,
                   "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('take', 'track', 'frame', 'edit')");
  if (!tables.step() || tables.integer(0) != 4)
    throw Error("{}: is damaged (a table is missing); restore it from a copy", database.path());
}

/// One file again, where a killed recorder left a journal and its lock beside it. Does nothing where it still records, and nothing
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

int checked_id(std::int64_t id, const std::string& path) {
  if (id <= 0 || id > std::numeric_limits<int>::max()) throw Error("{}: is damaged (a track's id is {})", path, id);
  return static_cast<int>(id);
}

}  // namespace

class TakeReader::Cursor {
 public:
  Cursor(const std::string& path, TakeReaderOptions options)
      : database_((require_take(path), tidy_after_kill(path), path), Database::Mode::read),
        version_(check_version()),
        value_(database_, "SELECT value FROM take WHERE key = ?"),
        frames_(database_, options.observations
                               ? "SELECT frame, time_ns, points, observations FROM frame WHERE frame >= ? ORDER BY frame LIMIT ?"
                               : "SELECT frame, time_ns, points FROM frame WHERE frame >= ? ORDER BY frame LIMIT ?"),
        with_observations_(options.observations),
        limits_(options.limits) {
    header_.name = text("name");
    header_.made_by = text("made_by");
    header_.recorded_at = text("recorded_at");
    header_.rate_hz = real("rate_hz");
    const std::string rig = text("rig");
    if (!rig.empty()) header_.rig = rig::parse_rig(rig, path + " (its rig)");
    if (!(std::isfinite(header_.rate_hz) && header_.rate_hz > 0)) throw Error("{}: is damaged (its rate is missing)", path);
    check_numbers();
  }

  const TakeHeader& header() const { return header_; }

  TakeSummary summary() {
    TakeSummary summary;
    summary.frames = integer("frames");
    summary.points = integer("points");
    summary.observations = integer("observations");
    summary.complete = integer("complete") != 0;
    std::tie(summary.first_frame, summary.first_time) = end_of("ASC");
    std::tie(summary.last_frame, summary.last_time) = end_of("DESC");
    Statement tracks(database_, "SELECT id, label, first_frame, last_frame, measured, filled, predicted FROM track ORDER BY id");
    while (tracks.step()) {
      if (summary.tracks.size() == limits_.tracks)
        throw Error("{}: has more than {} tracks (the limit tracks)", database_.path(), limits_.tracks);
      const std::string_view label = tracks.text(1);
      if (label.size() > limits_.label_bytes) {
        throw Error("{}: the label of track {} has {} bytes; they have at most {} (the limit label_bytes)", database_.path(),
                    tracks.integer(0), label.size(), limits_.label_bytes);
      }
      const TakeTrack track{TrackId(checked_id(tracks.integer(0), database_.path())), std::string(label)};
      summary.tracks.push_back(
          {track, tracks.integer(2), tracks.integer(3), tracks.integer(4), tracks.integer(5), tracks.integer(6)});
    }
    return summary;
  }

  std::vector<TakeEdit> edits() {
    std::vector<TakeEdit> edits;
    Statement rows(database_, "SELECT time, what FROM edit ORDER BY id");
    while (rows.step()) edits.push_back({std::string(rows.text(0)), std::string(rows.text(1))});
    return edits;
  }

  std::optional<TakeFrame> next() {
    if (at_ == fetched_.size()) fetch();
    if (at_ == fetched_.size()) return std::nullopt;
    TakeFrame frame = std::move(fetched_[at_++]);
    next_index_ = frame.index + 1;
    return frame;
  }

  void seek(std::int64_t index) {
    fetched_.clear();
    at_ = 0;
    next_index_ = index;
  }

 private:
  int check_version() {
    const std::int64_t version = database_.number("PRAGMA user_version");
    if (version > kTakeSchemaVersion) {
      throw Error("{}: was written by a later version of Marey (schema {}, this one knows {}); bring Marey up to date",
                  database_.path(), version, kTakeSchemaVersion);
    }
    if (version != kTakeSchemaVersion) throw Error("{}: is damaged (schema version {})", database_.path(), version);
    require_tables(database_);
    return kTakeSchemaVersion;
  }

  /// One frame that is far from all others: who follows the take would walk through all between.
  void check_numbers() {
    const auto first = end_of("ASC").first, last = end_of("DESC").first;
    if (!first || *first < 0 || *last - *first <= FrameNumbers::kMostMissing) return;
    FrameNumbers numbers;
    Statement frames(database_, "SELECT frame FROM frame ORDER BY frame");
    while (frames.step()) numbers.add(frames.integer(0));
    numbers.check(database_.path());
  }

  void fetch() {
    fetched_.clear();
    at_ = 0;
    if (next_index_ == std::numeric_limits<std::int64_t>::max()) return;
    frames_.reset();
    frames_.bind(0, next_index_);
    frames_.bind(1, static_cast<std::int64_t>(kFramesAtOnce));
    while (frames_.step()) {
      TakeFrame frame;
      frame.index = frames_.integer(0);
      if (frame.index < 0 || frame.index < next_index_ || (!fetched_.empty() && frame.index <= fetched_.back().index)) {
        throw Error("{}: is damaged (frame {} stands in the wrong place); restore it from a copy", database_.path(), frame.index);
      }
      frame.time = Timestamp(Duration(frames_.integer(1)));
      const std::string where = fmt::format("{}: frame {}", database_.path(), frame.index);
      frame.points = points_of(frames_.blob(2), where);
      if (with_observations_) frame.observations = observations_of(frames_.blob(3), where);
      fetched_.push_back(std::move(frame));
    }
    frames_.reset();
  }

  bool find(std::string_view key) {
    value_.reset();
    value_.bind(0, key);
    return value_.step();
  }
  std::string text(std::string_view key) {
    std::string found(find(key) ? value_.text(0) : std::string_view());
    value_.reset();
    return found;
  }
  double real(std::string_view key) {
    const double found = find(key) ? value_.real(0) : 0;
    value_.reset();
    return found;
  }
  std::int64_t integer(std::string_view key) {
    const std::int64_t found = find(key) ? value_.integer(0) : 0;
    value_.reset();
    return found;
  }

  std::pair<std::optional<std::int64_t>, std::optional<Timestamp>> end_of(std::string_view order) {
    Statement row(database_, fmt::format("SELECT frame, time_ns FROM frame ORDER BY frame {} LIMIT 1", order));
    if (!row.step()) return {};
    return {row.integer(0), Timestamp(Duration(row.integer(1)))};
  }

  Database database_;
  int version_;
  Statement value_, frames_;
  bool with_observations_;
  Limits limits_;
  TakeHeader header_;
  std::vector<TakeFrame> fetched_;
  std::size_t at_ = 0;
  std::int64_t next_index_ = std::numeric_limits<std::int64_t>::min();
};

TakeReader::TakeReader(const std::string& path, TakeReaderOptions options) : cursor_(std::make_unique<Cursor>(path, options)) {}
TakeReader::~TakeReader() = default;
TakeReader::TakeReader(TakeReader&&) noexcept = default;
TakeReader& TakeReader::operator=(TakeReader&&) noexcept = default;

const TakeHeader& TakeReader::header() const {
  return cursor_->header();
}
TakeSummary TakeReader::summary() const {
  return cursor_->summary();
}
std::vector<TakeTrack> TakeReader::tracks() const {
  std::vector<TakeTrack> tracks;
  for (TakeSummary::TrackCount& count : cursor_->summary().tracks) tracks.push_back(std::move(count.track));
  return tracks;
}
std::vector<TakeEdit> TakeReader::edits() const {
  return cursor_->edits();
}
std::optional<TakeFrame> TakeReader::next() {
  return cursor_->next();
}
void TakeReader::seek(std::int64_t index) {
  cursor_->seek(index);
}

bool is_take(const std::string& path) {
  const auto bytes = beginning_of(path);
  if (!bytes || std::string_view(bytes->data(), kMagic.size()) != kMagic) return false;
  std::int64_t id = 0;
  for (std::size_t i = 0; i < 4; ++i) id = id << 8 | static_cast<unsigned char>((*bytes)[kApplicationIdAt + i]);
  return id == kTakeApplicationId;
}

Take read_take(const std::string& path) {
  TakeReader reader(path);
  Take take;
  take.header = reader.header();
  take.tracks = reader.tracks();
  take.edits = reader.edits();
  while (auto frame = reader.next()) take.frames.push_back(std::move(*frame));
  return take;
}

}  // namespace marey::format::take
