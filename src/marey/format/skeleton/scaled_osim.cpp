#include "marey/format/skeleton/scaled_osim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format::skeleton {
namespace {

std::vector<double> numbers_of_node(pugi::xml_node node) {
  std::vector<double> values;
  std::string_view text = node.child_value();
  while (true) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    text.remove_prefix(begin);
    if (text.empty()) return values;
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    const auto value = number_of(text.substr(0, end));
    if (!value) return {};
    values.push_back(*value);
    text.remove_prefix(end);
  }
}

void set_numbers(pugi::xml_node node, std::span<const double> values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.17g}", text.empty() ? "" : " ", value);
  node.text().set(text.c_str());
}

/// "/bodyset/pelvis" is called "pelvis".
std::string body_named(std::string_view path) {
  while (!path.empty() && static_cast<unsigned char>(path.back()) <= ' ') path.remove_suffix(1);
  std::string name = plain_text(path.substr(path.find_last_of('/') + 1));
  name.erase(0, std::min(name.find_first_not_of(" \t\r\n"), name.size()));
  return name;
}

class ModelScaler {
 public:
  ModelScaler(pugi::xml_node model, const std::string& name, const Skeleton& fitted, std::span<const Vector<3>> scales)
      : model_(model), name_(name), fitted_(fitted), scales_(scales) {}

  void scale(const std::optional<double>& mass_kg) {
    for (const pugi::xml_node body : model_.child("BodySet").child("objects").children("Body")) {
      scale_body(body);
      const pugi::xml_node joints =
          body.child("Joint").child("objects") ? body.child("Joint").child("objects") : body.child("Joint");
      for (const pugi::xml_node joint : joints.children()) scale_old_joint(joint, body_named(body.attribute("name").value()));
    }
    for (const pugi::xml_node joint : model_.child("JointSet").child("objects").children()) scale_joint(joint);
    for (const pugi::xml_node force : model_.child("ForceSet").child("objects").children()) scale_points(force);
    move_markers();
    if (mass_kg) set_mass(*mass_kg);
  }
  bool has_muscles() const { return points_ > 0; }
  bool has_moving_points() const { return moving_; }

 private:
  std::optional<Vector<3>> scale_of(const std::string& body) const {
    const auto segment = fitted_.segment(body);
    return segment ? std::optional(scales_[static_cast<std::size_t>(*segment)]) : std::nullopt;
  }

  static void scale_vector(pugi::xml_node node, const std::optional<Vector<3>>& scale) {
    const std::vector<double> values = numbers_of_node(node);
    if (!node || !scale || values.size() != 3) return;
    const Vector<3> stretched = scale->cwiseProduct(Vector<3>(values[0], values[1], values[2]));
    set_numbers(node, std::array{stretched.x(), stretched.y(), stretched.z()});
  }

  void scale_body(pugi::xml_node body) {
    const auto scale = scale_of(body_named(body.attribute("name").value()));
    if (!scale) return;
    scale_vector(body.child("mass_center"), scale);
    scale_mass(body, *scale);
    for (const pugi::xml_node geometry : body.child("attached_geometry").children()) scale_geometry(geometry, *scale);
    for (const pugi::xml_node geometry : body.child("VisibleObject").child("GeometrySet").child("objects").children())
      scale_geometry(geometry, *scale);
    for (const pugi::xml_node wrap : body.child("WrapObjectSet").child("objects").children()) scale_wrap(wrap, *scale);
  }

  static void scale_geometry(pugi::xml_node geometry, const Vector<3>& scale) {
    scale_vector(geometry.child("scale_factors"), scale);
  }

  /// Sizes by the mean scale: a cylinder stays one.
  static void scale_wrap(pugi::xml_node wrap, const Vector<3>& scale) {
    scale_vector(wrap.child("translation"), scale);
    for (const char* size : {"radius", "length", "dimensions", "inner_radius", "outer_radius"}) {
      const pugi::xml_node node = wrap.child(size);
      std::vector<double> values = numbers_of_node(node);
      for (double& value : values) value *= scale.mean();
      if (node && !values.empty()) set_numbers(node, values);
    }
  }

  /// A stretched body's second moments are stretched likewise: D S D of S = ½ tr(I) − I.
  static void scale_mass(pugi::xml_node body, const Vector<3>& scale) {
    const double before = body.child("mass").text().as_double(), volume = scale.prod();
    if (!body.child("mass") || !(before > 0)) return;
    body.child("mass").text().set(fmt::format("{:.17g}", before * volume).c_str());
    constexpr std::array<const char*, 6> kElements = {"inertia_xx", "inertia_yy", "inertia_zz",
                                                      "inertia_xy", "inertia_xz", "inertia_yz"};
    std::vector<double> six = numbers_of_node(body.child("inertia"));
    const bool together = six.size() == 6;
    if (!together) {
      six.clear();
      for (const char* element : kElements) six.push_back(body.child(element).text().as_double());
    }
    Matrix<3> inertia;
    inertia << six[0], six[3], six[4], six[3], six[1], six[5], six[4], six[5], six[2];
    const Matrix<3> second =
        volume * (scale.asDiagonal() * Matrix<3>(0.5 * inertia.trace() * Matrix<3>::Identity() - inertia) * scale.asDiagonal());
    const Matrix<3> grown = second.trace() * Matrix<3>::Identity() - second;
    six = {grown(0, 0), grown(1, 1), grown(2, 2), grown(0, 1), grown(0, 2), grown(1, 2)};
    if (together) return set_numbers(body.child("inertia"), six);
    for (std::size_t i = 0; i < 6; ++i) body.child(kElements[i]).text().set(fmt::format("{:.17g}", six[i]).c_str());
  }

  /// Version 4: frames of the joint, each on a body.
  void scale_joint(pugi::xml_node joint) {
    std::map<std::string, std::string> body_of_frame;
    for (const pugi::xml_node frame : joint.child("frames").children()) {
      const std::string body = body_named(frame.child("socket_parent").child_value());
      body_of_frame[frame.attribute("name").value()] = body;
      scale_vector(frame.child("translation"), scale_of(body));
    }
    const auto body_at = [&](const char* socket) {
      const std::string frame = body_named(joint.child(socket).child_value());
      const auto found = body_of_frame.find(frame);
      return found == body_of_frame.end() ? frame : found->second;
    };
    scale_shifts(joint, body_at("socket_parent_frame"), body_at("socket_child_frame"));
  }

  /// Version 2 and 3: the joint is in the body that hangs on it.
  void scale_old_joint(pugi::xml_node joint, const std::string& body) {
    const std::string parent = body_named(joint.child("parent_body").child_value());
    scale_vector(joint.child("location_in_parent"), scale_of(parent));
    scale_vector(joint.child("location"), scale_of(body));
    scale_shifts(joint, parent, body);
  }

  void scale_shifts(pugi::xml_node joint, const std::string& parent, const std::string& child) {
    const auto scale = scale_of(parent);
    const auto segment = fitted_.segment(child);
    if (!scale || !segment) return;  // on the ground
    pugi::xml_node transform = joint.child("SpatialTransform");
    if (transform.child("objects")) transform = transform.child("objects");
    for (const pugi::xml_node axis : transform.children("TransformAxis")) {
      if (!std::string_view(axis.attribute("name").value()).starts_with("translation")) continue;
      const std::vector<double> along = numbers_of_node(axis.child("axis"));
      if (along.size() != 3) continue;
      const Vector<3> direction = Vector<3>(along[0], along[1], along[2]).normalized();
      const Matrix<3>& turn = fitted_.segments[static_cast<std::size_t>(*segment)].joint.parent_from_joint.rotation;
      multiply_function(axis, scale->cwiseProduct(turn * direction).norm());
    }
  }

  static bool is_function(std::string_view element) {
    return element == "Constant" || element.ends_with("Function") || element.ends_with("Spline");
  }

  /// A MultiplierFunction's factor grows, any other function gets one round it.
  static void multiply_function(pugi::xml_node axis, double factor) {
    pugi::xml_node holder = axis.child("function") ? axis.child("function") : axis;
    const pugi::xml_node function = holder.find_child([](pugi::xml_node node) { return is_function(node.name()); });
    if (!function || std::abs(factor - 1) < 1e-15) return;
    if (std::strcmp(function.name(), "MultiplierFunction") == 0) {
      const double before = function.child("scale") ? function.child("scale").text().as_double() : 1;
      pugi::xml_node own = function;
      pugi::xml_node scale = own.child("scale") ? own.child("scale") : own.append_child("scale");
      scale.text().set(fmt::format("{:.17g}", before * factor).c_str());
      return;
    }
    pugi::xml_node multiplier = holder.insert_child_before("MultiplierFunction", function);
    if (const pugi::xml_attribute name = function.attribute("name")) multiplier.append_attribute("name") = name.value();
    pugi::xml_node inner = multiplier.append_child("function");
    pugi::xml_node copy = inner.append_copy(function);
    copy.remove_attribute("name");
    multiplier.append_child("scale").text().set(fmt::format("{:.17g}", factor).c_str());
    holder.remove_child(function);
  }

  /// Every point of a path below an element.
  void scale_points(pugi::xml_node element) {
    for (pugi::xml_node child : element.children()) {
      if (std::strcmp(child.name(), "MovingPathPoint") == 0) {
        moving_ = true;
      } else if (std::string_view(child.name()).ends_with("PathPoint") && child.child("location")) {
        const char* const where = child.child("socket_parent_frame") ? "socket_parent_frame" : "body";
        scale_vector(child.child("location"), scale_of(body_named(child.child_value(where))));
        ++points_;
      } else {
        scale_points(child);
      }
    }
  }

  /// Markers that the skeleton has not (on ground) stay.
  void move_markers() {
    std::map<std::string, const SkeletonMarker*> by_label;
    for (const SkeletonMarker& marker : fitted_.markers) by_label[marker.label] = &marker;
    std::size_t moved = 0;
    for (const pugi::xml_node node : model_.child("MarkerSet").child("objects").children("Marker")) {
      std::string label = plain_text(node.attribute("name").value());
      label.erase(0, std::min(label.find_first_not_of(" \t\r\n"), label.size()));
      label.erase(label.find_last_not_of(" \t\r\n") + 1);
      const auto found = by_label.find(label);
      if (found == by_label.end()) continue;
      const Vector<3>& at = found->second->position;
      set_numbers(node.child("location"), std::array{at.x(), at.y(), at.z()});
      ++moved;
    }
    if (moved == 0) throw Error("{}: has none of the skeleton's markers; is it the model that was solved with?", name_);
  }

  void set_mass(double mass_kg) {
    double sum = 0;
    for (const pugi::xml_node body : model_.child("BodySet").child("objects").children("Body"))
      sum += body.child("mass").text().as_double();
    if (!(sum > 0)) return;
    const double factor = mass_kg / sum;
    for (const pugi::xml_node body : model_.child("BodySet").child("objects").children("Body")) {
      for (const char* element :
           {"mass", "inertia", "inertia_xx", "inertia_yy", "inertia_zz", "inertia_xy", "inertia_xz", "inertia_yz"}) {
        const pugi::xml_node node = body.child(element);
        std::vector<double> values = numbers_of_node(node);
        for (double& value : values) value *= factor;
        if (node && !values.empty()) set_numbers(node, values);
      }
    }
  }

  pugi::xml_node model_;
  std::string name_;
  const Skeleton& fitted_;
  std::span<const Vector<3>> scales_;
  int points_ = 0;
  bool moving_ = false;
};

}  // namespace

ScaledOsim scaled_osim(std::string_view text, const std::string& name, const Skeleton& fitted, std::span<const Vector<3>> scales,
                       const std::optional<double>& mass_kg) {
  const Skeleton own = parse_osim(text, name).skeleton;
  const bool same = own.segments.size() == fitted.segments.size() && scales.size() == own.segments.size() &&
                    std::equal(own.segments.begin(), own.segments.end(), fitted.segments.begin(),
                               [](const Segment& a, const Segment& b) { return a.name == b.name; });
  if (!same) throw Error("{}: is not the model that was fitted: its bodies are others", name);
  pugi::xml_document document = parse_xml(text, name);
  const pugi::xml_node root = document.document_element();
  const pugi::xml_node model = std::strcmp(root.name(), "Model") == 0 ? root : root.child("Model");
  ModelScaler scaler(model, name, fitted, scales);
  scaler.scale(mass_kg);
  ScaledOsim scaled{to_text(document), {}};
  if (scaler.has_muscles())
    scaled.warnings.push_back(fmt::format("{}: muscles' paths are scaled, their fibre and tendon lengths are not", name));
  if (scaler.has_moving_points()) scaled.warnings.push_back(fmt::format("{}: muscles' moving path points are not scaled", name));
  return scaled;
}

}  // namespace marey::format::skeleton
