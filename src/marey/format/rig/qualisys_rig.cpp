// Qualisys Track Manager's calibration: XML, mm, 1/64 px. A camera's rotation holds its axes in the world as rows, and they point
// to the right, up and backwards; its distortion has OpenCV's coefficients.
#include <fmt/format.h>
#include <pugixml.hpp>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/xml_text.h"

namespace marey::format::rig {
namespace {

constexpr double kPixel = 64;          // QTM's units in a pixel
constexpr double kQtmPerMetre = 1000;  // QTM measures places in mm

struct Node {
  pugi::xml_node node;
  const std::string& path;
  const std::string& camera;

  double number(const char* name) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    const double value = attribute.as_double(std::nan(""));
    if (attribute && std::isfinite(value)) return value;
    throw Error("{}: camera \"{}\": {} of <{}> is {}", path, camera, name, node.name(), attribute ? "no number" : "missing");
  }
};

Node part(const pugi::xml_node& camera, const char* name, const std::string& path, const std::string& identity) {
  const pugi::xml_node node = camera.child(name);
  if (!node) throw Error("{}: camera \"{}\": <{}> is missing", path, identity, name);
  return {node, path, identity};
}

/// Where the camera videos, its images; else what its marker mode sees.
const char* field_of_view(const pugi::xml_node& camera) {
  const std::string model = camera.attribute("model").as_string();
  const bool video = model.find("ideo") != std::string::npos || model == "none";
  if (video && camera.child("fov_video")) return "fov_video";
  return camera.child("fov_marker") ? "fov_marker" : "fov_video";
}

RigCamera camera_of(const pugi::xml_node& node, const std::string& path) {
  RigCamera camera;
  camera.name = plain_text(node.attribute("serial").as_string());
  const Node view = part(node, field_of_view(node), path, camera.name);
  const Vector<2> corner(view.number("left"), view.number("top"));
  camera.size = cv::Size(cv::saturate_cast<int>(view.number("right") - corner.x() + 1),
                         cv::saturate_cast<int>(view.number("bottom") - corner.y() + 1));
  const Node in = part(node, "intrinsic", path, camera.name);
  geometry::BrownLens lens;
  lens.focal = Vector<2>(in.number("focalLengthU"), in.number("focalLengthV")) / kPixel;
  lens.principal = Vector<2>(in.number("centerPointU"), in.number("centerPointV")) / kPixel - corner;
  lens.distortion = {in.number("radialDistortion1"), in.number("radialDistortion2"), in.number("tangentalDistortion1"),
                     in.number("tangentalDistortion2"), in.node.attribute("radialDistortion3").as_double(0)};
  camera.lens = lens;
  const Node at = part(node, "transform", path, camera.name);
  Matrix<3> axes;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) axes(i, j) = at.number(fmt::format("r{}{}", i + 1, j + 1).c_str());
  }
  const Vector<3> centre = Vector<3>(at.number("x"), at.number("y"), at.number("z")) / kQtmPerMetre;
  const Matrix<3> rotation = Vector<3>(1, -1, -1).asDiagonal() * axes;
  camera.camera_from_world = Rigid3{rotation, -(rotation * centre)};
  return camera;
}

void set(pugi::xml_node node, const std::string& name, double value) {
  node.append_attribute(name.c_str()).set_value(fmt::format("{:.12g}", value).c_str());
}

void add_camera(pugi::xml_node cameras, const RigCamera& camera) {
  const geometry::BrownLens lens = as_brown(camera, 5, "Qualisys");
  if (!camera.camera_from_world)
    throw Error("camera \"{}\": its pose is missing, which Qualisys' file needs; calibrate it first", camera.name);
  pugi::xml_node node = cameras.append_child("camera");
  for (const auto& [name, value] : {std::pair{"active", "1"}, {"calibrated", "1"}, {"viewrotation", "0"}, {"model", "none"}}) {
    node.append_attribute(name).set_value(value);
  }
  node.append_attribute("serial").set_value(camera.name.c_str());
  for (const char* name : {"fov_marker", "fov_marker_max", "fov_video", "fov_video_max"}) {
    pugi::xml_node view = node.append_child(name);
    set(view, "left", 0);
    set(view, "top", 0);
    set(view, "right", camera.size->width - 1);
    set(view, "bottom", camera.size->height - 1);
  }
  const Matrix<3> axes = Vector<3>(1, -1, -1).asDiagonal() * camera.camera_from_world->rotation;
  const Vector<3> centre = camera.camera_from_world->inverse().translation * kQtmPerMetre;
  pugi::xml_node at = node.append_child("transform");
  for (int i = 0; i < 3; ++i) set(at, std::string(1, "xyz"[i]), centre[i]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) set(at, fmt::format("r{}{}", i + 1, j + 1), axes(i, j));
  }
  pugi::xml_node in = node.append_child("intrinsic");
  set(in, "sensorMinU", 0);
  set(in, "sensorMaxU", (camera.size->width - 1) * kPixel);
  set(in, "sensorMinV", 0);
  set(in, "sensorMaxV", (camera.size->height - 1) * kPixel);
  set(in, "focalLengthU", lens.focal.x() * kPixel);
  set(in, "focalLengthV", lens.focal.y() * kPixel);
  set(in, "centerPointU", lens.principal.x() * kPixel);
  set(in, "centerPointV", lens.principal.y() * kPixel);
  set(in, "skew", 0);
  set(in, "radialDistortion1", lens.distortion[0]);
  set(in, "radialDistortion2", lens.distortion[1]);
  set(in, "radialDistortion3", lens.distortion[4]);
  set(in, "tangentalDistortion1", lens.distortion[2]);
  set(in, "tangentalDistortion2", lens.distortion[3]);
}

}  // namespace

Rig parse_qualisys_rig(std::string_view text, const std::string& path) {
  const pugi::xml_document document = parse_xml(text, path);
  Rig rig;
  rig.calibration.emplace().method = "Qualisys";
  for (const pugi::xml_node& node : document.child("calibration").child("cameras").children("camera")) {
    const bool used = node.attribute("active").as_bool(true) && node.attribute("calibrated").as_bool(true);
    if (used) rig.cameras.push_back(camera_of(node, path));
  }
  check_imported(rig, path);
  return rig;
}

Rig read_qualisys_rig(const std::string& path) {
  return parse_qualisys_rig(read_file(path), path);
}

void write_qualisys_rig(const Rig& rig, const std::string& path) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("calibration");
  root.append_attribute("type").set_value("regular");
  root.append_attribute("source").set_value("marey");
  pugi::xml_node cameras = root.append_child("cameras");
  for (const RigCamera& camera : rig.cameras) add_camera(cameras, camera);
  WholeFile file(path);
  file.write(to_text(document));
  file.finish();
}

Format qualisys_format() {
  return {.name = "qualisys",
          .title = "a calibration of Qualisys",
          .endings = ".qca.txt",
          .holds = Content::rig,
          .detail = "mm; lenses and poses",
          .is =
              [](const Beginning& file) {
                return file.is_text() && rig::is_xml(file) && file.has("<calibration") && file.has("<camera");
              },
          .read_rig = rig::read_qualisys_rig,
          .write_rig = rig::write_qualisys_rig};
}

}  // namespace marey::format::rig
