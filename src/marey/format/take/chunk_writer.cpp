#include "marey/format/take/chunk_writer.h"

#include <limits>
#include <span>

#include "marey/format/take/chunk_fields.h"
#include "marey/format/take/keypoints_blob.h"
#include "marey/format/take/outline_blob.h"
#include "marey/format/take/take_schema.h"

namespace marey::format::take {
namespace {

void bind_or_null(Statement& statement, int parameter, const Bytes& blob) {
  if (blob.empty()) {
    statement.bind_null(parameter);
  } else {
    statement.bind(parameter, std::span<const std::byte>(blob));
  }
}

/// One number where all rows have the same, else a blob.
void bind_integers(Statement& statement, int parameter, std::span<const std::uint64_t> values, Bytes& blob) {
  const auto common = common_value(values);
  if (common && *common <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    statement.bind(parameter, static_cast<std::int64_t>(*common));
  } else {
    encode_integers(values, blob);
    statement.bind(parameter, std::span<const std::byte>(blob));
  }
}

bool consecutive(std::span<const std::int32_t> locations) {
  return !locations.empty() && static_cast<std::size_t>(locations.back() - locations.front()) + 1 == locations.size();
}

}  // namespace

ChunkWriter::ChunkWriter(const Database& database)
    : add_instants_(database, "INSERT INTO chunk VALUES (?, ?, ?, ?, ?, ?)"),
      add_samples_(database, "INSERT INTO samples VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      add_observed_(database, "INSERT INTO seen VALUES (?, ?, ?, ?, ?, ?, ?, ?)"),
      add_poses_(database, "INSERT INTO poses VALUES (?, ?, ?, ?, ?, ?, ?, ?)"),
      remove_instants_(database, "DELETE FROM chunk WHERE id = ?"),
      remove_samples_(database, "DELETE FROM samples WHERE id >= ? AND id < ?"),
      remove_observed_(database, "DELETE FROM seen WHERE id >= ? AND id < ?"),
      remove_poses_(database, "DELETE FROM poses WHERE id >= ? AND id < ?"),
      blobs_(sample_keypoints + 1) {}

void ChunkWriter::write(std::int64_t chunk_id, const Chunk& chunk) {
  write_instants(chunk_id, chunk);
  for (const auto& [track, columns] : chunk.tracks) {
    if (!columns.empty()) write_samples(row_id(chunk_id, number(track)), columns);
  }
  for (const auto& [camera, columns] : chunk.detected) {
    if (columns.size() > 0) write_observed(row_id(chunk_id, number(camera)), columns);
  }
  for (const auto& [body, columns] : chunk.bodies) {
    if (!columns.empty()) write_poses(row_id(chunk_id, number(body)), columns);
  }
}

void ChunkWriter::write_instants(std::int64_t chunk_id, const Chunk& chunk) {
  const std::int64_t first = chunk.time_steps.front().index, last = chunk.time_steps.back().index;
  std::vector<std::int64_t> times;
  std::vector<std::uint32_t> indices;
  for (const Recording::TimeStep& time_step : chunk.time_steps) {
    times.push_back(time_step.time.time_since_epoch().count());
    indices.push_back(static_cast<std::uint32_t>(time_step.index - first));
  }
  const bool all = last - first + 1 == static_cast<std::int64_t>(times.size());
  add_instants_.bind(0, chunk_id);
  add_instants_.bind(1, first);
  add_instants_.bind(2, last);
  add_instants_.bind(3, static_cast<std::int64_t>(times.size()));
  if (all) {
    add_instants_.bind_null(4);
  } else {
    add_instants_.bind(4, std::as_bytes(std::span(indices)));
  }
  add_instants_.bind(5, std::as_bytes(std::span(times)));
  add_instants_.run();
}

void ChunkWriter::write_samples(std::int64_t row, const TrackColumns& track) {
  Statement& to = add_samples_;
  to.bind(sample_id, row);
  to.bind(sample_rows, static_cast<std::int64_t>(track.size()));
  if (consecutive(track.at())) {
    to.bind(sample_at, std::int64_t{track.at().front()});
  } else {
    to.bind(sample_at, std::as_bytes(track.at()));
  }
  encode_exactly(track.x(), blobs_[sample_x]);
  encode_exactly(track.y(), blobs_[sample_y]);
  encode_exactly(track.z(), blobs_[sample_z]);
  to.bind(sample_x, std::span<const std::byte>(blobs_[sample_x]));
  to.bind(sample_y, std::span<const std::byte>(blobs_[sample_y]));
  bind_or_null(to, sample_z, blobs_[sample_z]);
  integers_.clear();
  for (const Provenance each : track.provenance()) integers_.push_back(static_cast<std::uint64_t>(each));
  bind_integers(to, sample_provenance, integers_, blobs_[sample_provenance]);
  bind_integers(to, sample_cameras, track.cameras(), blobs_[sample_cameras]);
  int field = sample_first_optional;
  for (const auto& [column, exactly] : kOptionalFields) {
    Bytes& blob = blobs_[static_cast<std::size_t>(field)];
    encode(track.column(column), track.size(), exactly, blob);
    bind_or_null(to, field++, blob);
  }
  encode_outlines(track, blobs_[sample_outline]);
  bind_or_null(to, sample_outline, blobs_[sample_outline]);
  encode_keypoints(track, blobs_[sample_keypoints]);
  bind_or_null(to, sample_keypoints, blobs_[sample_keypoints]);
  to.run();
}

void ChunkWriter::write_observed(std::int64_t row, const ObservedColumns& detected) {
  Statement& to = add_observed_;
  to.bind(observed_id, row);
  to.bind(observed_rows, static_cast<std::int64_t>(detected.size()));
  to.bind(observed_at, std::as_bytes(std::span(detected.at)));
  encode_exactly(detected.x, blobs_[observed_x]);
  encode_exactly(detected.y, blobs_[observed_y]);
  encode(detected.sigma, detected.size(), false, blobs_[observed_sigma]);
  encode(detected.area, detected.size(), false, blobs_[observed_area]);
  to.bind(observed_x, std::span<const std::byte>(blobs_[observed_x]));
  to.bind(observed_y, std::span<const std::byte>(blobs_[observed_y]));
  bind_or_null(to, observed_sigma, blobs_[observed_sigma]);
  bind_or_null(to, observed_area, blobs_[observed_area]);
  bind_integers(to, observed_track, detected.track, blobs_[observed_track]);
  to.run();
}

void ChunkWriter::write_poses(std::int64_t row, const BodyColumns& body) {
  Statement& to = add_poses_;
  to.bind(poses_id, row);
  to.bind(poses_rows, static_cast<std::int64_t>(body.size()));
  if (consecutive(body.at())) {
    to.bind(poses_at, std::int64_t{body.at().front()});
  } else {
    to.bind(poses_at, std::as_bytes(body.at()));
  }
  std::vector<double> numbers;
  for (const Rigid3& pose : body.poses()) {
    const auto rows = geometry::rows_of(pose);
    numbers.insert(numbers.end(), rows.begin(), rows.end());
  }
  to.bind(poses_pose, std::as_bytes(std::span<const double>(numbers)));
  encode(body.residual_m(), body.size(), false, blobs_[poses_residual]);
  encode(body.covariance(), body.size(), false, blobs_[poses_covariance]);
  bind_or_null(to, poses_residual, blobs_[poses_residual]);
  bind_or_null(to, poses_covariance, blobs_[poses_covariance]);
  encode(body.other(), body.size(), true, blobs_[poses_other]);
  bind_or_null(to, poses_other, blobs_[poses_other]);
  integers_.assign(body.tracked().begin(), body.tracked().end());
  bind_integers(to, poses_tracked, integers_, blobs_[poses_tracked]);
  to.run();
}

void ChunkWriter::remove_instants(std::int64_t chunk_id) {
  remove_instants_.bind(0, chunk_id);
  remove_instants_.run();
}

void ChunkWriter::remove_rows(std::int64_t chunk_id) {
  for (Statement* statement : {&remove_samples_, &remove_observed_, &remove_poses_}) {
    statement->bind(0, row_id(chunk_id, 0));
    statement->bind(1, row_id(chunk_id + 1, 0));
    statement->run();
  }
}

}  // namespace marey::format::take
