// VMC, which avatar programs (VSeeFace, Warudo, VRM players, Unreal's VRM4U) receive: a skeleton's bones, and loose bodies as
// trackers. Unity's frame: metres, left-handed, y up, z forward. From Marey's right-handed z up a position (x, y, z) becomes (x, z,
// y), a quaternion (x, y, z, w) becomes (−x, −z, −y, w). Protocol: sh-akira/VirtualMotionCaptureProtocol, V3.1.
#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "marey/stream/osc_message.h"
#include "marey/stream/sender.h"

namespace marey::stream {

namespace {

constexpr std::size_t kMaxVmcBundle = 1472;  // with its heads one Ethernet frame

struct BoneName {
  std::string_view unity;
  std::string_view others;  ///< how motion capture calls it: lower case, blanks between; "?" stands for left and right
};
// Unity's HumanBodyBones as far as bodies of motion capture have them; "left" and "right" are put before them.
constexpr std::array<BoneName, 9> kMiddleBones{{{"Hips", "hips hip pelvis root"},
                                                {"Spine", "spine abdomen torso waist"},
                                                {"Chest", "chest spine1 thorax"},
                                                {"UpperChest", "upperchest spine2 spine3"},
                                                {"Neck", "neck neck1"},
                                                {"Head", "head skull"},
                                                {"Jaw", "jaw"},
                                                {"LeftEye", "lefteye"},
                                                {"RightEye", "righteye"}}};
constexpr std::array<BoneName, 8> kSideBones{{{"Shoulder", "shoulder clavicle collar"},
                                              {"UpperArm", "upperarm arm uarm humerus"},
                                              {"LowerArm", "lowerarm forearm larm farm radius"},
                                              {"Hand", "hand wrist"},
                                              {"UpperLeg", "upperleg upleg thigh uleg femur"},
                                              {"LowerLeg", "lowerleg leg shank shin lleg tibia"},
                                              {"Foot", "foot ankle"},
                                              {"Toes", "toes toe toebase"}}};

bool is_among(std::string_view word, std::string_view words) {
  for (std::size_t at = words.find(word); at != std::string_view::npos; at = words.find(word, at + 1)) {
    const bool begins = at == 0 || words[at - 1] == ' ', ends = at + word.size() == words.size() || words[at + word.size()] == ' ';
    if (begins && ends && !word.empty()) return true;
  }
  return false;
}

/// Unity's name of a segment; empty if it has none there. "LeftUpLeg", "left_thigh", "LThigh" and "thigh_l" are one.
std::string unity_bone(std::string_view label) {
  std::string word;
  for (const char c : label.substr(label.find_last_of(':') == std::string_view::npos ? 0 : label.find_last_of(':') + 1)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (const BoneName& bone : kMiddleBones) {
    if (is_among(word, bone.others)) return std::string(bone.unity);
  }
  for (const auto& [side, marks] : {std::pair{"Left", std::array{"left", "l"}}, std::pair{"Right", std::array{"right", "r"}}}) {
    for (const std::string_view mark : marks) {
      std::string_view rest = word;
      if (rest.starts_with(mark)) {
        rest.remove_prefix(mark.size());
      } else if (rest.ends_with(mark)) {
        rest.remove_suffix(mark.size());
      } else {
        continue;
      }
      for (const BoneName& bone : kSideBones) {
        if (is_among(rest, bone.others)) return side + std::string(bone.unity);
      }
    }
  }
  return {};
}

std::string located(std::string_view address, std::string_view name, const Rigid3& pose) {
  const Vector<3>& at = pose.translation;
  const Eigen::Quaterniond turn(pose.rotation);
  return OscMessage(address).s(name).f(at.x()).f(at.z()).f(at.y()).f(-turn.x()).f(-turn.z()).f(-turn.y()).f(turn.w()).bytes();
}

class VmcProtocol : public UdpProtocol {
 public:
  using UdpProtocol::UdpProtocol;

 protected:
  void start() override {
    bones_.clear();
    if (channel_layout().skeletons().empty()) return;
    for (const Body& segment : channel_layout().skeletons().front().segments) {  // one performer a port
      if (std::string bone = unity_bone(segment.label); !bone.empty())
        bones_.push_back({segment, std::move(bone), parent_bone(segment)});
    }
  }

  void send(const Instant& instant, FrameTimes times) override {
    std::vector<std::string> messages;
    const bool tracked =
        std::any_of(instant.bodies.begin(), instant.bodies.end(), [](const BodyPose& pose) { return pose.tracked; });
    messages.push_back(OscMessage("/VMC/Ext/OK").i(1).i(3).i(0).i(tracked || instant.bodies.empty() ? 1 : 0).bytes());
    messages.push_back(OscMessage("/VMC/Ext/T").f(seconds(instant.time)).bytes());
    // Receivers pass over addresses that they do not know. ms since capture.
    messages.push_back(OscMessage("/marey/latency")
                           .f(1e-6 * static_cast<double>(times.solve - times.capture))
                           .f(1e-6 * static_cast<double>(times.send - times.capture))
                           .bytes());
    put_bones(instant, messages);
    put_trackers(instant, messages);
    put_out(osc_bundles(messages, kMaxVmcBundle));
  }

 private:
  struct Bone {
    Body segment;
    std::string name;
    std::optional<BodyId> parent;  // the nearest above it that is a bone
  };

  std::optional<BodyId> parent_bone(const Body& segment) const {
    const auto parent =
        std::find_if(bones_.begin(), bones_.end(), [&](const Bone& bone) { return bone.segment.id == segment.parent; });
    if (parent != bones_.end()) return parent->segment.id;
    for (const Body& above : channel_layout().skeletons().front().segments) {  // parents come before children
      if (segment.parent && above.id == *segment.parent) return parent_bone(above);
    }
    return std::nullopt;
  }

  void put_bones(const Instant& instant, std::vector<std::string>& messages) const {
    if (bones_.empty()) return;
    messages.push_back(located("/VMC/Ext/Root/Pos", "root", {}));
    for (const Bone& bone : bones_) {
      const BodyPose* pose = pose_of(instant, bone.segment.id);
      const BodyPose* parent = bone.parent ? pose_of(instant, *bone.parent) : nullptr;
      if (pose == nullptr || (bone.parent && parent == nullptr)) continue;
      messages.push_back(
          located("/VMC/Ext/Bone/Pos", bone.name, parent == nullptr ? pose->world_from_body : in_parent(*parent, *pose)));
    }
  }

  /// Bodies; where a recording has none at all, its labelled points, which do not turn.
  void put_trackers(const Instant& instant, std::vector<std::string>& messages) const {
    for (const Body& body : channel_layout().bodies()) {
      const BodyPose* pose = pose_of(instant, body.id);
      if (pose != nullptr && pose->tracked) messages.push_back(located("/VMC/Ext/Tra/Pos", body.label, pose->world_from_body));
    }
    if (!header().bodies.empty()) return;
    for (const Sample& sample : instant.samples) {
      const std::string_view label = channel_layout().label_of(sample.track);
      if (!label.empty()) messages.push_back(located("/VMC/Ext/Tra/Pos", label, {.translation = sample.position}));
    }
  }

  std::vector<Bone> bones_;
};

}  // namespace

StreamProtocol vmc_protocol() {
  return {.name = "vmc",
          .title = "VMC (OSC over UDP)",
          .port = 39'539,
          .listens = false,
          .detail =
              "a skeleton's bones under Unity's names, bodies as trackers (of a recording without bodies its labelled points); "
              "Unity's frame: m, left-handed, y up",
          .open = [](const Target& target, const StreamOptions& options) -> std::unique_ptr<ProtocolSink> {
            return std::make_unique<VmcProtocol>(target, options);
          }};
}

}  // namespace marey::stream
