#include "chunk_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>
#include <unordered_map>

namespace marey::viewer {
namespace {

constexpr std::size_t kHeaderBytes = 40, kRowCountAt = 28, kPoseCountAt = 32;
constexpr std::uint8_t kProvenanceBits = 7, kBoxBit = 8;

template <typename T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Where the columns begin that wire.h describes.
struct SegmentLayout {
  SegmentLayout(const std::string& bytes, const WireColumns& columns)
      : instants(number_at<std::uint32_t>(bytes, 24)),
        rows(number_at<std::uint32_t>(bytes, kRowCountAt)),
        poses(number_at<std::uint32_t>(bytes, kPoseCountAt)),
        axes(columns.z ? 3 : 2),
        index(kHeaderBytes + 8 * instants),
        row_end(index + 4 * instants),
        pose_end(row_end + 4 * instants),
        tracks(pose_end + 4 * instants),
        positions(tracks + 4 * rows),
        boxes(positions + 4 * axes * rows),
        cameras(boxes + (columns.boxes ? 16 * rows : 0)),
        sigmas(cameras + (columns.cameras ? 4 * rows : 0)),
        bodies(sigmas + (columns.sigma ? 4 * rows : 0)),
        keypoints(columns.keypoints),
        points(bodies + 32 * poses),
        states(points + 8 * keypoints * rows),
        confidences(states + rows),
        tracked(confidences + keypoints * rows) {}

  std::size_t instants, rows, poses, axes;
  std::size_t index, row_end, pose_end, tracks, positions, boxes, cameras, sigmas, bodies, keypoints, points, states, confidences,
      tracked;
};

/// Null for a row without.
std::shared_ptr<const Keypoints<2>> keypoints_of(const std::string& bytes, const SegmentLayout& at, std::size_t row) {
  auto body = std::make_shared<Keypoints<2>>();
  body->points.resize(at.keypoints);
  bool any = false;
  for (std::size_t i = 0; i < at.keypoints; ++i) {
    const std::size_t location = row * at.keypoints + i;
    const auto confidence = number_at<std::uint8_t>(bytes, at.confidences + location);
    if (confidence == 0) continue;
    any = true;
    Keypoint<2>& point = body->points[i].emplace();
    point.position = {number_at<float>(bytes, at.points + 4 * location),
                      number_at<float>(bytes, at.points + 4 * (at.rows * at.keypoints + location))};
    point.visibility = confidence / 255.0;
  }
  if (!any) return nullptr;
  return body;
}

Sample row_of(const std::string& bytes, const SegmentLayout& at, std::size_t row) {
  const auto column = [&](std::size_t begin, std::size_t which) {
    return static_cast<double>(number_at<float>(bytes, begin + 4 * (which * at.rows + row)));
  };
  Sample sample;
  sample.track = TrackId{number_at<std::int32_t>(bytes, at.tracks + 4 * row)};
  sample.position = {column(at.positions, 0), column(at.positions, 1), at.axes == 3 ? column(at.positions, 2) : 0};
  const auto state = number_at<std::uint8_t>(bytes, at.states + row);
  sample.provenance = static_cast<Provenance>(state & kProvenanceBits);
  if (state & kBoxBit) sample.box = Box{column(at.boxes, 0), column(at.boxes, 1), column(at.boxes, 2), column(at.boxes, 3)};
  if (at.sigmas > at.cameras) sample.cameras = number_at<std::uint32_t>(bytes, at.cameras + 4 * row);
  if (at.bodies > at.sigmas) {
    const double sigma = column(at.sigmas, 0);
    if (std::isfinite(sigma)) sample.covariance = sigma * sigma * Matrix<3>::Identity();
  }
  if (at.keypoints > 0) sample.keypoints = keypoints_of(bytes, at, row);
  return sample;
}

/// Without what bodies did.
std::vector<Instant> instants_of(const std::string& bytes, const SegmentLayout& at) {
  std::vector<Instant> instants(at.instants);
  for (std::size_t i = 0, row = 0; i < at.instants; ++i) {
    instants[i].index = number_at<std::uint32_t>(bytes, at.index + 4 * i);
    instants[i].time = timestamp_from_seconds(time_in(bytes, i));
    for (const std::size_t end = number_at<std::uint32_t>(bytes, at.row_end + 4 * i); row < end; ++row)
      instants[i].samples.push_back(row_of(bytes, at, row));
  }
  return instants;
}

void put_tracks(std::vector<Instant>& instants, std::int64_t first, const std::vector<TrackColumns>& tracks) {
  std::set<TrackId> others;
  for (const TrackColumns& track : tracks) others.insert(track.id());
  for (Instant& instant : instants) std::erase_if(instant.samples, [&](const Sample& row) { return others.contains(row.track); });
  for (const TrackColumns& track : tracks) {
    const auto at = track.at();
    auto row = static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), first) - at.begin());
    for (; row < track.size() && at[row] < first + std::ssize(instants); ++row)
      instants[static_cast<std::size_t>(at[row] - first)].samples.push_back(track.sample(row));
  }
  for (Instant& instant : instants) std::ranges::stable_sort(instant.samples, {}, &Sample::track);
}

/// The rows of a track that fall into a chunk.
struct RowsWithin {
  RowsWithin(const TrackColumns& of, std::int64_t first, std::size_t instants) : track(&of) {
    const auto at = of.at();
    const auto begin = std::lower_bound(at.begin(), at.end(), first);
    next = static_cast<std::size_t>(begin - at.begin());
    end = static_cast<std::size_t>(std::lower_bound(begin, at.end(), first + static_cast<std::int64_t>(instants)) - at.begin());
  }

  const TrackColumns* track;
  std::size_t next, end;
};

bool same_row(const Sample& sent, const TrackColumns& track, std::size_t row) {
  const OptionalColumn& box = track.column(TrackColumns::Optional::box);
  if (sent.position.cast<float>() != track.position(row).cast<float>() || sent.provenance != track.provenance()[row] ||
      sent.box.has_value() != box.known(row))
    return false;
  if (!sent.box) return true;
  const double* side = box.values(row);
  const auto same = [](double one, double other) { return static_cast<float>(one) == static_cast<float>(other); };
  return same(sent.box->left, side[0]) && same(sent.box->top, side[1]) && same(sent.box->width, side[2]) &&
         same(sent.box->height, side[3]);
}

}  // namespace

bool has_tracks(const std::string& segment, const WireColumns& columns, std::int64_t first,
                const std::vector<TrackColumns>& tracks) {
  const SegmentLayout at(segment, columns);
  std::unordered_map<int, RowsWithin> required;
  for (const TrackColumns& track : tracks) required.emplace(number(track.id()), RowsWithin(track, first, at.instants));
  for (std::size_t instant = 0, row = 0; instant < at.instants; ++instant) {
    for (const std::size_t end = number_at<std::uint32_t>(segment, at.row_end + 4 * instant); row < end; ++row) {
      const auto found = required.find(number_at<std::int32_t>(segment, at.tracks + 4 * row));
      if (found == required.end()) continue;
      RowsWithin& rows = found->second;
      if (rows.next == rows.end || rows.track->at()[rows.next] != first + static_cast<std::int64_t>(instant) ||
          !same_row(row_of(segment, at, row), *rows.track, rows.next++))
        return false;
    }
  }
  return std::all_of(required.begin(), required.end(), [](const auto& one) { return one.second.next == one.second.end; });
}

void gather_rows(const std::string& segment, TrackId track, const WireColumns& columns, CourseColumns& course) {
  const SegmentLayout at(segment, columns);
  for (std::size_t instant = 0, row = 0; instant < at.instants; ++instant) {
    for (const std::size_t end = number_at<std::uint32_t>(segment, at.row_end + 4 * instant); row < end; ++row) {
      if (number_at<std::int32_t>(segment, at.tracks + 4 * row) != number(track)) continue;
      course.time.push_back(time_in(segment, instant));
      for (std::size_t axis = 0; axis < at.axes; ++axis)
        course.position[axis].push_back(number_at<float>(segment, at.positions + 4 * (axis * at.rows + row)));
      course.state.push_back(number_at<std::uint8_t>(segment, at.states + row));
    }
  }
}

std::string with_tracks(const std::string& segment, const WireColumns& columns, std::int64_t first,
                        const std::vector<TrackColumns>& tracks) {
  const SegmentLayout from(segment, columns);
  std::vector<Instant> instants = instants_of(segment, from);
  put_tracks(instants, first, tracks);
  std::string bytes = wire_of(instants, number_at<std::uint32_t>(segment, 4), columns);
  const SegmentLayout to(bytes, columns);
  bytes.replace(kPoseCountAt, 4, segment, kPoseCountAt, 4);
  bytes.replace(to.pose_end, 4 * to.instants, segment, from.pose_end, 4 * from.instants);
  bytes.append(segment, from.tracked, from.poses);
  bytes.insert(to.bodies, segment, from.bodies, 32 * from.poses);
  return bytes;
}

std::string with_poses(std::string segment, const WireColumns& columns, std::int64_t first,
                       const std::vector<BodyColumns>& bodies) {
  const SegmentLayout at(segment, columns);
  for (std::size_t instant = 0, pose = 0; instant < at.instants; ++instant) {
    for (const std::size_t end = number_at<std::uint32_t>(segment, at.pose_end + 4 * instant); pose < end; ++pose) {
      const BodyId id{number_at<std::int32_t>(segment, at.bodies + 4 * pose)};
      const auto body = std::ranges::find(bodies, id, &BodyColumns::body);
      const auto row =
          body == bodies.end() ? std::nullopt : body->row_at(static_cast<std::int32_t>(first + static_cast<std::int64_t>(instant)));
      if (!row) continue;
      const std::array<float, kPoseNumbers> numbers = pose_numbers(body->poses()[*row]);
      for (std::size_t part = 0; part < numbers.size(); ++part)
        std::memcpy(segment.data() + at.bodies + 4 * ((1 + part) * at.poses + pose), &numbers[part], sizeof(float));
    }
  }
  return segment;
}

std::int64_t row_count(const std::string& segment) {
  return std::int64_t{number_at<std::uint32_t>(segment, kRowCountAt)} + number_at<std::uint32_t>(segment, kPoseCountAt);
}

double time_in(const std::string& segment, std::size_t instant) {
  return number_at<double>(segment, kHeaderBytes + 8 * instant);
}

}  // namespace marey::viewer
