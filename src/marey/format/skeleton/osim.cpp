// OpenSim's models. Since version 4 joints stand in a set of their own and name frames, which may be offset from their bodies;
// before, each body holds the joint to its parent. Both become the same tree. y is up in them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format::skeleton {
namespace {

constexpr double kMaxDistanceM = 1e4;  // no model's numbers are beyond this

std::string_view bare(std::string_view text) {
  while (!text.empty() && static_cast<unsigned char>(text.front()) <= ' ') text.remove_prefix(1);
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.remove_suffix(1);
  return text;
}

/// "/bodyset/pelvis" is called "pelvis".
std::string last_part(std::string_view path) {
  path = bare(path);
  return plain_text(path.substr(path.find_last_of('/') + 1));
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> all;
  for (text = bare(text); !text.empty(); text = bare(text)) {
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    all.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return all;
}

/// One model; every member adds a part of it.
class OsimModel {
 public:
  OsimModel(pugi::xml_node model, const std::string& name) : model_(model), name_(name) {}

  SkeletonFile read() {
    file_.skeleton.name = plain_text(model_.attribute("name").value());
    gather_joints();
    for (const std::string& body : in_order()) add_segment(body);
    add_masses();
    for (const pugi::xml_node constraint : model_.child("ConstraintSet").child("objects").children()) add_constraint(constraint);
    for (const Coordinate& coordinate : file_.skeleton.coordinates) {
      if (coordinate.coupling && file_.skeleton.coordinates[static_cast<std::size_t>(coordinate.coupling->to)].coupling)
        fail(fmt::format("{} follows from a coordinate that itself follows from another", shown(coordinate.name)));
    }
    for (const pugi::xml_node marker : model_.child("MarkerSet").child("objects").children("Marker")) add_marker(marker);
    note_unused();
    return std::move(file_);
  }

 private:
  struct Frame {
    std::string body;
    Rigid3 body_from_frame;
  };
  struct Hung {
    pugi::xml_node joint;
    Frame parent, child;
  };

  [[noreturn]] void fail(const std::string& what) const { throw Error("{}: {}", name_, what); }

  double number_in(pugi::xml_node node, double without) const {
    if (!node || bare(node.child_value()).empty()) return without;
    const auto value = number_of(bare(node.child_value()));
    if (!value) fail(fmt::format("{} of <{}> is no number", shown(node.child_value()), shown(node.name())));
    return *value;
  }

  std::vector<double> numbers_in(pugi::xml_node node) const {
    std::vector<double> values;
    for (const std::string_view word : words(node.child_value())) {
      const auto value = number_of(word);
      if (!value) fail(fmt::format("{} in <{}> is no number", shown(word), shown(node.name())));
      values.push_back(*value);
    }
    return values;
  }

  Vector<3> vector_in(pugi::xml_node node) const {
    if (!node) return Vector<3>::Zero();
    const std::vector<double> values = numbers_in(node);
    if (values.size() != 3) fail(fmt::format("<{}> has {} numbers where 3 belong", shown(node.name()), values.size()));
    const Vector<3> vector(values[0], values[1], values[2]);
    if (!(vector.norm() < kMaxDistanceM))
      fail(fmt::format("<{}> is {} m long; is its unit right?", shown(node.name()), vector.norm()));
    return vector;
  }

  /// Angles about x, then the new y, then the new z, rad.
  Rigid3 located(pugi::xml_node translation, pugi::xml_node orientation) const {
    const Vector<3> angles = vector_in(orientation);
    Rigid3 location{.rotation = rotation_from_axes(angles), .translation = vector_in(translation)};
    return location;
  }
  static Matrix<3> rotation_from_axes(const Vector<3>& angles) {
    return (Eigen::AngleAxisd(angles.x(), Vector<3>::UnitX()) * Eigen::AngleAxisd(angles.y(), Vector<3>::UnitY()) *
            Eigen::AngleAxisd(angles.z(), Vector<3>::UnitZ()))
        .toRotationMatrix();
  }

  /// The frames that a joint of version 4 names: its own, or a body by itself.
  Frame frame_of(pugi::xml_node joint, const char* socket) const {
    const std::string required = last_part(joint.child(socket).child_value());
    if (required.empty()) fail(fmt::format("joint {} has no <{}>", shown(joint.attribute("name").value()), socket));
    for (const pugi::xml_node frame : joint.child("frames").children()) {
      if (last_part(frame.attribute("name").value()) != required) continue;
      return {last_part(frame.child("socket_parent").child_value()),
              located(frame.child("translation"), frame.child("orientation"))};
    }
    return {required, {}};
  }

  void hang(const std::string& body, Hung hung) {
    if (hung_.contains(body)) {
      file_.warnings.push_back(fmt::format("{}: {} hangs on two joints; {} is omitted", name_, shown(body),
                                           shown(hung.joint.attribute("name").value())));
      return;
    }
    if (body == "ground") fail("its ground hangs on a joint; nothing moves it");
    order_.push_back(body);
    hung_.emplace(body, std::move(hung));
  }

  void gather_joints() {
    for (const pugi::xml_node body : model_.child("BodySet").child("objects").children("Body")) {
      const std::string name = last_part(body.attribute("name").value());
      if (!bodies_.insert(name).second) fail(fmt::format("two bodies are called {}", shown(name)));
      const pugi::xml_node joint =
          first_element(body.child("Joint").child("objects") ? body.child("Joint").child("objects") : body.child("Joint"));
      if (!joint) continue;
      hang(name, {joint,
                  {last_part(joint.child("parent_body").child_value()),
                   located(joint.child("location_in_parent"), joint.child("orientation_in_parent"))},
                  {name, located(joint.child("location"), joint.child("orientation"))}});
    }
    for (const pugi::xml_node joint : model_.child("JointSet").child("objects").children()) {
      if (joint.type() != pugi::node_element) continue;
      Hung hung{joint, frame_of(joint, "socket_parent_frame"), frame_of(joint, "socket_child_frame")};
      const std::string body = hung.child.body;
      hang(body, std::move(hung));
    }
    if (hung_.empty()) fail("has no joints; is it an OpenSim model of version 2, 3 or 4?");
  }

  static pugi::xml_node first_element(pugi::xml_node parent) {
    return parent.find_child([](pugi::xml_node node) { return node.type() == pugi::node_element; });
  }

  /// Parents before children, else as the file has them.
  std::vector<std::string> in_order() const {
    std::vector<std::string> sorted;
    std::set<std::string> placed_bodies = {"ground"};
    for (bool more = true; more;) {
      more = false;
      for (const std::string& body : order_) {
        const std::string& parent = hung_.at(body).parent.body;
        if (placed_bodies.contains(body) || !placed_bodies.contains(parent)) continue;
        placed_bodies.insert(body);
        sorted.push_back(body);
        more = true;
      }
    }
    for (const std::string& body : order_) {
      if (!placed_bodies.contains(body))
        fail(fmt::format("{} hangs on {}, and nothing leads from there to the ground: a circle, or a body that is not there",
                         shown(body), shown(hung_.at(body).parent.body)));
    }
    return sorted;
  }

  void add_segment(const std::string& body) {
    const Hung& hung = hung_.at(body);
    Segment segment;
    segment.name = body;
    if (hung.parent.body == "ground") {
      segment.joint.parent_from_joint =
          Rigid3{.rotation = z_up_from(UpAxis::y), .translation = Vector<3>::Zero()} * hung.parent.body_from_frame;
    } else {
      segment.parent = file_.skeleton.segment(hung.parent.body);
      segment.joint.parent_from_joint = hung.parent.body_from_frame;
    }
    segment.joint.joint_from_segment = hung.child.body_from_frame.inverse();
    add_axes(hung.joint, segment.joint);
    file_.skeleton.segments.push_back(std::move(segment));
  }

  void add_masses() {
    file_.masses.resize(file_.skeleton.segments.size());
    for (const pugi::xml_node body : model_.child("BodySet").child("objects").children("Body")) {
      const std::string name = last_part(body.attribute("name").value());
      const auto segment = file_.skeleton.segment(name);
      if (!segment) continue;
      SegmentMass& mass = file_.masses[static_cast<std::size_t>(*segment)];
      mass.mass_kg = number_in(body.child("mass"), 0);
      if (!(mass.mass_kg >= 0)) fail(fmt::format("{} has a mass of {} kg", shown(name), mass.mass_kg));
      mass.centre = vector_in(body.child("mass_center"));
      const std::vector<double> six = numbers_in(body.child("inertia"));  // version 4; before, each has an element
      const auto of = [&](std::size_t i, const char* element) {
        return six.size() == 6 ? six[i] : number_in(body.child(element), 0);
      };
      const double xy = of(3, "inertia_xy"), xz = of(4, "inertia_xz"), yz = of(5, "inertia_yz");
      mass.inertia << of(0, "inertia_xx"), xy, xz, xy, of(1, "inertia_yy"), yz, xz, yz, of(2, "inertia_zz");
    }
  }

  void add_axes(pugi::xml_node joint, Joint& into) {
    const std::string kind = joint.name();
    if (bare(joint.child_value("reverse")) == "true")
      fail(fmt::format("joint {} is reversed (version 2 or 3); write the model again with OpenSim 4",
                       shown(joint.attribute("name").value())));
    const std::vector<int> coordinates = add_coordinates(joint);
    if (kind == "CustomJoint") return add_custom(joint, coordinates, into);
    static const std::map<std::string, std::string_view, std::less<>> kAxes = {
        {"WeldJoint", ""},    {"PinJoint", "z"},      {"SliderJoint", "X"},   {"UniversalJoint", "xy"},
        {"BallJoint", "xyz"}, {"GimbalJoint", "xyz"}, {"PlanarJoint", "zXY"}, {"FreeJoint", "xyzXYZ"}};
    const auto known = kAxes.find(kind);
    if (known == kAxes.end())
      fail(fmt::format("joint {} is a {}, which Marey does not know; weld it, or write it as a CustomJoint",
                       shown(joint.attribute("name").value()), shown(kind)));
    if (coordinates.size() != known->second.size())
      fail(fmt::format("joint {} has {} coordinates; a {} has {}", shown(joint.attribute("name").value()), coordinates.size(), kind,
                       known->second.size()));
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const char letter = known->second[i];
      const bool is_rotation = letter >= 'x';
      const JointAxis axis{is_rotation, Vector<3>::Unit(letter - (is_rotation ? 'x' : 'X')), {}, coordinates[i]};
      file_.skeleton.coordinates[static_cast<std::size_t>(coordinates[i])].is_rotation = is_rotation;
      // Shifts come before turns: they are along the parent's axes.
      const auto before = std::find_if(into.axes.begin(), into.axes.end(),
                                       [&](const JointAxis& other) { return !is_rotation && other.is_rotation; });
      into.axes.insert(before, axis);
    }
  }

  std::vector<int> add_coordinates(pugi::xml_node joint) {
    std::vector<int> indices;
    const pugi::xml_node set =
        joint.child("coordinates") ? joint.child("coordinates") : joint.child("CoordinateSet").child("objects");
    for (const pugi::xml_node node : set.children("Coordinate")) {
      Coordinate coordinate;
      coordinate.name = plain_text(node.attribute("name").value());
      if (file_.skeleton.coordinate(coordinate.name)) fail(fmt::format("two coordinates are called {}", shown(coordinate.name)));
      coordinate.rest = number_in(node.child("default_value"), 0);
      coordinate.locked = bare(node.child_value("locked")) == "true";
      if (bare(node.child_value("clamped")) == "true") {
        const std::vector<double> range = numbers_in(node.child("range"));
        if (range.size() == 2 && range[0] <= range[1]) {
          coordinate.lowest = range[0];
          coordinate.highest = range[1];
        }
      }
      indices.push_back(static_cast<int>(file_.skeleton.coordinates.size()));
      file_.skeleton.coordinates.push_back(std::move(coordinate));
    }
    return indices;
  }

  void add_custom(pugi::xml_node joint, const std::vector<int>& coordinates, Joint& into) {
    std::vector<JointAxis> rotations, shifts;
    pugi::xml_node transform = joint.child("SpatialTransform");
    if (transform.child("objects")) transform = transform.child("objects");
    for (int i : coordinates) file_.skeleton.coordinates[static_cast<std::size_t>(i)].is_rotation = false;
    for (const pugi::xml_node node : transform.children("TransformAxis")) {
      JointAxis axis;
      axis.is_rotation = std::string_view(node.attribute("name").value()).starts_with("rotation");
      axis.axis = vector_in(node.child("axis"));
      if (!(axis.axis.norm() > 1e-9))
        fail(fmt::format("an axis of joint {} has no direction", shown(joint.attribute("name").value())));
      axis.axis.normalize();
      const auto named = words(node.child_value("coordinates"));
      if (named.size() > 1)
        fail(fmt::format("joint {}: an axis of several coordinates is not known", shown(joint.attribute("name").value())));
      if (!named.empty()) {
        axis.coordinate = file_.skeleton.coordinate(named.front());
        if (!axis.coordinate)
          fail(fmt::format("joint {} names the coordinate {}, which is not there", shown(joint.attribute("name").value()),
                           shown(named.front())));
        if (axis.is_rotation) file_.skeleton.coordinates[static_cast<std::size_t>(*axis.coordinate)].is_rotation = true;
      }
      axis.amount = function_of(node, axis.coordinate.has_value());
      (axis.is_rotation ? rotations : shifts).push_back(std::move(axis));
    }
    if (rotations.size() > 3 || shifts.size() > 3)
      fail(fmt::format("joint {} has more than six axes", shown(joint.attribute("name").value())));
    into.axes = std::move(shifts);
    into.axes.insert(into.axes.end(), rotations.begin(), rotations.end());
  }

  /// The function below an element: in <function>, or (version 4) by itself.
  CoordinateFunction function_of(pugi::xml_node parent, bool moves, int depth = 0) const {
    if (depth > 8) fail("functions of functions are nested deeper than any model needs");
    pugi::xml_node node = first_element(parent.child("function"));
    if (!node) {
      node = parent.find_child([](pugi::xml_node child) {
        const std::string_view name = child.name();
        return name == "Constant" || name.ends_with("Function") || name.ends_with("Spline");
      });
    }
    if (!node) return moves ? CoordinateFunction() : CoordinateFunction::constant(0);
    const std::string kind = node.name();
    if (kind == "Constant") return CoordinateFunction::constant(number_in(node.child("value"), 0));
    if (kind == "MultiplierFunction") return function_of(node, moves, depth + 1).times(number_in(node.child("scale"), 1));
    if (kind == "LinearFunction" || kind == "PolynomialFunction") {
      std::vector<double> coefficients = numbers_in(node.child("coefficients"));
      std::reverse(coefficients.begin(), coefficients.end());
      return CoordinateFunction::polynomial(std::move(coefficients));
    }
    if (kind == "SimmSpline" || kind == "NaturalCubicSpline" || kind == "natCubicSpline") return spline_of(node);
    fail(fmt::format("the function {} is not known; constants, lines, polynomials and SIMM splines are", shown(kind)));
  }

  CoordinateFunction spline_of(pugi::xml_node node) const {
    std::vector<double> x = numbers_in(node.child("x")), y = numbers_in(node.child("y"));
    if (x.size() != y.size() || x.size() < 2) fail(fmt::format("a spline has {} x and {} y", x.size(), y.size()));
    for (std::size_t i = 1; i < x.size(); ++i) {
      if (!(x[i] - x[i - 1] > 1e-9)) fail("a spline's x do not grow");
    }
    return CoordinateFunction::spline(std::move(x), std::move(y));
  }

  void add_constraint(pugi::xml_node node) {
    if (node.type() != pugi::node_element) return;
    const std::string name = plain_text(node.attribute("name").value());
    if (bare(node.child_value("isEnforced")) == "false" || bare(node.child_value("isDisabled")) == "true") return;
    if (std::strcmp(node.name(), "CoordinateCouplerConstraint") != 0) {
      file_.warnings.push_back(
          fmt::format("{}: the {} {} is omitted; only couplers of coordinates are known", name_, shown(node.name()), shown(name)));
      return;
    }
    const auto of = words(node.child_value("independent_coordinate_names"));
    const auto dependent = file_.skeleton.coordinate(last_part(node.child_value("dependent_coordinate_name")));
    const auto to = of.size() == 1 ? file_.skeleton.coordinate(of.front()) : std::nullopt;
    if (!dependent || !to || *dependent == *to)
      fail(fmt::format("the coupler {} does not name one coordinate that follows from one other", shown(name)));
    const CoordinateFunction function =
        function_of(node.child("coupled_coordinates_function"), true).times(number_in(node.child("scale_factor"), 1));
    file_.skeleton.coordinates[static_cast<std::size_t>(*dependent)].coupling = Coordinate::Coupling{*to, function};
  }

  /// Muscles, other forces and the surfaces that muscles wrap around.
  void note_unused() {
    std::size_t muscles = 0, forces = 0, surfaces = 0;
    for (const pugi::xml_node force : model_.child("ForceSet").child("objects").children()) {
      if (force.type() == pugi::node_element) ++(std::strstr(force.name(), "Muscle") != nullptr ? muscles : forces);
    }
    for (const pugi::xml_node body : model_.child("BodySet").child("objects").children("Body")) {
      for (const char* name : {"WrapObjectSet", "WrapObjects"}) {
        for (const pugi::xml_node surface : body.child(name).child("objects").children())
          surfaces += surface.type() == pugi::node_element ? 1 : 0;
      }
    }
    const auto add = [&](std::size_t count, const char* one, const char* many) {
      if (count > 0) file_.unused += fmt::format("{}{} {}", file_.unused.empty() ? "" : ", ", count, count == 1 ? one : many);
    };
    add(muscles, "muscle", "muscles");
    add(forces, "other force", "other forces");
    add(surfaces, "wrapping surface", "wrapping surfaces");
  }

  void add_marker(pugi::xml_node node) {
    const char* const where = node.child("socket_parent_frame") ? "socket_parent_frame" : "body";
    const std::string label = plain_text(bare(node.attribute("name").value()));
    const std::string body = last_part(node.child_value(where));
    const auto segment = file_.skeleton.segment(body);
    if (!segment) {
      file_.warnings.push_back(
          fmt::format("{}: marker {} sits on {}, which is not a moving body; it is omitted", name_, shown(label), shown(body)));
      return;
    }
    file_.skeleton.markers.push_back({label, *segment, vector_in(node.child("location")), 1});
  }

  pugi::xml_node model_;
  std::string name_;
  SkeletonFile file_;
  std::set<std::string> bodies_;
  std::vector<std::string> order_;
  std::map<std::string, Hung> hung_;
};

}  // namespace

SkeletonFile parse_osim(std::string_view text, const std::string& name) {
  const pugi::xml_document document = parse_xml(text, name);
  const pugi::xml_node root = document.document_element();
  const pugi::xml_node model = std::strcmp(root.name(), "Model") == 0 ? root : root.child("Model");
  if (!model) throw Error("{}: has no <Model>, as an OpenSim model does", name);
  return OsimModel(model, name).read();
}

}  // namespace marey::format::skeleton
