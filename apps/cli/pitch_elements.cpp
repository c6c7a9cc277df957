#include "pitch_elements.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/core.h>

#include "marey/files/whole_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/soccernet_camera.h"
#include "marey/pipeline/calibrate/calibrate_elements.h"

#include "command_line.h"
#include "json_value.h"
#include "pitch_size.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
using calibrate::pitch::ElementView;

cv::Size parse_resolution(const std::string& text) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 16 || height < 16 || width > 32768 ||
      height > 32768)
    throw WrongUsage("--resolution {}: it must read WIDTHxHEIGHT in px, 960x540, each from 16 to 32768", text);
  return {width, height};
}

Json element_image_json(const pipeline::calibrate::ElementImage& image) {
  Json entry = {{"name", image.name},
                {"verdict", calibrate::pitch::element_verdict_name(image.found.verdict)},
                {"elements", image.labels.size()}};
  if (!image.found.camera) return entry;
  const auto& p = image.found.view.p;
  const Vector<3>& location = image.found.camera->centre();
  entry["place"] = {location.x(), location.y(), location.z()};
  entry["pan_degrees"] = p[ElementView::pan] * kDegrees;
  entry["tilt_degrees"] = p[ElementView::tilt] * kDegrees;
  entry["roll_degrees"] = p[ElementView::roll] * kDegrees;
  entry["focal_px"] = geometry::focal_of(image.found.camera->lens()).x();
  entry["jaccard_5"] = image.score.jaccard();
  const auto elements = geometry::pitch_elements({});
  for (std::size_t i = 0; i < image.labels.size(); ++i) {
    entry["labels"].push_back({{"name", elements[static_cast<std::size_t>(image.labels[i].element)].name},
                               {"error_px", image.found.error_px[i]},
                               {"used", image.found.used[i] != 0}});
  }
  return entry;
}

Json elements_json(const pipeline::calibrate::ElementRun& run) {
  Json images = Json::array();
  for (const pipeline::calibrate::ElementImage& image : run.images) images.push_back(element_image_json(image));
  return {{"pictures", images},
          {"found", run.rig.cameras.size()},
          {"complete", static_cast<double>(run.rig.cameras.size()) / static_cast<double>(run.images.size())},
          {"jaccard_5", run.jaccard},
          {"warnings", run.warnings}};
}

void print_elements(const pipeline::calibrate::ElementRun& run) {
  if (run.images.size() == 1) {
    const pipeline::calibrate::ElementImage& image = run.images[0];
    const auto& p = image.found.view.p;
    const Vector<3>& location = image.found.camera->centre();
    fmt::print(
        "{}: the camera stands at ({:.1f}, {:.1f}), {:.1f} m up; pan {:.2f}, tilt {:.2f}, roll {:.2f} degrees, focal length {:.0f} "
        "px\n",
        image.name, location.x(), location.y(), location.z(), p[ElementView::pan] * kDegrees, p[ElementView::tilt] * kDegrees,
        p[ElementView::roll] * kDegrees, geometry::focal_of(image.found.camera->lens()).x());
  }
  fmt::print("{} of {} images have a camera ({:.1f} %); JaC@5 against their labels {:.1f} %\n", run.rig.cameras.size(),
             run.images.size(), 100.0 * static_cast<double>(run.rig.cameras.size()) / static_cast<double>(run.images.size()),
             100 * run.jaccard);
}

void write_cameras(const pipeline::calibrate::ElementRun& run, const std::string& folder, const geometry::PitchSize& size) {
  std::filesystem::create_directories(folder);
  for (const pipeline::calibrate::ElementImage& image : run.images) {
    if (!image.found.camera) continue;
    WholeFile file((std::filesystem::path(folder) / fmt::format("camera_{}.json", image.name)).string());
    file.write(format::rig::soccernet_camera_text(*image.found.camera, size));
    file.finish();
  }
}

}  // namespace

void check_resolution(const std::string& text) {
  parse_resolution(text);
}

void run_pitch_elements(const PitchElements& command) {
  pipeline::calibrate::ElementRunOptions options;
  options.size = parse_resolution(command.resolution);
  options.camera.pitch = parse_pitch_size(command.size);
  const pipeline::calibrate::ElementRun run = with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::calibrate::calibrate_elements(command.files, options, hooks); });
  if (!command.out.empty()) format::rig::write_rig(run.rig, command.out);
  if (!command.cameras.empty()) write_cameras(run, command.cameras, options.camera.pitch);
  warn(run.warnings);
  if (command.json) {
    print(elements_json(run));
  } else if (!command.quiet) {
    print_elements(run);
    if (!command.out.empty()) fmt::print("rig: {}\n", command.out);
    if (!command.cameras.empty()) fmt::print("cameras: {}\n", command.cameras);
  }
}

}  // namespace marey::cli
