// The one result of every job: where everything was, when, how well that is known, and how it was found out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/rig.h"
#include "marey/core/time_base.h"

namespace marey {

/// Whose axes a recording's positions are in. A function that needs one refuses the others with a sentence; a change of frame makes
/// a new recording.
struct FrameOfReference {
  enum class Kind : std::uint8_t {
    image,        ///< px of one camera's images, y down
    ground,       ///< m on the ground in the rig's right-handed world, z up
    user_ground,  ///< m on the ground as the user has it: `Rig::ground_from_world` was applied
    space,        ///< m in the rig's right-handed world, z up
  };

  Kind kind = Kind::space;
  std::optional<CameraId> camera;  ///< of `image`, where the rig has several

  int dimensions() const { return kind == Kind::space ? 3 : 2; }
  bool metric() const { return kind != Kind::image; }
  bool operator==(const FrameOfReference&) const = default;
};

/// "px of camera 2's images", "m on the ground", …: for sentences to the user.
std::string to_string(const FrameOfReference& frame);

/// How a recording was made, so that it can be made again. No time of day, host, thread count or absolute path: the same input with
/// the same options gives the same bytes.
struct MadeBy {
  struct Input {
    std::string name;  ///< without its folder
    std::string hash;  ///< of its size, first and last MiB; empty if it is not a regular file
    bool operator==(const Input&) const = default;
  };
  std::string program;                         ///< "marey track" and its version, or the system that a file came from
  std::map<std::string, std::string> options;  ///< by name, as given and as defaulted
  std::vector<Input> inputs;
  bool operator==(const MadeBy&) const = default;
};

/// The properties of a recording before its first instant.
struct RecordingHeader {
  std::string name;         ///< free text; by default the file's
  std::string recorded_at;  ///< ISO 8601, UTC; empty if unknown
  FrameOfReference frame;
  TimeBase time_base;
  TrackKind track_kind = TrackKind::unspecified;  ///< of tracks without a kind of their own
  double rate_hz = 0;                             ///< instants a second, positive: the median step, where the file does not specify
  std::optional<Rig> rig;                         ///< the cameras with their sources; nothing if a file brings positions alone
  std::vector<Body> bodies;                       ///< by id, parents before children; none where none were solved
  std::optional<KeypointSet> keypoints;           ///< which body points samples have, where they have some
  MadeBy made_by;
  bool smoothed = false;  ///< a second pass has smoothed positions and velocities: a measurement does not smooth again
};

/// What was changed by hand or by a program after the recording: one operation, which is replayed over the recording. Edits
/// form a tree; the recording's head says which of them count, so that undoing moves the head.
struct Edit {
  std::int64_t id = 0;                 ///< positive
  std::optional<std::int64_t> parent;  ///< nothing for the first of a branch
  std::string operation;               ///< "rename", "swap", …; "note" for what older takes have
  std::string payload;                 ///< JSON
  bool operator==(const Edit&) const = default;
};

/// A column of a track of which some rows are not known. Costs nothing while none is. Rows are `width` numbers each.
class OptionalColumn {
 public:
  explicit OptionalColumn(int width) : width_(width) {}

  int width() const { return width_; }
  bool empty() const { return known_.empty(); }  ///< no row is known
  /// Up to the last row that is known.
  std::size_t size() const { return known_.size(); }
  bool known(std::size_t row) const { return row < known_.size() && known_[row]; }
  bool all_known(std::size_t rows) const { return known_.size() == rows && unknown_ == 0; }
  /// `width` numbers; only where the row is known.
  const double* values(std::size_t row) const { return values_.data() + row * static_cast<std::size_t>(width_); }
  /// Of all rows up to the last one known; 0 in those that are not.
  std::span<const double> values() const { return values_; }
  /// Rows before `row` that were never set are unknown. Rows come in growing order.
  void set(std::size_t row, std::span<const double> values);
  /// This many rows will come: where any is known, no more is taken than they need.
  void reserve(std::size_t rows) { rows_ = rows; }
  /// Rows from `first` on, as a file has them. `known` has a value for each of them, or none at all where all are known.
  void add_rows(std::size_t first, std::span<const double> values, const std::vector<bool>& known);
  void clear();

 private:
  int width_;
  std::size_t rows_ = 0;
  std::vector<double> values_;
  std::vector<bool> known_;
  std::size_t unknown_ = 0;  // of the rows in known_
};

/// One track over the whole recording, in columns, by growing instant. Optional columns exist only where a step filled them.
class TrackColumns {
 public:
  /// The columns that not every step fills.
  enum class Optional { velocity, covariance, score, box, residual_px, residual_m };
  static constexpr int kOptionals = 6;
  using Outlines = std::map<std::size_t, std::shared_ptr<const Outline>>;
  using Bodies = std::map<std::size_t, std::shared_ptr<const Keypoints<2>>>;

  /// The columns that every row has. `z` is empty in two dimensions.
  struct Rows {
    std::span<const std::int32_t> at;
    std::span<const double> x, y, z;
    std::span<const Provenance> provenance;
    std::span<const CameraMask> cameras;
  };

  TrackColumns(TrackName name, int dimensions);

  TrackName name;

  TrackId id() const { return name.id; }
  int dimensions() const { return dimensions_; }
  std::size_t size() const { return at_.size(); }
  bool empty() const { return at_.empty(); }
  /// Which of the recording's instants each row belongs to.
  std::span<const std::int32_t> at() const { return at_; }
  std::span<const double> x() const { return x_; }
  std::span<const double> y() const { return y_; }
  std::span<const double> z() const { return z_; }  ///< empty in two dimensions
  std::span<const Provenance> provenance() const { return provenance_; }
  std::span<const CameraMask> cameras() const { return cameras_; }
  bool has_velocities() const { return !column(Optional::velocity).empty(); }
  /// A covariance is its upper triangle, row by row; a box left, top, width, height.
  const OptionalColumn& column(Optional which) const { return optional_[static_cast<std::size_t>(which)]; }
  OptionalColumn& column(Optional which) { return optional_[static_cast<std::size_t>(which)]; }
  const Outlines& outlines() const { return outlines_; }  ///< by row
  const Bodies& keypoints() const { return keypoints_; }  ///< by row

  Vector<2> location(std::size_t row) const { return {x_[row], y_[row]}; }
  Vector<3> position(std::size_t row) const { return {x_[row], y_[row], z_.empty() ? 0 : z_[row]}; }
  std::optional<Vector<3>> velocity(std::size_t row) const;
  bool measured(std::size_t row) const { return provenance_[row] == Provenance::measured; }
  Sample sample(std::size_t row) const;
  /// The row of this instant of the recording, by binary search.
  std::optional<std::size_t> row_at(std::int32_t instant) const;

  /// `instant` is later than the last one's.
  void add(std::int32_t instant, const Sample& sample);
  /// This many rows will come, so that memory is what they need. Without it, it is a quarter more at most.
  void reserve(std::size_t rows);
  /// Says of every row again which instant it belongs to; as many as there are rows, growing.
  void set_at(std::vector<std::int32_t> instants);
  void forget_velocities() { column(Optional::velocity).clear(); }
  /// Many rows at once, later than those that are there; what they have in optional columns is put into those afterwards.
  void add_rows(const Rows& rows);
  void set_outline(std::size_t row, std::shared_ptr<const Outline> outline) { outlines_[row] = std::move(outline); }
  void set_keypoints(std::size_t row, std::shared_ptr<const Keypoints<2>> points) { keypoints_[row] = std::move(points); }
  /// Leaves no row, and the memory for the next ones.
  void clear();

 private:
  int dimensions_;
  std::vector<std::int32_t> at_;
  std::vector<double> x_, y_, z_;
  std::vector<Provenance> provenance_;
  std::vector<CameraMask> cameras_;
  std::array<OptionalColumn, kOptionals> optional_;
  Outlines outlines_;
  Bodies keypoints_;
};

/// One body over the whole recording, in columns, by growing instant.
class BodyColumns {
 public:
  explicit BodyColumns(BodyId body) : body_(body) {}

  BodyId body() const { return body_; }
  std::size_t size() const { return at_.size(); }
  bool empty() const { return at_.empty(); }
  /// Which of the recording's instants each row belongs to.
  std::span<const std::int32_t> at() const { return at_; }
  std::span<const Rigid3> poses() const { return poses_; }  ///< world_from_body, m
  const std::vector<bool>& tracked() const { return tracked_; }
  const OptionalColumn& covariance() const { return covariance_; }  ///< the upper triangle, row by row: 21 numbers
  const OptionalColumn& residual_m() const { return residual_m_; }
  const OptionalColumn& other() const { return other_; }  ///< the three rows of [R t] of the other pose, then its probability

  BodyPose pose(std::size_t row) const;
  /// The row of this instant of the recording, by binary search.
  std::optional<std::size_t> row_at(std::int32_t instant) const;

  /// `instant` is later than the last one's.
  void add(std::int32_t instant, const BodyPose& pose);
  /// What another one of this body holds, whose instants are later once `offset` is added to them.
  void append(const BodyColumns& other, std::int32_t offset);
  /// Says of every row again which instant it belongs to; as many as there are rows, growing.
  void set_at(std::vector<std::int32_t> instants);

 private:
  BodyId body_;
  std::vector<std::int32_t> at_;
  std::vector<Rigid3> poses_;
  std::vector<bool> tracked_;
  OptionalColumn covariance_{21}, residual_m_{1}, other_{13};
};

/// A whole recording in memory. What may be long and is only passed on is better streamed, instant by instant.
class Recording {
 public:
  struct TimeStep {
    std::int64_t index = 0;
    Timestamp time{};
  };

  Recording() = default;
  explicit Recording(RecordingHeader of) : header(std::move(of)) {}

  RecordingHeader header;
  std::vector<Edit> edits;
  std::optional<std::int64_t> head;  ///< the edit whose branch counts; nothing: the recording without any

  int dimensions() const { return header.frame.dimensions(); }
  const std::vector<TimeStep>& instants() const { return instants_; }
  const std::vector<TrackColumns>& tracks() const { return tracks_; }  ///< by id
  const TrackColumns* find(TrackId id) const;
  const std::vector<BodyColumns>& bodies() const { return bodies_; }  ///< by id; what they are says the header
  const BodyColumns* find(BodyId id) const;
  double seconds_at(std::size_t instant) const { return seconds(instants_[instant].time); }
  std::int64_t samples() const;
  std::span<const ImageObservation> detected(std::size_t instant) const;

  /// Its index is later than the last one's. Images are not kept.
  void add(const Instant& instant);
  /// A track's label, team and, if specified, kind; it need not have samples yet.
  void set_name(const TrackName& name);
  /// Puts a track in as a whole, in the place of one with its id. Its instants must be there already.
  void put(TrackColumns track);
  void put(BodyColumns body);
  /// Takes all tracks out, so that another recording can be made of them without holding both.
  std::vector<TrackColumns> take_tracks() { return std::exchange(tracks_, {}); }
  void add_time_step(const TimeStep& time_step) { instants_.push_back(time_step); }
  void shift_times(Duration shift);
  /// Omits the tracks for which this says so.
  void erase_tracks_if(const std::function<bool(const TrackColumns&)>& exclude);

 private:
  TrackColumns& track_of(TrackId id);
  BodyColumns& body_of(BodyId id);

  std::vector<TimeStep> instants_;
  std::vector<TrackColumns> tracks_;
  std::vector<BodyColumns> bodies_;
  std::vector<ImageObservation> detected_;
  std::vector<std::size_t> observed_end_;  // by instant; empty if nothing seen is kept
};

/// Who is there at one instant after the other, without copying samples. Cost: linear in the rows, and at each instant in the
/// tracks that have begun and not ended. The recording must outlive it and stay as it is.
class InstantRows {
 public:
  struct Row {
    std::size_t track = 0;  ///< index into the recording's tracks
    std::size_t row = 0;    ///< in the track
  };

  explicit InstantRows(const Recording& recording);
  /// The rows of this instant, by track; valid until the next call. Instants are asked for in growing order, some may be passed
  /// over.
  std::span<const Row> at(std::size_t instant);

 private:
  const Recording& recording_;
  std::vector<std::size_t> waiting_;  // tracks that have not begun, the first to begin at the back
  std::vector<Row> open_;             // of tracks that have begun, the next row of each; by track
  std::vector<Row> rows_;
};

/// The recording's instants one after the other, as a sink takes them. The recording must outlive it.
class InstantsOf {
 public:
  explicit InstantsOf(const Recording& recording)
      : recording_(recording), rows_(recording), body_rows_(recording.bodies().size()) {}
  /// The next one, names at the first that shows them; nothing behind the last.
  std::optional<Instant> next();

 private:
  const Recording& recording_;
  std::size_t next_ = 0;
  InstantRows rows_;
  std::vector<std::size_t> body_rows_;  // of each body, the next
};

/// The typical step between instants as a rate: the median, so that gaps and a slip in one number change nothing. Nothing for fewer
/// than two instants.
std::optional<double> median_rate_hz(std::span<const Recording::TimeStep> instants);

/// The same recording with its times by another clock. Both clocks are of the header's rig. Throws Error if there is no rig, or if
/// one of them is not specified.
Recording with_time_base(Recording recording, const TimeBase& base);

/// Whether a velocity is known anywhere.
bool has_velocities(const Recording& recording);

/// Throws Error, with `what` for the job that needs it, where the recording is not in that kind of frame.
void require_metric(const RecordingHeader& header, std::string_view what);
void require_ground(const RecordingHeader& header, std::string_view what);
inline void require_metric(const Recording& recording, std::string_view what) {
  require_metric(recording.header, what);
}
inline void require_ground(const Recording& recording, std::string_view what) {
  require_ground(recording.header, what);
}

}  // namespace marey
