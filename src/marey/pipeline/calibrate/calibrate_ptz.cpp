#include "marey/pipeline/calibrate/calibrate_ptz.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/draw/canvas.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/pitch_drawing.h"
#include "marey/format/pitch_points.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {
namespace {

using marey::calibrate::ptz::ClickedFrame;

constexpr double kMinFound = 0.1;      // of the frames: a video with less is not of the pitch that was clicked
constexpr double kMinReported = 0.02;  // of the frames that are lost

/// Where in the clicks' frame the pitch's corner with the smallest x and y lies: the origin, or, where they count from the middle,
/// half a pitch before it.
Vector<2> corner_of_clicks(const format::PitchClicks& clicks, const geometry::PitchSize& pitch) {
  const bool centred = std::any_of(clicks.points.begin(), clicks.points.end(),
                                   [](const auto& point) { return point.ground.x() < -1 || point.ground.y() < -1; });
  return centred ? Vector<2>(-pitch.length / 2, -pitch.width / 2) : Vector<2>::Zero();
}

std::vector<ClickedFrame> by_frame(const format::PitchClicks& clicks, const std::string& path, const geometry::PitchSize& pitch,
                                   const Vector<2>& corner) {
  std::map<std::int64_t, ClickedFrame> frames;
  for (const format::PitchClicks::Point& point : clicks.points) {
    if (!point.frame)
      throw Error("{}: the click on {} does not specify its frame; give the file a header with the columns frame,x,y,u,v", path,
                  point.name);
    const Vector<2> at = point.ground - corner;
    if (at.x() < -1 || at.y() < -1 || at.x() > pitch.length + 1 || at.y() > pitch.width + 1)
      throw Error("{}: the click on {} in frame {} is not on a pitch of {} x {} m; is --size the pitch's?", path, point.name,
                  *point.frame, pitch.length, pitch.width);
    ClickedFrame& frame = frames[*point.frame];
    frame.frame = *point.frame;
    frame.locations.push_back({at, point.pixel, point.name});
  }
  std::vector<ClickedFrame> result;
  for (auto& [number, frame] : frames) result.push_back(std::move(frame));
  return result;
}

void check_in_image(const std::vector<ClickedFrame>& clicks, const std::string& path, cv::Size size) {
  const cv::Rect image({}, size);
  for (const ClickedFrame& frame : clicks) {
    for (const auto& click : frame.locations) {
      if (image.contains(cv::Point(cvRound(click.pixel.x()), cvRound(click.pixel.y())))) continue;
      throw Error(
          "{}: the click on {} in frame {} at ({:.0f}, {:.0f}) is outside the image of {} x {} px; is it another video's file?",
          path, click.name, frame.frame, click.pixel.x(), click.pixel.y(), size.width, size.height);
    }
  }
}

/// 8-bit luma with the colours beside it.
Image in_bytes(const Image& image) {
  if (image.luma().type() == CV_8UC1) return image;
  cv::Mat bytes;
  image.luma().convertTo(bytes, CV_8U, 1.0 / 257);
  return Image(bytes);
}

RigCamera camera_of_video(const std::string& video, const std::string& name) {
  RigCamera camera;
  camera.name = name;
  camera.source = video;
  return camera;
}

/// Frames that follow each other evenly, so that what another program detected in them has their times.
bool is_even(const std::vector<PtzCamera::Turn>& rotations, double rate) {
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    if (std::abs(rotations[i].time_s - static_cast<double>(i) / rate) > 0.4 / rate) return false;
  }
  return true;
}

/// The users' frame from the world's, whose pitch begins at the origin.
Matrix<3> ground_from_pitch(const Vector<2>& corner, bool reflected, const geometry::PitchSize& pitch) {
  Matrix<3> ground = Matrix<3>::Identity();
  ground(0, 2) = corner.x();
  ground(1, 1) = reflected ? -1 : 1;
  ground(1, 2) = corner.y() + (reflected ? pitch.width : 0);
  return ground;
}

/// The clicked frames' images first: the tripod by clicks alone leaves lines some pixels off.
void prepare(marey::calibrate::ptz::PtzTracker& tracker, const corridor::Feed& feed, const std::vector<ClickedFrame>& clicks,
             const Hooks& hooks) {
  corridor::Feed ahead = feed.again();
  std::int64_t index = 0;
  for (const ClickedFrame& frame : clicks) {
    for (; index <= frame.frame; ++index) {
      stop_point();
      const auto given = ahead.next();
      if (!given) return;
      if (index == frame.frame) tracker.prepare(frame.frame, in_bytes(given->frame.image).luma());
    }
    hooks.advance({"reading the clicked frames", index, clicks.back().frame + 1});
  }
}

marey::calibrate::ptz::PtzResult run_tracker(corridor::Feed& feed, const PtzRun& run, const PtzRunOptions& options,
                                             const Hooks& hooks) {
  marey::calibrate::ptz::PtzTracker tracker(run.clicked.tripod, feed.info().size, options.tracking);
  for (std::size_t i = 0; i < run.clicks.size(); ++i) {
    std::vector<marey::calibrate::ptz::ClickedPosition> locations = run.clicks[i].locations;
    for (auto& location : locations) {
      if (run.clicked.reflected) location.ground.y() = options.tracking.pitch.width - location.ground.y();
    }
    tracker.know(run.clicks[i].frame, run.clicked.headings[i], locations);
  }
  prepare(tracker, feed, run.clicks, hooks);
  std::int64_t frames = 0;
  while (const auto given = feed.next()) {
    stop_point();
    tracker.add(in_bytes(given->frame.image), seconds(given->frame.time));
    hooks.advance({"following the camera", ++frames, feed.info().frame_count.value_or(0)});
  }
  if (frames == 0) throw Error("{}: not one frame could be read", feed.info().name);
  if (run.clicks.back().frame >= frames)
    throw Error("a click is in frame {}, and the video has {} frames, counted from 0; is it another video's file?",
                run.clicks.back().frame, frames);
  return tracker.finish();
}

void check_result(PtzRun& run, const std::string& video) {
  const auto frames = static_cast<double>(run.result.camera.rotations.size());
  const double found = frames - run.result.lost;
  if (found < kMinFound * frames)
    throw Error(
        "{}: the lines of the clicked pitch were found in {:.0f} of {:.0f} frames; is it a video of one main camera over a "
        "football "
        "pitch, are the clicks right, and is --size the pitch's?",
        video, found, frames);
  for (const auto& click : run.result.clicks) {
    if (click.contradicts)
      run.warnings.push_back(
          fmt::format("frame {}: {:.0f} px from its clicks; that frame and those about it are lost", click.frame, *click.off_px));
  }
  if (run.result.ambiguous_frames > 0)
    run.warnings.push_back(
        fmt::format("in {} frames the camera's track contradicts itself or clicks; they are lost", run.result.ambiguous_frames));
  if (run.result.lost > kMinReported * frames)
    run.warnings.push_back(fmt::format(
        "in {} of {:.0f} frames it is not known where the camera looked; no person has a place there", run.result.lost, frames));
}

void enter_camera(PtzRun& run, const corridor::Feed& feed, const Vector<2>& corner, const PtzRunOptions& options) {
  RigCamera camera = camera_of_video(feed.camera().source, options.name);
  camera.size = feed.info().size;
  camera.offset_s = 0;
  if (is_even(run.result.camera.rotations, feed.rate_hz())) camera.rate_hz = feed.rate_hz();
  run.rig.cameras = {std::move(camera)};
  run.rig.ground_from_world = ground_from_pitch(corner, run.clicked.reflected, options.tracking.pitch);
  run.rig.calibration.emplace().method = "pitch";
}

void draw_overlay(const corridor::Feed& feed, const PtzRun& run, const PtzRunOptions& options, const Hooks& hooks) {
  corridor::Feed again = feed.again();
  draw::MovieWriter movie(options.overlay, feed.info().size, feed.rate_hz());
  const auto lines = geometry::pitch_lines(options.tracking.pitch, 0.25);
  const PtzCamera& ptz = run.result.camera;
  std::size_t index = 0;
  while (const auto given = again.next()) {
    stop_point();
    if (index >= ptz.rotations.size()) break;
    const PtzCamera::Turn& turn = ptz.rotations[index++];
    if (turn.heading) {
      movie.write(draw::draw_pitch(given->frame.image, GroundView(geometry::camera_of(ptz.tripod, *turn.heading, feed.info().size)),
                                   lines, {}, {}),
                  given->frame.time);
    } else {
      draw::Canvas canvas(given->frame.image);
      canvas.tag("lost", {12, 30}, {255, 90, 0}, feed.info().size.height / 30.0);
      movie.write(canvas.take(), given->frame.time);
    }
    hooks.advance({"drawing", static_cast<std::int64_t>(index), std::ssize(ptz.rotations)});
  }
  movie.finish();
}

}  // namespace

PtzRun calibrate_ptz(const std::string& video, const std::string& clicks, const PtzRunOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  PtzRun run;
  const geometry::PitchSize& pitch = options.tracking.pitch;
  const format::PitchClicks file = format::read_pitch_clicks(clicks);
  const Vector<2> corner = corner_of_clicks(file, pitch);
  run.clicks = by_frame(file, clicks, pitch, corner);
  corridor::Feed feed(camera_of_video(video, options.name), CameraId{});
  check_in_image(run.clicks, clicks, feed.info().size);
  try {
    run.clicked = marey::calibrate::ptz::tripod_from_clicks(run.clicks, feed.info().size, pitch, options.tracking.tripod);
  } catch (const Error& error) {
    throw Error("{}: {}", clicks, error.what());
  }
  const auto begin = std::chrono::steady_clock::now();
  run.result = run_tracker(feed, run, options, hooks);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  check_result(run, video);
  enter_camera(run, feed, corner, options);
  if (!options.overlay.empty()) draw_overlay(feed, run, options, hooks);
  return run;
}

}  // namespace marey::pipeline::calibrate
