#include "marey/stream/natnet_packets.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

#include "marey/stream/bytes.h"

namespace marey::stream {
namespace {

constexpr std::size_t kMaxPayload = 65'503;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::int32_t kMarkerSetKind = 0, kBodyKind = 1, kSkeletonKind = 2;

// Flags of a labelled marker.
constexpr std::int16_t kOccluded = 1, kPointCloud = 2, kModelFilled = 4, kUnlabelled = 16;

/// From z up to y up.
Vector<3> y_up(const Vector<3>& at) {
  return {at.x(), at.z(), -at.y()};
}

void put_position(LittleBytes& bytes, const Vector<3>& at) {
  const Vector<3> rotated = y_up(at);
  for (int i = 0; i < 3; ++i) bytes.put<float>(static_cast<float>(rotated[i]));
}

void put_unknown(LittleBytes& bytes, int count) {
  for (int i = 0; i < count; ++i) bytes.put<float>(kUnknown);
}

/// A section: how many there are, and how many bytes they take, which is known only behind them.
class Section {
 public:
  Section(LittleBytes& bytes, std::size_t count) : bytes_(bytes) {
    bytes_.put<std::int32_t>(static_cast<std::int32_t>(count)).put<std::int32_t>(0);
    begin_ = bytes_.size();
  }
  ~Section() { bytes_.set<std::int32_t>(begin_ - 4, static_cast<std::int32_t>(bytes_.size() - begin_)); }
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;

 private:
  LittleBytes& bytes_;
  std::size_t begin_;
};

void put_pose(LittleBytes& bytes, std::int32_t id, const Rigid3* pose, double error, bool tracked) {
  bytes.put<std::int32_t>(id);
  if (pose == nullptr) {
    put_unknown(bytes, 7);
  } else {
    put_position(bytes, pose->translation);
    const Eigen::Quaterniond turn(pose->rotation);
    const Vector<3> axis = y_up(turn.vec());
    for (int i = 0; i < 3; ++i) bytes.put<float>(static_cast<float>(axis[i]));
    bytes.put<float>(static_cast<float>(turn.w()));
  }
  bytes.put<float>(static_cast<float>(error)).put<std::int16_t>(static_cast<std::int16_t>(tracked ? 1 : 0));
}

void put_body(LittleBytes& bytes, std::int32_t id, const BodyPose* pose) {
  put_pose(bytes, id, pose == nullptr ? nullptr : &pose->world_from_body, pose == nullptr ? kUnknown : pose->residual_m.value_or(0),
           pose != nullptr && pose->tracked);
}

void put_marker_set(LittleBytes& bytes, const ChannelLayout& channel_layout, const ChannelLayout::Scene& scene) {
  const Section section(bytes, channel_layout.labels().empty() ? 0 : 1);
  if (channel_layout.labels().empty()) return;
  bytes.text(kNatNetMarkerSet).put<std::int32_t>(static_cast<std::int32_t>(scene.labelled.size()));
  for (const Sample* sample : scene.labelled) {
    if (sample == nullptr) {
      put_unknown(bytes, 3);
    } else {
      put_position(bytes, sample->position);
    }
  }
}

void put_skeletons_natnet(LittleBytes& bytes, const ChannelLayout& channel_layout, const Instant& instant) {
  const Section section(bytes, channel_layout.skeletons().size());
  std::int32_t id = 0;
  for (const Skeleton& skeleton : channel_layout.skeletons()) {
    bytes.put<std::int32_t>(++id).put<std::int32_t>(static_cast<std::int32_t>(skeleton.segments.size()));
    std::int32_t bone = 0;
    for (const Body& segment : skeleton.segments) {
      ++bone;
      const BodyPose* pose = pose_of(instant, segment.id);
      const BodyPose* parent = segment.parent ? pose_of(instant, *segment.parent) : nullptr;
      if (pose != nullptr && parent != nullptr) {  // bones stream in their parents' frames
        const Rigid3 local = in_parent(*parent, *pose);
        put_pose(bytes, id << 16 | bone, &local, pose->residual_m.value_or(0), pose->tracked);
      } else {
        put_body(bytes, id << 16 | bone, pose);
      }
    }
  }
}

void put_marker(LittleBytes& bytes, std::int32_t id, const Sample& sample, std::int16_t flags) {
  if (sample.provenance == Provenance::predicted) flags |= kOccluded;
  if (sample.provenance == Provenance::filled || sample.provenance == Provenance::solved) flags |= kModelFilled;
  if (sample.measured()) flags |= kPointCloud;
  bytes.put<std::int32_t>(id);
  put_position(bytes, sample.position);
  bytes.put<float>(0).put<std::int16_t>(flags).put<float>(static_cast<float>(sample.residual_m.value_or(0)));
}

/// A labelled one's number is its place in the marker set, from 1; another's is its track's.
void put_markers(LittleBytes& bytes, const ChannelLayout::Scene& scene) {
  const auto detected =
      std::count_if(scene.labelled.begin(), scene.labelled.end(), [](const Sample* each) { return each != nullptr; });
  const Section section(bytes, static_cast<std::size_t>(detected) + scene.others.size());
  for (std::size_t i = 0; i < scene.labelled.size(); ++i) {
    if (scene.labelled[i] != nullptr) put_marker(bytes, static_cast<std::int32_t>(i + 1) & 0xffff, *scene.labelled[i], 0);
  }
  for (const Sample* sample : scene.others) put_marker(bytes, number(sample->track) & 0xffff, *sample, kUnlabelled);
}

void put_suffix(LittleBytes& bytes, const Instant& instant, const FrameTimes& times) {
  bytes.put<std::uint32_t>(0).put<std::uint32_t>(0).put<double>(seconds(instant.time));
  for (const std::int64_t ns : {times.capture, times.solve, times.send}) bytes.put<std::uint64_t>(static_cast<std::uint64_t>(ns));
  bytes.put<std::uint32_t>(0).put<std::uint32_t>(0);  // precision time
  bytes.put<std::int16_t>(0).put<std::int32_t>(0);    // flags, end of data
}

/// A body's definition, with what its markers are called.
void put_definition(LittleBytes& bytes, const std::string& name, std::int32_t id, std::int32_t parent, const Body& body) {
  bytes.text(name).put<std::int32_t>(id).put<std::int32_t>(parent);
  put_position(bytes, body.offset);
  bytes.put<std::int32_t>(static_cast<std::int32_t>(body.markers.size()));
  for (const BodyMarker& marker : body.markers) put_position(bytes, marker.position);
  for (std::size_t i = 0; i < body.markers.size(); ++i) bytes.put<std::int32_t>(static_cast<std::int32_t>(i + 1));
  for (const BodyMarker& marker : body.markers) bytes.text(marker.label);
}

void put_skeleton_definition(LittleBytes& bytes, const Skeleton& skeleton, std::int32_t id) {
  const Section section(bytes, kSkeletonKind);
  bytes.text(skeleton.name).put<std::int32_t>(id).put<std::int32_t>(static_cast<std::int32_t>(skeleton.segments.size()));
  std::int32_t bone = 0;
  for (const Body& segment : skeleton.segments) {
    const auto parent = std::find_if(skeleton.segments.begin(), skeleton.segments.end(),
                                     [&](const Body& each) { return segment.parent && each.id == *segment.parent; });
    const auto above = parent == skeleton.segments.end() ? 0 : static_cast<std::int32_t>(parent - skeleton.segments.begin() + 1);
    put_definition(bytes, segment.label, ++bone, above, segment);
  }
}

}  // namespace

std::string natnet_message(NatNetMessage message, std::string_view payload) {
  if (payload.size() > kMaxPayload) return {};
  LittleBytes bytes;
  bytes.put<std::uint16_t>(static_cast<std::uint16_t>(message)).put<std::uint16_t>(static_cast<std::uint16_t>(payload.size()));
  bytes.raw(payload);
  return std::move(bytes).str();
}

std::optional<NatNetReceived> natnet_received(std::string_view datagram) {
  const auto id = number_at<std::uint16_t>(datagram, 0);
  const auto size = number_at<std::uint16_t>(datagram, 2);
  if (!id || !size) return std::nullopt;
  // Some say 0 bytes and carry one, some vice versa: what came is what counts.
  return NatNetReceived{.message = static_cast<NatNetMessage>(*id), .payload = datagram.substr(4)};
}

std::string natnet_server_info(std::uint16_t data_port, std::optional<std::uint32_t> group) {
  LittleBytes bytes;
  std::string name = "Marey";
  name.resize(256);
  bytes.raw(name);
  for (const int part : {3, 1, 0, 0}) bytes.put<std::uint8_t>(static_cast<std::uint8_t>(part));  // as the program of that time
  for (const int part : {4, 1, 0, 0}) bytes.put<std::uint8_t>(static_cast<std::uint8_t>(part));  // NatNet
  bytes.put<std::uint64_t>(1'000'000'000).put<std::uint16_t>(data_port);
  bytes.put<std::uint8_t>(static_cast<std::uint8_t>(group ? 1 : 0));
  const std::uint32_t address = group.value_or(0);
  for (int i = 3; i >= 0; --i) bytes.put<std::uint8_t>(static_cast<std::uint8_t>(address >> 8 * i & 255));
  return natnet_message(NatNetMessage::server_info, bytes.str());
}

std::string natnet_response(std::string_view request) {
  request = request.substr(0, request.find('\0'));
  if (request.starts_with("Bitstream")) {
    LittleBytes text;
    text.text("Bitstream,4.1");
    return natnet_message(NatNetMessage::response, text.str());
  }
  LittleBytes zero;
  zero.put<std::int32_t>(0);
  return natnet_message(NatNetMessage::response, zero.str());
}

std::string natnet_definitions(const ChannelLayout& channel_layout) {
  LittleBytes bytes;
  const std::size_t sets = channel_layout.labels().empty() ? 0 : 1;
  bytes.put<std::int32_t>(static_cast<std::int32_t>(sets + channel_layout.bodies().size() + channel_layout.skeletons().size()));
  if (sets > 0) {
    const Section section(bytes, kMarkerSetKind);
    bytes.text(kNatNetMarkerSet).put<std::int32_t>(static_cast<std::int32_t>(channel_layout.labels().size()));
    for (const std::string& label : channel_layout.labels()) bytes.text(label);
  }
  for (const Body& body : channel_layout.bodies()) {
    const Section section(bytes, kBodyKind);
    put_definition(bytes, body.label, number(body.id), -1, body);
  }
  std::int32_t id = 0;
  for (const Skeleton& skeleton : channel_layout.skeletons()) put_skeleton_definition(bytes, skeleton, ++id);
  return natnet_message(NatNetMessage::definitions, bytes.str());
}

std::string natnet_frame(const ChannelLayout& channel_layout, const ChannelLayout::Scene& scene, const Instant& instant,
                         const FrameTimes& times) {
  LittleBytes bytes;
  bytes.put<std::int32_t>(static_cast<std::int32_t>(instant.index));
  put_marker_set(bytes, channel_layout, scene);
  {
    const Section unlabelled(bytes, scene.others.size());
    for (const Sample* sample : scene.others) put_position(bytes, sample->position);
  }
  {
    const Section bodies(bytes, channel_layout.bodies().size());
    for (const Body& body : channel_layout.bodies()) put_body(bytes, number(body.id), pose_of(instant, body.id));
  }
  put_skeletons_natnet(bytes, channel_layout, instant);
  {
    const Section assets(bytes, 0);
  }
  put_markers(bytes, scene);
  {
    const Section force_plates(bytes, 0);
  }
  {
    const Section devices(bytes, 0);
  }
  put_suffix(bytes, instant, times);
  return natnet_message(NatNetMessage::frame, bytes.str());
}

}  // namespace marey::stream
