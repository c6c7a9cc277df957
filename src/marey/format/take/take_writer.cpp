// A take grows at its end only: new rows are gathered in columns for half a second, then written as one chunk in one
// transaction, which adds pages and touches few. SQLite's rollback journal then holds next to nothing, the file is one and complete
// after each transaction, and a program killed between two leaves a journal that the next reader rolls back. (A write-ahead log
// would write everything twice, and leave two files more beside the take.) Short chunks are replaced by one of about a minute when
// there are as many, and at the end, so that a track's path lies in few places; what they hold is kept in memory until then. What
// comes faster than real time comes in long chunks by itself.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/files/file_lock.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/take/body_definition.h"
#include "marey/format/take/chunk_joiner.h"
#include "marey/format/take/chunk_writer.h"
#include "marey/format/take/frame_names.h"
#include "marey/format/take/keypoints_blob.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_chunk.h"
#include "marey/format/take/take_file.h"
#include "marey/format/take/take_place.h"
#include "marey/format/take/take_schema.h"

namespace marey::format::take {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kMaxTransaction = std::chrono::milliseconds(500);
constexpr std::size_t kLargestTransaction = std::size_t{16} << 20;

void require_valid(const RecordingHeader& header, const std::string& path) {
  if (!(std::isfinite(header.rate_hz) && header.rate_hz > 0))
    throw Error("{}: a rate of {} frames a second; it must be positive", path, header.rate_hz);
  for (const Body& body : header.bodies) {
    if (number(body.id) <= 0) throw Error("{}: body {} cannot be; ids are positive", path, number(body.id));
  }
}

}  // namespace

class TakeWriter::Recorder {
 public:
  Recorder(const std::string& path, const RecordingHeader& header)
      : path_(position_for_take(path)),
        database_((remove_old_take(path_), path_), Database::Mode::create),
        schema_(prepare_schema()),
        dimensions_(header.frame.dimensions()),
        metric_ground_(header.frame.metric() && dimensions_ == 2),
        set_key_(database_, "INSERT OR REPLACE INTO take VALUES (?, ?)"),
        set_track_(database_, "INSERT OR REPLACE INTO track VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
        add_edit_(database_, "INSERT INTO edit VALUES (?, ?, ?, ?)"),
        chunks_(database_) {
    open_ = true;
    began_ = Clock::now();
    set("name", header.name.empty() ? std::filesystem::path(path).stem().string() : header.name);
    set("recorded_at", header.recorded_at);
    set("rate_hz", header.rate_hz);
    set("frame", name_of(header.frame.kind));
    if (header.frame.camera) set("camera", std::int64_t{number(*header.frame.camera)});
    set_time_base(header.time_base);
    set("smoothed", std::int64_t{header.smoothed});
    set("track_kind", to_string(header.track_kind));
    const bool cameras = header.rig && !header.rig->cameras.empty();  // a rig's text has one at least
    if (header.rig) cameras ? set("rig", rig::rig_text(*header.rig)) : set("y_down", std::int64_t{y_grows_down(header)});
    if (header.keypoints) set("keypoints", keypoint_set_text(*header.keypoints));
    set("complete", std::int64_t{0});
    set_made_by(header.made_by);
    set_bodies(header.bodies);
    flush();
  }

  void set_time_base(const TimeBase& base) {
    if (base.kind == TimeBase::Kind::rig) set("clock", "rig");
    if (base.kind == TimeBase::Kind::camera) set("clock", std::int64_t{number(base.camera)});
  }

  void set_name(const TrackName& name) {
    if (number(name.id) <= 0) throw Error("{}: track {} cannot be; ids are positive", path_, number(name.id));
    Counts& counts = tracks_[name.id];
    const TrackKind kind = name.kind == TrackKind::unspecified ? counts.count.name.kind : name.kind;
    counts.count.name = name;
    counts.count.name.kind = kind;
    if (metric_ground_ && kind == TrackKind::ball) ball_ = name.id;
    counts.changed = true;
    gathered();
  }

  void write(const Instant& instant) {
    check(instant);
    for (const TrackName& name : instant.named) set_name(name);
    if (!chunk_.empty() && !fits(instant)) cut();
    chunk_.add(instant, dimensions_, ball_);
    last_index_ = instant.index;
    if (!first_index_) first_index_ = instant.index;
    gathered();
    if (chunk_.bytes >= kLargestChunk) cut();
    if (chunk_.bytes + written_ >= kLargestTransaction || Clock::now() - began_ >= kMaxTransaction) flush();
  }

  void add_edit(const Edit& edit) {
    begin();
    add_edit_.bind(0, edit.id);
    edit.parent ? add_edit_.bind(1, *edit.parent) : add_edit_.bind_null(1);
    add_edit_.bind(2, std::string_view(edit.operation));
    add_edit_.bind(3, std::string_view(edit.payload));
    run(add_edit_);
  }

  void set_head(std::optional<std::int64_t> head) {
    begin();
    set("head", head.value_or(0));
  }

  void flush() {
    if (broken_ || (!open_ && !waiting_)) return;
    cut();
    begin();
    write_counts();
    commit();
    if (joiner_.ready()) join_chunks();
  }

  void finish() {
    cut();
    begin();
    write_counts();
    joiner_.seal();
    if (joiner_.ready()) {
      commit();
      join_chunks();
    }
    begin();
    if (joined_) database_.run("PRAGMA incremental_vacuum");
    set("complete", std::int64_t{1});
    commit();
    if (open_) throw Error("{}: another program keeps reading it, so its end could not be written; close that program", path_);
  }

 private:
  struct Counts {
    RecordingSummary::TrackCount count;
    bool changed = true;
  };

  int prepare_schema() {
    database_.run(kTakePragmas);
    database_.run("BEGIN IMMEDIATE");  // what the constructor writes goes with it
    database_.run(kTakeSchema);
    return kTakeSchemaVersion;
  }

  void set_made_by(const MadeBy& made_by) {
    set("program", made_by.program);
    Statement add_option(database_, "INSERT INTO option VALUES (?, ?)");
    for (const auto& [name, value] : made_by.options) {
      add_option.bind(0, std::string_view(name));
      add_option.bind(1, std::string_view(value));
      run(add_option);
    }
    Statement add_input(database_, "INSERT INTO input (name, hash) VALUES (?, ?)");
    for (const MadeBy::Input& input : made_by.inputs) {
      add_input.bind(0, std::string_view(input.name));
      add_input.bind(1, std::string_view(input.hash));
      run(add_input);
    }
  }

  void set_bodies(const std::vector<Body>& bodies) {
    Statement add_body(database_, "INSERT INTO body VALUES (?, ?, ?)");
    for (const Body& body : bodies) {
      const std::string definition = body_definition(body);
      add_body.bind(0, std::int64_t{number(body.id)});
      add_body.bind(1, std::string_view(body.label));
      add_body.bind(2, std::string_view(definition));
      run(add_body);
    }
  }

  /// Refuses here what reading would refuse.
  void check(const Instant& instant) {
    if (broken_) throw Error("{}: cannot be written any more, since an earlier write failed", path_);
    if (instant.index < 0 || (last_index_ && instant.index <= *last_index_)) {
      throw Error("{}: frame {} comes out of order; frames come in growing order from 0", path_, instant.index);
    }
    ids_.clear();
    for (const Sample& sample : instant.samples) {
      if (const auto problem = problem_of(sample)) throw Error("{}: frame {}: {}", path_, instant.index, *problem);
      ids_.push_back(sample.track);
    }
    for (const ImageObservation& point : instant.detected) {
      if (!is_sound(point)) throw Error("{}: frame {}: {}", path_, instant.index, problem_of(point).value());
    }
    for (const BodyPose& pose : instant.bodies) {
      if (const auto problem = problem_of(pose)) throw Error("{}: frame {}: {}", path_, instant.index, *problem);
    }
    std::sort(ids_.begin(), ids_.end());
    const auto twin = std::adjacent_find(ids_.begin(), ids_.end());
    if (twin != ids_.end())
      throw Error("{}: track {} has two samples in frame {}; it may have one", path_, number(*twin), instant.index);
  }

  bool fits(const Instant& instant) const {
    const Recording::TimeStep& first = chunk_.time_steps.front();
    return instant.time - first.time < kMaxChunk && instant.index - first.index < std::numeric_limits<std::uint32_t>::max();
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

  /// Something waits in memory; the file is to have it soon.
  void gathered() {
    if (waiting_ || open_) return;
    waiting_ = true;
    began_ = Clock::now();
  }

  void begin() {
    if (broken_) throw Error("{}: cannot be written any more, since an earlier write failed", path_);
    if (open_) return;
    database_.run("BEGIN IMMEDIATE");
    open_ = true;
    if (!waiting_) began_ = Clock::now();
    waiting_ = false;
    written_ = 0;
  }

  void commit() {
    const FailureMark mark(broken_);
    if (!database_.commit()) return;  // a reader holds on to the file, and the next write tries again
    open_ = false;
    written_ = 0;
  }

  /// What is gathered becomes a chunk of the file.
  void cut() {
    if (chunk_.empty()) return;
    begin();
    count();
    if (next_id_ == kMaxChunks) throw Error("{}: is too long to continue; begin another take", path_);
    const FailureMark mark(broken_);
    chunks_.write(next_id_, chunk_);
    joiner_.add(next_id_++, chunk_);
    written_ += chunk_.bytes;
    chunk_.clear();
  }

  void count() {
    instants_ += static_cast<std::int64_t>(chunk_.time_steps.size());
    for (const auto& [id, columns] : chunk_.tracks) {
      if (columns.empty()) continue;
      Counts& counts = tracks_[id];
      counts.count.name.id = id;
      counts.changed = true;
      for (std::size_t row = 0; row < columns.size(); ++row)
        counts.count.add(chunk_.time_steps[static_cast<std::size_t>(columns.at()[row])].index, columns.provenance()[row]);
      samples_ += static_cast<std::int64_t>(columns.size());
    }
    for (const auto& [camera, columns] : chunk_.detected) detected_ += static_cast<std::int64_t>(columns.size());
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

  void write_counts() {
    set("instants", instants_);
    set("samples", samples_);
    set("seen", detected_);
    for (auto& [id, counts] : tracks_) {
      if (!counts.changed) continue;
      const RecordingSummary::TrackCount& count = counts.count;
      set_track_.bind(0, std::int64_t{number(id)});
      set_track_.bind(1, std::string_view(count.name.label));
      set_track_.bind(2, std::string_view(count.name.team));
      set_track_.bind_null(3);
      set_track_.bind_null(4);
      if (count.first_index) set_track_.bind(3, *count.first_index);
      if (count.last_index) set_track_.bind(4, *count.last_index);
      for (int i = 0; i < 4; ++i) set_track_.bind(5 + i, count.by_provenance[static_cast<std::size_t>(i)]);
      set_track_.bind(9, to_string(count.name.kind));
      run(set_track_);
      counts.changed = false;
    }
  }

  /// Each group in a transaction of its own. A take is whole without this: where it fails (a full disk), the short chunks stay.
  void join_chunks() {
    try {
      while (!open_ && joiner_.ready()) {
        begin();
        joiner_.join(chunks_, next_id_++);
        joined_ = true;
        if (database_.commit()) open_ = false;
      }
    } catch (const Error&) {
      database_.roll_back();
      open_ = false;
      joiner_.forget();
    }
  }

  std::string path_;
  Database database_;
  int schema_;
  int dimensions_;
  bool metric_ground_;
  std::optional<TrackId> ball_;  // whose positions have heights where the others' have none
  Statement set_key_, set_track_, add_edit_;
  ChunkWriter chunks_;
  bool open_ = false;     // within a transaction
  bool waiting_ = false;  // something in memory, and no transaction yet
  bool broken_ = false;   // a write failed, and its transaction with it
  Clock::time_point began_;
  std::size_t written_ = 0;  // within the transaction
  Chunk chunk_;
  ChunkJoiner joiner_;
  bool joined_ = false;
  std::int64_t next_id_ = 1;
  std::int64_t instants_ = 0, samples_ = 0, detected_ = 0;
  std::optional<std::int64_t> first_index_, last_index_;
  std::map<TrackId, Counts> tracks_;
  std::vector<TrackId> ids_;
};

TakeWriter::TakeWriter(std::string path) : path_(std::move(path)) {}

TakeWriter::~TakeWriter() {
  if (!recorder_) return;
  try {
    recorder_->flush();
  } catch (const Error&) {
    // The write that failed has thrown it already; what came before it is in the file.
  }
}

TakeWriter::Recorder& TakeWriter::recorder() {
  if (!lock_) throw Error("{}: is written before it was begun, or after it was finished", path_);
  if (!recorder_) recorder_ = std::make_unique<Recorder>(path_, header_);
  return *recorder_;
}

Sink::SinkRequirements TakeWriter::begin(const RecordingHeader& header) {
  require_valid(header, path_);
  lock_ = std::make_unique<FileLock>(position_for_take(path_));
  header_ = header;
  return {.images = false, .detected = true};
}
void TakeWriter::write(const Instant& instant) {
  recorder().write(instant);
}
void TakeWriter::finish() {
  recorder().finish();
  recorder_.reset();
  lock_.reset();
}
void TakeWriter::set_name(const TrackName& name) {
  recorder().set_name(name);
}
void TakeWriter::add_edit(const Edit& edit) {
  recorder().add_edit(edit);
}
void TakeWriter::set_head(std::optional<std::int64_t> head) {
  recorder().set_head(head);
}
void TakeWriter::flush() {
  recorder().flush();
}

void write_recording(const std::string& path, const Recording& recording) {
  TakeWriter writer(path);
  writer.begin(recording.header);
  for (const TrackColumns& track : recording.tracks()) writer.set_name(track.name);
  InstantsOf instants(recording);
  while (const auto instant = instants.next()) writer.write(*instant);
  for (const Edit& edit : recording.edits) writer.add_edit(edit);
  writer.set_head(recording.head);
  writer.finish();
}

}  // namespace marey::format::take
