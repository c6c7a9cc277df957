#include "marey/pipeline/calibrate/calibrate_elements.h"

#include <set>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/pitch_labels.h"

namespace marey::pipeline::calibrate {
namespace {

constexpr double kTolerance = 5.0 / 960;  // of the picture's width: JaC@5 as it is quoted

std::vector<ElementPicture> labelled_pictures(const std::vector<std::string>& files, cv::Size size) {
  std::vector<ElementPicture> pictures;
  std::set<std::string> names;
  for (const std::string& file : files) {
    for (format::LabelledPicture& labelled : format::read_pitch_labels(file, size)) {
      if (!names.insert(labelled.name).second)
        throw Error("{}: a picture named \"{}\" was there before; each needs a name of its own", file, labelled.name);
      pictures.push_back({labelled.name, std::move(labelled.elements), {}, {}});
    }
  }
  return pictures;
}

std::string why_not(const ElementPicture& picture) {
  using marey::calibrate::pitch::ElementVerdict;
  switch (picture.found.verdict) {
    case ElementVerdict::too_few:
      return fmt::format("{}: {} labelled element{}; at least two are needed, better five", picture.name, picture.labels.size(),
                         picture.labels.size() == 1 ? "" : "s");
    case ElementVerdict::mirrored:
      return fmt::format("{}: the labels fit a mirrored pitch; are left and right, or near (bottom) and far (top), exchanged?",
                         picture.name);
    case ElementVerdict::far_side:
      return fmt::format(
          "{}: the labels fit a camera beyond the far touchline; is each named as seen from the main stand, near "
          "lines \"bottom\"?",
          picture.name);
    default:
      return fmt::format("{}: no camera explains most of the labelled elements; is each labelled as what it is?", picture.name);
  }
}

void warn_of_labels(const ElementPicture& picture, std::vector<std::string>& warnings) {
  const auto elements = geometry::pitch_elements({});
  std::string left_out;
  for (std::size_t i = 0; i < picture.labels.size(); ++i) {
    if (picture.found.used[i]) continue;
    left_out +=
        fmt::format("{}\"{}\"", left_out.empty() ? "" : ", ", elements[static_cast<std::size_t>(picture.labels[i].element)].name);
  }
  if (!left_out.empty())
    warnings.push_back(fmt::format("{}: does not fit the others, and is left out: {}", picture.name, left_out));
}

RigCamera rig_camera(const ElementPicture& picture, double rms_px) {
  RigCamera camera;
  camera.name = picture.name;
  camera.size = picture.found.camera->size();
  camera.lens = picture.found.camera->lens();
  camera.camera_from_world = picture.found.camera->camera_from_world();
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
  run.pictures = labelled_pictures(files, options.size);
  for (std::size_t i = 0; i < run.pictures.size(); ++i) {
    hooks.advance({"fitting cameras", static_cast<std::int64_t>(i), static_cast<std::int64_t>(run.pictures.size())});
    ElementPicture& picture = run.pictures[i];
    picture.found = marey::calibrate::pitch::camera_from_elements(picture.labels, options.size, options.camera);
    if (!picture.found.camera) {
      run.warnings.push_back(why_not(picture));
      continue;
    }
    picture.score = marey::calibrate::pitch::score_elements(*picture.found.camera, picture.labels, options.camera.pitch,
                                                            kTolerance * options.size.width);
    run.jaccard += picture.score.jaccard();
    warn_of_labels(picture, run.warnings);
    run.rig.cameras.push_back(rig_camera(picture, rms_of(picture.found)));
  }
  if (run.rig.cameras.empty()) throw Error("{}", run.warnings.empty() ? "no picture is labelled" : run.warnings[0]);
  run.jaccard /= static_cast<double>(run.rig.cameras.size());
  run.rig.ground_from_world = Matrix<3>::Identity();
  run.rig.calibration =
      Rig::Calibration{.method = "pitch elements", .mean_px = {}, .rms_px = {}, .inliers = {}, .observations = {}, .grade = {}};
  return run;
}

}  // namespace marey::pipeline::calibrate
