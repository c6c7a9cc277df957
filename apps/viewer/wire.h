// What goes to the page in bytes: numbers in columns, so that the page lays arrays over them and copies nothing. Little-endian.
//
// A header of 40 bytes: uint8 kind, uint8 version (1), uint16 flags, uint32 sequence, uint64 capture time (ns, by the recording's
// clock), uint64 send time (ns, by the server's steady clock; 0 in what is stored), then four uint32.
//
// Kinds 1 (a chunk of a recording; sequence is its first instant's place, from 0) and 2 (one live instant; sequence counts them).
// The four are the numbers of instants n, rows r, poses p, and of keypoints of a row k. Then the columns
//   float64 time[n] (s);  uint32 index[n], row_end[n], pose_end[n];  int32 track[r];  float32 x[r], y[r], with flag 1 z[r];
//   with flag 2 float32 left[r], top[r], width[r], height[r];  with flag 4 uint32 cameras[r] (who saw it, a bit each: the first 32
//   of them);  with flag 8 float32 sigma[r] (standard deviation of the position along an axis, m; NaN where unknown);
//   int32 body[p];  float32 px[p], py[p], pz[p], qx[p], qy[p], qz[p], qw[p];
//   float32 keypoint x[r * k], y[r * k] (px, row by row);
//   uint8 state[r]: provenance (0 measured, 1 filled, 2 predicted, 3 solved), and 8 where the row has a box;
//   uint8 keypoint confidence[r * k] (visibility times presence, of 255; 0: the keypoint is absent);  uint8 tracked[p].
//
// Kind 3 is a camera's image; sequence is its frame. The four are camera, the numbers of points n and of boxes b, and
// width | height << 16 of the camera's images (px; 0 where unknown). Then float32 x[n], y[n], int32 track[n] (0: of no track),
// float32 left[b], top[b], width[b], height[b], int32 track[b], all px of the camera; the rest is a JPEG, or nothing if there is
// no image.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <opencv2/core/types.hpp>

#include "marey/core/instant.h"
#include "marey/core/recording.h"

namespace marey::viewer {

/// Which optional columns a recording's chunks have.
struct WireColumns {
  bool z = false;
  bool boxes = false;
  bool cameras = false;
  bool sigma = false;
  std::size_t keypoints = 0;  ///< of a row
};
/// Those of a recording with this header.
WireColumns wire_columns(const RecordingHeader& header);

/// A pose as the columns px to qw have it.
inline constexpr std::size_t kPoseNumbers = 7;
std::array<float, kPoseNumbers> pose_numbers(const Rigid3& world_from_body);

/// Kind 1.
std::string wire_of(std::span<const Instant> instants, std::uint32_t first, const WireColumns& columns);
/// Kind 2.
std::string wire_of(const Instant& instant, std::uint32_t sequence, const WireColumns& columns, std::uint64_t sent_ns);

/// What is drawn over a camera's image.
struct ProtocolImage {
  CameraId camera{};
  std::int64_t frame = 0;
  Timestamp time{};
  std::uint64_t sent_ns = 0;
  cv::Size size;                               ///< px, of the camera's images
  std::span<const ImageObservation> detected;  ///< those of other cameras are skipped
  std::span<const BoxInView> boxes;            ///< likewise
  std::string_view jpeg;
};
/// Kind 3.
std::string wire_of(const ProtocolImage& image);

}  // namespace marey::viewer
