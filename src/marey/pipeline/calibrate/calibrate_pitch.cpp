#include "marey/pipeline/calibrate/calibrate_pitch.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/core/rig_sources.h"
#include "marey/draw/image_file.h"
#include "marey/draw/pitch_drawing.h"
#include "marey/files/whole_file.h"
#include "marey/format/pitch_points.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {
namespace {

// The empty ground is the median of this many images, spread over this long a beginning: people who move are in few of them.
constexpr int kImages = 15;
constexpr double kSeconds = 60;
constexpr double kMargin = 2;  // m round the pitch, where people still count

cv::Mat as_bytes(const cv::Mat& luma) {
  if (luma.type() == CV_8UC1) return luma;
  cv::Mat bytes;
  luma.convertTo(bytes, CV_8U, 1.0 / 257);
  return bytes;
}

/// The median over time of each pixel, 8-bit luma.
cv::Mat empty_ground(corridor::Feed& feed) {
  double span = kSeconds * feed.rate_hz();
  if (feed.info().frame_count) span = std::min(span, static_cast<double>(*feed.info().frame_count));
  const auto step = std::max<std::int64_t>(1, static_cast<std::int64_t>(span / kImages));
  std::vector<cv::Mat> images;
  while (images.size() < kImages) {
    const auto given = feed.next();
    stop_point();
    if (!given) break;
    if (given->frame.index % step != 0) continue;
    const cv::Mat luma = as_bytes(given->frame.image.luma());
    if (luma.size() == feed.info().size) images.push_back(luma.clone());
  }
  if (images.empty()) throw Error("{}: not one frame could be read", feed.info().name);
  cv::Mat median(images[0].size(), CV_8UC1);
  std::vector<unsigned char> values(images.size());
  for (int y = 0; y < median.rows; ++y) {
    for (int x = 0; x < median.cols; ++x) {
      for (std::size_t i = 0; i < images.size(); ++i) values[i] = images[i].at<unsigned char>(y, x);
      median.at<unsigned char>(y, x) = geometry::median(values);
    }
  }
  return median;
}

marey::calibrate::pitch::PitchView view_of(RigCamera& camera, const std::string& clicks_path, std::vector<std::string>& warnings) {
  marey::calibrate::pitch::PitchView view;
  view.name = camera.name;
  const format::PitchClicks clicks = format::read_pitch_clicks(clicks_path);
  for (const format::PitchClicks::Point& click : clicks.points) view.points.push_back({click.ground, click.pixel, click.name});
  for (const format::PitchClicks::Line& line : clicks.lines) view.lines.push_back({line.from, line.to, line.pixels});
  if (!camera.source.empty()) {
    RigCamera uncalibrated = camera;  // of whatever size its images are
    uncalibrated.size.reset();
    corridor::Feed feed(uncalibrated, CameraId{}, {.ahead = 0});
    view.empty_ground = empty_ground(feed);
    view.size = view.empty_ground.size();
    camera.size = view.size;
  } else if (camera.size) {
    view.size = *camera.size;
    warnings.push_back(
        fmt::format("camera \"{}\" has no images: it is calibrated by the clicks alone, not by the white lines", camera.name));
  } else {
    throw Error("camera \"{}\": its size is not known; give its source, or size = [width, height] in px", camera.name);
  }
  const cv::Rect frame({}, view.size);
  for (const marey::calibrate::pitch::PitchPoint& point : view.points) {
    if (!frame.contains(cv::Point(cvRound(point.pixel.x()), cvRound(point.pixel.y()))))
      throw Error(
          "{}: the click on {} at ({:.0f}, {:.0f}) is outside camera \"{}\"'s image of {} x {} px; is it another camera's file?",
          clicks_path, point.name, point.pixel.x(), point.pixel.y(), camera.name, view.size.width, view.size.height);
  }
  return view;
}

/// A lens known before, from a board, against the one found over the pitch.
void compare_lens(const RigCamera& before, const Camera& found, std::vector<std::string>& warnings) {
  if (!before.lens || !before.size || *before.size != found.size()) return;
  const Camera old(*before.lens, found.camera_from_world(), found.size());
  double worst = 0;
  for (double x = 0; x <= 1; x += 0.125) {
    for (double y = 0.25; y <= 1; y += 0.125) {
      const auto ray = found.ray({x * (found.size().width - 1), y * (found.size().height - 1)});
      const auto pixel = ray ? old.project(ray->origin + ray->direction) : std::nullopt;
      if (pixel) worst = std::max(worst, (*pixel - Vector<2>(x * (found.size().width - 1), y * (found.size().height - 1))).norm());
    }
  }
  warnings.push_back(
      fmt::format("camera \"{}\": the lens it came with and the one that the pitch shows differ by up to {:.0f} px; "
                  "the pitch's is kept",
                  before.name, worst));
}

void draw(const PitchRun& run, const PitchRunOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(options.images, error);
  if (error) throw Error("{}: this folder cannot be made ({})", options.images, error.message());
  const Matrix<3> world_from_ground = run.calibration.ground_from_world.inverse();
  const auto to_world = [&](const Vector<2>& pitch) -> Vector<2> {
    return (world_from_ground * (pitch + run.calibration.corner).homogeneous()).hnormalized();
  };
  auto lines = geometry::pitch_lines(options.pitch.size, 0.25);
  for (geometry::PitchLine& line : lines) {
    for (Vector<2>& location : line.points) location = to_world(location);
  }
  for (std::size_t i = 0; i < run.views.size(); ++i) {
    const marey::calibrate::pitch::PitchView& view = run.views[i];
    const marey::calibrate::pitch::PitchViewResult& found = run.calibration.views[i];
    const GroundView ground(found.camera, run.calibration.fit.ground);
    const PitchImages files(options.images, view.name);
    if (!view.empty_ground.empty()) {
      std::vector<Vector<2>> paint;
      for (const marey::calibrate::pitch::LineSighting& detected : found.lines) paint.push_back(detected.pixel);
      std::vector<draw::DrawnClick> clicks;
      for (std::size_t k = 0; k < view.points.size(); ++k)
        clicks.push_back({view.points[k].pixel, found.inlier[k] != 0, view.points[k].name});
      draw::write_image(files.overlay, draw::draw_pitch(Image(view.empty_ground), ground, lines, paint, clicks));
    }
    WholeFile map(files.accuracy);
    map.write(draw::pitch_map_svg(fmt::format("{}: what a pixel is on the ground", view.name), options.pitch.size,
                                  is_reflection(run.calibration.ground_from_world),
                                  [&](const Vector<2>& pitch) -> std::optional<double> {
                                    const auto pixel = ground.pixel(to_world(pitch));
                                    if (!pixel || !found.camera.in_image(*pixel)) return std::nullopt;
                                    const auto location = ground.location(*pixel);
                                    if (!location) return std::nullopt;
                                    return location->by_pixel.operatorNorm();
                                  }));
    map.finish();
  }
}

/// Offsets that the rig does not specify.
void put_in_step(PitchRun& run, const PitchRunOptions& options, const Hooks& hooks) {
  if (options.synced) {
    for (RigCamera& camera : run.rig.cameras) camera.offset_s = camera.offset_s.value_or(0);
  }
  if (!people::ground::lacks_offsets(run.rig)) return;
  // A pitch whose corner is elsewhere has no name in the rig yet: then every person counts.
  const bool at_origin = run.calibration.corner.norm() < 0.01;
  const reconstruct::GroundArea area(run.rig.ground_from_world, at_origin ? std::optional(options.pitch.size) : std::nullopt,
                                     kMargin);
  try {
    run.offsets = people::ground::find_rig_offsets(run.rig, area, {}, hooks);
  } catch (const Error& error) {
    run.warnings.push_back(fmt::format("when cameras were started was not searched for: {}", error.what()));
    return;
  }
  people::ground::enter_offsets(run.rig, run.offsets);
  run.warnings.insert(run.warnings.end(), run.offsets.warnings.begin(), run.offsets.warnings.end());
}

/// Whether cameras that are not clicked in were calibrated before: their ground stays as it is.
bool others_stand_on_it(const Rig& rig, const std::map<std::string, std::string>& clicks) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(),
                     [&](const RigCamera& camera) { return !clicks.contains(camera.name) && camera.camera(); });
}

/// A camera on a stand or a mast is beside the pitch: one that is found on it has another camera's clicks, or wrong names of
/// places.
void check_locations(PitchRun& run, const geometry::PitchSize& size) {
  constexpr double kAboveAll_m = 15;  // by definition: cameras on wires hang higher
  double to_side = 0;                 // the user's y grows to either side
  for (const marey::calibrate::pitch::PitchView& view : run.views) {
    for (const auto& point : view.points) to_side += point.ground.y();
  }
  for (std::size_t i = 0; i < run.views.size(); ++i) {
    const Vector<3>& centre = run.calibration.views[i].camera.centre();
    const Vector<2> at = (run.calibration.ground_from_world * centre.head<2>().homogeneous()).hnormalized();
    const double across = to_side < 0 ? -at.y() : at.y();
    if (at.x() > 0 && at.x() < size.length && across > 0 && across < size.width && centre.z() < kAboveAll_m)
      run.warnings.push_back(
          fmt::format("camera \"{}\" is found on the pitch, at ({:.1f}, {:.1f}), {:.1f} m up: are its points another camera's?",
                      run.cameras[i], at.x(), at.y(), centre.z()));
  }
}

/// The result, in the rig.
void enter(PitchRun& run) {
  run.rig.ground_from_world = run.calibration.ground_from_world;
  run.rig.ground = run.calibration.fit.ground;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < run.views.size(); ++i) {
    const marey::calibrate::pitch::PitchViewResult& found = run.calibration.views[i];
    RigCamera& camera = camera_named(run.rig, run.cameras[i]);
    compare_lens(camera, found.camera, run.warnings);
    camera.size = found.camera.size();
    camera.lens = found.camera.lens();
    camera.camera_from_world = found.camera.camera_from_world();
    camera.ground_from_image.reset();
    double square = 0, good = 0;
    for (std::size_t k = 0; k < found.inlier.size(); ++k) {
      if (found.inlier[k]) square += found.error_px[k] * found.error_px[k], ++good;
    }
    camera.rms_px = std::sqrt(square / std::max(1.0, good));
    sum += square, count += good;
  }
  run.rig.calibration = Rig::Calibration{.method = "pitch",
                                         .mean_px = {},
                                         .rms_px = std::sqrt(sum / std::max(1.0, count)),
                                         .inliers = static_cast<int>(count),
                                         .observations = {},
                                         .grade = {}};
}

}  // namespace

PitchImages::PitchImages(const std::string& folder, const std::string& camera)
    : overlay((std::filesystem::path(folder) / (camera + ".jpg")).string()),
      accuracy((std::filesystem::path(folder) / (camera + "_accuracy.svg")).string()) {}

PitchRun calibrate_pitch(const Rig& rig, const std::map<std::string, std::string>& clicks, const PitchRunOptions& options,
                         const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  PitchRun run;
  run.rig = rig;
  if (clicks.empty()) throw Error("give the clicked points of at least one camera: --points CAM=FILE");
  for (const auto& [name, path] : clicks) camera_named(run.rig, name);
  for (RigCamera& camera : run.rig.cameras) {
    const auto given = clicks.find(camera.name);
    if (given == clicks.end()) continue;
    hooks.advance({"looking at the ground", std::ssize(run.views), std::ssize(clicks)});
    run.views.push_back(view_of(camera, given->second, run.warnings));
    run.cameras.push_back(camera.name);
  }
  marey::calibrate::pitch::PitchCalibrationOptions pitch = options.pitch;
  if (pitch.known == marey::calibrate::pitch::GroundKnown::nothing && others_stand_on_it(run.rig, clicks))
    pitch.known = marey::calibrate::pitch::GroundKnown::wholly;
  pitch.ground = run.rig.ground;
  run.calibration = marey::calibrate::pitch::calibrate_pitch(run.views, pitch);
  enter(run);
  check_locations(run, pitch.size);
  put_in_step(run, options, hooks);
  if (!options.images.empty()) draw(run, options);
  return run;
}

}  // namespace marey::pipeline::calibrate
