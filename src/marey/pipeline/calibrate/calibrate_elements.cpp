#include "marey/pipeline/calibrate/calibrate_elements.h"

#include <set>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/pitch_labels.h"

namespace marey::pipeline::calibrate {
namespace {

constexpr double kTolerance = 5.0 / 960;  // of the image's width: JaC@5 as it is quoted

std::vector<ElementImage> labelled_images(const std::vector<std::string>& files, cv::Size size) {
  std::vector<ElementImage> images;
  std::set<std::string> names;
  for (const std::string& file : files) {
    for (format::LabelledImage& labelled : format::read_pitch_labels(file, size)) {
      if (!names.insert(labelled.name).second)
        throw Error("{}: an image named \"{}\" was there before; each needs a name of its own", file, labelled.name);
      images.push_back({labelled.name, std::move(labelled.elements), {}, {}});
    }
  }
  return images;
}

std::string why_not(const ElementImage& image) {
  using marey::calibrate::pitch::ElementVerdict;
  switch (image.found.verdict) {
    case ElementVerdict::too_few:
      return fmt::format("{}: {} labelled element{}; at least two are needed, better five", image.name, image.labels.size(),
                         image.labels.size() == 1 ? "" : "s");
    case ElementVerdict::mirrored:
      return fmt::format("{}: the labels fit a mirrored pitch; are left and right, or near (bottom) and far (top), exchanged?",
                         image.name);
    case ElementVerdict::far_side:
      return fmt::format(
          "{}: the labels fit a camera beyond the far touchline; is each named as seen from the main stand, near "
          "lines \"bottom\"?",
          image.name);
    default:
      return fmt::format("{}: no camera explains most of the labelled elements; is each labelled as what it is?", image.name);
  }
}

void warn_of_labels(const ElementImage& image, std::vector<std::string>& warnings) {
  const auto elements = geometry::pitch_elements({});
  std::string excluded;
  for (std::size_t i = 0; i < image.labels.size(); ++i) {
    if (image.found.used[i]) continue;
    excluded +=
        fmt::format("{}\"{}\"", excluded.empty() ? "" : ", ", elements[static_cast<std::size_t>(image.labels[i].element)].name);
  }
  if (!excluded.empty()) warnings.push_back(fmt::format("{}: does not fit the others, and is omitted: {}", image.name, excluded));
}

RigCamera rig_camera(const ElementImage& image, double rms_px) {
  RigCamera camera;
  camera.name = image.name;
  camera.size = image.found.camera->size();
  camera.lens = image.found.camera->lens();
  camera.camera_from_world = image.found.camera->camera_from_world();
  camera.rms_px = rms_px;
  return camera;
}

/// Over the elements used, of their median distances, px.
double rms_of(const marey::calibrate::pitch::ElementCamera& found) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < found.used.size(); ++i) {
    if (found.used[i]) sum += found.error_px[i] * found.error_px[i], ++count;
  }
  return std::sqrt(sum / std::max(1.0, count));
}

}  // namespace

ElementRun calibrate_elements(const std::vector<std::string>& files, const ElementRunOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  ElementRun run;
  run.images = labelled_images(files, options.size);
  for (std::size_t i = 0; i < run.images.size(); ++i) {
    hooks.advance({"fitting cameras", static_cast<std::int64_t>(i), static_cast<std::int64_t>(run.images.size())});
    ElementImage& image = run.images[i];
    image.found = marey::calibrate::pitch::camera_from_elements(image.labels, options.size, options.camera);
    if (!image.found.camera) {
      run.warnings.push_back(why_not(image));
      continue;
    }
    image.score = marey::calibrate::pitch::score_elements(*image.found.camera, image.labels, options.camera.pitch,
                                                          kTolerance * options.size.width);
    run.jaccard += image.score.jaccard();
    warn_of_labels(image, run.warnings);
    run.rig.cameras.push_back(rig_camera(image, rms_of(image.found)));
  }
  if (run.rig.cameras.empty()) throw Error("{}", run.warnings.empty() ? "no image is labelled" : run.warnings[0]);
  run.jaccard /= static_cast<double>(run.rig.cameras.size());
  run.rig.ground_from_world = Matrix<3>::Identity();
  run.rig.calibration =
      Rig::Calibration{.method = "pitch elements", .mean_px = {}, .rms_px = {}, .inliers = {}, .observations = {}, .grade = {}};
  return run;
}

}  // namespace marey::pipeline::calibrate
