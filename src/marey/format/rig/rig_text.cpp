#include <algorithm>
#include <filesystem>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/files/source_name.h"
#include "marey/files/whole_file.h"
#include "marey/format/rig/rig_file.h"

namespace marey::format::rig {
namespace {

/// To 12 digits, always with a point or an exponent, never "-0.0".
std::string number_text(double value) {
  if (value == 0) return "0.0";
  std::string text = fmt::format("{:.12g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string row(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + number_text(value);
  return "[" + text + "]";
}

std::string row(const Vector<2>& v) {
  return row(std::span(v.data(), 2));
}

/// One row a line, each under the one before it.
std::string rows(const Matrix<3>& m, std::string_view key) {
  std::string text(key);
  text += " = [";
  const std::string indent(text.size(), ' ');
  for (int i = 0; i < 3; ++i) {
    const Vector<3> values = m.row(i);
    text += (i > 0 ? ",\n" + indent : "") + row(std::span(values.data(), 3));
  }
  return text + "]\n";
}

std::string rect_text(const cv::Rect& r) {
  return fmt::format("[{}, {}, {}, {}]", r.x, r.y, r.width, r.height);
}

std::string rows_of(std::span<const Mask> masks) {
  std::string text;
  for (const Mask& mask : masks) text += fmt::format("{}[{}]", text.empty() ? "" : ", ", fmt::join(mask.numbers(), ", "));
  return "[" + text + "]";
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      (result += '\\') += c;
    } else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      result += c;
    }
  }
  return result + "\"";
}

/// `source` as it is found from `folder`, where it has a relative path or lies below it.
std::string observed_from(const std::string& folder, const std::string& source) {
  namespace fs = std::filesystem;
  constexpr std::string_view kPlayed = "play:";
  if (source.starts_with(kPlayed)) return std::string(kPlayed) + observed_from(folder, source.substr(kPlayed.size()));
  if (folder.empty() || !scheme_of(source).empty() || source.find("://") != std::string::npos) return source;
  const fs::path path(source), base = fs::absolute(folder).lexically_normal();
  const fs::path relative = fs::absolute(path).lexically_normal().lexically_relative(base / "");
  const bool below = !relative.empty() && *relative.begin() != "..";
  return path.is_absolute() && !below ? source : relative.string();
}

/// `key = value` and, on the first camera, what an editor of the file should know about it.
class Lines {
 public:
  explicit Lines(bool explain) : explain_(explain) {}

  void add(std::string_view key, const std::string& value, std::string_view remark = {}) {
    std::string line = fmt::format("{} = {}", key, value);
    if (explain_ && !remark.empty()) line = fmt::format("{:<42} # {}", line, remark);
    text_ += line + "\n";
  }
  void add_matrix(std::string_view key, const Matrix<3>& m, std::string_view remark) {
    if (explain_) text_ += fmt::format("# {}: {}\n", key, remark);
    text_ += rows(m, key);
  }
  const std::string& text() const { return text_; }

 private:
  bool explain_;
  std::string text_;
};

void add_lens(Lines& lines, const geometry::Lens& lens) {
  std::visit(
      [&](const auto& model) {
        lines.add("model", in_quotes(model.name), fmt::format("{}", fmt::join(geometry::lens_names(), " | ")));
        lines.add("focal", row(model.focal), "px");
        lines.add("principal", row(model.principal), "px; a pixel's whole number is its centre");
        // Brown's first five are the common ones; its last three are written where they are used.
        std::size_t count = model.distortion.size();
        if (count == 8 && std::all_of(model.distortion.begin() + 5, model.distortion.end(), [](double k) { return k == 0; }))
          count = 5;
        lines.add("distortion", row(std::span(model.distortion).first(count)));
      },
      lens);
}

std::string camera_text(const RigCamera& camera, const std::string& folder, bool first) {
  Lines lines(first);
  lines.add("name", in_quotes(camera.name));
  if (!camera.source.empty())
    lines.add("source", in_quotes(observed_from(folder, camera.source)),
              scheme_of(camera.source).empty() ? "seen from this file" : "");
  if (!camera.detections.empty())
    lines.add("detections", in_quotes(observed_from(folder, camera.detections)), "seen from this file");
  if (camera.region) lines.add("region", rect_text(*camera.region), "x, y, width, height in px");
  if (camera.rate_hz) lines.add("rate", number_text(*camera.rate_hz), "Hz");
  if (camera.exposure_ms) lines.add("exposure", number_text(*camera.exposure_ms), "ms, of a live camera");
  if (camera.gain) lines.add("gain", number_text(*camera.gain), "in the camera's own unit");
  if (camera.threshold) lines.add("threshold", number_text(*camera.threshold), "grey level that a marker's pixels pass");
  if (!camera.masks.empty())
    lines.add("masks", rows_of(camera.masks), "[x, y, width, height] or a polygon's [x, y, x, y, …] in px: no marker there");
  if (camera.offset_s) lines.add("offset_s", number_text(*camera.offset_s), "add to this camera's times to get the rig's");
  if (camera.size) lines.add("size", fmt::format("[{}, {}]", camera.size->width, camera.size->height), "px");
  if (camera.lens) add_lens(lines, *camera.lens);
  if (const auto& pose = camera.camera_from_world) {
    lines.add_matrix("rotation", pose->rotation, "camera_from_world (a camera has x right, y down, z ahead)");
    lines.add("translation", row(std::span(pose->translation.data(), 3)), "m, in the camera's frame");
  }
  if (camera.ground_from_image) lines.add_matrix("ground_from_image", *camera.ground_from_image, "px to m on the ground");
  if (camera.rms_px) lines.add("rms_px", number_text(*camera.rms_px), "2-D reprojection error of the calibration");
  return lines.text();
}

std::string calibration_text(const Rig::Calibration& calibration) {
  Lines lines(false);
  if (!calibration.method.empty()) lines.add("method", in_quotes(calibration.method));
  if (calibration.mean_px) lines.add("mean_px", number_text(*calibration.mean_px));
  if (calibration.rms_px) lines.add("rms_px", number_text(*calibration.rms_px));
  if (calibration.inliers) lines.add("inliers", fmt::format("{}", *calibration.inliers));
  if (calibration.observations) lines.add("observations", fmt::format("{}", *calibration.observations));
  if (calibration.grade) lines.add("grade", in_quotes(*calibration.grade));
  return "\n[calibration]\n" + lines.text();
}

/// Nothing for a level one.
std::string ground_text(const geometry::GroundSurface& ground) {
  if (ground.flat()) return "";
  Lines lines(true);
  lines.add("centre", row(ground.middle), "m, in the world; how high the ground is above z = 0:");
  lines.add("half_size", row(ground.half), "m from the centre to the lines: u and v are 1 there");
  lines.add("crown_across", number_text(ground.across),
            "m: crown_across (1 - v^2) + crown_along (1 - u^2) + crown_dome (1 - u^2) (1 - v^2)");
  lines.add("crown_along", number_text(ground.along));
  if (ground.dome != 0) lines.add("crown_dome", number_text(ground.dome));
  if (ground.ridge != 0) lines.add("ridge", number_text(ground.ridge), "0: parabolas as above; 1: roofs");
  return "\n[world.ground]\n" + lines.text();
}

}  // namespace

std::string rig_text(const Rig& rig, const std::string& folder) {
  Lines world(true);
  world.add("up", in_quotes("z"), "metres, right-handed");
  if (rig.ground_from_world)
    world.add_matrix("ground_from_world", *rig.ground_from_world, "the ground as its user counts it, of (x, y, 1)");
  std::string text = "[world]\n" + world.text() + ground_text(rig.ground);
  if (rig.calibration) text += calibration_text(*rig.calibration);
  for (const RigCamera& camera : rig.cameras) {
    text += "\n[[camera]]\n" + camera_text(camera, folder, &camera == rig.cameras.data());
  }
  return text;
}

void write_rig(const Rig& rig, const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  WholeFile file(path);
  file.write(rig_text(rig, folder.empty() ? "." : folder));
  file.finish();
}

}  // namespace marey::format::rig
