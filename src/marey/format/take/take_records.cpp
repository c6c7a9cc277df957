#include "marey/format/take/take_records.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "marey/core/error.h"

namespace marey::format::take {
namespace {

static_assert(std::endian::native == std::endian::little, "records are copied as they lie in memory");

template <typename Record>
void append(std::vector<std::byte>& blob, const Record& record) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&record);
  blob.insert(blob.end(), bytes, bytes + sizeof(Record));
}

template <typename Record>
std::size_t record_count(std::span<const std::byte> blob, std::string_view where) {
  if (blob.size() % sizeof(Record) != 0) {
    throw Error("{}: is damaged ({} bytes are no whole number of records of {})", where, blob.size(), sizeof(Record));
  }
  return blob.size() / sizeof(Record);
}

template <typename Record>
Record record_at(std::span<const std::byte> blob, std::size_t i) {
  Record record;
  std::memcpy(&record, blob.data() + i * sizeof(Record), sizeof(Record));
  return record;
}

PointRecord record_of(const TakePoint& point) {
  PointRecord record{};
  record.x = point.position.x();
  record.y = point.position.y();
  record.z = point.position.z();
  record.cameras = point.cameras;
  record.track = number(point.track);
  record.provenance = static_cast<std::uint8_t>(point.provenance);
  if (point.covariance) {
    const Matrix<3>& P = *point.covariance;
    record.flags |= PointRecord::has_covariance;
    const double upper[] = {P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2)};
    for (int i = 0; i < 6; ++i) record.covariance[i] = static_cast<float>(upper[i]);
  }
  if (point.residual_px) {
    record.flags |= PointRecord::has_residual_px;
    record.residual_px = static_cast<float>(*point.residual_px);
  }
  if (point.residual_m) {
    record.flags |= PointRecord::has_residual_m;
    record.residual_m = static_cast<float>(*point.residual_m);
  }
  return record;
}

TakePoint point_of(const PointRecord& record) {
  TakePoint point;
  point.track = TrackId(record.track);
  point.position = {record.x, record.y, record.z};
  point.cameras = record.cameras;
  point.provenance = static_cast<Provenance>(record.provenance);
  if ((record.flags & PointRecord::has_covariance) != 0) {
    const float* c = record.covariance;
    point.covariance = Matrix<3>{{c[0], c[1], c[2]}, {c[1], c[3], c[4]}, {c[2], c[4], c[5]}};
  }
  if ((record.flags & PointRecord::has_residual_px) != 0) point.residual_px = record.residual_px;
  if ((record.flags & PointRecord::has_residual_m) != 0) point.residual_m = record.residual_m;
  return point;
}

bool is_sound(const PointRecord& record) {
  for (const float value : record.covariance) {
    if (!std::isfinite(value)) return false;
  }
  return std::isfinite(record.x) && std::isfinite(record.y) && std::isfinite(record.z) && std::isfinite(record.residual_px) &&
         std::isfinite(record.residual_m) && record.provenance <= 2 && record.track > 0;
}

bool is_sound(const ObservationRecord& record) {
  return std::isfinite(record.x) && std::isfinite(record.y) && std::isfinite(record.sigma) && std::isfinite(record.area) &&
         record.camera >= 0 && record.camera < 64 && record.track >= 0;
}

}  // namespace

void append_records(std::vector<std::byte>& blob, std::span<const TakeObservation> observations) {
  for (const TakeObservation& seen : observations) {
    append(blob, ObservationRecord{seen.pixel.x(), seen.pixel.y(), static_cast<float>(seen.sigma), static_cast<float>(seen.area),
                                   number(seen.camera), seen.track ? number(*seen.track) : 0});
  }
}

void append_records(std::vector<std::byte>& blob, std::span<const TakePoint> points) {
  for (const TakePoint& point : points) append(blob, record_of(point));
}

std::vector<TakeObservation> observations_of(std::span<const std::byte> blob, std::string_view where) {
  std::vector<TakeObservation> observations(record_count<ObservationRecord>(blob, where));
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const auto record = record_at<ObservationRecord>(blob, i);
    if (!is_sound(record)) throw Error("{}: is damaged (observation {} holds what no camera sees)", where, i);
    observations[i] = {CameraId(record.camera), {record.x, record.y}, record.sigma, record.area, {}};
    if (record.track > 0) observations[i].track = TrackId(record.track);
  }
  return observations;
}

std::vector<TakePoint> points_of(std::span<const std::byte> blob, std::string_view where) {
  std::vector<TakePoint> points(record_count<PointRecord>(blob, where));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto record = record_at<PointRecord>(blob, i);
    if (!is_sound(record)) throw Error("{}: is damaged (point {} is nowhere)", where, i);
    points[i] = point_of(record);
  }
  return points;
}

}  // namespace marey::format::take
