// Acclaim's skeletons (ASF) and motions (AMC), as CMU's and others' are. A bone has a direction and a length, and its children
// begin at its end. Its turns are about axes of its own: C = Rz·Ry·Rx of `axis`, and the bone turns by C·Rz·Ry·Rx·C⁻¹, in the order
// that `dof` lists from the right. One unit is 1/length inches (CMU: 1/0.45).
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/read_file.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/format/skeleton/skeleton_recording.h"
#include "marey/format/text_rows.h"

namespace marey::format::skeleton {
namespace {

constexpr double kInchM = 0.0254;
constexpr std::size_t kMaxBones = 10'000;
constexpr std::size_t kFewNumbers = 1'000'000;

std::vector<std::string> tokens_of(std::string_view line) {
  std::vector<std::string> tokens;
  line = line.substr(0, line.find('#'));
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r()", at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(" \t\r()", begin), line.size());
    tokens.emplace_back(line.substr(begin, end - begin));
    at = end;
  }
  return tokens;
}

std::string small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

struct Bone {
  std::string name;
  Vector<3> direction = Vector<3>::UnitZ(), axis = Vector<3>::Zero();
  double length = 0;
  std::vector<std::string> dof;  // "rx", "ty", …
  std::vector<std::pair<double, double>> limits;
  std::optional<int> segment;
};

class AsfText {
 public:
  AsfText(std::string_view text, std::string name, const SkeletonOptions& options)
      : lines_(text), name_(std::move(name)), options_(options) {
    root_.name = "root";
  }

  SkeletonFile read() {
    std::string_view line;
    std::string section;
    while (lines_.next(line)) {
      std::vector<std::string> words = tokens_of(line);
      if (words.empty()) continue;
      if (words.front().starts_with(':')) {
        section = small_letters(words.front());
        if (section == ":name" && words.size() > 1) file_.skeleton.name = plain_text(words[1]);
        continue;
      }
      words.front() = small_letters(words.front());
      if (section == ":units") units(words);
      if (section == ":root") bone_line(root_, words);
      if (section == ":bonedata") bone_data(words);
      if (section == ":hierarchy") hierarchy(words);
    }
    if (file_.skeleton.segments.empty()) fail("has no :hierarchy of bones");
    file_.unit_m = unit_m_;
    for (const Bone& bone : bones_) {
      if (!bone.segment)
        file_.warnings.push_back(fmt::format("{}: the bone {} hangs nowhere; it is omitted", name_, shown(bone.name)));
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error("{}:{}: {}", name_, std::max<std::size_t>(1, lines_.number()), what);
  }

  double number_at(const std::vector<std::string>& words, std::size_t i) const {
    const auto value = i < words.size() ? number_of(words[i]) : std::nullopt;
    if (!value || std::abs(*value) > 1e7) fail(fmt::format("{} numbers belong behind {}", i, shown(words.front())));
    return *value;
  }
  Vector<3> vector_at(const std::vector<std::string>& words) const {
    return {number_at(words, 1), number_at(words, 2), number_at(words, 3)};
  }

  void units(const std::vector<std::string>& words) {
    if (words.front() == "length") {
      const double length = number_at(words, 1);
      if (!(length > 1e-9)) fail("the unit of length is 0");
      unit_m_ = kInchM / length;
    }
    if (words.front() == "angle" && words.size() > 1)
      radians_ = small_letters(words[1]).starts_with("rad") ? 1 : std::numbers::pi / 180;
  }

  void bone_data(const std::vector<std::string>& words) {
    if (words.front() == "begin") {
      if (bones_.size() >= kMaxBones) fail(fmt::format("more than {} bones", kMaxBones));
      bones_.emplace_back();
    } else if (words.front() != "end") {
      if (bones_.empty()) fail("a bone's data outside begin and end");
      bone_line(bones_.back(), words);
    }
  }

  void bone_line(Bone& bone, const std::vector<std::string>& words) {
    const std::string& key = words.front();
    if (key == "name" && words.size() > 1) bone.name = plain_text(words[1]);
    if (key == "direction") bone.direction = vector_at(words);
    if (key == "length") bone.length = number_at(words, 1);
    if (key == "axis" && words.size() > 3) bone.axis = vector_at(words) * radians_;
    if (key == "axis" && small_letters(words.back()) != "xyz")
      fail(fmt::format("an axis in the order {}; Marey knows XYZ", shown(words.back())));
    if (key == "position") root_position_ = vector_at(words);
    if (key == "orientation") bone.axis = vector_at(words) * radians_;
    if (key == "dof" || key == "order") {
      for (std::size_t i = 1; i < words.size(); ++i) bone.dof.push_back(small_letters(words[i]));
    }
    std::size_t first = key == "limits" ? 1 : 0;
    if (key == "limits") bone.limits.clear();
    if (key == "limits" || (number_of(key) && words.size() == 2 && !bone.limits.empty())) {
      const auto low = first < words.size() ? number_of(words[first]) : std::nullopt,
                 high = first + 1 < words.size() ? number_of(words[first + 1]) : std::nullopt;
      bone.limits.emplace_back(low.value_or(-360), high.value_or(360));
    }
  }

  void hierarchy(const std::vector<std::string>& words) {
    if (words.front() == "begin" || words.front() == "end") return;
    if (file_.skeleton.segments.empty()) hang(root_, std::nullopt);
    const Bone& parent = bone_called(words.front());
    if (!parent.segment) fail(fmt::format("{} has children before it is hung up itself", shown(words.front())));
    for (std::size_t i = 1; i < words.size(); ++i) {
      Bone& child = bone_called(words[i]);
      if (child.segment) fail(fmt::format("{} hangs on two bones, or in a circle", shown(words[i])));
      hang(child, parent);
    }
  }

  Bone& bone_called(const std::string& required) {
    if (required == "root") return root_;
    const auto found = std::find_if(bones_.begin(), bones_.end(), [&](const Bone& bone) { return bone.name == required; });
    if (found == bones_.end()) fail(fmt::format("there is no bone {}", shown(required)));
    return *found;
  }

  static Matrix<3> fixed_rotations(const Vector<3>& angles) {
    return (Eigen::AngleAxisd(angles.z(), Vector<3>::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vector<3>::UnitY()) *
            Eigen::AngleAxisd(angles.x(), Vector<3>::UnitX()))
        .toRotationMatrix();
  }

  void hang(Bone& bone, const std::optional<Bone>& parent) {
    Segment segment;
    segment.name = bone.name;
    const Matrix<3> own_axes = fixed_rotations(bone.axis);
    segment.joint.parent_from_joint.rotation = own_axes;
    if (parent) {
      segment.parent = parent->segment;
      if (parent->segment != 0)
        segment.joint.parent_from_joint.translation = parent->direction.normalized() * parent->length * unit_m_;
      segment.joint.joint_from_segment.rotation = own_axes.transpose();
    } else {
      const Matrix<3> up = z_up_from(options_.up);
      segment.joint.parent_from_joint = {up, up * root_position_ * unit_m_};
    }
    if (bone.direction.norm() > 1e-12) segment.end = Vector<3>(bone.direction.normalized() * bone.length * unit_m_);
    if (!parent) segment.end.reset();
    add_axes(bone, segment.joint, !parent, own_axes);
    bone.segment = static_cast<int>(file_.skeleton.segments.size());
    file_.skeleton.segments.push_back(std::move(segment));
  }

  /// The first turn of `dof` is the innermost. A root's shifts come before its own axes.
  void add_axes(const Bone& bone, Joint& joint, bool root, const Matrix<3>& own_axes) {
    std::vector<JointAxis> shifts, rotations;
    for (std::size_t i = 0; i < bone.dof.size(); ++i) {
      const std::string& dof = bone.dof[i];
      if (dof == "l") continue;
      if (dof.size() != 2 || (dof[0] != 'r' && dof[0] != 't') || dof[1] < 'x' || dof[1] > 'z')
        fail(fmt::format("{} is not a degree of freedom", shown(dof)));
      const bool is_turn = dof[0] == 'r';
      Coordinate coordinate{fmt::format("{}_{}", bone.name, dof), is_turn, 0, {}, {}, false, {}};
      if (is_turn && i < bone.limits.size() && bone.limits[i].first <= bone.limits[i].second) {
        coordinate.lowest = bone.limits[i].first * radians_;
        coordinate.highest = bone.limits[i].second * radians_;
      }
      const JointAxis axis{is_turn, Vector<3>::Unit(dof[1] - 'x'), {}, static_cast<int>(file_.skeleton.coordinates.size())};
      file_.skeleton.coordinates.push_back(std::move(coordinate));
      if (is_turn) {
        rotations.insert(rotations.begin(), axis);
      } else {
        shifts.push_back(axis);
      }
    }
    if (rotations.size() > 3 || shifts.size() > 3) fail(fmt::format("{} has more than six degrees of freedom", shown(bone.name)));
    joint.axes = shifts;
    if (root && !own_axes.isIdentity(1e-12)) {  // C before the turns, and back behind them
      const Eigen::AngleAxisd whole(own_axes);
      joint.axes.push_back({true, whole.axis(), CoordinateFunction::constant(whole.angle()), {}});
      joint.joint_from_segment.rotation = own_axes.transpose();
    }
    joint.axes.insert(joint.axes.end(), rotations.begin(), rotations.end());
  }

  TextLines lines_;
  std::string name_;
  SkeletonOptions options_;
  SkeletonFile file_;
  double unit_m_ = kInchM, radians_ = std::numbers::pi / 180;
  Vector<3> root_position_ = Vector<3>::Zero();
  Bone root_;
  std::vector<Bone> bones_;
};

}  // namespace

SkeletonFile parse_asf(std::string_view text, const std::string& name, const SkeletonOptions& options) {
  return AsfText(text, name, options).read();
}

SkeletonMotion parse_amc(std::string_view text, const std::string& name, const SkeletonFile& skeleton,
                         const SkeletonOptions& options) {
  const Skeleton& asf = skeleton.skeleton;
  // Values come in the order of `dof`: as the coordinates of a bone stand in the skeleton, shifts in units of the skeleton's own.
  std::map<std::string, std::vector<int>, std::less<>> coordinates;
  for (std::size_t i = 0; i < asf.coordinates.size(); ++i) {
    const std::string& full = asf.coordinates[i].name;
    coordinates[full.substr(0, full.rfind('_'))].push_back(static_cast<int>(i));
  }
  SkeletonMotion motion{.rate_hz = options.rate_hz, .times = {}, .rows = {}};
  TextLines lines(text);
  std::string_view line;
  double radians = std::numbers::pi / 180;
  while (lines.next(line)) {
    const std::vector<std::string> words = tokens_of(line);
    if (words.empty()) continue;
    const std::string head = small_letters(words.front());
    if (head.starts_with(':')) {
      if (head == ":radians") radians = 1;
      continue;
    }
    if (words.size() == 1 && whole_number_of(head)) {
      // A frame names what moves in it, at two bytes a number and more.
      if ((motion.rows.size() + 1) * asf.coordinates.size() > text.size() + kFewNumbers)
        throw Error("{}:{}: frames without their bones; the file is damaged", name, lines.number());
      motion.times.push_back(timestamp_from_seconds(static_cast<double>(motion.rows.size()) / motion.rate_hz));
      motion.rows.push_back(motion.rows.empty() ? asf.rest() : motion.rows.back());
      continue;
    }
    const auto bone = coordinates.find(words.front());
    if (bone == coordinates.end())
      throw Error("{}:{}: the skeleton has no bone {} that moves", name, lines.number(), shown(words.front()));
    if (motion.rows.empty()) throw Error("{}:{}: a bone's values before the first frame's number", name, lines.number());
    if (words.size() != bone->second.size() + 1)
      throw Error("{}:{}: {} values of {}, which has {}", name, lines.number(), words.size() - 1, shown(words.front()),
                  bone->second.size());
    for (std::size_t i = 0; i < bone->second.size(); ++i) {
      const auto value = number_of(words[i + 1]);
      if (!value || std::abs(*value) > 1e7)
        throw Error("{}:{}: {} is no number that could stand here", name, lines.number(), shown(words[i + 1]));
      const auto at = static_cast<std::size_t>(bone->second[i]);
      motion.rows.back()[at] = *value * (asf.coordinates[at].is_rotation ? radians : skeleton.unit_m);
    }
  }
  if (motion.rows.empty()) throw Error("{}: has no frames", name);
  return motion;
}

/// An .asf file alone rests in one frame; an .amc file moves the bones of its own.
std::unique_ptr<FileReader> open_acclaim(const std::string& path, const ReadOptions& how) {
  const SkeletonOptions options = skeleton_options(how);
  const std::string text = read_file(path);
  if (text.find(":bonedata") != std::string::npos) return recording_of(parse_asf(text, path, options), path);
  const std::string asf = how.metadata.empty() ? asf_for(path) : how.metadata;
  SkeletonFile file = parse_asf(read_file(asf), asf, options);
  file.motion = parse_amc(text, path, file, options);
  return recording_of(std::move(file), path);
}

Format acclaim_format() {
  return {.name = "amc",
          .title = "an AMC or ASF file",
          .endings = "",
          .holds = Content::space,
          .detail =
              "units as the .asf says, y up, 120 Hz where not reported otherwise; joints as points, bones as bodies. Of an .amc "
              "file the "
              ".asf beside it is read, or `--metadata`",
          .is =
              [](const Beginning& file) {
                if (!file.is_text()) return false;
                const bool motion = file.has(":FULLY-SPECIFIED") || file.has(":DEGREES") || file.has(":RADIANS");
                return motion || (file.has(":bonedata") && file.has(":root"));
              },
          .open = open_acclaim,
          .z_up = true,
          .skeleton = true};
}

}  // namespace marey::format::skeleton
