#include "marey/format/mcap/foxglove_messages.h"

#include <algorithm>
#include <array>
#include <bit>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "marey/files/text_safety.h"
#include "marey/format/mcap/foxglove_schemas.h"
#include "marey/format/mcap/protobuf.h"

namespace marey::format::mcap {
namespace {

constexpr std::string_view kWorld = "world";
constexpr double kMarkerSize = 0.015, kPersonSize = 0.6;  // m, as drawn
constexpr std::string_view kTimesSchema =
    R"({"type":"object","properties":{"frame":{"type":"integer"},"time":{"type":"number"},"capture_ns":{"type":"integer"},)"
    R"("solve_ns":{"type":"integer"},"send_ns":{"type":"integer"}}})";

ProtobufWriter stamp_of(std::int64_t ns) {
  ProtobufWriter stamp;
  stamp.varint(1, static_cast<std::uint64_t>(ns / 1'000'000'000)).varint(2, static_cast<std::uint64_t>(ns % 1'000'000'000));
  return stamp;
}

ProtobufWriter vector_of(const Vector<3>& value) {
  return ProtobufWriter().real(1, value.x()).real(2, value.y()).real(3, value.z());
}

ProtobufWriter quaternion_of(const Matrix<3>& rotation) {
  const Eigen::Quaterniond turn(rotation);
  return ProtobufWriter().real(1, turn.x()).real(2, turn.y()).real(3, turn.z()).real(4, turn.w());
}

ProtobufWriter pose_message(const Vector<3>& at, const Matrix<3>& rotation = Matrix<3>::Identity()) {
  return ProtobufWriter().message(1, vector_of(at)).message(2, quaternion_of(rotation));
}

ProtobufWriter colour_message(const std::array<double, 4>& colour) {
  return ProtobufWriter().real(1, colour[0]).real(2, colour[1]).real(3, colour[2]).real(4, colour[3]);
}

std::string frame_of(const Body& body) {
  return plain_text(body.skeleton.empty() ? body.label : body.skeleton + "/" + body.label);
}

const BodyPose* pose_at(const Instant& instant, BodyId body) {
  const auto found =
      std::find_if(instant.bodies.begin(), instant.bodies.end(), [&](const BodyPose& pose) { return pose.body == body; });
  return found == instant.bodies.end() ? nullptr : &*found;
}

/// A colour that is a track's own, or one that stands for its number.
std::array<double, 4> colour_of(const TrackName* name, TrackId track, bool measured) {
  std::array<double, 4> colour{0.2, 0.7, 1, measured ? 1.0 : 0.4};
  if (name != nullptr && name->colour) {
    for (std::size_t i = 0; i < 3; ++i) colour[i] = (*name->colour)[i] / 255.0;
  } else {
    constexpr std::array<std::array<double, 3>, 6> kColours{
        {{0.2, 0.7, 1}, {1, 0.6, 0.1}, {0.4, 0.9, 0.3}, {1, 0.4, 0.5}, {0.8, 0.5, 1}, {0.95, 0.9, 0.3}}};
    const auto& own = kColours[static_cast<std::size_t>(number(track)) % kColours.size()];
    std::copy(own.begin(), own.end(), colour.begin());
  }
  return colour;
}

std::string label_shown(const TrackName* name) {
  if (name == nullptr || name->label.empty()) return {};
  return plain_text(name->team.empty() ? name->label : name->team + " " + name->label);
}

void append_little(std::string& data, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) data += static_cast<char>(value >> 8 * i & 255);
}

std::string times_json(const Instant& instant, const MessageTimes& times) {
  std::string text = fmt::format(R"({{"frame":{},"time":{:.9f})", instant.index, seconds(instant.time));
  if (times.capture) text += fmt::format(R"(,"capture_ns":{})", *times.capture);
  if (times.solve) text += fmt::format(R"(,"solve_ns":{})", *times.solve);
  if (times.send) text += fmt::format(R"(,"send_ns":{})", *times.send);
  return text + "}";
}

}  // namespace

const std::vector<Topic>& topics() {
  static const std::vector<Topic> all = {
      {"/marey/points", "protobuf", "foxglove.PointCloud", "protobuf", foxglove_descriptors()},
      {"/tf", "protobuf", "foxglove.FrameTransforms", "protobuf", foxglove_descriptors()},
      {"/marey/scene", "protobuf", "foxglove.SceneUpdate", "protobuf", foxglove_descriptors()},
      {"/marey/times", "json", "marey.Times", "jsonschema", std::string(kTimesSchema)},
  };
  return all;
}

void FoxgloveMessages::begin(const RecordingHeader& header) {
  header_ = header;
  names_.clear();
}

void FoxgloveMessages::add(const std::vector<TrackName>& names) {
  for (const TrackName& name : names) names_[number(name.id)] = name;
}

std::string FoxgloveMessages::message(std::size_t topic, const Instant& instant, const MessageTimes& times) const {
  switch (topic) {
    case kPointsTopic:
      return points(instant, times);
    case kTransformsTopic:
      return transforms(instant, times);
    case kSceneTopic:
      return scene(instant, times);
    default:
      return times_json(instant, times);
  }
}

/// x, y, z as 32-bit floats and the track's number.
std::string FoxgloveMessages::points(const Instant& instant, const MessageTimes& times) const {
  constexpr std::uint64_t kFloat32 = 7, kUint32 = 5;
  ProtobufWriter cloud;
  cloud.message(1, stamp_of(times.stamp)).bytes(2, kWorld).message(3, pose_message(Vector<3>::Zero())).fixed32(4, 16);
  std::uint32_t offset = 0;
  for (const std::string_view name : {"x", "y", "z", "id"}) {
    cloud.message(5, ProtobufWriter().bytes(1, name).fixed32(2, offset).varint(3, name == "id" ? kUint32 : kFloat32));
    offset += 4;
  }
  std::string data;
  data.reserve(16 * instant.samples.size());
  for (const Sample& sample : instant.samples) {
    for (int i = 0; i < 3; ++i) append_little(data, std::bit_cast<std::uint32_t>(static_cast<float>(sample.position[i])));
    append_little(data, static_cast<std::uint32_t>(number(sample.track)));
  }
  return std::move(cloud.bytes(6, data)).str();
}

std::string FoxgloveMessages::transforms(const Instant& instant, const MessageTimes& times) const {
  ProtobufWriter all;
  const ProtobufWriter stamp = stamp_of(times.stamp);
  for (const Body& body : header_.bodies) {
    const BodyPose* pose = pose_at(instant, body.id);
    if (pose == nullptr) continue;
    all.message(1, ProtobufWriter()
                       .message(1, stamp)
                       .bytes(2, kWorld)
                       .bytes(3, frame_of(body))
                       .message(4, vector_of(pose->world_from_body.translation))
                       .message(5, quaternion_of(pose->world_from_body.rotation)));
  }
  return std::move(all).str();
}

/// One entity: spheres with names, and a skeleton's bones as lines.
std::string FoxgloveMessages::scene(const Instant& instant, const MessageTimes& times) const {
  const double size = header_.frame.dimensions() == 3 ? kMarkerSize : kPersonSize;
  ProtobufWriter entity;
  entity.message(1, stamp_of(times.stamp)).bytes(2, kWorld).bytes(3, "points");
  for (const Sample& sample : instant.samples) {
    const auto known = names_.find(number(sample.track));
    const TrackName* name = known == names_.end() ? nullptr : &known->second;
    entity.message(9, ProtobufWriter()
                          .message(1, pose_message(sample.position))
                          .message(2, vector_of(Vector<3>::Constant(size)))
                          .message(3, colour_message(colour_of(name, sample.track, sample.measured()))));
  }
  ProtobufWriter bones;
  bones.varint(1, 2).message(2, pose_message(Vector<3>::Zero())).real(3, kMarkerSize);
  bool any = false;
  for (const Body& body : header_.bodies) {
    const BodyPose* pose = pose_at(instant, body.id);
    const BodyPose* parent = body.parent ? pose_at(instant, *body.parent) : nullptr;
    if (pose == nullptr || parent == nullptr) continue;
    bones.message(5, vector_of(parent->world_from_body.translation)).message(5, vector_of(pose->world_from_body.translation));
    any = true;
  }
  if (any) entity.message(11, bones.message(6, colour_message({1, 1, 1, 0.8})));
  for (const Sample& sample : instant.samples) {
    const auto known = names_.find(number(sample.track));
    const std::string label = label_shown(known == names_.end() ? nullptr : &known->second);
    if (label.empty()) continue;
    entity.message(13, ProtobufWriter()
                           .message(1, pose_message(sample.position + Vector<3>(0, 0, size)))
                           .varint(2, 1)
                           .real(3, 2 * size)
                           .message(5, colour_message({1, 1, 1, 1}))
                           .bytes(6, label));
  }
  return std::move(ProtobufWriter().message(2, entity)).str();
}

}  // namespace marey::format::mcap
