// Takes of schema 1, which hold points in space only: a row a frame. Frames are fetched some at a time, each time by a query of its
// own, so that nothing stays locked between them.
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/core/text_safety.h"
#include "marey/format/take/schema_1_records.h"
#include "marey/format/take/take_cursor.h"

namespace marey::format::take {
namespace {

constexpr std::size_t kFramesAtOnce = 64;

class CursorOfSchema1 : public TakeCursor {
 public:
  CursorOfSchema1(std::unique_ptr<Database> database, TakeReaderOptions options)
      : database_(std::move(database)),
        values_((require_tables(*database_, "'take', 'track', 'frame', 'edit'", 4), *database_)),
        frames_(*database_, options.seen
                                ? "SELECT frame, time_ns, points, observations FROM frame WHERE frame >= ? ORDER BY frame LIMIT ?"
                                : "SELECT frame, time_ns, points FROM frame WHERE frame >= ? ORDER BY frame LIMIT ?"),
        options_(options),
        header_(common_header(*database_, values_)) {
    header_.made_by.program = plain_text(values_.text("made_by"));
    header_.frame.kind = FrameOfReference::Kind::space;
  }

  const RecordingHeader& header() const override { return header_; }

  RecordingSummary summary() override {
    RecordingSummary summary;
    summary.instants = values_.integer("frames");
    summary.samples = values_.integer("points");
    summary.seen = values_.integer("observations");
    summary.complete = values_.integer("complete") != 0;
    std::tie(summary.first_index, summary.first_time) = end_of("ASC");
    std::tie(summary.last_index, summary.last_time) = end_of("DESC");
    Statement tracks(*database_, "SELECT id, label, first_frame, last_frame, measured, filled, predicted FROM track ORDER BY id");
    while (tracks.step()) {
      RecordingSummary::TrackCount count;
      count.name.id = checked_track(tracks.integer(0), *database_);
      count.name.label = plain_text(tracks.text(1));
      check_name(count.name, summary.tracks.size(), options_.limits, *database_);
      for (int i = 0; i < 3; ++i) count.by_provenance[static_cast<std::size_t>(i)] = tracks.integer(4 + i);
      if (count.samples() > 0) {
        count.first_index = tracks.integer(2);
        count.last_index = tracks.integer(3);
      }
      summary.tracks.push_back(std::move(count));
    }
    return summary;
  }

  /// Sentences become notes, each the child of the one before.
  std::vector<Edit> edits() override {
    std::vector<Edit> edits;
    Statement rows(*database_, "SELECT time, what FROM edit ORDER BY id");
    while (rows.step()) {
      const nlohmann::json payload{{"time", std::string(rows.text(0))}, {"what", std::string(rows.text(1))}};
      const auto id = std::ssize(edits) + 1;
      edits.push_back({.id = id,
                       .parent = id > 1 ? std::optional<std::int64_t>(id - 1) : std::nullopt,
                       .operation = "note",
                       .payload = payload.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)});
    }
    return edits;
  }
  std::optional<std::int64_t> head() override {
    const auto count = database_->number("SELECT count(*) FROM edit");
    return count > 0 ? std::optional(count) : std::nullopt;
  }

  std::optional<Instant> next() override {
    if (at_ == fetched_.size()) fetch();
    if (at_ == fetched_.size()) return std::nullopt;
    Instant instant = std::move(fetched_[at_++]);
    next_index_ = instant.index + 1;
    return instant;
  }

  void seek(std::int64_t index) override {
    fetched_.clear();
    at_ = 0;
    next_index_ = index;
  }

  std::vector<Recording::Moment> moments() override {
    std::vector<Recording::Moment> moments;
    Statement rows(*database_, "SELECT frame, time_ns FROM frame ORDER BY frame");
    while (rows.step()) moments.push_back({rows.integer(0), Timestamp(Duration(rows.integer(1)))});
    return moments;
  }

  TrackColumns read_track(const TrackName& name) override {
    TrackColumns track(name, 3);
    Statement rows(*database_, "SELECT frame, points FROM frame ORDER BY frame");
    for (std::int32_t at = 0; rows.step(); ++at) {
      for (const Sample& sample : samples_of_schema_1(rows.blob(1), where(rows.integer(0)))) {
        if (sample.track == name.id) track.add(at, sample);
      }
    }
    return track;
  }

 private:
  std::string where(std::int64_t frame) const { return fmt::format("{}: frame {}", database_->path(), frame); }

  void fetch() {
    fetched_.clear();
    at_ = 0;
    if (next_index_ == std::numeric_limits<std::int64_t>::max()) return;
    frames_.reset();
    frames_.bind(0, next_index_);
    frames_.bind(1, static_cast<std::int64_t>(kFramesAtOnce));
    while (frames_.step()) {
      Instant instant;
      instant.index = frames_.integer(0);
      if (instant.index < 0 || instant.index < next_index_ || (!fetched_.empty() && instant.index <= fetched_.back().index)) {
        throw Error("{}: is damaged (frame {} stands in the wrong place); restore it from a copy", database_->path(),
                    instant.index);
      }
      instant.time = Timestamp(Duration(frames_.integer(1)));
      instant.samples = samples_of_schema_1(frames_.blob(2), where(instant.index));
      if (options_.seen) instant.seen = seen_of_schema_1(frames_.blob(3), where(instant.index));
      fetched_.push_back(std::move(instant));
    }
    frames_.reset();
  }

  std::pair<std::optional<std::int64_t>, std::optional<Timestamp>> end_of(std::string_view order) {
    Statement row(*database_, fmt::format("SELECT frame, time_ns FROM frame ORDER BY frame {} LIMIT 1", order));
    if (!row.step()) return {};
    return {row.integer(0), Timestamp(Duration(row.integer(1)))};
  }

  std::unique_ptr<Database> database_;
  TakeValues values_;
  Statement frames_;
  TakeReaderOptions options_;
  RecordingHeader header_;
  std::vector<Instant> fetched_;
  std::size_t at_ = 0;
  std::int64_t next_index_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace

std::unique_ptr<TakeCursor> open_schema_1(std::unique_ptr<Database> database, TakeReaderOptions options) {
  return std::make_unique<CursorOfSchema1>(std::move(database), options);
}

}  // namespace marey::format::take
