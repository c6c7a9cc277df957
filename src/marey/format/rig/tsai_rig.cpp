// One camera in Tsai's model as PETS and ETISEO give it: XML, mm. A point of the world is turned by Rz Ry Rx, moved, divided by its
// depth times the focal length (mm on the sensor), distorted by κ1, and scaled to px by dpx / sx and dpy.
#include <cmath>

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

constexpr double kMillimetresPerMetre = 1000;

double number(const pugi::xml_node& node, const char* name, const std::string& path) {
  const pugi::xml_attribute attribute = node.attribute(name);
  const double value = attribute.as_double(std::nan(""));
  if (attribute && std::isfinite(value)) return value;
  throw Error("{}: {} of <{}> is {}; a Tsai camera has <Geometry>, <Intrinsic> and <Extrinsic>", path, name,
              node ? node.name() : "a missing element", attribute ? "no number" : "missing");
}

Matrix<3> rotation_of(double rx, double ry, double rz) {
  return geometry::rotation_from({0, 0, rz}) * geometry::rotation_from({0, ry, 0}) * geometry::rotation_from({rx, 0, 0});
}

}  // namespace

Rig parse_tsai_rig(std::string_view text, const std::string& path) {
  const pugi::xml_document document = parse_xml(text, path);
  const pugi::xml_node root = document.child("Camera");
  const pugi::xml_node sensor = root.child("Geometry"), in = root.child("Intrinsic"), out = root.child("Extrinsic");
  const auto of = [&](const pugi::xml_node& node, const char* name) { return number(node, name, path); };
  Rig rig;
  rig.calibration.emplace().method = "Tsai";
  RigCamera& camera = rig.cameras.emplace_back();
  camera.name = plain_text(root.attribute("name").as_string());
  camera.size = cv::Size(cv::saturate_cast<int>(of(sensor, "width")), cv::saturate_cast<int>(of(sensor, "height")));
  const double focal = of(in, "focal");
  geometry::TsaiLens lens;
  lens.focal = {of(in, "sx") * focal / of(sensor, "dpx"), focal / of(sensor, "dpy")};
  lens.principal = {of(in, "cx"), of(in, "cy")};
  lens.distortion = {of(in, "kappa1") * focal * focal};
  camera.lens = lens;
  camera.camera_from_world = Rigid3{rotation_of(of(out, "rx"), of(out, "ry"), of(out, "rz")),
                                    Vector<3>(of(out, "tx"), of(out, "ty"), of(out, "tz")) / kMillimetresPerMetre};
  check_imported(rig, path);
  return rig;
}

Rig read_tsai_rig(const std::string& path) {
  return parse_tsai_rig(read_file(path), path);
}

void write_tsai_rig(const Rig& rig, const std::string& path) {
  if (rig.cameras.size() != 1) {
    throw Error("a Tsai file holds one camera, and the rig has {}; write each camera's alone, or another format",
                rig.cameras.size());
  }
  const RigCamera& camera = rig.cameras.front();
  const auto whole = camera.camera();
  if (!whole)
    throw Error("camera \"{}\": its lens, size or pose is missing, which Tsai's model needs; calibrate it first", camera.name);
  const auto* tsai = std::get_if<geometry::TsaiLens>(&whole->lens());
  if (tsai == nullptr) {
    throw Error("camera \"{}\": its lens is {}, and this file holds tsai alone; write another format", camera.name,
                geometry::name_of(whole->lens()));
  }
  // A sensor of 1/100 mm a pixel: any will do, for only ratios are known.
  constexpr double kPitch = 0.01;
  const double focal = tsai->focal.y() * kPitch;
  const Matrix<3>& R = whole->camera_from_world().rotation;
  const Vector<3> t = whole->camera_from_world().translation * kMillimetresPerMetre;
  const double rx = std::atan2(R(2, 1), R(2, 2)), ry = std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
               rz = std::atan2(R(1, 0), R(0, 0));
  WholeFile file(path);
  file.write(
      fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                  "<Camera name=\"{}\">\n"
                  "  <Geometry width=\"{}\" height=\"{}\" ncx=\"{}\" nfx=\"{}\" dx=\"{}\" dy=\"{}\" dpx=\"{}\" dpy=\"{}\"/>\n"
                  "  <Intrinsic focal=\"{:.12g}\" kappa1=\"{:.12g}\" cx=\"{:.12g}\" cy=\"{:.12g}\" sx=\"{:.12g}\"/>\n"
                  "  <Extrinsic tx=\"{:.12g}\" ty=\"{:.12g}\" tz=\"{:.12g}\" rx=\"{:.15g}\" ry=\"{:.15g}\" rz=\"{:.15g}\"/>\n"
                  "</Camera>\n",
                  xml_escaped(camera.name), camera.size->width, camera.size->height, camera.size->width, camera.size->width, kPitch,
                  kPitch, kPitch, kPitch, focal, tsai->distortion[0] / (focal * focal), tsai->principal.x(), tsai->principal.y(),
                  tsai->focal.x() / tsai->focal.y(), t.x(), t.y(), t.z(), rx, ry, rz));
  file.finish();
}

Format tsai_format() {
  return {
      .name = "tsai",
      .title = "a camera in Tsai's model",
      .endings = ".xml",
      .holds = Content::rig,
      .detail = "mm; one camera, as PETS gives it",
      .is =
          [](const Beginning& file) { return file.is_text() && rig::is_xml(file) && file.has("<Camera") && file.has("<Geometry"); },
      .read_rig = rig::read_tsai_rig,
      .write_rig = rig::write_tsai_rig};
}

}  // namespace marey::format::rig
