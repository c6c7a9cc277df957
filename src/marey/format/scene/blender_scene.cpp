// Blender's cameras are pinholes with square-based sensors, are aimed along −z with y up, and have their image's middle at
// ((width − 1) / 2, (height − 1) / 2) of our pixels. Distortion is not transferred: the script says by how much the lens bends.
#include "marey/format/scene/blender_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/format.h"
#include "marey/format/scene/blender_script.h"

namespace marey::format::scene {
namespace {

constexpr double kMinBoneM = 0.02;  // Blender drops bones without length
constexpr double kMarkerM = 0.01;
constexpr double kMinReportedBendPx = 2;

/// A Python string.
std::string quoted_python(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : plain_text(text)) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string row_of(const Vector<3>& v) {
  return fmt::format("({:.5f},{:.5f},{:.5f})", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

/// px: how far the lens moves the image's corners from where a pinhole has them; nothing if a pinhole has none.
std::optional<double> bend_of(const Camera& camera) {
  const auto [focal, principal] = std::visit([](const auto& lens) { return std::pair(lens.focal, lens.principal); }, camera.lens());
  const double right = camera.size().width - 1, bottom = camera.size().height - 1;
  double worst = 0;
  for (const Vector<2>& corner : {Vector<2>(0, 0), Vector<2>(right, 0), Vector<2>(0, bottom), Vector<2>(right, bottom)}) {
    const auto bearing = camera.bearing(corner);
    if (!bearing || bearing->z() < 0.05) return std::nullopt;
    const Vector<2> pinhole = principal + focal.cwiseProduct(Vector<2>(bearing->head<2>() / bearing->z()));
    worst = std::max(worst, (pinhole - corner).norm());
  }
  return worst;
}

std::string camera_text(const RigCamera& one, const Camera& camera) {
  const auto [focal, principal] = std::visit([](const auto& lens) { return std::pair(lens.focal, lens.principal); }, camera.lens());
  const Rigid3 pose = camera.camera_from_world().inverse();
  std::vector<std::string> rows;
  for (int i = 0; i < 3; ++i)
    rows.push_back(fmt::format("({:.9f},{:.9f},{:.9f},{:.6f})", pose.rotation(i, 0), pose.rotation(i, 1), pose.rotation(i, 2),
                               pose.translation[i]));
  std::string text = fmt::format(
      "    {{\"name\": {}, \"size\": ({}, {}), \"fx\": {:.6f}, \"fy\": {:.6f}, \"cx\": {:.6f}, \"cy\": {:.6f},\n"
      "     \"world_from_camera\": ({}, (0,0,0,1)),\n     \"video\": {}, \"offset_s\": {:.6f}}},",
      quoted_python(one.name), camera.size().width, camera.size().height, focal.x(), focal.y(), principal.x(), principal.y(),
      fmt::join(rows, ", "), quoted_python(one.region ? "" : one.source), one.offset_s.value_or(0));
  const auto bend = bend_of(camera);
  if (one.region) text += "  # its video is a part of a larger image: no background";
  if (!bend) text += "  # its lens is too wide for a pinhole: the edges differ from its video";
  if (bend && *bend > kMinReportedBendPx)
    text += fmt::format("  # its lens bends the corners by {:.0f} px, which Blender's does not", *bend);
  return text + "\n";
}

/// One bone and its poses.
struct SceneBone {
  Body body;
  std::optional<std::size_t> parent;  ///< among the bones of its skeleton
  Vector<3> head = Vector<3>::Zero();
  std::vector<std::string> rows;
};

class BlenderSceneSink final : public Sink {
 public:
  explicit BlenderSceneSink(std::string path) : path_(std::move(path)) {}

  std::string name() const override { return path_; }

  SinkRequirements begin(const RecordingHeader& header) override {
    if (content_of(header.frame) != Content::space)
      throw Error("{}: a scene for Blender is made of a recording in space (m)", path_);
    title_ = header.name;
    rate_hz_ = header.rate_hz;
    if (header.rig) {
      for (const RigCamera& one : header.rig->cameras) {
        if (const auto camera = one.camera()) cameras_ += camera_text(one, *camera);
      }
    }
    for (const Body& body : header.bodies) {
      if (!body.skeleton.empty()) add_bone(body);
    }
    return {};
  }

  void write(const Instant& instant) override {
    for (const TrackName& track : instant.named) labels_[track.id] = track.label;
    if (!first_) first_ = instant.index;
    const auto frame = static_cast<std::size_t>(instant.index - *first_);
    for (const Sample& sample : instant.samples) {
      std::vector<std::string>& rows = markers_[sample.track];
      rows.resize(frame, "None");
      rows.push_back(row_of(sample.position));
    }
    for (auto& [skeleton, bones] : skeletons_) {
      for (SceneBone& bone : bones) {
        const auto pose = std::ranges::find(instant.bodies, bone.body.id, &BodyPose::body);
        bone.rows.resize(frame, "None");
        bone.rows.push_back(pose == instant.bodies.end() ? "None" : pose_text(pose->world_from_body));
      }
    }
    frames_ = frame + 1;
  }

  void finish() override {
    WholeFile file(path_);
    file.write(fmt::format(
        "# {}: cameras, markers and skeletons, written by Marey.\n# Open it in Blender (Scripting, Open, Run Script), or: blender "
        "--python FILE\nRATE_HZ = {:.9g}\nFIRST = 1  # the scene's first frame\nLAST = {}  # instants after it\nMARKER_M = {}\n",
        plain_text(title_), rate_hz_, frames_ == 0 ? 0 : frames_ - 1, kMarkerM));
    file.write("CAMERAS = [\n" + cameras_ + "]\nMARKERS = [\n");
    for (auto& [track, rows] : markers_) {
      rows.resize(frames_, "None");
      const std::string& label = labels_[track];
      file.write(fmt::format("    ({}, [{}]),\n", quoted_python(label.empty() ? fmt::format("{}", number(track)) : label),
                             fmt::join(rows, ",")));
    }
    file.write("]\nSKELETONS = [\n");
    for (auto& [skeleton, bones] : skeletons_) write_skeleton(file, skeleton, bones);
    file.write("]\n");
    file.write(kBlenderScript);
    file.finish();
  }

 private:
  void add_bone(const Body& body) {
    auto known = std::ranges::find(skeletons_, body.skeleton, &std::pair<std::string, std::vector<SceneBone>>::first);
    if (known == skeletons_.end()) known = skeletons_.insert(known, {body.skeleton, {}});
    std::vector<SceneBone>& bones = known->second;
    SceneBone bone{.body = body, .parent = {}, .rows = {}};
    for (std::size_t i = 0; i < bones.size(); ++i) {
      if (bones[i].body.id != body.parent) continue;
      bone.parent = i;
      bone.head = bones[i].head + body.offset;
    }
    bones.push_back(std::move(bone));
  }

  static std::string pose_text(const Rigid3& pose) {
    const Eigen::Quaterniond turn(pose.rotation);
    return fmt::format("({:.5f},{:.5f},{:.5f},{:.6f},{:.6f},{:.6f},{:.6f})", pose.translation.x(), pose.translation.y(),
                       pose.translation.z(), turn.w(), turn.x(), turn.y(), turn.z());
  }

  /// Where a bone ends at rest: at what hangs on it, else where it says, else a little above.
  static Vector<3> tail_of(const std::vector<SceneBone>& bones, std::size_t i) {
    const Vector<3>& head = bones[i].head;
    for (const SceneBone& other : bones) {
      if (other.parent == i && (other.head - head).norm() > kMinBoneM) return other.head;
    }
    if (bones[i].body.end && bones[i].body.end->norm() > kMinBoneM) return head + *bones[i].body.end;
    return head + Vector<3>(0, 0, 0.05);
  }

  static void write_skeleton(WholeFile& file, const std::string& skeleton, const std::vector<SceneBone>& bones) {
    file.write(fmt::format("    ({}, [\n", quoted_python(skeleton)));
    for (std::size_t i = 0; i < bones.size(); ++i) {
      const SceneBone& bone = bones[i];
      file.write(fmt::format("        ({}, {}, {}, {}, [{}]),\n", quoted_python(bone.body.label),
                             bone.parent ? fmt::format("{}", *bone.parent) : "None", row_of(bone.head), row_of(tail_of(bones, i)),
                             fmt::join(bone.rows, ",")));
    }
    file.write("    ]),\n");
  }

  std::string path_, title_, cameras_;
  double rate_hz_ = 0;
  std::optional<std::int64_t> first_;
  std::size_t frames_ = 0;
  std::map<TrackId, std::vector<std::string>> markers_;
  std::map<TrackId, std::string> labels_;
  std::vector<std::pair<std::string, std::vector<SceneBone>>> skeletons_;
};

}  // namespace

std::unique_ptr<Sink> create_blender_scene(const std::string& path) {
  return std::make_unique<BlenderSceneSink>(path);
}

Format blender_format() {
  return {
      .name = "blender",
      .title = "a scene for Blender",
      .endings = ".py",
      .holds = Content::space,
      .detail =
          "a script that builds the scene: cameras with their videos, markers, skeletons; m, z up. Lenses' distortion is not kept",
      .create = [](const std::string& path, const WritePlan&) { return create_blender_scene(path); },
      .while_recording = true,
      .poses = true,
      .z_up = true};
}

}  // namespace marey::format::scene
