// A bone's frame may be any that is fixed in it: one turned by C has poses world_from_body · C, and its children's offsets and its
// own end are Cᵀ times what they were. C is chosen so that the skeleton, when nothing is turned, stands in the program's rest pose
// and faces −y with z up (+z with y up), as the characters of all these programs do; joints stay where they are. Sources: Mixamo's
// and MotionBuilder's names from their FBX files; Unreal's from the mannequin; VRM 1.0, humanoid; Rokoko Studio's BVH export;
// Rigify's human metarig of Blender 4.5 (its pose too).
#include "marey/format/skeleton/rig_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/format/skeleton/gltf.h"

namespace marey::format::skeleton {
namespace {

constexpr std::array<RigScheme, 6> kSchemes{{
    {.name = "mixamo", .title = "Mixamo"},
    {.name = "unreal", .title = "Unreal's mannequin and MetaHuman", .arms = ArmsAtRest::lowered, .up = UpAxis::z, .root = "root"},
    {.name = "vrm", .title = "VRM", .unit_m = 1, .order = "YXZ"},
    {.name = "rokoko", .title = "Rokoko Studio", .order = "YXZ"},
    {.name = "rigify", .title = "Blender's Rigify", .arms = ArmsAtRest::metarig, .unit_m = 1, .up = UpAxis::z},
    {.name = "motionbuilder", .title = "MotionBuilder"},
}};

/// A bone of the human body. "?" stands for the side: Left or left, L or l, as the scheme writes it.
struct HumanBone {
  std::string_view marey;
  std::string_view others;                ///< how OpenSim and motion capture call it: lower case, without separators
  std::array<std::string_view, 5> names;  ///< mixamo's, unreal's, vrm's, rokoko's, rigify's; MotionBuilder's are Mixamo's
};
constexpr std::array<HumanBone, 13> kBones{{
    {"pelvis", "pelvis hips hip", {"Hips", "pelvis", "hips", "Hips", "spine"}},
    {"trunk", "trunk torso spine abdomen", {"Spine", "spine_01", "spine", "Spine1", "spine.001"}},
    {"chest", "chest thorax spine1", {"Spine1", "spine_02", "chest", "Spine2", "spine.002"}},
    {"neck", "neck", {"Neck", "neck_01", "neck", "Neck", "spine.004"}},
    {"head", "head", {"Head", "head", "head", "Head", "spine.006"}},
    {"?_thigh", "thigh femur upleg upperleg hip", {"?UpLeg", "thigh_?", "?UpperLeg", "?Thigh", "thigh.?"}},
    {"?_shank", "shank tibia leg lowerleg shin knee", {"?Leg", "calf_?", "?LowerLeg", "?Shin", "shin.?"}},
    {"?_foot", "foot talus ankle", {"?Foot", "foot_?", "?Foot", "?Foot", "foot.?"}},
    {"?_toes", "toes toe toebase", {"?ToeBase", "ball_?", "?Toes", "?Toe", "toe.?"}},
    {"?_clavicle", "clavicle shoulder collar", {"?Shoulder", "clavicle_?", "?Shoulder", "?Shoulder", "shoulder.?"}},
    {"?_upper_arm", "upperarm humerus arm uarm", {"?Arm", "upperarm_?", "?UpperArm", "?Arm", "upper_arm.?"}},
    {"?_forearm", "forearm ulna lowerarm elbow larm", {"?ForeArm", "lowerarm_?", "?LowerArm", "?ForeArm", "forearm.?"}},
    {"?_hand", "hand wrist", {"?Hand", "hand_?", "?Hand", "?Hand", "hand.?"}},
}};

enum class Flank { middle, left, right };

struct KnownBone {
  const HumanBone* bone = nullptr;
  Flank side = Flank::middle;
};

bool holds_word(std::string_view words, std::string_view word) {
  const std::string padded = fmt::format(" {} ", words);
  return !word.empty() && padded.find(fmt::format(" {} ", word)) != std::string::npos;
}

std::string bare(std::string_view label) {
  std::string word;
  for (const char c : label.substr(label.find_last_of(':') == std::string_view::npos ? 0 : label.find_last_of(':') + 1)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return word;
}

/// Nothing for a bone that is not of the human body.
std::optional<KnownBone> known_bone(std::string_view label) {
  const std::string word = bare(label);
  const auto among = [](std::string_view name, bool sided) -> const HumanBone* {
    const auto found = std::ranges::find_if(
        kBones, [&](const HumanBone& bone) { return bone.marey.starts_with('?') == sided && holds_word(bone.others, name); });
    return found == kBones.end() ? nullptr : &*found;
  };
  if (const HumanBone* const bone = among(word, false)) return KnownBone{bone, Flank::middle};
  for (const auto& [flank, marks] :
       {std::pair{Flank::left, std::array{"left", "l"}}, std::pair{Flank::right, std::array{"right", "r"}}}) {
    for (const std::string_view mark : marks) {
      std::string_view rest = word;
      if (rest.starts_with(mark)) {
        if (const HumanBone* const bone = among(rest.substr(mark.size()), true)) return KnownBone{bone, flank};
      }
      if (rest.ends_with(mark)) {
        if (const HumanBone* const bone = among(rest.substr(0, rest.size() - mark.size()), true)) return KnownBone{bone, flank};
      }
    }
  }
  return std::nullopt;
}

std::string side_word(const RigScheme& scheme, Flank side) {
  const bool left = side == Flank::left;
  if (scheme.name == "unreal") return left ? "l" : "r";
  if (scheme.name == "rigify") return left ? "L" : "R";
  if (scheme.name == "vrm") return left ? "left" : "right";
  return left ? "Left" : "Right";
}

/// Where bones have the names of the joints that they begin at (Xsens MVN, Poser), a shoulder is an upper arm: the collar is by
/// itself.
void name_shoulders(std::vector<Body>& bodies, const std::string& skeleton) {
  const auto has = [&](std::string_view word) {
    return std::ranges::any_of(bodies,
                               [&](const Body& body) { return body.skeleton == skeleton && bare(body.label).ends_with(word); });
  };
  if (!has("collar") || !has("elbow")) return;
  for (Body& body : bodies) {
    const std::string word = bare(body.label);
    if (body.skeleton == skeleton && word.ends_with("shoulder")) body.label = word.substr(0, word.find("shoulder")) + "_upper_arm";
  }
}

/// Where a bone of the arm points at rest, in axes x to the left, y backwards, z up; nothing: as it is.
std::optional<Vector<3>> arm_direction(const RigScheme& scheme, const HumanBone& bone) {
  const bool upper = bone.marey == "?_upper_arm", lower = bone.marey == "?_forearm" || bone.marey == "?_hand";
  if (!upper && !lower) return std::nullopt;
  if (scheme.arms == ArmsAtRest::sideways) return Vector<3>(1, 0, 0);
  if (scheme.arms == ArmsAtRest::lowered) return Vector<3>(std::numbers::sqrt2 / 2, 0, -std::numbers::sqrt2 / 2);
  return Vector<3>(upper ? Vector<3>(0.2471, 0.0618, -0.1355) : Vector<3>(0.2170, -0.0393, -0.1430)).normalized();
}

Vector<3> nearest_axis(const Vector<3>& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return Vector<3>::Unit(axis) * (direction[axis] < 0 ? -1 : 1);
}

/// One skeleton's bones turned into the scheme's rest pose.
class RestPose {
 public:
  RestPose(const std::vector<Body>& bodies, const std::string& skeleton, const RigScheme& scheme, const std::string& path)
      : bodies_(bodies), scheme_(scheme) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].skeleton == skeleton) bones_.push_back(i);
    }
    upright_ = upright_axes(path, skeleton);
    for (const std::size_t i : bones_) rotations_[bodies[i].id] = own_turn(bodies[i]);
  }

  /// body_from_named of each bone.
  const std::map<BodyId, Matrix<3>>& rotations() const { return rotations_; }

 private:
  const Body* bone_named(std::string_view marey, Flank side) const {
    for (const std::size_t i : bones_) {
      const auto known = known_bone(bodies_[i].label);
      if (known && known->bone->marey == marey && known->side == side) return &bodies_[i];
    }
    return nullptr;
  }

  /// Columns: to the left, backwards, up, in the bodies' axes at rest.
  Matrix<3> upright_axes(const std::string& path, const std::string& skeleton) const {
    const Body* const left = bone_named("?_thigh", Flank::left);
    const Body* const right = bone_named("?_thigh", Flank::right);
    const Body* const shank = bone_named("?_shank", Flank::left);
    if (left == nullptr || right == nullptr || shank == nullptr || left->parent != right->parent)
      throw Error(
          "{}: the skeleton {} has no two thighs and a left shank by their names, by which its left and its up are known; "
          "--rig-names is "
          "for human skeletons",
          path, skeleton);
    const Vector<3> up = nearest_axis(-shank->offset), to_left = nearest_axis(left->offset - right->offset);
    if (std::abs(up.dot(to_left)) > 0.5)
      throw Error("{}: the legs of the skeleton {} hang sideways at rest; --rig-names is for skeletons that stand", path, skeleton);
    Matrix<3> axes;
    axes << to_left, up.cross(to_left), up;
    return axes;
  }

  /// Where the bone goes: to what hangs on it, else to its end.
  std::optional<Vector<3>> direction_of(const Body& body) const {
    for (const std::size_t i : bones_) {
      if (bodies_[i].parent == body.id && bodies_[i].offset.norm() > 1e-3) return bodies_[i].offset.normalized();
    }
    if (body.end && body.end->norm() > 1e-3) return body.end->normalized();
    return std::nullopt;
  }

  /// Of the bone that it hangs on.
  Matrix<3> turn_above(const Body& body) const {
    const auto parent = body.parent ? rotations_.find(*body.parent) : rotations_.end();
    return parent == rotations_.end() ? upright_ : parent->second;
  }

  Matrix<3> own_turn(const Body& body) const {
    const auto known = known_bone(body.label);
    if (!known) return turn_above(body);
    auto wanted = arm_direction(scheme_, *known->bone);
    if (!wanted) return upright_;
    if (known->side == Flank::right) wanted->x() *= -1;
    const auto direction = direction_of(body);
    if (!direction) return turn_above(body);
    const Vector<3> is = upright_.transpose() * *direction;
    return upright_ * Eigen::Quaterniond::FromTwoVectors(is, *wanted).toRotationMatrix().transpose();
  }

  const std::vector<Body>& bodies_;
  const RigScheme& scheme_;
  std::vector<std::size_t> bones_;
  Matrix<3> upright_;
  std::map<BodyId, Matrix<3>> rotations_;
};

class NamedSink final : public Sink {
 public:
  NamedSink(std::unique_ptr<Sink> inner, const RigScheme& scheme) : inner_(std::move(inner)), scheme_(scheme) {}

  std::string name() const override { return inner_->name(); }

  SinkRequirements begin(const RecordingHeader& header) override {
    RecordingHeader named = header;
    std::vector<std::string> skeletons;
    for (const Body& body : header.bodies) {
      if (!body.skeleton.empty() && std::ranges::find(skeletons, body.skeleton) == skeletons.end())
        skeletons.push_back(body.skeleton);
    }
    for (const std::string& skeleton : skeletons) name_shoulders(named.bodies, skeleton);
    for (const std::string& skeleton : skeletons)
      rotations_.merge(std::map(RestPose(named.bodies, skeleton, scheme_, name()).rotations()));
    for (Body& body : named.bodies) turn(body);
    for (const std::string& skeleton : skeletons) rename(skeleton, named.bodies);
    if (!scheme_.root.empty()) add_roots(skeletons, named.bodies);
    return inner_->begin(named);
  }

  void write(const Instant& instant) override {
    Instant named = instant;
    for (BodyPose& pose : named.bodies) {
      if (const auto turn = rotations_.find(pose.body); turn != rotations_.end()) pose.world_from_body.rotation *= turn->second;
    }
    for (const BodyId root : roots_)
      named.bodies.insert(named.bodies.begin(), BodyPose{.body = root, .world_from_body = {}, .covariance = {}, .residual_m = {}});
    inner_->write(named);
  }

  void finish() override { inner_->finish(); }

 private:
  void turn(Body& body) const {
    const auto own = rotations_.find(body.id);
    if (own == rotations_.end()) return;
    const Matrix<3> named_from_body = own->second.transpose();
    if (body.end) body.end = named_from_body * *body.end;
    for (BodyMarker& marker : body.markers) marker.position = named_from_body * marker.position;
    if (body.parent) {
      if (const auto parent = rotations_.find(*body.parent); parent != rotations_.end())
        body.offset = parent->second.transpose() * body.offset;
    }
  }

  /// A chest is the trunk where there is no other one. A name that another bone of the skeleton has already is not given again.
  void rename(const std::string& skeleton, std::vector<Body>& bodies) const {
    const auto is_bone = [&](const Body& body, std::string_view bone) {
      const auto known = known_bone(body.label);
      return body.skeleton == skeleton && known && known->bone->marey == bone;
    };
    const bool has_trunk = std::ranges::any_of(bodies, [&](const Body& body) { return is_bone(body, "trunk"); });
    std::set<std::string> used;
    for (Body& body : bodies) {
      if (body.skeleton != skeleton) continue;
      const std::string name = rig_bone_name(scheme_, !has_trunk && is_bone(body, "chest") ? "trunk" : body.label);
      if (used.insert(name).second) {
        body.label = name;
      } else {
        used.insert(body.label);
      }
    }
  }

  /// A bone at the origin before each skeleton's first one.
  void add_roots(const std::vector<std::string>& skeletons, std::vector<Body>& bodies) {
    int last = 0;
    for (const Body& body : bodies) last = std::max(last, number(body.id));
    for (const std::string& skeleton : skeletons) {
      Body root;
      root.id = BodyId{++last};
      root.label = scheme_.root;
      root.skeleton = skeleton;
      for (Body& body : bodies) {
        if (body.skeleton == skeleton && !body.parent) body.parent = root.id;
      }
      const auto first = std::ranges::find(bodies, skeleton, &Body::skeleton);
      roots_.push_back(root.id);
      bodies.insert(first, std::move(root));
    }
  }

  std::unique_ptr<Sink> inner_;
  const RigScheme& scheme_;
  std::map<BodyId, Matrix<3>> rotations_;
  std::vector<BodyId> roots_;
};

}  // namespace

const RigScheme& rig_scheme(std::string_view name) {
  const auto found = std::ranges::find(kSchemes, name, &RigScheme::name);
  if (found == kSchemes.end()) throw Error("\"{}\": bones are known of {}", name, rig_scheme_names());
  return *found;
}

std::string rig_scheme_names() {
  std::vector<std::string_view> names;
  for (const RigScheme& scheme : kSchemes) names.push_back(scheme.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string rig_bone_name(const RigScheme& scheme, const std::string& label) {
  const auto known = known_bone(label);
  if (!known) return label;
  const auto at = static_cast<std::size_t>(&scheme - kSchemes.data());
  std::string name(known->bone->names[at < known->bone->names.size() ? at : 0]);
  if (const std::size_t mark = name.find('?'); mark != std::string::npos) name.replace(mark, 1, side_word(scheme, known->side));
  return scheme.name == "mixamo" ? "mixamorig:" + name : name;
}

bool is_bone_file(const std::string& path) {
  return path.ends_with(".bvh") || path.ends_with(".glb");
}

std::unique_ptr<Sink> create_bones(const std::string& path, const BoneOutput& output) {
  const RigScheme* const scheme = output.rig_names.empty() ? nullptr : &rig_scheme(output.rig_names);
  BvhDialect bvh;
  if (scheme != nullptr) bvh = {.unit_m = scheme->unit_m, .up = scheme->up, .order = std::string(scheme->order)};
  bvh.unit_m = output.bvh_unit_m.value_or(bvh.unit_m);
  bvh.up = output.bvh_up.value_or(bvh.up);
  if (!output.bvh_order.empty()) bvh.order = output.bvh_order;
  const GlbContent content = scheme == nullptr       ? GlbContent::scene
                             : scheme->name == "vrm" ? GlbContent::vrm_animation
                                                     : GlbContent::bones;
  auto sink = path.ends_with(".glb") ? create_glb(path, content) : create_bvh(path, bvh);
  return scheme == nullptr ? std::move(sink) : with_rig_scheme(std::move(sink), *scheme);
}

std::unique_ptr<Sink> with_rig_scheme(std::unique_ptr<Sink> inner, const RigScheme& scheme) {
  return std::make_unique<NamedSink>(std::move(inner), scheme);
}

}  // namespace marey::format::skeleton
