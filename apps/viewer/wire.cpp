#include "wire.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include <Eigen/Geometry>

namespace marey::viewer {
namespace {

static_assert(std::endian::native == std::endian::little, "columns are written as they lie in memory");

constexpr std::uint16_t kHasZ = 1, kHasBoxes = 2, kHasCameras = 4, kHasSigma = 8;
constexpr std::uint8_t kRowHasBox = 8;

class ByteWriter {
 public:
  template <typename T>
  void number(std::type_identity_t<T> value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  /// A column of what `value` gives of each.
  template <typename T, typename Range, typename Value>
  void column(const Range& range, Value&& value) {
    for (const auto& each : range) number<T>(static_cast<T>(value(each)));
  }
  void text(std::string_view text) { bytes_.append(text); }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

struct WireHeader {
  std::uint8_t kind = 0;
  std::uint16_t flags = 0;
  std::uint32_t sequence = 0;
  Timestamp time{};
  std::uint64_t sent_ns = 0;
  std::array<std::uint32_t, 4> counts{};
};

void write_header(ByteWriter& out, const WireHeader& header) {
  out.number<std::uint8_t>(header.kind);
  out.number<std::uint8_t>(1);
  out.number<std::uint16_t>(header.flags);
  out.number<std::uint32_t>(header.sequence);
  out.number<std::uint64_t>(static_cast<std::uint64_t>(header.time.time_since_epoch().count()));
  out.number<std::uint64_t>(header.sent_ns);
  for (const std::uint32_t count : header.counts) out.number<std::uint32_t>(count);
}

/// A column over all rows, or all poses, of all instants.
template <typename T, typename Items, typename Value>
void write_column(ByteWriter& out, std::span<const Instant> instants, Items Instant::* items, Value&& value) {
  for (const Instant& instant : instants) out.column<T>(instant.*items, value);
}

void write_rows(ByteWriter& out, std::span<const Instant> instants, const WireColumns& columns) {
  const auto rows = &Instant::samples;
  write_column<std::int32_t>(out, instants, rows, [](const Sample& row) { return number(row.track); });
  for (int axis = 0; axis < (columns.z ? 3 : 2); ++axis)
    write_column<float>(out, instants, rows, [axis](const Sample& row) { return row.position[axis]; });
  if (columns.boxes) {
    for (double Box::* part : {&Box::left, &Box::top, &Box::width, &Box::height})
      write_column<float>(out, instants, rows, [part](const Sample& row) { return row.box ? (*row.box).*part : 0; });
  }
  if (columns.cameras) write_column<std::uint32_t>(out, instants, rows, [](const Sample& row) { return row.cameras; });
  if (columns.sigma) {
    write_column<float>(out, instants, rows, [](const Sample& row) {
      return row.covariance ? std::sqrt(row.covariance->trace() / 3) : std::numeric_limits<double>::quiet_NaN();
    });
  }
}

/// `value` of each of a row's keypoints; 0 where it has none.
template <typename T, typename Value>
void write_keypoints(ByteWriter& out, std::span<const Instant> instants, std::size_t count, Value&& value) {
  for (const Instant& instant : instants) {
    for (const Sample& row : instant.samples) {
      for (std::size_t i = 0; i < count; ++i) {
        const bool known = row.keypoints && i < row.keypoints->points.size() && row.keypoints->points[i];
        out.number<T>(known ? static_cast<T>(value(*row.keypoints->points[i])) : T{0});
      }
    }
  }
}

/// At least 1: 0 is a keypoint that is absent.
double confidence_byte(const Keypoint<2>& point) {
  return std::clamp(std::round(255 * point.visibility * point.presence), 1.0, 255.0);
}

void write_poses(ByteWriter& out, std::span<const Instant> instants) {
  const auto poses = &Instant::bodies;
  write_column<std::int32_t>(out, instants, poses, [](const BodyPose& pose) { return number(pose.body); });
  for (std::size_t part = 0; part < kPoseNumbers; ++part)
    write_column<float>(out, instants, poses, [part](const BodyPose& pose) { return pose_numbers(pose.world_from_body)[part]; });
}

std::string columns_of(std::span<const Instant> instants, WireHeader header, const WireColumns& columns) {
  std::uint32_t rows = 0, poses = 0;
  std::vector<std::uint32_t> row_end, pose_end;
  for (const Instant& instant : instants) {
    row_end.push_back(rows += static_cast<std::uint32_t>(instant.samples.size()));
    pose_end.push_back(poses += static_cast<std::uint32_t>(instant.bodies.size()));
  }
  header.flags = static_cast<std::uint16_t>((columns.z ? kHasZ : 0) | (columns.boxes ? kHasBoxes : 0) |
                                            (columns.cameras ? kHasCameras : 0) | (columns.sigma ? kHasSigma : 0));
  header.counts = {static_cast<std::uint32_t>(instants.size()), rows, poses, static_cast<std::uint32_t>(columns.keypoints)};
  ByteWriter out;
  out.reserve(40 + 20 * instants.size() + rows * (41 + 9 * columns.keypoints) + poses * std::size_t{33});
  write_header(out, header);
  out.column<double>(instants, [](const Instant& instant) { return seconds(instant.time); });
  out.column<std::uint32_t>(instants, [](const Instant& instant) { return instant.index; });
  for (const std::uint32_t end : row_end) out.number<std::uint32_t>(end);
  for (const std::uint32_t end : pose_end) out.number<std::uint32_t>(end);
  write_rows(out, instants, columns);
  write_poses(out, instants);
  for (int axis = 0; axis < 2; ++axis)
    write_keypoints<float>(out, instants, columns.keypoints, [axis](const Keypoint<2>& point) { return point.position[axis]; });
  write_column<std::uint8_t>(out, instants, &Instant::samples, [&](const Sample& row) {
    return static_cast<std::uint8_t>(row.provenance) | (columns.boxes && row.box ? kRowHasBox : 0);
  });
  write_keypoints<std::uint8_t>(out, instants, columns.keypoints, confidence_byte);
  write_column<std::uint8_t>(out, instants, &Instant::bodies, [](const BodyPose& pose) { return pose.tracked ? 1 : 0; });
  return out.take();
}

template <typename Item>
std::vector<Item> of_camera(std::span<const Item> items, CameraId camera) {
  std::vector<Item> own;
  std::copy_if(items.begin(), items.end(), std::back_inserter(own), [&](const Item& item) { return item.camera == camera; });
  return own;
}

}  // namespace

std::array<float, kPoseNumbers> pose_numbers(const Rigid3& world_from_body) {
  std::array<float, kPoseNumbers> numbers{};
  Eigen::Map<Eigen::Vector3f>(numbers.data()) = world_from_body.translation.cast<float>();
  Eigen::Map<Eigen::Vector4f>(numbers.data() + 3) =
      Eigen::Quaterniond(world_from_body.rotation).coeffs().cast<float>();  // x, y, z, w
  return numbers;
}

WireColumns wire_columns(const RecordingHeader& header) {
  const bool space = header.frame.dimensions() == 3;
  return {.z = space,
          .boxes = header.frame.kind == FrameOfReference::Kind::image,
          .cameras = space && header.rig && !header.rig->cameras.empty(),
          .sigma = space && header.track_kind == TrackKind::keypoint,
          .keypoints = header.keypoints ? header.keypoints->points.size() : 0};
}

std::string wire_of(std::span<const Instant> instants, std::uint32_t first, const WireColumns& columns) {
  const Timestamp time = instants.empty() ? Timestamp{} : instants.front().time;
  return columns_of(instants, {.kind = 1, .flags = 0, .sequence = first, .time = time, .sent_ns = 0, .counts = {}}, columns);
}

std::string wire_of(const Instant& instant, std::uint32_t sequence, const WireColumns& columns, std::uint64_t sent_ns) {
  return columns_of({&instant, 1},
                    {.kind = 2, .flags = 0, .sequence = sequence, .time = instant.time, .sent_ns = sent_ns, .counts = {}}, columns);
}

std::string wire_of(const ProtocolImage& image) {
  const std::vector<ImageObservation> detected = of_camera(image.detected, image.camera);
  const std::vector<BoxInView> boxes = of_camera(image.boxes, image.camera);
  const std::uint32_t size = static_cast<std::uint32_t>(image.size.width) | static_cast<std::uint32_t>(image.size.height) << 16;
  ByteWriter out;
  write_header(out, {.kind = 3,
                     .flags = 0,
                     .sequence = static_cast<std::uint32_t>(image.frame),
                     .time = image.time,
                     .sent_ns = image.sent_ns,
                     .counts = {static_cast<std::uint32_t>(number(image.camera)), static_cast<std::uint32_t>(detected.size()),
                                static_cast<std::uint32_t>(boxes.size()), size}});
  for (int axis = 0; axis < 2; ++axis)
    out.column<float>(detected, [axis](const ImageObservation& point) { return point.pixel[axis]; });
  out.column<std::int32_t>(detected, [](const ImageObservation& point) { return point.track ? number(*point.track) : 0; });
  for (double Box::* part : {&Box::left, &Box::top, &Box::width, &Box::height})
    out.column<float>(boxes, [part](const BoxInView& box) { return box.box.*part; });
  out.column<std::int32_t>(boxes, [](const BoxInView& box) { return number(box.track); });
  out.text(image.jpeg);
  return out.take();
}

}  // namespace marey::viewer
