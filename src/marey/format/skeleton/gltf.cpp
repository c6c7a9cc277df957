// glTF 2.0, sections 3.4 to 3.11 and 4.4 of the specification: JSON that describes a scene, and one buffer with its numbers.
#include "marey/format/skeleton/gltf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/core/recording.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/format.h"
#include "marey/format/mapped_file.h"
#include "marey/format/nesting.h"
#include "marey/format/skeleton/skeleton_file.h"

namespace marey::format::skeleton {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr double kMinBoneM = 1e-3;
constexpr std::array<std::string_view, 21> kVrmBones{
    "hips",         "spine",        "chest",         "neck",          "head",          "leftUpperLeg",  "leftLowerLeg",
    "leftFoot",     "leftToes",     "rightUpperLeg", "rightLowerLeg", "rightFoot",     "rightToes",     "leftShoulder",
    "leftUpperArm", "leftLowerArm", "leftHand",      "rightShoulder", "rightUpperArm", "rightLowerArm", "rightHand"};

std::string json_text(const std::string& text) {
  std::string quoted_text = "\"";
  for (const char c : plain_text(text)) {
    if (c == '"' || c == '\\') quoted_text += '\\';
    quoted_text += c;
  }
  return quoted_text + '"';
}

/// The buffer, and what says where in it everything lies.
class GltfBuffer {
 public:
  /// Appends numbers as one accessor and returns its index. `bounds`: says the least and the greatest of each component.
  template <typename T>
  int add(const std::vector<T>& values, int component, const char* type, std::size_t width, bool bounds, int target = 0) {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    views_.push_back(fmt::format("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}{}}}", bytes_.size(), values.size() * sizeof(T),
                                 target != 0 ? fmt::format(",\"target\":{}", target) : ""));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    accessors_.push_back(fmt::format("{{\"bufferView\":{},\"componentType\":{},\"count\":{},\"type\":\"{}\"{}}}", views_.size() - 1,
                                     component, values.size() / width, type, bounds ? bounds_of(values, width) : ""));
    return static_cast<int>(accessors_.size()) - 1;
  }

  /// When it is padded to whole words.
  std::size_t size() const { return (bytes_.size() + 3) / 4 * 4; }
  const std::vector<std::string>& views() const { return views_; }
  const std::vector<std::string>& accessors() const { return accessors_; }
  std::string take_bytes() {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    return std::move(bytes_);
  }

 private:
  template <typename T>
  static std::string bounds_of(const std::vector<T>& values, std::size_t width) {
    std::vector<T> minimum(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)), greatest = minimum;
    for (std::size_t i = 0; i < values.size(); ++i) {
      minimum[i % width] = std::min(minimum[i % width], values[i]);
      greatest[i % width] = std::max(greatest[i % width], values[i]);
    }
    return fmt::format(",\"min\":[{}],\"max\":[{}]", fmt::join(minimum, ","), fmt::join(greatest, ","));
  }

  std::string bytes_;
  std::vector<std::string> views_, accessors_;
};

void push_vector(std::vector<float>& values, const Vector<3>& v) {
  for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(v[i]));
}

/// One segment over time, as its parent sees it, in the file's axes.
struct GltfJoint {
  Body body;
  std::optional<std::size_t> parent;
  Vector<3> rest = Vector<3>::Zero();  ///< in the scene, at rest
  Vector<3> offset = Vector<3>::Zero();
  std::vector<float> locations, rotations;
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  bool shifts = false;
};

/// The stick figure's vertices, all of a bone bound to its segment.
struct StickFigure {
  std::vector<float> positions, normals, weights;
  std::vector<std::uint16_t> joints;
  std::vector<std::uint32_t> indices;

  /// An octahedron, thickest at a fifth of the bone; eight faces with corners of their own, so that they appear flat.
  void add_bone(const Vector<3>& from, const Vector<3>& to, std::size_t joint) {
    const Vector<3> along = to - from;
    const double length = along.norm();
    if (!(length > kMinBoneM)) return;
    const Vector<3> direction = along / length, side = direction.unitOrthogonal() * 0.12 * length, other = direction.cross(side);
    const Vector<3> middle = from + 0.2 * along;
    const std::array<Vector<3>, 4> ring = {middle + side, middle + other, middle - side, middle - other};
    for (std::size_t i = 0; i < 4; ++i) {
      add_face(from, ring[(i + 1) % 4], ring[i], joint);
      add_face(to, ring[i], ring[(i + 1) % 4], joint);
    }
  }

 private:
  void add_face(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c, std::size_t joint) {
    const Vector<3> normal = (b - a).cross(c - a).normalized();
    for (const Vector<3>* corner : {&a, &b, &c}) {
      indices.push_back(static_cast<std::uint32_t>(indices.size()));
      push_vector(positions, *corner);
      push_vector(normals, normal);
      joints.insert(joints.end(), {static_cast<std::uint16_t>(joint), 0, 0, 0});
      weights.insert(weights.end(), {1, 0, 0, 0});
    }
  }
};

class GlbSink final : public Sink {
 public:
  GlbSink(std::string path, bool vrm_animation)
      : path_(std::move(path)), vrm_animation_(vrm_animation), file_from_world_(z_up_from(UpAxis::y).transpose()) {}

  std::string name() const override { return path_; }

  SinkRequirements begin(const RecordingHeader& header) override {
    for (const Body& body : header.bodies) {
      if (body.skeleton.empty()) continue;
      GltfJoint joint{
          .body = body, .parent = {}, .rest = {}, .offset = file_from_world_ * body.offset, .locations = {}, .rotations = {}};
      if (body.parent) {
        joint.parent = joint_of(*body.parent);
        if (!joint.parent) throw Error("{}: {} hangs on a body that is not there", path_, body.label);
        joint.rest = joints_[*joint.parent].rest + joint.offset;
      }
      joints_.push_back(std::move(joint));
    }
    if (joints_.empty()) throw Error("{}: the recording holds no skeleton; `marey solve` makes one of markers", path_);
    if (joints_.size() > 60'000) throw Error("{}: {} segments are more than the format numbers", path_, joints_.size());
    return {};
  }

  void write(const Instant& instant) override {
    std::vector<const BodyPose*> poses(joints_.size(), nullptr);
    for (const BodyPose& pose : instant.bodies) {
      if (const auto joint = joint_of(pose.body)) poses[*joint] = &pose;
    }
    if (times_.empty()) first_ = instant.time;
    times_.push_back(static_cast<float>(seconds(instant.time - first_)));
    for (std::size_t i = 0; i < joints_.size(); ++i) add(joints_[i], poses, i);
  }

  void finish() override {
    const std::string json = describe();
    const std::string bytes = buffer_.take_bytes();
    const std::string padded = json + std::string((4 - json.size() % 4) % 4, ' ');
    WholeFile file(path_);
    file.write("glTF");
    write_words(file, {2, static_cast<std::uint32_t>(12 + 8 + padded.size() + 8 + bytes.size()),
                       static_cast<std::uint32_t>(padded.size()), 0x4E4F534A});
    file.write(padded);
    write_words(file, {static_cast<std::uint32_t>(bytes.size()), 0x004E4942});
    file.write(bytes);
    file.finish();
  }

 private:
  static void write_words(WholeFile& file, std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words) file.write({reinterpret_cast<const char*>(&word), sizeof word});
  }

  std::optional<std::size_t> joint_of(BodyId id) const {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (joints_[i].body.id == id) return i;
    }
    return std::nullopt;
  }

  void add(GltfJoint& joint, const std::vector<const BodyPose*>& poses, std::size_t i) const {
    const BodyPose* const parent = joint.parent ? poses[*joint.parent] : nullptr;
    Vector<3> location = joint.locations.size() < 3
                             ? joint.offset
                             : Vector<3>(joint.locations[joint.locations.size() - 3], joint.locations[joint.locations.size() - 2],
                                         joint.locations.back());
    if (poses[i] != nullptr && (!joint.parent || parent != nullptr)) {
      const Rigid3 local =
          parent != nullptr ? parent->world_from_body.inverse() * poses[i]->world_from_body : poses[i]->world_from_body;
      location = file_from_world_ * local.translation;
      Eigen::Quaterniond turn(Matrix<3>(file_from_world_ * local.rotation * file_from_world_.transpose()));
      if (turn.dot(joint.last) < 0) turn.coeffs() *= -1;
      joint.last = turn.normalized();
    }
    push_vector(joint.locations, location);
    for (const double c : {joint.last.x(), joint.last.y(), joint.last.z(), joint.last.w()})
      joint.rotations.push_back(static_cast<float>(c));
    joint.shifts = joint.shifts || !joint.parent || (location - joint.offset).norm() > 1e-4;
  }

  std::string nodes() const {
    std::vector<std::string> all, roots;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      std::vector<std::size_t> children;
      for (std::size_t c = 0; c < joints_.size(); ++c) {
        if (joints_[c].parent == i) children.push_back(c);
      }
      if (!joints_[i].parent) roots.push_back(fmt::format("{}", i));
      const Vector<3>& at = joints_[i].offset;
      all.push_back(fmt::format("{{\"name\":{},\"translation\":[{},{},{}]{}}}", json_text(joints_[i].body.label), at.x() + 0.0,
                                at.y() + 0.0, at.z() + 0.0,
                                children.empty() ? "" : fmt::format(",\"children\":[{}]", fmt::join(children, ","))));
    }
    all.push_back(
        fmt::format("{{\"name\":{},\"children\":[{}]}}", json_text(joints_.front().body.skeleton), fmt::join(roots, ",")));
    return fmt::format("{}", fmt::join(all, ","));
  }

  /// Bones lead to the segments that hang on a segment, and to its end.
  StickFigure figure() const {
    StickFigure stick;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const GltfJoint& joint = joints_[i];
      if (joint.parent) stick.add_bone(joints_[*joint.parent].rest, joint.rest, *joint.parent);
      if (joint.body.end) stick.add_bone(joint.rest, joint.rest + file_from_world_ * *joint.body.end, i);
    }
    if (stick.indices.empty()) stick.add_bone(joints_.front().rest, joints_.front().rest + Vector<3>(0, 0.1, 0), 0);
    return stick;
  }

  std::string mesh() {
    const StickFigure stick = figure();
    const int indices = buffer_.add(stick.indices, kUnsignedInt, "SCALAR", 1, false, 34963);
    const int positions = buffer_.add(stick.positions, kFloat, "VEC3", 3, true, 34962);
    const int normals = buffer_.add(stick.normals, kFloat, "VEC3", 3, false, 34962);
    const int joints = buffer_.add(stick.joints, kUnsignedShort, "VEC4", 4, false, 34962);
    const int weights = buffer_.add(stick.weights, kFloat, "VEC4", 4, false, 34962);
    return fmt::format(
        "{{\"primitives\":[{{\"attributes\":{{\"POSITION\":{},\"NORMAL\":{},\"JOINTS_0\":{},\"WEIGHTS_0\":{}}},\"indices\":{}}}]}}",
        positions, normals, joints, weights, indices);
  }

  std::string skin() {
    std::vector<float> inverse;
    for (const GltfJoint& joint : joints_) {
      for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row)
          inverse.push_back(column == 3 && row < 3 ? static_cast<float>(-joint.rest[row]) : column == row ? 1.0F : 0.0F);
      }
    }
    std::vector<std::size_t> all(joints_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    return fmt::format("{{\"inverseBindMatrices\":{},\"joints\":[{}]}}", buffer_.add(inverse, kFloat, "MAT4", 16, false),
                       fmt::join(all, ","));
  }

  std::string animation() {
    std::vector<std::string> samplers, channels;
    const int input = buffer_.add(times_, kFloat, "SCALAR", 1, true);
    const auto add_channel = [&](std::size_t node, const char* path, int output) {
      channels.push_back(fmt::format("{{\"sampler\":{},\"target\":{{\"node\":{},\"path\":\"{}\"}}}}", samplers.size(), node, path));
      samplers.push_back(fmt::format("{{\"input\":{},\"output\":{}}}", input, output));
    };
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      add_channel(i, "rotation", buffer_.add(joints_[i].rotations, kFloat, "VEC4", 4, false));
      if (joints_[i].shifts) add_channel(i, "translation", buffer_.add(joints_[i].locations, kFloat, "VEC3", 3, false));
    }
    return fmt::format("{{\"name\":\"motion\",\"samplers\":[{}],\"channels\":[{}]}}", fmt::join(samplers, ","),
                       fmt::join(channels, ","));
  }

  /// Which node is which bone, as VRM animations (.vrma) say it.
  std::string vrm_extension() const {
    std::vector<std::string> bones;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (std::ranges::find(kVrmBones, joints_[i].body.label) == kVrmBones.end()) continue;
      bones.push_back(fmt::format("{}:{{\"node\":{}}}", json_text(joints_[i].body.label), i));
    }
    return fmt::format(
        ",\"extensionsUsed\":[\"VRMC_vrm_animation\"],\"extensions\":{{\"VRMC_vrm_animation\":{{\"specVersion\":\"1.0\","
        "\"humanoid\":{{\"humanBones\":{{{}}}}}}}}}",
        fmt::join(bones, ","));
  }

  std::string describe() {
    const std::size_t armature = joints_.size();
    const std::string all_nodes = nodes(), its_mesh = mesh(), its_skin = skin(),
                      its_animation = times_.empty() ? "" : fmt::format(",\"animations\":[{}]", animation()),
                      extension = vrm_animation_ ? vrm_extension() : "";
    std::string json =
        fmt::format("{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"Marey\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[{},{}]}}],",
                    armature, armature + 1);
    json += fmt::format("\"nodes\":[{},{{\"name\":\"figure\",\"mesh\":0,\"skin\":0}}],\"meshes\":[{}],\"skins\":[{}]{}{},",
                        all_nodes, its_mesh, its_skin, its_animation, extension);
    json += fmt::format("\"accessors\":[{}],\"bufferViews\":[{}],", fmt::join(buffer_.accessors(), ","),
                        fmt::join(buffer_.views(), ","));
    return json + fmt::format("\"buffers\":[{{\"byteLength\":{}}}]}}", buffer_.size());
  }

  std::string path_;
  bool vrm_animation_ = false;
  Matrix<3> file_from_world_;
  std::vector<GltfJoint> joints_;
  std::vector<float> times_;
  Timestamp first_{};
  GltfBuffer buffer_;
};

}  // namespace

std::unique_ptr<Sink> create_glb(const std::string& path, bool vrm_animation) {
  return std::make_unique<GlbSink>(path, vrm_animation);
}

namespace {

constexpr std::size_t kGlbHead = 20;  // magic, version, length; length and kind of the first chunk

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

}  // namespace

std::vector<Fact> facts_of_glb(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kGlbHead || !bytes.starts_with("glTF") || word_at(bytes, 4) != 2)
    throw Error("{}: is not a glTF of version 2", name);
  const std::uint32_t size = word_at(bytes, 12);
  if (bytes.substr(16, 4) != "JSON" || size > bytes.size() - kGlbHead)
    throw Error("{}: its description is cut off; copy it again", name);
  const std::string_view description = bytes.substr(kGlbHead, size);
  check_nesting(description, Notation::json, name);
  const auto json = nlohmann::json::parse(description, nullptr, false);
  if (!json.is_object()) throw Error("{}: its description is not JSON", name);
  const auto count = [&](const char* what) {
    const auto found = json.find(what);
    return found != json.end() && found->is_array() ? std::ssize(*found) : std::ptrdiff_t{0};
  };
  std::vector<Fact> facts;
  if (const auto asset = json.find("asset"); asset != json.end() && asset->is_object()) {
    if (const auto maker = asset->find("generator"); maker != asset->end() && maker->is_string())
      facts.push_back({"made_by", plain_text(maker->get<std::string>())});
  }
  for (const char* what : {"nodes", "skins", "animations"}) facts.push_back({what, static_cast<std::int64_t>(count(what))});
  return facts;
}

Format glb_format() {
  return {.name = "glb",
          .title = "a glTF file",
          .endings = ".glb",
          .holds = Content::space,
          .detail =
              "glTF 2.0: m, y up; the bones of a skeleton, their motion, and a stick figure. Written; of one that is read, `marey "
              "info` "
              "tells what its description says",
          .is = [](const Beginning& file) { return file.bytes.starts_with("glTF"); },
          .facts = [](const std::string& path) { return facts_of_glb(MappedFile(path).text(), path); },
          .create = [](const std::string& path, const WritePlan&) { return create_glb(path); },
          .while_recording = true,
          .poses = true,
          .z_up = true};
}

}  // namespace marey::format::skeleton
