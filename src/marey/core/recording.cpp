#include "marey/core/recording.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/geometry/median.h"

namespace marey {
namespace {

bool is_new(const std::vector<std::int32_t>& at, std::int32_t instant) {
  return at.empty() || at.back() < instant;
}

}  // namespace

std::string to_string(const FrameOfReference& frame) {
  switch (frame.kind) {
    case FrameOfReference::Kind::image:
      return frame.camera ? fmt::format("px of camera {}'s images", number(*frame.camera) + 1) : "px of an image";
    case FrameOfReference::Kind::ground:
      return "m on the ground of the rig's world";
    case FrameOfReference::Kind::user_ground:
      return "m on the ground";
    case FrameOfReference::Kind::space:
      return "m in space";
  }
  return {};
}

void OptionalColumn::set(std::size_t row, std::span<const double> values) {
  const auto width = static_cast<std::size_t>(width_);
  // Memory is what the rows need where their number is known, else a quarter more at most.
  if (values_.size() + width > values_.capacity())
    values_.reserve(std::max({rows_ * width, (row + 1) * width, values_.size() + values_.size() / 4 + 16 * width}));
  if (known_.empty() && rows_ > row) known_.reserve(rows_), values_.reserve(rows_ * width);
  if (known_.size() < row) {
    unknown_ += row - known_.size();
    known_.resize(row, false);
    values_.resize(row * width);
  }
  known_.push_back(true);
  values_.insert(values_.end(), values.begin(), values.end());
}

void OptionalColumn::add_rows(std::size_t first, std::span<const double> values, const std::vector<bool>& known) {
  unknown_ += first - known_.size();
  known_.resize(first, false);
  values_.resize(first * static_cast<std::size_t>(width_));
  values_.insert(values_.end(), values.begin(), values.end());
  if (known.empty()) {
    known_.resize(first + values.size() / static_cast<std::size_t>(width_), true);
  } else {
    known_.insert(known_.end(), known.begin(), known.end());
    unknown_ += static_cast<std::size_t>(std::count(known.begin(), known.end(), false));
  }
}

void OptionalColumn::clear() {
  values_.clear();
  known_.clear();
  unknown_ = 0;
}

TrackColumns::TrackColumns(TrackName of, int dimensions)
    : name(std::move(of)),
      dimensions_(dimensions),
      optional_{OptionalColumn(dimensions), OptionalColumn(dimensions * (dimensions + 1) / 2),
                OptionalColumn(1),          OptionalColumn(4),
                OptionalColumn(1),          OptionalColumn(1)} {}

std::optional<Vector<3>> TrackColumns::velocity(std::size_t row) const {
  if (!column(Optional::velocity).known(row)) return std::nullopt;
  const double* value = column(Optional::velocity).values(row);
  return Vector<3>(value[0], value[1], dimensions_ == 3 ? value[2] : 0);
}

Sample TrackColumns::sample(std::size_t row) const {
  Sample sample{.track = name.id,
                .position = position(row),
                .velocity = velocity(row),
                .covariance = {},
                .provenance = provenance_[row],
                .cameras = cameras_[row],
                .score = {},
                .box = {},
                .residual_px = {},
                .residual_m = {}};
  if (column(Optional::covariance).known(row)) {
    const double* value = column(Optional::covariance).values(row);
    Matrix<3> covariance = Matrix<3>::Zero();
    for (int i = 0; i < dimensions_; ++i) {
      for (int k = i; k < dimensions_; ++k) covariance(i, k) = covariance(k, i) = *value++;
    }
    sample.covariance = covariance;
  }
  if (column(Optional::score).known(row)) sample.score = *column(Optional::score).values(row);
  if (column(Optional::box).known(row)) {
    const double* value = column(Optional::box).values(row);
    sample.box = Box{value[0], value[1], value[2], value[3]};
  }
  if (column(Optional::residual_px).known(row)) sample.residual_px = *column(Optional::residual_px).values(row);
  if (column(Optional::residual_m).known(row)) sample.residual_m = *column(Optional::residual_m).values(row);
  if (const auto outline = outlines_.find(row); outline != outlines_.end()) sample.outline = outline->second;
  if (const auto points = keypoints_.find(row); points != keypoints_.end()) sample.keypoints = points->second;
  return sample;
}

std::optional<std::size_t> TrackColumns::row_at(std::int32_t instant) const {
  const auto found = std::lower_bound(at_.begin(), at_.end(), instant);
  if (found == at_.end() || *found != instant) return std::nullopt;
  return static_cast<std::size_t>(found - at_.begin());
}

void TrackColumns::add(std::int32_t instant, const Sample& sample) {
  if (!is_new(at_, instant)) throw Error("track {} has two samples at one instant", number(name.id));
  const std::size_t row = at_.size();
  if (row == at_.capacity()) reserve(row + row / 4 + 16);
  at_.push_back(instant);
  x_.push_back(sample.position.x());
  y_.push_back(sample.position.y());
  if (dimensions_ == 3) z_.push_back(sample.position.z());
  provenance_.push_back(sample.provenance);
  cameras_.push_back(sample.cameras);
  if (sample.velocity) column(Optional::velocity).set(row, {sample.velocity->data(), static_cast<std::size_t>(dimensions_)});
  if (sample.covariance) {
    std::array<double, 6> upper{};
    std::size_t count = 0;
    for (int i = 0; i < dimensions_; ++i) {
      for (int k = i; k < dimensions_; ++k) upper[count++] = (*sample.covariance)(i, k);
    }
    column(Optional::covariance).set(row, {upper.data(), count});
  }
  if (sample.score) column(Optional::score).set(row, {&*sample.score, 1});
  if (sample.box)
    column(Optional::box).set(row, std::array{sample.box->left, sample.box->top, sample.box->width, sample.box->height});
  if (sample.residual_px) column(Optional::residual_px).set(row, {&*sample.residual_px, 1});
  if (sample.residual_m) column(Optional::residual_m).set(row, {&*sample.residual_m, 1});
  if (sample.outline) outlines_.emplace(row, sample.outline);
  if (sample.keypoints) keypoints_.emplace(row, sample.keypoints);
}

void TrackColumns::reserve(std::size_t rows) {
  at_.reserve(rows), x_.reserve(rows), y_.reserve(rows), provenance_.reserve(rows), cameras_.reserve(rows);
  if (dimensions_ == 3) z_.reserve(rows);
  for (OptionalColumn& column : optional_) column.reserve(rows);
}

void TrackColumns::add_rows(const Rows& rows) {
  for (std::size_t i = 0; i < rows.at.size(); ++i) {
    if (i == 0 ? !is_new(at_, rows.at[0]) : rows.at[i] <= rows.at[i - 1])
      throw Error("track {} has two samples at one instant", number(name.id));
  }
  const auto put = [](auto& column, const auto& more) { column.insert(column.end(), more.begin(), more.end()); };
  put(at_, rows.at);
  put(x_, rows.x);
  put(y_, rows.y);
  if (dimensions_ == 3) put(z_, rows.z);
  put(provenance_, rows.provenance);
  put(cameras_, rows.cameras);
}

void TrackColumns::clear() {
  at_.clear();
  x_.clear();
  y_.clear();
  z_.clear();
  provenance_.clear();
  cameras_.clear();
  for (OptionalColumn& column : optional_) column.clear();
  outlines_.clear();
  keypoints_.clear();
}

void TrackColumns::set_at(std::vector<std::int32_t> instants) {
  assert(instants.size() == at_.size() && std::is_sorted(instants.begin(), instants.end()));
  at_ = std::move(instants);
}

const TrackColumns* Recording::find(TrackId id) const {
  const auto found =
      std::lower_bound(tracks_.begin(), tracks_.end(), id, [](const TrackColumns& t, TrackId i) { return t.id() < i; });
  return found == tracks_.end() || found->id() != id ? nullptr : &*found;
}

TrackColumns& Recording::track_of(TrackId id) {
  const auto at = std::lower_bound(tracks_.begin(), tracks_.end(), id, [](const TrackColumns& t, TrackId i) { return t.id() < i; });
  if (at != tracks_.end() && at->id() == id) return *at;
  return *tracks_.emplace(at, TrackName{.id = id, .label = {}, .team = {}, .kind = header.track_kind}, dimensions());
}

const BodyColumns* Recording::find(BodyId id) const {
  const auto found =
      std::lower_bound(bodies_.begin(), bodies_.end(), id, [](const BodyColumns& b, BodyId i) { return b.body() < i; });
  return found == bodies_.end() || found->body() != id ? nullptr : &*found;
}

BodyColumns& Recording::body_of(BodyId id) {
  const auto at = std::lower_bound(bodies_.begin(), bodies_.end(), id, [](const BodyColumns& b, BodyId i) { return b.body() < i; });
  if (at != bodies_.end() && at->body() == id) return *at;
  return *bodies_.emplace(at, id);
}

std::int64_t Recording::samples() const {
  std::int64_t count = 0;
  for (const TrackColumns& track : tracks_) count += static_cast<std::int64_t>(track.size());
  return count;
}

std::span<const ImageObservation> Recording::detected(std::size_t instant) const {
  if (instant >= observed_end_.size()) return {};
  const std::size_t begin = instant == 0 ? 0 : observed_end_[instant - 1];
  return {detected_.data() + begin, observed_end_[instant] - begin};
}

void Recording::add(const Instant& instant) {
  if (!instants_.empty() && instant.index <= instants_.back().index)
    throw Error("instant {} comes after instant {}; they must grow", instant.index, instants_.back().index);
  const auto at = static_cast<std::int32_t>(instants_.size());
  instants_.push_back({instant.index, instant.time});
  for (const TrackName& name : instant.named) set_name(name);
  for (const Sample& sample : instant.samples) track_of(sample.track).add(at, sample);
  for (const BodyPose& pose : instant.bodies) body_of(pose.body).add(at, pose);
  if (instant.detected.empty() && observed_end_.empty()) return;
  observed_end_.resize(static_cast<std::size_t>(at), detected_.size());
  detected_.insert(detected_.end(), instant.detected.begin(), instant.detected.end());
  observed_end_.push_back(detected_.size());
}

void Recording::set_name(const TrackName& name) {
  TrackColumns& track = track_of(name.id);
  const TrackKind kind = name.kind == TrackKind::unspecified ? track.name.kind : name.kind;
  if (track.empty() && track.dimensions() == 2 && header.frame.metric() && kind == TrackKind::ball) track = TrackColumns(name, 3);
  track.name = name;
  track.name.kind = kind;
}

void Recording::shift_times(Duration shift) {
  for (TimeStep& time_step : instants_) time_step.time += shift;
}

void Recording::put(TrackColumns track) {
  TrackColumns& location = track_of(track.id());
  location = std::move(track);
  if (location.name.kind == TrackKind::unspecified) location.name.kind = header.track_kind;
}

void Recording::put(BodyColumns body) {
  BodyColumns& location = body_of(body.body());
  location = std::move(body);
}

void Recording::erase_tracks_if(const std::function<bool(const TrackColumns&)>& exclude) {
  std::erase_if(tracks_, exclude);
}

InstantRows::InstantRows(const Recording& recording) : recording_(recording) {
  const std::vector<TrackColumns>& tracks = recording.tracks();
  for (std::size_t i = tracks.size(); i-- > 0;) {
    if (!tracks[i].empty()) waiting_.push_back(i);
  }
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [&](std::size_t a, std::size_t b) { return tracks[a].at().front() > tracks[b].at().front(); });
}

std::span<const InstantRows::Row> InstantRows::at(std::size_t instant) {
  const std::vector<TrackColumns>& tracks = recording_.tracks();
  const auto now = static_cast<std::int32_t>(instant);
  for (; !waiting_.empty() && tracks[waiting_.back()].at().front() <= now; waiting_.pop_back()) {
    const auto location = std::lower_bound(open_.begin(), open_.end(), waiting_.back(),
                                           [](const Row& row, std::size_t track) { return row.track < track; });
    open_.insert(location, {waiting_.back(), 0});
  }
  rows_.clear();
  bool ended = false;
  for (Row& next : open_) {
    const std::span<const std::int32_t> at = tracks[next.track].at();
    while (next.row < at.size() && at[next.row] < now) ++next.row;
    if (next.row < at.size() && at[next.row] == now) rows_.push_back({next.track, next.row++});
    ended |= next.row == at.size();
  }
  if (ended) std::erase_if(open_, [&](const Row& next) { return next.row == tracks[next.track].size(); });
  return rows_;
}

std::optional<Instant> InstantsOf::next() {
  if (next_ == recording_.instants().size()) return std::nullopt;
  Instant instant;
  instant.index = recording_.instants()[next_].index;
  instant.time = recording_.instants()[next_].time;
  const auto detected = recording_.detected(next_);
  instant.detected.assign(detected.begin(), detected.end());
  for (std::size_t b = 0; b < body_rows_.size(); ++b) {
    const BodyColumns& body = recording_.bodies()[b];
    if (body_rows_[b] < body.size() && body.at()[body_rows_[b]] == static_cast<std::int32_t>(next_))
      instant.bodies.push_back(body.pose(body_rows_[b]++));
  }
  const auto rows = rows_.at(next_++);
  instant.samples.reserve(rows.size());
  for (const auto& [index, row] : rows) {
    const TrackColumns& track = recording_.tracks()[index];
    if (row == 0 && (!track.name.label.empty() || !track.name.team.empty() || track.name.kind != recording_.header.track_kind))
      instant.named.push_back(track.name);
    instant.samples.push_back(track.sample(row));
  }
  return instant;
}

std::optional<double> median_rate_hz(std::span<const Recording::TimeStep> instants) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < instants.size(); ++i) {
    const auto frames = static_cast<double>(instants[i].index - instants[i - 1].index);
    const double step = seconds(instants[i].time - instants[i - 1].time);
    if (step > 0 && frames > 0) steps.push_back(step / frames);
  }
  return steps.empty() ? std::nullopt : std::optional(1 / geometry::median(steps));
}

Recording with_time_base(Recording recording, const TimeBase& base) {
  if (!recording.header.rig)
    throw Error("{}: its cameras are not known, so its times cannot be given by another clock", recording.header.name);
  const Rig& rig = *recording.header.rig;
  const Duration shift = rig_time_offset(recording.header.time_base, rig) - rig_time_offset(base, rig);
  recording.shift_times(shift);
  recording.header.time_base = base;
  return recording;
}

bool has_velocities(const Recording& recording) {
  return std::any_of(recording.tracks().begin(), recording.tracks().end(),
                     [](const TrackColumns& t) { return t.has_velocities(); });
}

void require_metric(const RecordingHeader& header, std::string_view what) {
  if (header.frame.metric()) return;
  throw Error("{}: {} needs metres, and these positions are {}; track with a calibrated rig (marey track RIG --ground)",
              header.name, what, to_string(header.frame));
}

void require_ground(const RecordingHeader& header, std::string_view what) {
  require_metric(header, what);
  if (header.frame.dimensions() == 2) return;
  throw Error("{}: {} is of people on the ground, and these positions are {}", header.name, what, to_string(header.frame));
}

}  // namespace marey
