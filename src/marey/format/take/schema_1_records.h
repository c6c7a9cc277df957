#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "marey/core/instant.h"

namespace marey::format::take {

// How a frame lay in takes of schema 1: fixed records, little-endian, one behind the other. Such takes are read, and no longer
// written.

struct ObservationRecord {
  double x, y;  // px
  float sigma;  // px; 0: unknown
  float area;   // px²; 0: unknown
  std::int32_t camera;
  std::int32_t track;  // 0: nobody's
};
static_assert(sizeof(ObservationRecord) == 32);

struct PointRecord {
  enum Flags : std::uint8_t { has_covariance = 1, has_residual_px = 2, has_residual_m = 4 };

  double x, y, z;  // m
  std::uint64_t cameras;
  float covariance[6];  // m²: xx xy xz yy yz zz
  float residual_px, residual_m;
  std::int32_t track;
  std::uint8_t provenance;  // 0 measured, 1 filled, 2 predicted
  std::uint8_t flags;
  std::uint16_t reserved;  // 0
};
static_assert(sizeof(PointRecord) == 72);

/// Throw Error, `where: what is wrong`, for a blob that is none of ours.
std::vector<SeenPoint> seen_of_schema_1(std::span<const std::byte> blob, std::string_view where);
std::vector<Sample> samples_of_schema_1(std::span<const std::byte> blob, std::string_view where);

}  // namespace marey::format::take
