#include "marey/format/take/take_chunk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

namespace marey::format::take {
namespace {

bool is_number(double value) {
  return std::abs(value) <= std::numeric_limits<float>::max();
}
bool is_number(const std::optional<double>& value) {
  return !value || is_number(*value);
}

bool is_sound(const Outline& outline) {
  const auto known = [](const Vector<2>& pair) { return is_number(pair.x()) && is_number(pair.y()); };
  return outline.order >= 0 && outline.order <= 255 && outline.control_points.size() <= 65535 &&
         std::all_of(outline.control_points.begin(), outline.control_points.end(), known) &&
         std::all_of(outline.deviations.begin(), outline.deviations.end(), known) && known(outline.centre) &&
         known(outline.velocity) && known(outline.centre_deviation) && known(outline.velocity_deviation) &&
         is_number(outline.scale_rate) && is_number(outline.scale_rate_deviation) &&
         (!outline.silhouette || known(*outline.silhouette));
}

bool is_sound(const Keypoints<2>& body) {
  const auto known = [](const auto& matrix) { return (matrix.array().abs() <= std::numeric_limits<float>::max()).all(); };
  return is_number(body.presence) &&
         std::all_of(body.points.begin(), body.points.end(), [&](const std::optional<Keypoint<2>>& point) {
           return !point || (known(point->position) && known(point->covariance) && is_number(point->visibility) &&
                             is_number(point->presence));
         });
}

/// The entry of `key`, found soonest where keys are asked for in growing order.
template <typename Map, typename Make>
typename Map::mapped_type& entry_of(Map& map, typename Map::iterator& hint, const typename Map::key_type& key, const Make& make) {
  if (hint == map.end() || hint->first != key) {
    hint = map.lower_bound(key);
    if (hint == map.end() || hint->first != key) hint = map.emplace_hint(hint, key, make());
  }
  return (hint++)->second;
}

void append_column(const OptionalColumn& from, std::size_t first, OptionalColumn& to) {
  if (from.empty()) return;
  std::vector<bool> known;
  if (!from.all_known(from.size())) {
    for (std::size_t row = 0; row < from.size(); ++row) known.push_back(from.known(row));
  }
  to.add_rows(first, from.values(), known);
}

/// At once where all know the value, as they do mostly.
void set_known(std::span<const ImageObservation> points, std::optional<double> ImageObservation::* value, std::size_t first,
               OptionalColumn& column) {
  const auto knows = [&](const ImageObservation& point) { return (point.*value).has_value(); };
  if (std::all_of(points.begin(), points.end(), knows)) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const ImageObservation& point : points) values.push_back(*(point.*value));
    column.add_rows(first, values, {});
    return;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (knows(points[i])) column.set(first + i, {&*(points[i].*value), 1});
  }
}

std::vector<std::int32_t> moved_by(std::int32_t offset, std::span<const std::int32_t> at) {
  std::vector<std::int32_t> moved(at.begin(), at.end());
  for (std::int32_t& instant : moved) instant += offset;
  return moved;
}

}  // namespace

void ObservedColumns::append(const ObservedColumns& other, std::int32_t offset) {
  append_column(other.sigma, size(), sigma);
  append_column(other.area, size(), area);
  const auto put = [](auto& column, const auto& more) { column.insert(column.end(), more.begin(), more.end()); };
  put(at, moved_by(offset, other.at));
  put(x, other.x);
  put(y, other.y);
  put(track, other.track);
}

void ObservedColumns::add(std::int32_t instant, std::span<const ImageObservation> points) {
  const std::size_t first = at.size(), all = first + points.size();
  at.resize(all, instant);
  x.resize(all);
  y.resize(all);
  track.resize(all);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImageObservation& point = points[i];
    x[first + i] = point.pixel.x();
    y[first + i] = point.pixel.y();
    track[first + i] = point.track ? static_cast<std::uint64_t>(number(*point.track)) : 0;
  }
  set_known(points, &ImageObservation::sigma, first, sigma);
  set_known(points, &ImageObservation::area, first, area);
}

ImageObservation ObservedColumns::point(CameraId camera, std::size_t row) const {
  ImageObservation point{.camera = camera, .pixel = {x[row], y[row]}, .sigma = {}, .area = {}, .track = {}};
  if (sigma.known(row)) point.sigma = *sigma.values(row);
  if (area.known(row)) point.area = *area.values(row);
  if (track[row] != 0) point.track = TrackId{static_cast<int>(track[row])};
  return point;
}

void ObservedColumns::clear() {
  at.clear();
  x.clear();
  y.clear();
  sigma.clear();
  area.clear();
  track.clear();
}

TrackColumns& Chunk::track(TrackId id, int dimensions) {
  return tracks.try_emplace(id, TrackName{.id = id, .label = {}, .team = {}}, dimensions).first->second;
}

void Chunk::add(const Instant& instant, int dimensions, std::optional<TrackId> ball) {
  const auto at = static_cast<std::int32_t>(time_steps.size());
  time_steps.push_back({instant.index, instant.time});
  auto column = tracks.begin();
  for (const Sample& sample : instant.samples) {
    const auto make = [&] {
      return TrackColumns({.id = sample.track, .label = {}, .team = {}}, sample.track == ball ? 3 : dimensions);
    };
    entry_of(tracks, column, sample.track, make).add(at, sample);
    bytes += 28 + (sample.velocity ? 12 : 0) + (sample.covariance ? 24 : 0) + (sample.box ? 32 : 0);
    if (sample.keypoints) bytes += 8 + 29 * sample.keypoints->points.size();
    if (sample.outline) bytes += 64 + 16 * sample.outline->control_points.size();
  }
  for (auto begin = instant.detected.begin(); begin != instant.detected.end();) {
    const auto of_another = [&](const ImageObservation& point) { return point.camera != begin->camera; };
    const auto end = std::find_if(begin, instant.detected.end(), of_another);
    detected[begin->camera].add(at, {begin, end});
    begin = end;
  }
  for (const BodyPose& pose : instant.bodies) bodies.try_emplace(pose.body, pose.body).first->second.add(at, pose);
  bytes += 16 + 32 * instant.detected.size() + 190 * instant.bodies.size();
}

void Chunk::append(const Chunk& other) {
  const auto offset = static_cast<std::int32_t>(time_steps.size());
  time_steps.insert(time_steps.end(), other.time_steps.begin(), other.time_steps.end());
  bytes += other.bytes;
  for (const auto& [id, columns] : other.tracks) {
    if (columns.empty()) continue;
    TrackColumns& to = track(id, columns.dimensions());
    const std::size_t first = to.size();
    const std::vector<std::int32_t> at = moved_by(offset, columns.at());
    to.add_rows({at, columns.x(), columns.y(), columns.z(), columns.provenance(), columns.cameras()});
    for (int i = 0; i < TrackColumns::kOptionals; ++i) {
      const auto which = static_cast<TrackColumns::Optional>(i);
      append_column(columns.column(which), first, to.column(which));
    }
    for (const auto& [row, outline] : columns.outlines()) to.set_outline(first + row, outline);
    for (const auto& [row, body] : columns.keypoints()) to.set_keypoints(first + row, body);
  }
  for (const auto& [camera, columns] : other.detected) detected[camera].append(columns, offset);
  for (const auto& [body, columns] : other.bodies) bodies.try_emplace(body, body).first->second.append(columns, offset);
}

void Chunk::clear() {
  time_steps.clear();
  bytes = 0;
  // Who was not there this time is gone permanently, most likely.
  std::erase_if(tracks, [](const auto& entry) { return entry.second.empty(); });
  for (auto& [id, columns] : tracks) columns.clear();
  for (auto& [camera, columns] : detected) columns.clear();
  bodies.clear();
}

std::optional<std::string> problem_of(const Sample& sample) {
  const auto nowhere = [&] { return fmt::format("track {} is nowhere", number(sample.track)); };
  if (number(sample.track) <= 0) return fmt::format("track {} cannot be; ids are positive", number(sample.track));
  if (!sample.position.allFinite()) return nowhere();
  const auto known = [](const auto& matrix) { return (matrix.array().abs() <= std::numeric_limits<float>::max()).all(); };
  if ((sample.velocity && !known(*sample.velocity)) || (sample.covariance && !known(*sample.covariance))) return nowhere();
  if (!is_number(sample.score) || !is_number(sample.residual_px) || !is_number(sample.residual_m)) return nowhere();
  if (sample.outline && !is_sound(*sample.outline)) return fmt::format("the outline of track {} is nowhere", number(sample.track));
  if (sample.keypoints && !is_sound(*sample.keypoints))
    return fmt::format("a keypoint of track {} is nowhere", number(sample.track));
  if (!sample.box) return std::nullopt;
  const Box& box = *sample.box;
  if (!is_number(box.left) || !is_number(box.top) || !is_number(box.width) || !is_number(box.height)) return nowhere();
  return std::nullopt;
}

bool is_sound(const ImageObservation& point) {
  const int camera = number(point.camera);
  return camera >= 0 && camera <= 63 && point.pixel.allFinite() && is_number(point.sigma) && is_number(point.area) &&
         (!point.track || number(*point.track) > 0);
}

std::optional<std::string> problem_of(const ImageObservation& point) {
  if (is_sound(point)) return std::nullopt;
  const int camera = number(point.camera);
  if (camera < 0 || camera > 63) return fmt::format("camera {} cannot be; a rig has 64 at most", camera);
  return fmt::format("camera {} has seen what no camera sees", camera);
}

std::optional<std::string> problem_of(const BodyPose& pose) {
  if (number(pose.body) <= 0) return fmt::format("body {} cannot be; ids are positive", number(pose.body));
  const auto rigid = [](const Rigid3& motion) {
    const Matrix<3>& rotation = motion.rotation;
    return rotation.allFinite() && motion.translation.allFinite() &&
           (rotation.transpose() * rotation - Matrix<3>::Identity()).norm() < 1e-6;
  };
  const bool known = !pose.covariance || (pose.covariance->array().abs() <= std::numeric_limits<float>::max()).all();
  const bool other =
      !pose.other || (rigid(pose.other->world_from_body) && pose.other->probability >= 0 && pose.other->probability <= 1);
  if (rigid(pose.world_from_body) && known && other && is_number(pose.residual_m)) return std::nullopt;
  return fmt::format("body {} is nowhere", number(pose.body));
}

}  // namespace marey::format::take
