// A take grows at its end only: frames are rows of one table in the order of their indices, so each transaction adds pages and
// touches few. SQLite's rollback journal then holds next to nothing, the file is one and complete after each transaction, and a
// program killed between two leaves a journal that the next reader rolls back. (A write-ahead log would write everything twice, and
// leave two files more beside the take.) A transaction ends after half a second, or when it has grown to some megabytes.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>

#include "marey/core/error.h"
#include "marey/core/file_lock.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_file.h"
#include "marey/format/take/take_records.h"

namespace marey::format::take {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto kLongestTransaction = std::chrono::milliseconds(500);
constexpr std::size_t kLargestTransaction = std::size_t{16} << 20;

constexpr const char* kSchema = R"(
  PRAGMA page_size = 8192;
  PRAGMA journal_mode = DELETE;
  PRAGMA synchronous = NORMAL;
  PRAGMA cache_size = -24000;
  PRAGMA application_id = 0x4D524559;
  PRAGMA user_version = 1;
  CREATE TABLE take (key TEXT PRIMARY KEY, value) WITHOUT ROWID;
  CREATE TABLE track (id INTEGER PRIMARY KEY, label TEXT NOT NULL, first_frame INTEGER, last_frame INTEGER,
                      measured INTEGER NOT NULL, filled INTEGER NOT NULL, predicted INTEGER NOT NULL);
  CREATE TABLE frame (frame INTEGER PRIMARY KEY, time_ns INTEGER NOT NULL, points BLOB NOT NULL, observations BLOB NOT NULL);
  CREATE TABLE edit (id INTEGER PRIMARY KEY, time TEXT NOT NULL, what TEXT NOT NULL);
)";

/// Clears the way for a new take. What is no take is somebody's work, named by mistake.
std::string place_for(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return path;
  if (!fs::is_regular_file(status)) throw Error("{}: is no file; name one for the take", path);
  if (fs::file_size(path, error) > 0 && !is_take(path)) {
    throw Error("{}: exists and is no take; it is not overwritten, choose another name", path);
  }
  return fs::canonical(path).string();
}

void remove_old(const std::string& path) {
  std::error_code error;
  fs::remove(path + "-journal", error);
  fs::remove(path, error);
  if (error) throw Error("{}: cannot be replaced ({})", path, error.message());
}

void check(const TakeHeader& header, const std::string& path) {
  if (!(std::isfinite(header.rate_hz) && header.rate_hz > 0)) {
    throw Error("{}: a rate of {} frames a second; it must be positive", path, header.rate_hz);
  }
}

}  // namespace

class TakeWriter::Recorder {
 public:
  Recorder(const std::string& path, const TakeHeader& header)
      : path_(place_for(path)),
        lock_(path_),
        database_((check(header, path), remove_old(path_), path_), Database::Mode::create),
        schema_(prepare_schema()),
        set_key_(database_, "INSERT OR REPLACE INTO take VALUES (?, ?)"),
        add_frame_(database_, "INSERT INTO frame VALUES (?, ?, ?, ?)"),
        set_track_(database_, "INSERT OR REPLACE INTO track VALUES (?, ?, ?, ?, ?, ?, ?)"),
        add_edit_(database_, "INSERT INTO edit (time, what) VALUES (?, ?)") {
    begin();
    set("name", header.name.empty() ? fs::path(path).stem().string() : header.name);
    set("made_by", header.made_by);
    set("recorded_at", header.recorded_at);
    set("rate_hz", header.rate_hz);
    if (header.rig) set("rig", rig::rig_text(*header.rig));
    set("complete", std::int64_t{0});
    flush();
  }

  void set_label(TrackId id, std::string_view label) {
    if (number(id) <= 0) throw Error("{}: track {} cannot be; ids are positive", path_, number(id));
    begin();
    counts_of(id).track.label = label;
    commit_when_due();
  }

  void write(const TakeFrame& frame) {
    pack(frame);
    begin();
    count(frame);
    add_frame_.bind(0, frame.index);
    add_frame_.bind(1, std::int64_t{frame.time.time_since_epoch().count()});
    add_frame_.bind(2, std::span<const std::byte>(points_));
    add_frame_.bind(3, std::span<const std::byte>(observations_));
    run(add_frame_);
    written_ += points_.size() + observations_.size();
    commit_when_due();
  }

  void add_edit(const TakeEdit& edit) {
    begin();
    add_edit_.bind(0, std::string_view(edit.time));
    add_edit_.bind(1, std::string_view(edit.what));
    run(add_edit_);
    commit_when_due();
  }

  void flush() {
    if (!open_ || broken_) return;
    write_counts();
    const FailureMark mark(broken_);
    if (database_.commit()) open_ = false;  // else a reader holds on to the file, and the next write tries again
  }

  void finish() {
    begin();
    set("complete", std::int64_t{1});
    flush();
    if (open_) throw Error("{}: another program keeps reading it, so its end could not be written; close that program", path_);
  }

 private:
  int prepare_schema() {
    database_.run(kSchema);
    return kTakeSchemaVersion;
  }

  /// Refuses here what reading would refuse.
  void pack(const TakeFrame& frame) {
    if (frame.index < 0 || (summary_.last_frame && frame.index <= *summary_.last_frame)) {
      throw Error("{}: frame {} comes out of order; frames come in growing order from 0", path_, frame.index);
    }
    points_.clear();
    observations_.clear();
    append_records(points_, frame.points);
    append_records(observations_, frame.observations);
    points_of(points_, path_);
    observations_of(observations_, path_);
    ids_.clear();
    for (const TakePoint& point : frame.points) ids_.push_back(point.track);
    std::sort(ids_.begin(), ids_.end());
    const auto twin = std::adjacent_find(ids_.begin(), ids_.end());
    if (twin != ids_.end())
      throw Error("{}: track {} has two points in frame {}; it may have one", path_, number(*twin), frame.index);
  }

  /// Marks what a failure passes through.
  class FailureMark {
   public:
    explicit FailureMark(bool& mark) : mark_(mark), before_(std::uncaught_exceptions()) {}
    ~FailureMark() { mark_ = mark_ || std::uncaught_exceptions() > before_; }

   private:
    bool& mark_;
    int before_;
  };

  void run(Statement& statement) {
    const FailureMark mark(broken_);
    statement.run();
  }

  void begin() {
    if (broken_) throw Error("{}: cannot be written any more, since an earlier write failed", path_);
    if (open_) return;
    database_.run("BEGIN IMMEDIATE");
    open_ = true;
    began_ = Clock::now();
    written_ = 0;
  }

  void commit_when_due() {
    if (written_ >= kLargestTransaction || Clock::now() - began_ >= kLongestTransaction) flush();
  }

  template <typename Value>
  void set(std::string_view key, const Value& value) {
    set_key_.bind(0, key);
    if constexpr (std::is_arithmetic_v<Value>) {
      set_key_.bind(1, value);
    } else {
      set_key_.bind(1, std::string_view(value));
    }
    run(set_key_);
  }

  struct Counts {
    TakeTrack track;
    std::optional<std::int64_t> first_frame;
    std::int64_t last_frame = 0;
    std::array<std::int64_t, 3> by_provenance{};
    bool changed = true;
  };

  Counts& counts_of(TrackId id) {
    Counts& counts = tracks_[id];
    counts.track.id = id;
    counts.changed = true;
    return counts;
  }

  void count(const TakeFrame& frame) {
    for (const TakePoint& point : frame.points) {
      Counts& counts = counts_of(point.track);
      if (!counts.first_frame) counts.first_frame = frame.index;
      counts.last_frame = frame.index;
      ++counts.by_provenance[static_cast<std::size_t>(point.provenance)];
    }
    if (!summary_.first_frame) {
      summary_.first_frame = frame.index;
      summary_.first_time = frame.time;
    }
    summary_.last_frame = frame.index;
    summary_.last_time = frame.time;
    ++summary_.frames;
    summary_.points += static_cast<std::int64_t>(frame.points.size());
    summary_.observations += static_cast<std::int64_t>(frame.observations.size());
  }

  void write_counts() {
    set("frames", summary_.frames);
    set("points", summary_.points);
    set("observations", summary_.observations);
    for (auto& [id, counts] : tracks_) {
      if (!counts.changed) continue;
      set_track_.bind(0, std::int64_t{number(id)});
      set_track_.bind(1, std::string_view(counts.track.label));
      set_track_.bind(2, counts.first_frame.value_or(0));
      set_track_.bind(3, counts.last_frame);
      for (int i = 0; i < 3; ++i) set_track_.bind(4 + i, counts.by_provenance[static_cast<std::size_t>(i)]);
      run(set_track_);
      counts.changed = false;
    }
  }

  std::string path_;
  FileLock lock_;
  Database database_;
  int schema_;
  Statement set_key_, add_frame_, set_track_, add_edit_;
  bool open_ = false;    // within a transaction
  bool broken_ = false;  // a write failed, and its transaction with it
  Clock::time_point began_;
  std::size_t written_ = 0;
  TakeSummary summary_;
  std::map<TrackId, Counts> tracks_;
  std::vector<std::byte> points_, observations_;
  std::vector<TrackId> ids_;
};

TakeWriter::TakeWriter(const std::string& path, const TakeHeader& header) : recorder_(std::make_unique<Recorder>(path, header)) {}

TakeWriter::~TakeWriter() {
  if (!recorder_) return;
  try {
    recorder_->flush();
  } catch (const Error&) {
    // Said already by the write that failed; what came before it is in the file.
  }
}

void TakeWriter::set_label(TrackId track, std::string_view label) {
  recorder_->set_label(track, label);
}
void TakeWriter::write(const TakeFrame& frame) {
  recorder_->write(frame);
}
void TakeWriter::add_edit(const TakeEdit& edit) {
  recorder_->add_edit(edit);
}
void TakeWriter::flush() {
  recorder_->flush();
}
void TakeWriter::finish() {
  recorder_->finish();
  recorder_.reset();
}

void write_take(const std::string& path, const Take& take) {
  TakeWriter writer(path, take.header);
  for (const TakeTrack& track : take.tracks) writer.set_label(track.id, track.label);
  for (const TakeFrame& frame : take.frames) writer.write(frame);
  for (const TakeEdit& edit : take.edits) writer.add_edit(edit);
  writer.finish();
}

}  // namespace marey::format::take
