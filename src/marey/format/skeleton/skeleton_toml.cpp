// skeleton.toml, our own: one table a segment with its joint, one a marker, lengths in m, angles in degrees, z up. All that is
// wrong is reported at once.
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/nesting.h"
#include "marey/format/rig/rig_section.h"
#include "marey/format/skeleton/skeleton_file.h"

namespace marey::format::skeleton {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kMaxSegments = 10'000;

/// The joints that the file names, and their coordinates: shifts (capital), turns.
int coordinates_of_kind(std::string_view kind) {
  if (kind == "weld") return 0;
  if (kind == "hinge") return 1;
  if (kind == "universal") return 2;
  if (kind == "ball") return 3;
  return kind == "free" ? 6 : -1;
}

class SkeletonToml {
 public:
  SkeletonToml(const toml::table& file, const std::string& name) : file_(file), problems_(name) {}

  SkeletonFile read() {
    rig::Section top(file_, "the skeleton", problems_);
    top.only({"name", "segment", "marker", "coupling"});
    read_.skeleton.name = plain_text(top.text("name").value_or("skeleton"));
    for_each_table("segment", [&](const toml::table& table) { add_segment(table); });
    for_each_table("coupling", [&](const toml::table& table) { add_coupling(table); });
    for_each_table("marker", [&](const toml::table& table) { add_marker(table); });
    if (read_.skeleton.segments.empty()) problems_.add(file_.source(), "has no [[segment]]");
    problems_.throw_if_any();
    return std::move(read_);
  }

 private:
  template <typename Take>
  void for_each_table(std::string_view key, Take&& take) {
    const toml::node* const node = file_.get(key);
    if (node == nullptr) return;
    const toml::array* const array = node->as_array();
    if (array == nullptr) return problems_.add(node->source(), fmt::format("{} must be tables: [[{}]]", key, key));
    for (const toml::node& each : *array) {
      if (const toml::table* const table = each.as_table()) {
        take(*table);
      } else {
        problems_.add(each.source(), fmt::format("{} must be tables: [[{}]]", key, key));
      }
    }
  }

  static Vector<3> vector_of(const rig::Section& section, std::string_view key) {
    const auto values = section.numbers(key, 3, 3, "three numbers");
    return values ? Vector<3>((*values)[0], (*values)[1], (*values)[2]) : Vector<3>(Vector<3>::Zero());
  }

  void add_segment(const toml::table& table) {
    if (read_.skeleton.segments.size() >= kMaxSegments) return;
    rig::Section section(table, "a segment", problems_);
    section.only({"name", "parent", "at", "turned", "joint", "axes", "coordinates", "limits", "rest", "end"});
    Segment segment;
    segment.name = plain_text(section.text("name").value_or(""));
    if (segment.name.empty()) return section.problem("name", "name must be given");
    section.rename(fmt::format("segment {}", segment.name));
    if (read_.skeleton.segment(segment.name)) section.problem("name", "is there twice");
    if (const auto parent = section.text("parent")) {
      segment.parent = read_.skeleton.segment(*parent);
      if (!segment.parent) return section.problem("parent", "parent is not a segment that stands before it");
    }
    const Vector<3> rotated = vector_of(section, "turned") * kDegree;
    segment.joint.parent_from_joint = {
        (Eigen::AngleAxisd(rotated.x(), Vector<3>::UnitX()) * Eigen::AngleAxisd(rotated.y(), Vector<3>::UnitY()) *
         Eigen::AngleAxisd(rotated.z(), Vector<3>::UnitZ()))
            .toRotationMatrix(),
        vector_of(section, "at")};
    if (section.has("end")) segment.end = vector_of(section, "end");
    add_joint(table, section, segment);
    read_.skeleton.segments.push_back(std::move(segment));
  }

  void add_joint(const toml::table& table, const rig::Section& section, Segment& segment) {
    const std::string kind = section.text("joint").value_or(segment.parent ? "weld" : "free");
    const int count = coordinates_of_kind(kind);
    if (count < 0) return section.problem("joint", "joint must be weld, hinge, universal, ball or free");
    const std::vector<std::string> names = texts_of(table, "coordinates");
    if (!names.empty() && names.size() != static_cast<std::size_t>(count))
      return section.problem("coordinates", fmt::format("coordinates must be {} names", count));
    const auto limits = section.numbers("limits", static_cast<std::size_t>(2 * count), static_cast<std::size_t>(2 * count),
                                        fmt::format("{} numbers: a low and a high one for each coordinate", 2 * count));
    const auto rest = section.numbers("rest", static_cast<std::size_t>(count), static_cast<std::size_t>(count),
                                      fmt::format("{} numbers, one for each coordinate", count));
    const std::vector<Vector<3>> rotations = axes_of(table, section, count == 6 ? 3 : count);
    if (static_cast<int>(rotations.size()) != (count == 6 ? 3 : count)) return;
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const bool shift = count == 6 && i < 3;
      Coordinate coordinate;
      coordinate.name = names.empty() ? fmt::format("{}_{}", segment.name, i + 1) : plain_text(names[at]);
      if (read_.skeleton.coordinate(coordinate.name))
        section.problem("coordinates", fmt::format("{} is there twice", coordinate.name));
      coordinate.is_rotation = !shift;
      const double unit = shift ? 1 : kDegree;
      if (rest) coordinate.rest = (*rest)[at] * unit;
      if (limits && (*limits)[2 * at] < (*limits)[2 * at + 1]) {
        coordinate.lowest = (*limits)[2 * at] * unit;
        coordinate.highest = (*limits)[2 * at + 1] * unit;
      } else if (limits) {
        section.problem("limits", fmt::format("of {} do not grow", coordinate.name));
      }
      segment.joint.axes.push_back({!shift,
                                    shift ? Vector<3>(Vector<3>::Unit(i)) : rotations[count == 6 ? at - 3 : at],
                                    {},
                                    static_cast<int>(read_.skeleton.coordinates.size())});
      read_.skeleton.coordinates.push_back(std::move(coordinate));
    }
  }

  static std::vector<std::string> texts_of(const toml::table& table, std::string_view key) {
    std::vector<std::string> texts;
    if (const toml::array* const array = table[key].as_array()) {
      for (const toml::node& each : *array) texts.push_back(each.value<std::string>().value_or(""));
    }
    return texts;
  }

  /// "x", "-z", or three numbers; nothing of all where one is neither.
  std::vector<Vector<3>> axes_of(const toml::table& table, const rig::Section& section, int count) const {
    std::vector<Vector<3>> axes;
    const toml::array* const array = table["axes"].as_array();
    if (array == nullptr) {
      for (const int i : {2, 0, 1}) {
        if (static_cast<int>(axes.size()) < count) axes.emplace_back(Vector<3>::Unit(i));
      }
      return axes;
    }
    for (const toml::node& each : *array) {
      Vector<3> axis = Vector<3>::Zero();
      if (const auto letter = each.value<std::string>()) {
        const double sign = letter->starts_with('-') ? -1 : 1;
        const char last = letter->empty() ? ' ' : letter->back();
        if (last >= 'x' && last <= 'z') axis = sign * Vector<3>::Unit(last - 'x');
      } else if (const toml::array* const three = each.as_array(); three != nullptr && three->size() == 3) {
        for (int i = 0; i < 3; ++i) axis[i] = three->get(static_cast<std::size_t>(i))->value<double>().value_or(0);
      }
      if (!(axis.norm() > 1e-9) || !axis.allFinite()) break;
      axes.emplace_back(axis.normalized());
    }
    if (static_cast<int>(axes.size()) != count || axes.size() != array->size())
      section.problem("axes", fmt::format("axes must be {} of \"x\", \"y\", \"z\", or three numbers each", count));
    return axes;
  }

  void add_coupling(const toml::table& table) {
    rig::Section section(table, "a coupling", problems_);
    section.only({"coordinate", "follows", "slope", "offset"});
    const auto own = read_.skeleton.coordinate(section.text("coordinate").value_or("")),
               to = read_.skeleton.coordinate(section.text("follows").value_or(""));
    if (!own || !to || *own == *to) return section.problem("coordinate", "and follows must be two coordinates");
    Coordinate& coordinate = read_.skeleton.coordinates[static_cast<std::size_t>(*own)];
    if (coordinate.coupling || read_.skeleton.coordinates[static_cast<std::size_t>(*to)].coupling)
      return section.problem("follows", "must not follow from another itself");
    const double unit = coordinate.is_rotation ? kDegree : 1;
    coordinate.coupling = Coordinate::Coupling{
        *to, CoordinateFunction::linear(section.number("slope").value_or(1), section.number("offset").value_or(0) * unit)};
  }

  void add_marker(const toml::table& table) {
    rig::Section section(table, "a marker", problems_);
    section.only({"name", "on", "at", "weight"});
    SkeletonMarker marker;
    marker.label = plain_text(section.text("name").value_or(""));
    if (marker.label.empty()) return section.problem("name", "name must be given");
    section.rename(fmt::format("marker {}", marker.label));
    const auto on = read_.skeleton.segment(section.text("on").value_or(""));
    if (!on) return section.problem("on", "on must be a segment");
    marker.segment = *on;
    marker.position = vector_of(section, "at");
    if (section.has("weight")) marker.weight = section.positive("weight").value_or(1);
    read_.skeleton.markers.push_back(std::move(marker));
  }

  const toml::table& file_;
  rig::Problems problems_;
  SkeletonFile read_;
};

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : plain_text(text)) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string bracketed(const Vector<3>& v) {
  return fmt::format("[{}, {}, {}]", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);  // no −0
}

void append_joint_toml(std::string& text, const Skeleton& skeleton, const Segment& segment) {
  const std::string_view kind = kind_of(skeleton, segment.joint);
  const int count = coordinates_of_kind(kind);
  if (count < 0 || count != static_cast<int>(segment.joint.axes.size()) ||
      !segment.joint.joint_from_segment.rotation.isIdentity(1e-12) || !segment.joint.joint_from_segment.translation.isZero(1e-12))
    throw Error("the joint of {} is more than a skeleton.toml can say: write the model's own format instead", segment.name);
  std::vector<std::string> names, axes, limits, rest;
  bool limited = true;
  for (const JointAxis& axis : segment.joint.axes) {
    const Coordinate& coordinate = skeleton.coordinates[static_cast<std::size_t>(*axis.coordinate)];
    const double unit = coordinate.is_rotation ? kDegree : 1;
    names.push_back(quoted(coordinate.name));
    if (axis.is_rotation) axes.push_back(bracketed(axis.axis));
    rest.push_back(fmt::format("{}", coordinate.rest / unit));
    limited = limited && coordinate.lowest && coordinate.highest;
    if (limited) limits.push_back(fmt::format("{}, {}", *coordinate.lowest / unit, *coordinate.highest / unit));
  }
  text += fmt::format("joint = \"{}\"\n", kind);
  if (names.empty()) return;
  text += fmt::format("axes = [{}]\ncoordinates = [{}]\nrest = [{}]\n", fmt::join(axes, ", "), fmt::join(names, ", "),
                      fmt::join(rest, ", "));
  if (limited) text += fmt::format("limits = [{}]\n", fmt::join(limits, ", "));
}

}  // namespace

SkeletonFile parse_toml(std::string_view text, const std::string& name) {
  check_nesting(text, Notation::toml, name);
  toml::table file;
  try {
    file = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", name, error.source().begin.line, rig::excerpt(error.description(), 200));
  }
  return SkeletonToml(file, name).read();
}

std::string to_toml(const Skeleton& skeleton) {
  std::string text = fmt::format("# A skeleton: lengths in m, angles in degrees, z up.\nname = {}\n", quoted(skeleton.name));
  for (const Segment& segment : skeleton.segments) {
    text += fmt::format("\n[[segment]]\nname = {}\n", quoted(segment.name));
    if (segment.parent)
      text += fmt::format("parent = {}\n", quoted(skeleton.segments[static_cast<std::size_t>(*segment.parent)].name));
    text += fmt::format("at = {}\n", bracketed(segment.joint.parent_from_joint.translation));
    const Vector<3> rotated =
        rotations_about(segment.joint.parent_from_joint.rotation, Matrix<3>::Identity(), Vector<3>::Zero()) / kDegree;
    if (rotated.norm() > 1e-12) text += fmt::format("turned = {}\n", bracketed(rotated));
    append_joint_toml(text, skeleton, segment);
    if (segment.end) text += fmt::format("end = {}\n", bracketed(*segment.end));
  }
  for (const Coordinate& coordinate : skeleton.coordinates) {
    if (!coordinate.coupling) continue;
    const auto line = coordinate.coupling->function.line();
    if (!line) throw Error("{} follows another coordinate by a curve, which a skeleton.toml cannot say", coordinate.name);
    text += fmt::format("\n[[coupling]]\ncoordinate = {}\nfollows = {}\nslope = {}\noffset = {}\n", quoted(coordinate.name),
                        quoted(skeleton.coordinates[static_cast<std::size_t>(coordinate.coupling->to)].name), line->first,
                        line->second / (coordinate.is_rotation ? kDegree : 1));
  }
  for (const SkeletonMarker& marker : skeleton.markers) {
    text += fmt::format("\n[[marker]]\nname = {}\non = {}\nat = {}\n", quoted(marker.label),
                        quoted(skeleton.segments[static_cast<std::size_t>(marker.segment)].name), bracketed(marker.position));
    if (marker.weight != 1) text += fmt::format("weight = {}\n", marker.weight);
  }
  return text;
}

}  // namespace marey::format::skeleton
