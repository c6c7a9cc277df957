// BVH, written: bodies that form a skeleton, as joints whose axes are parallel at rest. A joint's local rotation is taken apart
// into three turns, of the two solutions the one nearest to the last frame's.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/recording.h"
#include "marey/core/skeleton.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/read_file.h"
#include "marey/format/skeleton/bvh.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/format/skeleton/skeleton_recording.h"

namespace marey::format::skeleton {
namespace {

constexpr double kShiftM = 1e-4;  // of a joint that is written with positions

/// One body over time, as its parent sees it, in the file's axes and units.
struct WrittenJoint {
  Body body;
  std::vector<std::size_t> children;
  std::optional<std::size_t> parent;
  bool shifts = false;
  Vector<3> offset = Vector<3>::Zero();
  std::vector<Vector<3>> locations, rotations;  // units; degrees, in the order of the channels
};

class BvhSink final : public Sink {
 public:
  BvhSink(std::string path, const BvhDialect& dialect)
      : path_(std::move(path)), dialect_(dialect), file_from_world_(z_up_from(dialect.up).transpose()) {
    for (int i = 0; i < 3; ++i) axes_.col(i) = Vector<3>::Unit(dialect_.order[static_cast<std::size_t>(i)] - 'X');
  }

  std::string name() const override { return path_; }

  SinkRequirements begin(const RecordingHeader& header) override {
    rate_hz_ = header.rate_hz;
    for (const Body& body : header.bodies) {
      if (body.skeleton.empty()) continue;
      WrittenJoint joint{.body = body,
                         .children = {},
                         .parent = {},
                         .shifts = false,
                         .offset = Vector<3>::Zero(),
                         .locations = {},
                         .rotations = {}};
      if (body.parent) {
        joint.parent = joint_of(*body.parent);
        if (!joint.parent) throw Error("{}: {} hangs on a body that is not there", path_, body.label);
        joints_[*joint.parent].children.push_back(joints_.size());
      }
      joint.offset = in_file(body.offset);
      joints_.push_back(std::move(joint));
    }
    if (joints_.empty())
      throw Error("{}: the recording holds no skeleton; BVH holds nothing else. `marey solve` makes one of markers", path_);
    return {};
  }

  void write(const Instant& instant) override {
    std::vector<const BodyPose*> poses(joints_.size(), nullptr);
    for (const BodyPose& pose : instant.bodies) {
      if (const auto joint = joint_of(pose.body)) poses[*joint] = &pose;
    }
    for (std::size_t i = 0; i < joints_.size(); ++i) add(joints_[i], poses, i);
    ++frames_;
  }

  void finish() override {
    WholeFile file(path_);
    for (WrittenJoint& joint : joints_) joint.shifts = !joint.parent || shifts(joint);
    file.write(hierarchy());
    file.write(fmt::format("MOTION\nFrames: {}\nFrame Time: {:.8f}\n", frames_, 1 / rate_hz_));
    std::string text;
    for (std::size_t frame = 0; frame < frames_; ++frame) {
      text.clear();
      for (const std::size_t i : in_file_order()) append_row(text, joints_[i], frame);
      text.back() = '\n';
      file.write(text);
    }
    file.finish();
  }

 private:
  std::optional<std::size_t> joint_of(BodyId id) const {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (joints_[i].body.id == id) return i;
    }
    return std::nullopt;
  }

  Vector<3> in_file(const Vector<3>& world) const { return file_from_world_ * world / dialect_.unit_m; }

  /// One frame more: as the parent sees it, or as it was where it is not known.
  void add(WrittenJoint& joint, const std::vector<const BodyPose*>& poses, std::size_t i) const {
    const BodyPose* const own = poses[i];
    const BodyPose* const parent = joint.parent ? poses[*joint.parent] : nullptr;
    Vector<3> near =
        joint.rotations.empty() ? Vector<3>(Vector<3>::Zero()) : Vector<3>(joint.rotations.back() * std::numbers::pi / 180);
    if (own == nullptr || (joint.parent && parent == nullptr)) {
      joint.locations.push_back(joint.locations.empty() ? joint.offset : joint.locations.back());
      joint.rotations.push_back(near * 180 / std::numbers::pi);
      return;
    }
    const Rigid3 local = parent != nullptr ? parent->world_from_body.inverse() * own->world_from_body : own->world_from_body;
    const Matrix<3> rotated = file_from_world_ * local.rotation * file_from_world_.transpose();
    joint.locations.push_back(in_file(local.translation));
    joint.rotations.push_back(rotations_about(rotated, axes_, near) * 180 / std::numbers::pi);
  }

  bool shifts(const WrittenJoint& joint) const {
    return std::any_of(joint.locations.begin(), joint.locations.end(),
                       [&](const Vector<3>& location) { return (location - joint.offset).norm() * dialect_.unit_m > kShiftM; });
  }

  static std::string shown_name(const Body& body) {
    std::string name = plain_text(body.label);
    std::replace(name.begin(), name.end(), ' ', '_');
    std::replace_if(name.begin(), name.end(), [](char c) { return c == '{' || c == '}'; }, '_');
    return name.empty() ? fmt::format("joint{}", number(body.id)) : name;
  }

  /// Depth first, as the file has its joints.
  std::vector<std::size_t> in_file_order() const {
    std::vector<std::size_t> order, open;
    for (std::size_t i = joints_.size(); i-- > 0;) {
      if (!joints_[i].parent) open.push_back(i);
    }
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      order.push_back(i);
      open.insert(open.end(), joints_[i].children.rbegin(), joints_[i].children.rend());
    }
    return order;
  }

  std::string hierarchy() const {
    std::string text = "HIERARCHY\n";
    std::vector<std::size_t> open;  // joints whose braces are open
    const auto close_to = [&](std::size_t depth) {
      for (; open.size() > depth; open.pop_back()) text += std::string(2 * (open.size() - 1), ' ') + "}\n";
    };
    for (const std::size_t i : in_file_order()) {
      const WrittenJoint& joint = joints_[i];
      std::size_t depth = open.size();
      while (depth > 0 && (!joint.parent || open[depth - 1] != *joint.parent)) --depth;
      close_to(depth);
      append_joint(text, joint, std::string(2 * depth, ' '));
      open.push_back(i);
    }
    close_to(0);
    return text;
  }

  void append_joint(std::string& text, const WrittenJoint& joint, const std::string& indent) const {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{0}{1} {2}\n{0}{{\n{0}  OFFSET {3}\n", indent, joint.parent ? "JOINT" : "ROOT", shown_name(joint.body),
                   shown_vector(joint.offset));
    fmt::format_to(out, "{}  CHANNELS {}", indent, joint.shifts ? "6 Xposition Yposition Zposition" : "3");
    for (const char axis : dialect_.order) fmt::format_to(out, " {}rotation", axis);
    text += '\n';
    if (!joint.children.empty()) return;
    const Vector<3> end = joint.body.end ? in_file(*joint.body.end) : Vector<3>::Zero();
    fmt::format_to(out, "{0}  End Site\n{0}  {{\n{0}    OFFSET {1}\n{0}  }}\n", indent, shown_vector(end));
  }

  static std::string shown_vector(const Vector<3>& v) {
    return fmt::format("{:.6f} {:.6f} {:.6f}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
  }

  static void append_row(std::string& text, const WrittenJoint& joint, std::size_t frame) {
    auto out = std::back_inserter(text);
    if (joint.shifts) fmt::format_to(out, "{} ", shown_vector(joint.locations[frame]));
    fmt::format_to(out, "{} ", shown_vector(joint.rotations[frame]));
  }

  std::string path_;
  BvhDialect dialect_;
  Matrix<3> file_from_world_;
  Matrix<3> axes_;
  double rate_hz_ = 0;
  std::size_t frames_ = 0;
  std::vector<WrittenJoint> joints_;
};

}  // namespace

std::unique_ptr<Sink> create_bvh(const std::string& path, const BvhDialect& dialect) {
  std::string sorted = dialect.order;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != "XYZ") throw Error("\"{}\" is no order of turns; ZXY, ZYX, XYZ, XZY, YXZ and YZX are", dialect.order);
  return std::make_unique<BvhSink>(path, dialect);
}

Format bvh_format() {
  return {
      .name = "bvh",
      .title = "a BVH file",
      .endings = ".bvh",
      .holds = Content::space,
      .detail =
          "cm and y up where not reported otherwise; joints as points, bones as bodies. Written: bones alone, with the skeleton's "
          "motion; its dialects are options of `marey solve`",
      .is =
          [](const Beginning& file) {
            std::string_view text = file.text();
            text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
            return file.is_text() && text.starts_with("HIERARCHY");
          },
      .open = [](const std::string& path,
                 const ReadOptions& how) { return recording_of(parse_bvh(read_file(path), path, skeleton_options(how)), path); },
      .create = [](const std::string& path, const WritePlan&) { return create_bvh(path); },
      .while_recording = true,
      .poses = true,
      .z_up = true,
      .skeleton = true};
}

}  // namespace marey::format::skeleton
