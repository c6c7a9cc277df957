// glTF 2.0, sections 3.4 to 3.11 and 4.4 of the specification: JSON that describes a scene, and one buffer with its numbers.
#include "marey/format/skeleton/gltf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <variant>
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
#include "marey/format/skeleton/gltf_parts.h"
#include "marey/format/skeleton/skeleton_file.h"

namespace marey::format::skeleton {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr double kMarkerRadiusM = 0.01;
constexpr double kNearM = 0.01;  // nearer things are not drawn
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

/// A point over time. Where it is not known it keeps its last place, with no size.
struct GltfMarker {
  std::string label;
  std::vector<float> locations, sizes;
  bool hides = false;

  /// Up to `count` instants it is not known.
  void hide_until(std::size_t count) {
    const std::array<float, 3> last =
        locations.empty() ? std::array<float, 3>{} : std::array{locations.end()[-3], locations.end()[-2], locations.end()[-1]};
    for (std::size_t i = locations.size() / 3; i < count; ++i) {
      locations.insert(locations.end(), last.begin(), last.end());
      sizes.insert(sizes.end(), {0, 0, 0});
      hides = true;
    }
  }
};

class GlbSink final : public Sink {
 public:
  GlbSink(std::string path, GlbContent content)
      : path_(std::move(path)), content_(content), file_from_world_(z_up_from(UpAxis::y).transpose()) {}

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
    if (joints_.empty() && content_ != GlbContent::scene)
      throw Error("{}: the recording holds no skeleton; `marey solve` makes one of markers", path_);
    if (content_of(header.frame) != Content::space) throw Error("{}: a .glb is made of a recording in space (m)", path_);
    if (content_ == GlbContent::scene && header.rig) cameras_ = header.rig->cameras;
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
    if (content_ != GlbContent::scene) return;
    for (const TrackName& track : instant.named) markers_[track.id].label = track.label;
    for (const Sample& sample : instant.samples) {
      GltfMarker& marker = markers_[sample.track];
      marker.hide_until(times_.size() - 1);
      push_vector(marker.locations, file_from_world_ * sample.position);
      marker.sizes.insert(marker.sizes.end(), {1, 1, 1});
    }
  }

  void finish() override {
    const std::string json = describe();
    const std::string bytes = buffer_.take_bytes();
    const std::string padded = json + std::string((4 - json.size() % 4) % 4, ' ');
    const std::size_t tail = bytes.empty() ? 0 : 8 + bytes.size();
    WholeFile file(path_);
    file.write("glTF");
    write_words(file, {2, static_cast<std::uint32_t>(12 + 8 + padded.size() + tail), static_cast<std::uint32_t>(padded.size()),
                       0x4E4F534A});
    file.write(padded);
    if (tail > 0) write_words(file, {static_cast<std::uint32_t>(bytes.size()), 0x004E4942});
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

  /// A node for each segment, and the one that holds them; then the stick figure.
  void add_skeleton() {
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      std::vector<std::size_t> children;
      for (std::size_t c = 0; c < joints_.size(); ++c) {
        if (joints_[c].parent == i) children.push_back(c);
      }
      if (!joints_[i].parent) roots.push_back(i);
      const Vector<3>& at = joints_[i].offset;
      nodes_.push_back(fmt::format("{{\"name\":{},\"translation\":[{},{},{}]{}}}", json_text(joints_[i].body.label), at.x() + 0.0,
                                   at.y() + 0.0, at.z() + 0.0,
                                   children.empty() ? "" : fmt::format(",\"children\":[{}]", fmt::join(children, ","))));
    }
    add_root(fmt::format("{{\"name\":{},\"children\":[{}]}}", json_text(joints_.front().body.skeleton), fmt::join(roots, ",")));
    add_root(fmt::format("{{\"name\":\"figure\",\"mesh\":{},\"skin\":0}}", add_mesh(figure(), true)));
    for (std::size_t i = 0; i < joints_.size() && !times_.empty(); ++i) {
      animate(i, "rotation", buffer_.add(joints_[i].rotations, kFloat, "VEC4", 4, false));
      if (joints_[i].shifts) animate(i, "translation", buffer_.add(joints_[i].locations, kFloat, "VEC3", 3, false));
    }
  }

  /// Cameras are aimed along −z with y up, and are pinholes whose axis meets the image's middle; what else is known of one is in
  /// its node's "extras".
  std::string add_cameras() {
    std::vector<std::string> all;
    for (const RigCamera& one : cameras_) {
      const auto camera = one.camera();
      if (!camera) continue;
      const auto [focal, principal] =
          std::visit([](const auto& lens) { return std::pair(lens.focal, lens.principal); }, camera->lens());
      const double width = camera->size().width, height = camera->size().height;
      const Rigid3 pose = camera->camera_from_world().inverse();
      const Vector<3> at = file_from_world_ * pose.translation;
      const Eigen::Quaterniond turn(Matrix<3>(file_from_world_ * pose.rotation * Vector<3>(1, -1, -1).asDiagonal()));
      add_root(fmt::format(
          "{{\"name\":{},\"camera\":{},\"translation\":[{},{},{}],\"rotation\":[{},{},{},{}],\"extras\":{{\"width_px\":{},"
          "\"height_px\":{},\"fx_px\":{},\"fy_px\":{},\"cx_px\":{},\"cy_px\":{},\"video\":{},\"offset_s\":{}}}}}",
          json_text(one.name), all.size(), at.x() + 0.0, at.y() + 0.0, at.z() + 0.0, turn.x(), turn.y(), turn.z(), turn.w(), width,
          height, focal.x(), focal.y(), principal.x(), principal.y(), json_text(one.source), one.offset_s.value_or(0)));
      all.push_back(fmt::format(
          "{{\"type\":\"perspective\",\"name\":{},\"perspective\":{{\"yfov\":{},\"aspectRatio\":{},\"znear\":{}}}}}",
          json_text(one.name), 2 * std::atan(height / (2 * focal.y())), width * focal.y() / (height * focal.x()), kNearM));
    }
    return all.empty() ? "" : fmt::format(",\"cameras\":[{}]", fmt::join(all, ","));
  }

  void add_markers() {
    if (markers_.empty()) return;
    Octahedra shape;
    shape.add_marker(kMarkerRadiusM);
    const int mesh = add_mesh(shape, false);
    for (auto& [track, marker] : markers_) {
      if (marker.locations.empty()) continue;
      marker.hide_until(times_.size());
      const std::string label = marker.label.empty() ? fmt::format("{}", number(track)) : marker.label;
      const std::size_t node = nodes_.size();
      add_root(fmt::format("{{\"name\":{},\"mesh\":{}}}", json_text(label), mesh));
      animate(node, "translation", buffer_.add(marker.locations, kFloat, "VEC3", 3, false));
      if (marker.hides) animate(node, "scale", buffer_.add(marker.sizes, kFloat, "VEC3", 3, false), ",\"interpolation\":\"STEP\"");
    }
  }

  void add_root(std::string node) {
    roots_.push_back(nodes_.size());
    nodes_.push_back(std::move(node));
  }

  void animate(std::size_t node, const char* path, int output, const char* more = "") {
    if (!input_) input_ = buffer_.add(times_, kFloat, "SCALAR", 1, true);
    channels_.push_back(fmt::format("{{\"sampler\":{},\"target\":{{\"node\":{},\"path\":\"{}\"}}}}", samplers_.size(), node, path));
    samplers_.push_back(fmt::format("{{\"input\":{},\"output\":{}{}}}", *input_, output, more));
  }

  /// Bones lead to the segments that hang on a segment, and to its end.
  Octahedra figure() const {
    Octahedra stick;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const GltfJoint& joint = joints_[i];
      if (joint.parent) stick.add_bone(joints_[*joint.parent].rest, joint.rest, *joint.parent);
      if (joint.body.end) stick.add_bone(joint.rest, joint.rest + file_from_world_ * *joint.body.end, i);
    }
    if (stick.indices.empty()) stick.add_bone(joints_.front().rest, joints_.front().rest + Vector<3>(0, 0.1, 0), 0);
    return stick;
  }

  /// Its index.
  std::size_t add_mesh(const Octahedra& shape, bool skinned) {
    const int indices = buffer_.add(shape.indices, kUnsignedInt, "SCALAR", 1, false, 34963);
    std::string attributes = fmt::format("\"POSITION\":{}", buffer_.add(shape.positions, kFloat, "VEC3", 3, true, 34962));
    attributes += fmt::format(",\"NORMAL\":{}", buffer_.add(shape.normals, kFloat, "VEC3", 3, false, 34962));
    if (skinned) {
      attributes += fmt::format(",\"JOINTS_0\":{}", buffer_.add(shape.joints, kUnsignedShort, "VEC4", 4, false, 34962));
      attributes += fmt::format(",\"WEIGHTS_0\":{}", buffer_.add(shape.weights, kFloat, "VEC4", 4, false, 34962));
    }
    meshes_.push_back(fmt::format("{{\"primitives\":[{{\"attributes\":{{{}}},\"indices\":{}}}]}}", attributes, indices));
    return meshes_.size() - 1;
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

  /// Fills the buffer, too.
  std::string describe() {
    if (!joints_.empty()) add_skeleton();
    const std::string cameras = add_cameras();
    add_markers();
    const std::string skins = joints_.empty() ? "" : fmt::format(",\"skins\":[{}]", skin());
    std::string json = fmt::format(
        "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"Marey\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[{}]}}],\"nodes\":[{}]",
        fmt::join(roots_, ","), fmt::join(nodes_, ","));
    if (!meshes_.empty()) json += fmt::format(",\"meshes\":[{}]", fmt::join(meshes_, ","));
    json += skins + cameras;
    if (!channels_.empty())
      json += fmt::format(",\"animations\":[{{\"name\":\"motion\",\"samplers\":[{}],\"channels\":[{}]}}]",
                          fmt::join(samplers_, ","), fmt::join(channels_, ","));
    if (content_ == GlbContent::vrm_animation) json += vrm_extension();
    if (!buffer_.views().empty())
      json += fmt::format(",\"accessors\":[{}],\"bufferViews\":[{}],\"buffers\":[{{\"byteLength\":{}}}]",
                          fmt::join(buffer_.accessors(), ","), fmt::join(buffer_.views(), ","), buffer_.size());
    return json + "}";
  }

  std::string path_;
  GlbContent content_ = GlbContent::scene;
  Matrix<3> file_from_world_;
  std::vector<GltfJoint> joints_;
  std::vector<RigCamera> cameras_;
  std::map<TrackId, GltfMarker> markers_;
  std::vector<float> times_;
  Timestamp first_{};

  // What describe() makes.
  GltfBuffer buffer_;
  std::vector<std::string> nodes_, meshes_, samplers_, channels_;
  std::vector<std::size_t> roots_;  ///< indices of nodes that no other holds
  std::optional<int> input_;        ///< the accessor of the instants' times
};

}  // namespace

std::unique_ptr<Sink> create_glb(const std::string& path, GlbContent content) {
  return std::make_unique<GlbSink>(path, content);
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
  for (const char* what : {"nodes", "skins", "animations", "cameras"})
    facts.push_back({what, static_cast<std::int64_t>(count(what))});
  return facts;
}

Format glb_format() {
  return {.name = "glb",
          .title = "a glTF file",
          .endings = ".glb",
          .holds = Content::space,
          .detail =
              "glTF 2.0: m, y up; the bones of a skeleton, their motion, and a stick figure; markers, and the rig's cameras (their "
              "lenses' distortion is not kept). With --rig-names the bones alone. Written; of one that is read, `marey info` tells "
              "what its description says",
          .is = [](const Beginning& file) { return file.bytes.starts_with("glTF"); },
          .facts = [](const std::string& path) { return facts_of_glb(MappedFile(path).text(), path); },
          .create = [](const std::string& path, const WritePlan&) { return create_glb(path); },
          .while_recording = true,
          .poses = true,
          .z_up = true};
}

}  // namespace marey::format::skeleton
