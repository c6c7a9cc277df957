// Vicon's skeletons (VSK): segments within segments, each placed in its parent and hung by a joint, and markers on them. Numbers
// may be expressions of named parameters, which Vicon fits to the person. mm and rad. Vicon does not publish the format; what is
// known here is what two subjects' files show, and a sentence is said where they leave something open.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format::skeleton {
namespace {

constexpr double kMillimetre = 0.001;
constexpr double kMaxDistanceMm = 1e6;
constexpr std::size_t kMaxVskSegments = 1000;
constexpr std::array kShifts = {"tx", "ty", "tz"}, kRotations = {"rx", "ry", "rz"};

/// Numbers by name, and sums and products of them.
class VskParameters {
 public:
  VskParameters(pugi::xml_node parameters, const std::string& file) : file_(file) {
    for (const pugi::xml_node parameter : parameters.children("Parameter")) {
      const auto value = number_of(parameter.attribute("VALUE").value());
      if (!value)
        throw Error("{}: parameter {} is {}, which is no number", file_, shown(parameter.attribute("NAME").value()),
                    shown(parameter.attribute("VALUE").value()));
      values_[parameter.attribute("NAME").value()] = *value;
    }
  }

  /// Three of them, with blanks between.
  Vector<3> vector(pugi::xml_node node, const char* attribute) const {
    const std::string_view text = node.attribute(attribute).value();
    Vector<3> vector = Vector<3>::Zero();
    std::size_t at = 0;
    int count = 0;
    while ((at = text.find_first_not_of(" \t\r\n", at)) != std::string_view::npos) {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
      if (count < 3) vector[count] = value(text.substr(at, end - at));
      ++count;
      at = end;
    }
    if (count != 3)
      throw Error("{}: {} of {} has {} numbers where 3 belong", file_, attribute, shown(node.attribute("NAME").value()), count);
    return vector;
  }

  double value(std::string_view word) const {
    if (const auto plain = one(word)) return *plain;
    double sum = 0;
    for (std::size_t at = 0; at < word.size();) {
      const double sign = word[at] == '-' ? -1 : 1;
      if (word[at] == '-' || word[at] == '+') ++at;
      const std::size_t end = std::min(word.find_first_of("+-", at), word.size());
      sum += sign * product(word.substr(at, end - at), word);
      at = end;
    }
    return finite(sum, word);
  }

 private:
  double finite(double value, std::string_view word) const {
    if (!(std::abs(value) <= kMaxDistanceMm)) throw Error("{}: {} is beyond what a skeleton has", file_, shown(word));
    return value;
  }

  /// A number or a name, with a sign or without.
  std::optional<double> one(std::string_view word) const {
    if (const auto number = number_of(word)) return finite(*number, word);
    if (const auto found = values_.find(word); found != values_.end()) return finite(found->second, word);
    if (word.empty() || (word.front() != '-' && word.front() != '+')) return std::nullopt;
    const auto found = values_.find(word.substr(1));
    if (found == values_.end()) return std::nullopt;
    return finite(word.front() == '-' ? -found->second : found->second, word);
  }

  double product(std::string_view factors, std::string_view whole) const {
    double product = 1;
    char before = '*';
    for (std::size_t at = 0; at <= factors.size();) {
      const std::size_t end = std::min(factors.find_first_of("*/", at), factors.size());
      const auto factor = one(factors.substr(at, end - at));
      if (!factor) throw Error("{}: {} is no number, and no parameter that the file has", file_, shown(whole));
      product = before == '*' ? product * *factor : product / *factor;
      if (end == factors.size()) break;
      before = factors[end];
      at = end + 1;
    }
    return product;
  }

  const std::string& file_;
  std::map<std::string, double, std::less<>> values_;
};

class VskModel {
 public:
  VskModel(pugi::xml_node model, const std::string& name, const SkeletonOptions& options)
      : model_(model), name_(name), parameters_(model.child("Parameters"), name), options_(options) {}

  SkeletonFile read() {
    for (const pugi::xml_node marker : markers()) carrying_.insert(marker.attribute("SEGMENT").value());
    for (const pugi::xml_node segment : model_.child("Skeleton").children("Segment")) add_segment(segment, std::nullopt);
    if (file_.skeleton.segments.empty()) throw Error("{}: has no segments, as a Vicon skeleton does", name_);
    for (const pugi::xml_node marker : markers()) add_marker(marker);
    file_.unit_m = kMillimetre;
    return std::move(file_);
  }

 private:
  pugi::xml_object_range<pugi::xml_named_node_iterator> markers() const {
    return model_.child("MarkerSet").child("Markers").children("Marker");
  }

  /// A leaf without markers that only says where its parent ends.
  bool is_end(pugi::xml_node segment) const {
    const std::string_view name = segment.attribute("NAME").value();
    return !segment.child("Segment") && !carrying_.contains(name) && (segment.child("JointDummy") || name.ends_with("_End"));
  }

  /// It and all that hangs on it; XML is not nested deeper than the stack supports.
  void add_segment(pugi::xml_node node, std::optional<int> parent) {
    const Vector<3> location = kMillimetre * parameters_.vector(node, "POSITION");
    if (parent && is_end(node)) {
      std::optional<Vector<3>>& end = file_.skeleton.segments[static_cast<std::size_t>(*parent)].end;
      if (!end) end = location;
      return;
    }
    Segment segment;
    segment.name = plain_text(node.attribute("NAME").value());
    segment.parent = parent;
    if (segment.name.empty()) throw Error("{}: a segment without a name", name_);
    if (file_.skeleton.segment(segment.name)) throw Error("{}: two segments are called {}", name_, shown(segment.name));
    if (file_.skeleton.segments.size() >= kMaxVskSegments) throw Error("{}: more than {} segments", name_, kMaxVskSegments);
    segment.joint.parent_from_joint = {rotated(node, segment.name), location};
    if (!parent)
      segment.joint.parent_from_joint = Rigid3{z_up_from(options_.up), Vector<3>::Zero()} * segment.joint.parent_from_joint;
    add_axes(node, segment);
    const int index = static_cast<int>(file_.skeleton.segments.size());
    file_.skeleton.segments.push_back(std::move(segment));
    for (const pugi::xml_node child : node.children("Segment")) add_segment(child, index);
  }

  Matrix<3> rotated(pugi::xml_node node, const std::string& segment) {
    if (!node.attribute("ORIENTATION")) return Matrix<3>::Identity();
    const Vector<3> angles = parameters_.vector(node, "ORIENTATION");
    if ((angles.array() != 0).count() > 1)
      file_.warnings.push_back(fmt::format(
          "{}: {} rests turned about several axes; taken as about x, then the new y, then the new z", name_, shown(segment)));
    return (Eigen::AngleAxisd(angles.x(), Vector<3>::UnitX()) * Eigen::AngleAxisd(angles.y(), Vector<3>::UnitY()) *
            Eigen::AngleAxisd(angles.z(), Vector<3>::UnitZ()))
        .toRotationMatrix();
  }

  void add_axes(pugi::xml_node node, Segment& segment) {
    if (node.child("JointDummy")) return;
    const bool moves_freely = static_cast<bool>(node.child("JointFree"));
    if (moves_freely || node.child("JointBall")) {
      for (int i = 0; moves_freely && i < 3; ++i)
        add_axis(segment, kShifts[static_cast<std::size_t>(i)], false, Vector<3>::Unit(i));
      for (int i = 0; i < 3; ++i) add_axis(segment, kRotations[static_cast<std::size_t>(i)], true, Vector<3>::Unit(i));
    } else if (const pugi::xml_node hinge = node.child("JointHinge")) {
      add_axis(segment, "turn", true, axis_of(hinge, 0, "AXIS"));
    } else if (const pugi::xml_node cross = node.child("JointHardySpicer")) {
      add_axis(segment, "turn1", true, axis_of(cross, 0, "AXIS-PAIR"));
      add_axis(segment, "turn2", true, axis_of(cross, 3, "AXIS-PAIR"));
    } else {
      throw Error("{}: {} hangs on no joint that Marey knows: JointFree, JointBall, JointHinge, JointHardySpicer, JointDummy",
                  name_, shown(segment.name));
    }
  }

  void add_axis(Segment& segment, const char* name, bool is_rotation, const Vector<3>& axis) {
    const int index = static_cast<int>(file_.skeleton.coordinates.size());
    file_.skeleton.coordinates.push_back({fmt::format("{}_{}", segment.name, name), is_rotation, 0, {}, {}, false, {}});
    segment.joint.axes.push_back({is_rotation, axis, {}, index});
  }

  /// Three of an attribute's numbers, from the `first` on.
  Vector<3> axis_of(pugi::xml_node joint, std::size_t first, const char* attribute) const {
    std::vector<double> numbers;
    std::string_view text = joint.attribute(attribute).value();
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
      if (end > 0) numbers.push_back(parameters_.value(text.substr(0, end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (numbers.size() < first + 3) throw Error("{}: {} of a joint has {} numbers", name_, attribute, numbers.size());
    const Vector<3> axis(numbers[first], numbers[first + 1], numbers[first + 2]);
    if (!(axis.norm() > 1e-9)) throw Error("{}: {} of a joint has no direction", name_, attribute);
    return axis.normalized();
  }

  void add_marker(pugi::xml_node node) {
    const std::string label = plain_text(node.attribute("NAME").value()), on = plain_text(node.attribute("SEGMENT").value());
    const auto segment = file_.skeleton.segment(on);
    if (!segment || label.empty()) {
      file_.warnings.push_back(
          fmt::format("{}: marker {} sits on {}, which is not a segment; it is omitted", name_, shown(label), shown(on)));
      return;
    }
    file_.skeleton.markers.push_back({label, *segment, kMillimetre * parameters_.vector(node, "POSITION"), 1});
  }

  pugi::xml_node model_;
  std::string name_;
  VskParameters parameters_;
  SkeletonOptions options_;
  SkeletonFile file_;
  std::set<std::string, std::less<>> carrying_;  // segments that have markers
};

}  // namespace

SkeletonFile parse_vsk(std::string_view text, const std::string& name, const SkeletonOptions& options) {
  const pugi::xml_document document = parse_xml(text, name);
  const pugi::xml_node model = document.child("KinematicModel");
  if (!model) throw Error("{}: has no <KinematicModel>, as a Vicon skeleton does", name);
  return VskModel(model, name, options).read();
}

}  // namespace marey::format::skeleton
