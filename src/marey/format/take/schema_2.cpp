// A chunk is read at once, in one transaction: between two nothing is locked, so that a slow reader does not hold up the program
// that writes the take, and what it has written since is found by the next query.
#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/take/body_definition.h"
#include "marey/format/take/chunk_reader.h"
#include "marey/format/take/frame_names.h"
#include "marey/format/take/keypoints_blob.h"
#include "marey/format/take/take_cursor.h"
#include "marey/format/take/take_schema.h"

namespace marey::format::take {
namespace {

constexpr const char* kTables = "'take', 'option', 'input', 'track', 'chunk', 'samples', 'seen', 'body', 'poses', 'edit'";

/// Where reading stands within the columns of the chunk at hand.
template <typename Columns>
struct Location {
  const Columns* columns;
  std::size_t row;
};

class CursorOfSchema2 : public TakeCursor {
 public:
  CursorOfSchema2(std::unique_ptr<Database> database, TakeReaderOptions options)
      : database_(std::move(database)),
        values_((require_tables(*database_, kTables, kTakeTables), *database_)),
        options_(options),
        header_(read_header()),
        chunks_(*database_, header_.frame.dimensions()) {}

  const RecordingHeader& header() const override { return header_; }

  RecordingSummary summary() override {
    const ReadTransaction transaction(*database_);
    RecordingSummary summary;
    summary.instants = values_.integer("instants");
    summary.samples = values_.integer("samples");
    summary.detected = values_.integer("seen");
    summary.complete = values_.integer("complete") != 0;
    // Takes of older versions have no kinds; their ball is known by its label.
    const bool kinds = database_->number("SELECT count(*) FROM pragma_table_info('track') WHERE name = 'kind'") != 0;
    Statement tracks(
        *database_, fmt::format("SELECT id, label, team, first_index, last_index, measured, filled, predicted, solved{} FROM track "
                                "ORDER BY id",
                                kinds ? ", kind" : ""));
    while (tracks.step()) {
      RecordingSummary::TrackCount count;
      count.name = {checked_track(tracks.integer(0), *database_), plain_text(tracks.text(1)), plain_text(tracks.text(2))};
      count.name.kind = kinds ? checked_kind(tracks.text(9)) : kind_of_label(count.name);
      if (count.name.kind == TrackKind::unspecified) count.name.kind = header_.track_kind;
      check_name(count.name, summary.tracks.size(), options_.limits, *database_);
      if (tracks.is_number(3)) count.first_index = tracks.integer(3);
      if (tracks.is_number(4)) count.last_index = tracks.integer(4);
      for (int i = 0; i < 4; ++i) count.by_provenance[static_cast<std::size_t>(i)] = tracks.integer(5 + i);
      summary.tracks.push_back(std::move(count));
    }
    const auto rows = chunks_.rows();
    if (rows.empty()) return summary;
    std::vector<Recording::TimeStep> first, last;
    chunks_.read_time_steps(rows.front(), first);
    chunks_.read_time_steps(rows.back(), last);
    summary.first_index = first.front().index;
    summary.first_time = first.front().time;
    summary.last_index = last.back().index;
    summary.last_time = last.back().time;
    return summary;
  }

  std::vector<Edit> edits() override {
    std::vector<Edit> edits;
    Statement rows(*database_, "SELECT id, parent, operation, payload FROM edit ORDER BY id");
    while (rows.step()) {
      Edit edit{.id = rows.integer(0), .parent = {}, .operation = std::string(rows.text(2)), .payload = std::string(rows.text(3))};
      if (rows.is_number(1)) edit.parent = rows.integer(1);
      edits.push_back(std::move(edit));
    }
    return edits;
  }
  std::optional<std::int64_t> head() override {
    const std::int64_t head = values_.integer("head");
    return head > 0 ? std::optional(head) : std::nullopt;
  }

  std::optional<Instant> next() override {
    if (at_ == chunk_.time_steps.size() && !fetch()) return std::nullopt;
    Instant instant;
    instant.index = chunk_.time_steps[at_].index;
    instant.time = chunk_.time_steps[at_].time;
    const auto at = static_cast<std::int32_t>(at_++);
    for (auto& [track, row] : tracks_) {
      if (row < track->size() && track->at()[row] == at) instant.samples.push_back(track->sample(row++));
    }
    for (auto& [camera, location] : detected_) {
      for (; location.row < location.columns->size() && location.columns->at[location.row] == at; ++location.row)
        instant.detected.push_back(location.columns->point(camera, location.row));
    }
    for (Location<BodyColumns>& location : bodies_) {
      if (location.row < location.columns->size() && location.columns->at()[location.row] == at)
        instant.bodies.push_back(location.columns->pose(location.row++));
    }
    next_index_ = instant.index + 1;
    return instant;
  }

  void seek(std::int64_t index) override {
    leave_chunk();
    next_index_ = index;
  }

  std::vector<Recording::TimeStep> time_steps() override {
    const ReadTransaction transaction(*database_);
    std::vector<Recording::TimeStep> time_steps;
    for (const ChunkReader::Row& row : chunks_.rows()) chunks_.read_time_steps(row, time_steps);
    return time_steps;
  }

  TrackColumns read_track(const TrackName& name) override {
    const ReadTransaction transaction(*database_);
    TrackColumns track(name, header_.frame.metric() && name.kind == TrackKind::ball ? 3 : header_.frame.dimensions());
    std::int64_t offset = 0;
    for (const ChunkReader::Row& row : chunks_.rows()) {
      chunks_.read_track(row, offset, track);
      offset += row.instants;
    }
    return track;
  }

 private:
  RecordingHeader read_header() {
    RecordingHeader header = common_header(*database_, values_);
    const std::string frame = values_.text("frame");
    const auto kind = frame_kind_of(frame);
    if (!kind) throw Error("{}: is damaged (its frame of reference is \"{}\")", database_->path(), plain_text(frame.substr(0, 40)));
    header.frame.kind = *kind;
    if (values_.has("camera")) {
      const std::int64_t camera = values_.integer("camera");
      if (camera < 0 || camera > 63) throw Error("{}: is damaged (its camera is {})", database_->path(), camera);
      header.frame.camera = CameraId{static_cast<int>(camera)};
    }
    if (values_.has("keypoints")) header.keypoints = keypoint_set_of(values_.text("keypoints"), database_->path());
    header.time_base = read_time_base();
    header.smoothed = values_.integer("smoothed") != 0;
    if (values_.has("track_kind")) header.track_kind = checked_kind(values_.text("track_kind"));
    header.made_by.program = plain_text(values_.text("program"));
    Statement options(*database_, "SELECT name, value FROM option ORDER BY name");
    while (options.step()) header.made_by.options.emplace(plain_text(options.text(0)), plain_text(options.text(1)));
    Statement inputs(*database_, "SELECT name, hash FROM input ORDER BY id");
    while (inputs.step()) header.made_by.inputs.push_back({plain_text(inputs.text(0)), plain_text(inputs.text(1))});
    read_bodies(header.bodies);
    return header;
  }

  /// Of the key `clock`, which older takes lack: "rig" or the number of a camera.
  TimeBase read_time_base() {
    if (!values_.has("clock")) return {};
    if (values_.text("clock") == "rig") return {.kind = TimeBase::Kind::rig};
    const std::int64_t camera = values_.integer("clock");
    if (camera < 0 || camera > 63) throw Error("{}: is damaged (its clock is of camera {})", database_->path(), camera);
    return {.kind = TimeBase::Kind::camera, .camera = CameraId{static_cast<int>(camera)}};
  }

  TrackKind checked_kind(std::string_view text) const {
    if (const auto kind = track_kind_of(text)) return *kind;
    throw Error("{}: is damaged (a track's kind is \"{}\")", database_->path(), plain_text(std::string(text.substr(0, 40))));
  }

  TrackKind kind_of_label(const TrackName& name) const {
    return header_.frame.metric() ? kind_by_label(name.label, name.team) : TrackKind::unspecified;
  }

  void read_bodies(std::vector<Body>& bodies) {
    Statement rows(*database_, "SELECT id, label, definition FROM body ORDER BY id");
    while (rows.step()) {
      const std::int64_t id = rows.integer(0);
      if (id <= 0 || id > std::numeric_limits<int>::max()) throw Error("{}: is damaged (a body's id is {})", database_->path(), id);
      if (bodies.size() >= options_.limits.tracks)
        throw Error("{}: has more than {} bodies (the limit tracks)", database_->path(), options_.limits.tracks);
      Body& body = bodies.emplace_back();
      body.id = BodyId{static_cast<int>(id)};
      body.label = plain_text(rows.text(1));
      check_name({.id = TrackId{static_cast<int>(id)}, .label = body.label, .team = {}}, 0, options_.limits, *database_);
      read_body_definition(rows.text(2), database_->path(), body);
    }
  }

  void leave_chunk() {
    chunk_.clear();
    tracks_.clear();
    detected_.clear();
    bodies_.clear();
    at_ = 0;
  }

  /// The chunk in which the next instant is; false if it does not exist yet.
  bool fetch() {
    leave_chunk();
    const ReadTransaction transaction(*database_);
    const auto row = chunks_.find(std::max(next_index_, std::int64_t{0}));
    if (!row) return false;
    try {
      chunks_.read(*row, options_.detected, chunk_);
    } catch (const Error&) {
      leave_chunk();
      throw;
    }
    const auto first =
        std::lower_bound(chunk_.time_steps.begin(), chunk_.time_steps.end(), next_index_,
                         [](const Recording::TimeStep& time_step, std::int64_t index) { return time_step.index < index; });
    at_ = static_cast<std::size_t>(first - chunk_.time_steps.begin());
    const auto begin = static_cast<std::int32_t>(at_);
    const auto row_of = [begin](const auto& at) {
      return static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), begin) - at.begin());
    };
    for (const auto& [id, columns] : chunk_.tracks) tracks_.push_back({&columns, row_of(columns.at())});
    for (const auto& [camera, columns] : chunk_.detected)
      detected_.emplace_back(camera, Location<ObservedColumns>{&columns, row_of(columns.at)});
    for (const auto& [id, columns] : chunk_.bodies) bodies_.push_back({&columns, row_of(columns.at())});
    return true;
  }

  std::unique_ptr<Database> database_;
  TakeValues values_;
  TakeReaderOptions options_;
  RecordingHeader header_;
  ChunkReader chunks_;
  Chunk chunk_;
  std::size_t at_ = 0;  // the chunk's instants: the next
  std::vector<Location<TrackColumns>> tracks_;
  std::vector<std::pair<CameraId, Location<ObservedColumns>>> detected_;
  std::vector<Location<BodyColumns>> bodies_;
  std::int64_t next_index_ = 0;
};

}  // namespace

std::unique_ptr<TakeCursor> open_schema_2(std::unique_ptr<Database> database, TakeReaderOptions options) {
  return std::make_unique<CursorOfSchema2>(std::move(database), options);
}

}  // namespace marey::format::take
