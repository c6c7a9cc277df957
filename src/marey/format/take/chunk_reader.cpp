#include "marey/format/take/chunk_reader.h"

#include <cstring>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/take/chunk_fields.h"
#include "marey/format/take/keypoints_blob.h"
#include "marey/format/take/outline_blob.h"
#include "marey/format/take/take_schema.h"

namespace marey::format::take {
namespace {

constexpr std::int64_t kLastIndex = std::int64_t{1} << 62;
constexpr std::int64_t kOneChunk = std::int64_t{1} << 32;

/// Takes of earlier versions lack columns that were added since.
bool has_column(const Database& database, std::string_view table, std::string_view column) {
  Statement found(database, fmt::format("SELECT count(*) FROM pragma_table_info('{}') WHERE name = '{}'", table, column));
  return found.step() && found.integer(0) == 1;
}

std::string sample_fields(const Database& database) {
  return fmt::format("{}, {}", kSampleFields, has_column(database, "samples", "keypoints") ? "keypoints" : "NULL");
}

std::optional<Matrix<6>> symmetric_6(const OptionalColumn& column, std::size_t row) {
  if (!column.known(row)) return std::nullopt;
  Matrix<6> matrix;
  const double* value = column.values(row);
  for (int i = 0; i < 6; ++i) {
    for (int k = i; k < 6; ++k) matrix(i, k) = matrix(k, i) = *value++;
  }
  return matrix;
}

}  // namespace

ChunkReader::ChunkReader(const Database& database, int dimensions)
    : database_(&database),
      dimensions_(dimensions),
      find_(database, "SELECT id, first_index, last_index, instants FROM chunk WHERE last_index >= ? ORDER BY last_index LIMIT 1"),
      time_steps_(database, "SELECT indices, times FROM chunk WHERE id = ?"),
      samples_(database, fmt::format("SELECT {} FROM samples WHERE id >= ? AND id < ? ORDER BY id", sample_fields(database))),
      detected_(database, "SELECT id, rows, at, x, y, sigma, area, track FROM seen WHERE id >= ? AND id < ? ORDER BY id"),
      one_track_(database, fmt::format("SELECT {} FROM samples WHERE id = ?", sample_fields(database))) {
  Statement columns(database, "SELECT count(*) FROM pragma_table_info('poses') WHERE name IN ('covariance', 'tracked')");
  if (columns.step() && columns.integer(0) == 2)
    poses_.emplace(database, fmt::format("SELECT id, rows, at, pose, residual, covariance, tracked, {} FROM poses WHERE id >= ? "
                                         "AND id < ? ORDER BY id",
                                         has_column(database, "poses", "other") ? "other" : "NULL"));
}

ChunkReader::Row ChunkReader::checked_row(const Statement& row) const {
  const Row result{.id = row.integer(0), .first_index = row.integer(1), .last_index = row.integer(2), .instants = row.integer(3)};
  const bool possible = result.id > 0 && result.id < kMaxChunks && result.first_index >= 0 &&
                        result.last_index >= result.first_index && result.last_index < kLastIndex && result.instants > 0 &&
                        result.instants <= result.last_index - result.first_index + 1 &&
                        result.instants <= std::numeric_limits<std::int32_t>::max();
  if (!possible) throw Error("{}: is damaged (chunk {} cannot be); restore it from a copy", database_->path(), result.id);
  return result;
}

std::vector<ChunkReader::Row> ChunkReader::rows() {
  std::vector<Row> all;
  Statement statement(*database_, "SELECT id, first_index, last_index, instants FROM chunk ORDER BY last_index");
  std::int64_t instants = 0;
  while (statement.step()) {
    const Row row = checked_row(statement);
    instants += row.instants;
    if (instants > std::numeric_limits<std::int32_t>::max() || (!all.empty() && row.first_index <= all.back().last_index))
      throw Error("{}: is damaged (chunk {} overlaps another); restore it from a copy", database_->path(), row.id);
    all.push_back(row);
  }
  return all;
}

std::optional<ChunkReader::Row> ChunkReader::find(std::int64_t index) {
  find_.reset();
  find_.bind(0, index);
  if (!find_.step()) return std::nullopt;
  const Row row = checked_row(find_);
  find_.reset();
  return row;
}

void ChunkReader::read_time_steps(const Row& row, std::vector<Recording::TimeStep>& time_steps) {
  time_steps_.reset();
  time_steps_.bind(0, row.id);
  const std::string where = fmt::format("{}: chunk {}", database_->path(), row.id);
  const auto count = static_cast<std::size_t>(row.instants);
  const ColumnDecoder decoder(count, where);
  if (!time_steps_.step()) decoder.fail("its instants are missing");
  const auto times = time_steps_.blob(1), indices = time_steps_.blob(0);
  if (times.size() != count * 8) decoder.fail("it has another number of times than of instants");
  if (indices.empty() && row.last_index - row.first_index + 1 != row.instants) decoder.fail("its indices are missing");
  if (!indices.empty() && indices.size() != count * 4) decoder.fail("it has another number of indices than of instants");
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t time = 0;
    std::memcpy(&time, times.data() + 8 * i, 8);
    std::uint32_t index = static_cast<std::uint32_t>(i);
    if (!indices.empty()) std::memcpy(&index, indices.data() + 4 * i, 4);
    time_steps.push_back({row.first_index + index, Timestamp(Duration(time))});
    if (i > 0 && time_steps.back().index <= time_steps[time_steps.size() - 2].index) decoder.fail("its instants are out of order");
  }
  if (time_steps.back().index != row.last_index) decoder.fail("its instants do not end where it says");
  time_steps_.reset();
}

void ChunkReader::read(const Row& row, bool with_seen, Chunk& chunk) {
  const auto offset = static_cast<std::int64_t>(chunk.time_steps.size());
  read_time_steps(row, chunk.time_steps);
  samples_.reset();
  samples_.bind(0, row_id(row.id, 1));
  samples_.bind(1, row_id(row.id, 0) + kOneChunk);
  while (samples_.step()) {
    const std::int64_t track = samples_.integer(sample_id) & 0xffffffff;
    if (track > std::numeric_limits<int>::max()) throw Error("{}: is damaged (a track's id is {})", database_->path(), track);
    const int dimensions = samples_.blob(sample_z).empty() ? dimensions_ : 3;  // the ball on the ground has heights
    decode_samples(samples_, row, offset, chunk.track(TrackId{static_cast<int>(track)}, dimensions));
  }
  samples_.reset();
  if (poses_) read_poses(row, offset, chunk.bodies);
  if (!with_seen) return;
  detected_.reset();
  detected_.bind(0, row_id(row.id, 0));
  detected_.bind(1, row_id(row.id, 0) + kOneChunk);
  while (detected_.step()) {
    const std::int64_t camera = detected_.integer(observed_id) & 0xffffffff;
    if (camera > 63) throw Error("{}: is damaged (a camera's number is {})", database_->path(), camera);
    decode_observed(detected_, row, offset, chunk.detected[CameraId{static_cast<int>(camera)}]);
  }
  detected_.reset();
}

bool ChunkReader::read_track(const Row& row, std::int64_t offset, TrackColumns& track) {
  one_track_.reset();
  one_track_.bind(0, row_id(row.id, number(track.id())));
  const bool there = one_track_.step();
  if (there) decode_samples(one_track_, row, offset, track);
  one_track_.reset();
  return there;
}

void ChunkReader::read_poses(const Row& row, std::int64_t offset, std::map<BodyId, BodyColumns>& bodies) {
  poses_->reset();
  poses_->bind(0, row_id(row.id, 1));
  poses_->bind(1, row_id(row.id, 0) + kOneChunk);
  while (poses_->step()) {
    const std::int64_t body = poses_->integer(poses_id) & 0xffffffff;
    if (body > std::numeric_limits<int>::max()) throw Error("{}: is damaged (a body's id is {})", database_->path(), body);
    const BodyId id{static_cast<int>(body)};
    decode_poses(row, offset, bodies.try_emplace(id, id).first->second);
  }
  poses_->reset();
}

void ChunkReader::decode_poses(const Row& chunk, std::int64_t offset, BodyColumns& body) {
  const std::string where = fmt::format("{}: chunk {}, body {}", database_->path(), chunk.id, number(body.body()));
  ColumnDecoder decoder(checked_count(poses_->integer(poses_rows)), where);
  const std::span<const std::byte> blob = poses_->blob(poses_pose);
  if (blob.size() != decoder.rows() * 12 * sizeof(double)) decoder.fail("it has another number of poses than of rows");
  decode_positions(*poses_, poses_at, chunk, offset, decoder);
  OptionalColumn covariance(21), residual(1), other(13);
  decoder.optional(poses_->blob(poses_residual), 0, residual);
  decoder.optional(poses_->blob(poses_covariance), 0, covariance);
  decoder.optional(poses_->blob(poses_other), 0, other);
  if (poses_->is_number(poses_tracked)) {
    integers_.assign(decoder.rows(), static_cast<std::uint64_t>(poses_->integer(poses_tracked)));
  } else {
    decoder.integers(poses_->blob(poses_tracked), integers_);
  }
  std::vector<double> numbers(blob.size() / sizeof(double));
  std::memcpy(numbers.data(), blob.data(), blob.size());
  for (std::size_t row = 0; row < decoder.rows(); ++row) {
    BodyPose pose{.body = body.body(), .world_from_body = {}, .covariance = {}, .residual_m = {}, .tracked = integers_[row] != 0};
    pose.world_from_body = geometry::rigid_from_rows(numbers.data() + 12 * row);
    pose.covariance = symmetric_6(covariance, row);
    if (other.known(row)) pose.other = {geometry::rigid_from_rows(other.values(row)), other.values(row)[12]};
    if (residual.known(row)) pose.residual_m = *residual.values(row);
    if (problem_of(pose)) decoder.fail("it is nowhere");
    body.add(at_[row], pose);
  }
}

std::size_t ChunkReader::checked_count(std::int64_t count) const {
  if (count <= 0 || count > std::numeric_limits<std::int32_t>::max())
    throw Error("{}: is damaged (a row of {} rows); restore it from a copy", database_->path(), count);
  return static_cast<std::size_t>(count);
}

void ChunkReader::decode_positions(const Statement& row, int column, const Row& chunk, std::int64_t offset,
                                   ColumnDecoder& decoder) {
  const auto end = static_cast<std::size_t>(chunk.instants);
  if (row.is_number(column)) {
    const std::int64_t first = row.integer(column);
    if (first < 0 || first >= chunk.instants || decoder.rows() > end - static_cast<std::size_t>(first))
      decoder.fail("rows lie beyond the chunk");
    at_.resize(decoder.rows());
    for (std::size_t i = 0; i < at_.size(); ++i) at_[i] = static_cast<std::int32_t>(first + static_cast<std::int64_t>(i));
  } else {
    decoder.locations(row.blob(column), end, column == observed_at && &row == &detected_, at_);
  }
  for (std::int32_t& location : at_) location = static_cast<std::int32_t>(location + offset);
}

void ChunkReader::decode_samples(const Statement& row, const Row& chunk, std::int64_t offset, TrackColumns& track) {
  const std::string where = fmt::format("{}: chunk {}, track {}", database_->path(), chunk.id, number(track.id()));
  ColumnDecoder decoder(checked_count(row.integer(sample_rows)), where);
  decoder.numbers(row.blob(sample_x), x_);  // first, as it holds that there are this many rows
  decoder.numbers(row.blob(sample_y), y_);
  decode_positions(row, sample_at, chunk, offset, decoder);
  z_.clear();
  if (track.dimensions() == 3 && (dimensions_ == 3 || !row.blob(sample_z).empty())) decoder.numbers(row.blob(sample_z), z_);
  if (track.dimensions() == 3 && z_.empty()) z_.assign(decoder.rows(), 0);  // a ball on the ground without heights
  if (row.is_number(sample_provenance)) {
    integers_.assign(decoder.rows(), static_cast<std::uint64_t>(row.integer(sample_provenance)));
  } else {
    decoder.integers(row.blob(sample_provenance), integers_);
  }
  provenance_.clear();
  for (const std::uint64_t value : integers_) {
    if (value > static_cast<std::uint64_t>(Provenance::solved)) decoder.fail("a provenance cannot be");
    provenance_.push_back(static_cast<Provenance>(value));
  }
  if (row.is_number(sample_cameras)) {
    integers_.assign(decoder.rows(), static_cast<std::uint64_t>(row.integer(sample_cameras)));
  } else {
    decoder.integers(row.blob(sample_cameras), integers_);
  }
  const std::size_t first = track.size();
  track.add_rows({.at = at_, .x = x_, .y = y_, .z = z_, .provenance = provenance_, .cameras = integers_});
  int field = sample_first_optional;
  for (const auto& [column, exactly] : kOptionalFields) decoder.optional(row.blob(field++), first, track.column(column));
  decode_outlines(row.blob(sample_outline), decoder, first, track);
  decode_keypoints(row.blob(sample_keypoints), decoder, first, track);
}

void ChunkReader::decode_observed(const Statement& row, const Row& chunk, std::int64_t offset, ObservedColumns& detected) {
  const std::string where = fmt::format("{}: chunk {}, what was seen", database_->path(), chunk.id);
  ColumnDecoder decoder(checked_count(row.integer(observed_rows)), where);
  decoder.numbers(row.blob(observed_x), x_);  // first, as it holds that there are this many rows
  decoder.numbers(row.blob(observed_y), y_);
  decode_positions(row, observed_at, chunk, offset, decoder);
  if (row.is_number(observed_track)) {
    integers_.assign(decoder.rows(), static_cast<std::uint64_t>(row.integer(observed_track)));
  } else {
    decoder.integers(row.blob(observed_track), integers_);
  }
  for (const std::uint64_t track : integers_) {
    if (track > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) decoder.fail("a track cannot be");
  }
  const std::size_t first = detected.size();
  const auto put = [](auto& column, const auto& more) { column.insert(column.end(), more.begin(), more.end()); };
  put(detected.at, at_);
  put(detected.x, x_);
  put(detected.y, y_);
  put(detected.track, integers_);
  decoder.optional(row.blob(observed_sigma), first, detected.sigma);
  decoder.optional(row.blob(observed_area), first, detected.area);
}

}  // namespace marey::format::take
