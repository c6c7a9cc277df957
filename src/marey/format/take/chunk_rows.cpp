#include "marey/format/take/chunk_rows.h"

#include <array>
#include <cstring>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/take/outline_blob.h"
#include "marey/format/take/take_schema.h"

namespace marey::format::take {
namespace {

using Optional = TrackColumns::Optional;

/// In the order of the table's columns; boxes are kept exactly, as positions are.
struct OptionalField {
  Optional column;
  bool exactly;
};
constexpr std::array<OptionalField, TrackColumns::kOptionals> kOptionalFields{{{Optional::velocity, false},
                                                                               {Optional::covariance, false},
                                                                               {Optional::score, false},
                                                                               {Optional::box, true},
                                                                               {Optional::residual_px, false},
                                                                               {Optional::residual_m, false}}};
enum SampleField {
  id,
  row_count,
  at,
  x,
  y,
  z,
  provenance,
  cameras,
  first_optional,
  outline = first_optional + TrackColumns::kOptionals
};
enum PosesField { poses_id, poses_rows, poses_at, poses_pose, poses_residual, poses_covariance, poses_tracked };
enum SeenField { seen_id, seen_rows, seen_at, seen_x, seen_y, seen_sigma, seen_area, seen_track };

constexpr const char* kSampleFields =
    "id, rows, at, x, y, z, provenance, cameras, velocity, covariance, score, box, residual_px, residual_m, outline";

constexpr std::int64_t kLastIndex = std::int64_t{1} << 62;
constexpr std::int64_t kOneChunk = std::int64_t{1} << 32;

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

std::optional<Matrix<6>> symmetric_6(const OptionalColumn& column, std::size_t row) {
  if (!column.known(row)) return std::nullopt;
  Matrix<6> matrix;
  const double* value = column.values(row);
  for (int i = 0; i < 6; ++i) {
    for (int k = i; k < 6; ++k) matrix(i, k) = matrix(k, i) = *value++;
  }
  return matrix;
}

bool consecutive(std::span<const std::int32_t> places) {
  return !places.empty() && static_cast<std::size_t>(places.back() - places.front()) + 1 == places.size();
}

}  // namespace

ChunkWriter::ChunkWriter(const Database& database)
    : add_instants_(database, "INSERT INTO chunk VALUES (?, ?, ?, ?, ?, ?)"),
      add_samples_(database, "INSERT INTO samples VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      add_seen_(database, "INSERT INTO seen VALUES (?, ?, ?, ?, ?, ?, ?, ?)"),
      add_poses_(database, "INSERT INTO poses VALUES (?, ?, ?, ?, ?, ?, ?)"),
      remove_instants_(database, "DELETE FROM chunk WHERE id = ?"),
      remove_samples_(database, "DELETE FROM samples WHERE id >= ? AND id < ?"),
      remove_seen_(database, "DELETE FROM seen WHERE id >= ? AND id < ?"),
      remove_poses_(database, "DELETE FROM poses WHERE id >= ? AND id < ?"),
      blobs_(outline + 1) {}

void ChunkWriter::write(std::int64_t chunk_id, const Chunk& chunk) {
  write_instants(chunk_id, chunk);
  for (const auto& [track, columns] : chunk.tracks) {
    if (!columns.empty()) write_samples(row_id(chunk_id, number(track)), columns);
  }
  for (const auto& [camera, columns] : chunk.seen) {
    if (columns.size() > 0) write_seen(row_id(chunk_id, number(camera)), columns);
  }
  for (const auto& [body, columns] : chunk.bodies) {
    if (!columns.empty()) write_poses(row_id(chunk_id, number(body)), columns);
  }
}

void ChunkWriter::write_instants(std::int64_t chunk_id, const Chunk& chunk) {
  const std::int64_t first = chunk.moments.front().index, last = chunk.moments.back().index;
  std::vector<std::int64_t> times;
  std::vector<std::uint32_t> indices;
  for (const Recording::Moment& moment : chunk.moments) {
    times.push_back(moment.time.time_since_epoch().count());
    indices.push_back(static_cast<std::uint32_t>(moment.index - first));
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
  to.bind(id, row);
  to.bind(row_count, static_cast<std::int64_t>(track.size()));
  if (consecutive(track.at())) {
    to.bind(at, std::int64_t{track.at().front()});
  } else {
    to.bind(at, std::as_bytes(track.at()));
  }
  encode_exactly(track.x(), blobs_[x]);
  encode_exactly(track.y(), blobs_[y]);
  encode_exactly(track.z(), blobs_[z]);
  to.bind(x, std::span<const std::byte>(blobs_[x]));
  to.bind(y, std::span<const std::byte>(blobs_[y]));
  bind_or_null(to, z, blobs_[z]);
  integers_.clear();
  for (const Provenance each : track.provenance()) integers_.push_back(static_cast<std::uint64_t>(each));
  bind_integers(to, provenance, integers_, blobs_[provenance]);
  bind_integers(to, cameras, track.cameras(), blobs_[cameras]);
  int field = first_optional;
  for (const auto& [column, exactly] : kOptionalFields) {
    Bytes& blob = blobs_[static_cast<std::size_t>(field)];
    encode(track.column(column), track.size(), exactly, blob);
    bind_or_null(to, field++, blob);
  }
  encode_outlines(track, blobs_[outline]);
  bind_or_null(to, outline, blobs_[outline]);
  to.run();
}

void ChunkWriter::write_seen(std::int64_t row, const SeenColumns& seen) {
  Statement& to = add_seen_;
  to.bind(seen_id, row);
  to.bind(seen_rows, static_cast<std::int64_t>(seen.size()));
  to.bind(seen_at, std::as_bytes(std::span(seen.at)));
  encode_exactly(seen.x, blobs_[seen_x]);
  encode_exactly(seen.y, blobs_[seen_y]);
  encode(seen.sigma, seen.size(), false, blobs_[seen_sigma]);
  encode(seen.area, seen.size(), false, blobs_[seen_area]);
  to.bind(seen_x, std::span<const std::byte>(blobs_[seen_x]));
  to.bind(seen_y, std::span<const std::byte>(blobs_[seen_y]));
  bind_or_null(to, seen_sigma, blobs_[seen_sigma]);
  bind_or_null(to, seen_area, blobs_[seen_area]);
  bind_integers(to, seen_track, seen.track, blobs_[seen_track]);
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
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) numbers.push_back(pose.rotation(i, k));
      numbers.push_back(pose.translation[i]);
    }
  }
  to.bind(poses_pose, std::as_bytes(std::span<const double>(numbers)));
  encode(body.residual_m(), body.size(), false, blobs_[x]);
  encode(body.covariance(), body.size(), false, blobs_[y]);
  bind_or_null(to, poses_residual, blobs_[x]);
  bind_or_null(to, poses_covariance, blobs_[y]);
  integers_.assign(body.tracked().begin(), body.tracked().end());
  bind_integers(to, poses_tracked, integers_, blobs_[z]);
  to.run();
}

void ChunkWriter::remove_instants(std::int64_t chunk_id) {
  remove_instants_.bind(0, chunk_id);
  remove_instants_.run();
}

void ChunkWriter::remove_rows(std::int64_t chunk_id) {
  for (Statement* statement : {&remove_samples_, &remove_seen_, &remove_poses_}) {
    statement->bind(0, row_id(chunk_id, 0));
    statement->bind(1, row_id(chunk_id + 1, 0));
    statement->run();
  }
}

ChunkReader::ChunkReader(const Database& database, int dimensions)
    : database_(&database),
      dimensions_(dimensions),
      find_(database, "SELECT id, first_index, last_index, instants FROM chunk WHERE last_index >= ? ORDER BY last_index LIMIT 1"),
      moments_(database, "SELECT indices, times FROM chunk WHERE id = ?"),
      samples_(database, fmt::format("SELECT {} FROM samples WHERE id >= ? AND id < ? ORDER BY id", kSampleFields)),
      seen_(database, "SELECT id, rows, at, x, y, sigma, area, track FROM seen WHERE id >= ? AND id < ? ORDER BY id"),
      one_track_(database, fmt::format("SELECT {} FROM samples WHERE id = ?", kSampleFields)) {
  Statement columns(database, "SELECT count(*) FROM pragma_table_info('poses') WHERE name IN ('covariance', 'tracked')");
  if (columns.step() && columns.integer(0) == 2)
    poses_.emplace(database,
                   "SELECT id, rows, at, pose, residual, covariance, tracked FROM poses WHERE id >= ? AND id < ? ORDER BY id");
}

ChunkReader::Row ChunkReader::checked_row(const Statement& row) const {
  const Row result{.id = row.integer(0), .first_index = row.integer(1), .last_index = row.integer(2), .instants = row.integer(3)};
  const bool possible = result.id > 0 && result.id < kMostChunks && result.first_index >= 0 &&
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

void ChunkReader::read_moments(const Row& row, std::vector<Recording::Moment>& moments) {
  moments_.reset();
  moments_.bind(0, row.id);
  const std::string where = fmt::format("{}: chunk {}", database_->path(), row.id);
  const auto count = static_cast<std::size_t>(row.instants);
  const ColumnDecoder decoder(count, where);
  if (!moments_.step()) decoder.fail("its instants are missing");
  const auto times = moments_.blob(1), indices = moments_.blob(0);
  if (times.size() != count * 8) decoder.fail("it has another number of times than of instants");
  if (indices.empty() && row.last_index - row.first_index + 1 != row.instants) decoder.fail("its indices are missing");
  if (!indices.empty() && indices.size() != count * 4) decoder.fail("it has another number of indices than of instants");
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t time = 0;
    std::memcpy(&time, times.data() + 8 * i, 8);
    std::uint32_t index = static_cast<std::uint32_t>(i);
    if (!indices.empty()) std::memcpy(&index, indices.data() + 4 * i, 4);
    moments.push_back({row.first_index + index, Timestamp(Duration(time))});
    if (i > 0 && moments.back().index <= moments[moments.size() - 2].index) decoder.fail("its instants are out of order");
  }
  if (moments.back().index != row.last_index) decoder.fail("its instants do not end where it says");
  moments_.reset();
}

void ChunkReader::read(const Row& row, bool with_seen, Chunk& chunk) {
  const auto offset = static_cast<std::int64_t>(chunk.moments.size());
  read_moments(row, chunk.moments);
  samples_.reset();
  samples_.bind(0, row_id(row.id, 1));
  samples_.bind(1, row_id(row.id, 0) + kOneChunk);
  while (samples_.step()) {
    const std::int64_t track = samples_.integer(id) & 0xffffffff;
    if (track > std::numeric_limits<int>::max()) throw Error("{}: is damaged (a track's id is {})", database_->path(), track);
    decode_samples(samples_, row, offset, chunk.track(TrackId{static_cast<int>(track)}, dimensions_));
  }
  samples_.reset();
  if (poses_) read_poses(row, offset, chunk.bodies);
  if (!with_seen) return;
  seen_.reset();
  seen_.bind(0, row_id(row.id, 0));
  seen_.bind(1, row_id(row.id, 0) + kOneChunk);
  while (seen_.step()) {
    const std::int64_t camera = seen_.integer(seen_id) & 0xffffffff;
    if (camera > 63) throw Error("{}: is damaged (a camera's number is {})", database_->path(), camera);
    decode_seen(seen_, row, offset, chunk.seen[CameraId{static_cast<int>(camera)}]);
  }
  seen_.reset();
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
  decode_places(*poses_, poses_at, chunk, offset, decoder);
  OptionalColumn covariance(21), residual(1);
  decoder.optional(poses_->blob(poses_residual), 0, residual);
  decoder.optional(poses_->blob(poses_covariance), 0, covariance);
  if (poses_->is_number(poses_tracked)) {
    integers_.assign(decoder.rows(), static_cast<std::uint64_t>(poses_->integer(poses_tracked)));
  } else {
    decoder.integers(poses_->blob(poses_tracked), integers_);
  }
  std::vector<double> numbers(blob.size() / sizeof(double));
  std::memcpy(numbers.data(), blob.data(), blob.size());
  for (std::size_t row = 0; row < decoder.rows(); ++row) {
    BodyPose pose{.body = body.body(), .world_from_body = {}, .covariance = {}, .residual_m = {}, .tracked = integers_[row] != 0};
    const double* value = numbers.data() + 12 * row;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) pose.world_from_body.rotation(i, k) = *value++;
      pose.world_from_body.translation[i] = *value++;
    }
    pose.covariance = symmetric_6(covariance, row);
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

void ChunkReader::decode_places(const Statement& row, int column, const Row& chunk, std::int64_t offset, ColumnDecoder& decoder) {
  const auto end = static_cast<std::size_t>(chunk.instants);
  if (row.is_number(column)) {
    const std::int64_t first = row.integer(column);
    if (first < 0 || first >= chunk.instants || decoder.rows() > end - static_cast<std::size_t>(first))
      decoder.fail("rows lie beyond the chunk");
    at_.resize(decoder.rows());
    for (std::size_t i = 0; i < at_.size(); ++i) at_[i] = static_cast<std::int32_t>(first + static_cast<std::int64_t>(i));
  } else {
    decoder.places(row.blob(column), end, column == seen_at && &row == &seen_, at_);
  }
  for (std::int32_t& place : at_) place = static_cast<std::int32_t>(place + offset);
}

void ChunkReader::decode_samples(const Statement& row, const Row& chunk, std::int64_t offset, TrackColumns& track) {
  const std::string where = fmt::format("{}: chunk {}, track {}", database_->path(), chunk.id, number(track.id()));
  ColumnDecoder decoder(checked_count(row.integer(row_count)), where);
  decoder.numbers(row.blob(x), x_);  // first, as it holds that there are so many rows
  decoder.numbers(row.blob(y), y_);
  decode_places(row, at, chunk, offset, decoder);
  z_.clear();
  if (dimensions_ == 3) decoder.numbers(row.blob(z), z_);
  if (row.is_number(provenance)) {
    integers_.assign(decoder.rows(), static_cast<std::uint64_t>(row.integer(provenance)));
  } else {
    decoder.integers(row.blob(provenance), integers_);
  }
  provenance_.clear();
  for (const std::uint64_t value : integers_) {
    if (value > static_cast<std::uint64_t>(Provenance::solved)) decoder.fail("a provenance cannot be");
    provenance_.push_back(static_cast<Provenance>(value));
  }
  if (row.is_number(cameras)) {
    integers_.assign(decoder.rows(), static_cast<std::uint64_t>(row.integer(cameras)));
  } else {
    decoder.integers(row.blob(cameras), integers_);
  }
  const std::size_t first = track.size();
  track.add_rows({.at = at_, .x = x_, .y = y_, .z = z_, .provenance = provenance_, .cameras = integers_});
  int field = first_optional;
  for (const auto& [column, exactly] : kOptionalFields) decoder.optional(row.blob(field++), first, track.column(column));
  decode_outlines(row.blob(outline), decoder, first, track);
}

void ChunkReader::decode_seen(const Statement& row, const Row& chunk, std::int64_t offset, SeenColumns& seen) {
  const std::string where = fmt::format("{}: chunk {}, what was seen", database_->path(), chunk.id);
  ColumnDecoder decoder(checked_count(row.integer(seen_rows)), where);
  decoder.numbers(row.blob(seen_x), x_);  // first, as it holds that there are so many rows
  decoder.numbers(row.blob(seen_y), y_);
  decode_places(row, seen_at, chunk, offset, decoder);
  if (row.is_number(seen_track)) {
    integers_.assign(decoder.rows(), static_cast<std::uint64_t>(row.integer(seen_track)));
  } else {
    decoder.integers(row.blob(seen_track), integers_);
  }
  for (const std::uint64_t track : integers_) {
    if (track > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) decoder.fail("a track cannot be");
  }
  const std::size_t first = seen.size();
  const auto put = [](auto& column, const auto& more) { column.insert(column.end(), more.begin(), more.end()); };
  put(seen.at, at_);
  put(seen.x, x_);
  put(seen.y, y_);
  put(seen.track, integers_);
  decoder.optional(row.blob(seen_sigma), first, seen.sigma);
  decoder.optional(row.blob(seen_area), first, seen.area);
}

}  // namespace marey::format::take
