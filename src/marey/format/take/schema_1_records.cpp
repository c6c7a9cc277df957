#include "marey/format/take/schema_1_records.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "marey/core/error.h"

namespace marey::format::take {
namespace {

static_assert(std::endian::native == std::endian::little, "records are copied as they lie in memory");

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

Sample sample_of(const PointRecord& record) {
  Sample point;
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

std::vector<SeenPoint> seen_of_schema_1(std::span<const std::byte> blob, std::string_view where) {
  std::vector<SeenPoint> points(record_count<ObservationRecord>(blob, where));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto record = record_at<ObservationRecord>(blob, i);
    if (!is_sound(record)) throw Error("{}: is damaged (observation {} holds what no camera sees)", where, i);
    SeenPoint& point = points[i];
    point.camera = CameraId(record.camera);
    point.pixel = {record.x, record.y};
    if (record.sigma != 0) point.sigma = record.sigma;
    if (record.area != 0) point.area = record.area;
    if (record.track > 0) point.track = TrackId(record.track);
  }
  return points;
}

std::vector<Sample> samples_of_schema_1(std::span<const std::byte> blob, std::string_view where) {
  std::vector<Sample> samples(record_count<PointRecord>(blob, where));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto record = record_at<PointRecord>(blob, i);
    if (!is_sound(record)) throw Error("{}: is damaged (point {} is nowhere)", where, i);
    samples[i] = sample_of(record);
  }
  return samples;
}

}  // namespace marey::format::take
