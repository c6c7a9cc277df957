#include "stored_recording.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "chunk_rows.h"

namespace marey::viewer {
namespace {

constexpr std::int64_t kSegmentInstants = 128, kSegmentRows = 32768;
constexpr std::size_t kMaxSampled = 20000;
constexpr double kOutside = 0.005;  // share of positions, at either end, that may be errors

template <typename T>
void append_column(std::string& bytes, const std::vector<T>& column) {
  bytes.append(reinterpret_cast<const char*>(column.data()), column.size() * sizeof(T));
}

}  // namespace

StoredRecording::StoredRecording(const RecordingHeader& header, const std::vector<TrackName>& tracks) {
  columns_ = wire_columns(header);
  for (const TrackName& name : tracks) courses_[name.id].name = name;
}

void StoredRecording::add(const Instant& instant) {
  {
    const std::lock_guard lock(mutex_);
    for (const TrackName& name : instant.named) courses_[name.id].name = name;
    for (const Sample& row : instant.samples) {
      RecordingState::Course& course = courses_[row.track];
      course.name.id = row.track;
      if (course.rows++ == 0) {
        course.first_s = seconds(instant.time);
        course.first_instant = added_;
      }
      course.measured += row.measured() ? 1 : 0;
      course.last_s = seconds(instant.time);
      course.last_instant = added_;
      sample(row.position);
    }
    ++added_;
  }
  open_rows_ += std::ssize(instant.samples) + std::ssize(instant.bodies);
  open_.push_back({.index = instant.index,
                   .time = instant.time,
                   .samples = instant.samples,
                   .detected = {},
                   .bodies = instant.bodies,
                   .named = {},
                   .boxes = {},
                   .frames = {}});
  for (Sample& row : open_.back().samples) row.outline = nullptr;
  if (std::ssize(open_) >= kSegmentInstants || open_rows_ >= kSegmentRows) close_segment();
}

void StoredRecording::close_segment() {
  if (open_.empty()) return;
  const RecordingState::TimeChunk segment{
      .first_s = seconds(open_.front().time), .instants = std::ssize(open_), .rows = open_rows_, .version = 0};
  Bytes bytes = bytes_of(wire_of(open_, static_cast<std::uint32_t>(state_.instants), columns_));
  const std::lock_guard lock(mutex_);
  segments_.push_back(std::move(bytes));
  state_.segments.push_back(segment);
  state_.instants += segment.instants;
  state_.last_s = seconds(open_.back().time);
  open_.clear();
  open_rows_ = 0;
}

void StoredRecording::finish(std::vector<std::string> warnings) {
  close_segment();
  const std::lock_guard lock(mutex_);
  state_.warnings = std::move(warnings);
  state_.complete = true;
}

void StoredRecording::put(const std::vector<TrackColumns>& tracks) {
  // Only this thread writes now: present data are read without the lock, and only the exchange takes it.
  std::int64_t first = 0;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const std::int64_t begins = std::exchange(first, first + state_.segments[i].instants);
    if (has_tracks(*segments_[i], columns_, begins, tracks)) continue;
    replace_segment(i, bytes_of(with_tracks(*segments_[i], columns_, begins, tracks)));
  }
  for (const TrackColumns& track : tracks) {
    const auto known = courses_.find(track.id());
    RecordingState::Course course = course_of(track, known == courses_.end() ? 0 : known->second.version + 1);
    const std::lock_guard lock(mutex_);
    courses_[track.id()] = std::move(course);
  }
}

void StoredRecording::put_poses(const std::vector<BodyColumns>& bodies) {
  std::int64_t first = 0;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    std::string bytes = with_poses(*segments_[i], columns_, std::exchange(first, first + state_.segments[i].instants), bodies);
    if (bytes != *segments_[i]) replace_segment(i, bytes_of(std::move(bytes)));
  }
}

void StoredRecording::replace_segment(std::size_t number, Bytes bytes) {
  const std::lock_guard lock(mutex_);
  segments_[number] = std::move(bytes);
  state_.segments[number].rows = row_count(*segments_[number]);
  ++state_.segments[number].version;
}

RecordingState::Course StoredRecording::course_of(const TrackColumns& track, int version) const {
  RecordingState::Course course{.name = track.name, .rows = std::ssize(track.at()), .measured = 0, .version = version};
  for (std::size_t row = 0; row < track.size(); ++row) course.measured += track.measured(row) ? 1 : 0;
  if (track.empty()) return course;
  const auto time_of = [&](std::int64_t instant) {
    std::size_t segment = 0;
    while (instant >= state_.segments[segment].instants) instant -= state_.segments[segment++].instants;
    return time_in(*segments_[segment], static_cast<std::size_t>(instant));
  };
  course.first_instant = track.at().front();
  course.last_instant = track.at().back();
  course.first_s = time_of(course.first_instant);
  course.last_s = time_of(course.last_instant);
  return course;
}

void StoredRecording::sample(const Vector<3>& position) {
  if (until_next_-- > 0) return;
  until_next_ = sampled_each_ - 1;
  sampled_.push_back(position);
  if (sampled_.size() < kMaxSampled) return;
  for (std::size_t i = 0; 2 * i < sampled_.size(); ++i) sampled_[i] = sampled_[2 * i];
  sampled_.resize(sampled_.size() / 2);
  sampled_each_ *= 2;
}

std::optional<Extent> StoredRecording::extent() const {
  if (sampled_.empty()) return std::nullopt;
  Extent extent;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vector<3>& position : sampled_) values.push_back(position[axis]);
    const auto cut = static_cast<std::ptrdiff_t>(kOutside * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + cut, values.end());
    extent.low[axis] = values[static_cast<std::size_t>(cut)];
    const std::ptrdiff_t last = std::ssize(values) - 1 - cut;
    std::nth_element(values.begin(), values.begin() + last, values.end());
    extent.high[axis] = values[static_cast<std::size_t>(last)];
  }
  return extent;
}

RecordingState StoredRecording::state() const {
  const std::lock_guard lock(mutex_);
  RecordingState state = state_;
  for (const auto& [id, course] : courses_) {
    if (course.rows > 0) state.tracks.push_back(course);
  }
  state.extent = extent();
  return state;
}

Bytes StoredRecording::segment(std::size_t number) const {
  const std::lock_guard lock(mutex_);
  return number < segments_.size() ? segments_[number] : nullptr;
}

std::string StoredRecording::course(TrackId track) const {
  std::vector<Bytes> segments;
  {
    const std::lock_guard lock(mutex_);
    const auto known = courses_.find(track);
    if (known != courses_.end() && known->second.rows > 0) {
      for (std::size_t i = 0; i < segments_.size(); ++i) {
        const RecordingState::TimeChunk& segment = state_.segments[i];
        const double end_s = i + 1 < segments_.size() ? state_.segments[i + 1].first_s : state_.last_s;
        if (end_s >= known->second.first_s && segment.first_s <= known->second.last_s) segments.push_back(segments_[i]);
      }
    }
  }
  CourseColumns course;
  for (const Bytes& segment : segments) gather_rows(*segment, track, columns_, course);
  std::string bytes(40, '\0');
  bytes[0] = 4;
  bytes[1] = 1;
  bytes[2] = columns_.z ? 1 : 0;
  const auto rows = static_cast<std::uint32_t>(course.time.size());
  std::memcpy(bytes.data() + 24, &rows, sizeof rows);
  append_column(bytes, course.time);
  for (const std::vector<float>& axis : course.position) append_column(bytes, axis);
  append_column(bytes, course.state);
  return bytes;
}

}  // namespace marey::viewer
