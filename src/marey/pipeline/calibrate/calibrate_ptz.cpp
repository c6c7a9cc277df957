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
#include "marey/pipeline/calibrate/start_ptz.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {
namespace {

using marey::calibrate::ptz::ClickedFrame;

constexpr double kMinFound = 0.1;      // of the frames: a video with less is not of the pitch that was clicked
constexpr double kMinReported = 0.02;  // of the frames that are lost
constexpr int kFewLines = 4;  // straight lines: with fewer the message says that there is no pitch; numerical: nothing else

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

/// The same turned by half a turn: the camera stands behind the far touchline.
Matrix<3> ground_from_other_side(const geometry::PitchSize& pitch) {
  Matrix<3> ground = Matrix<3>::Identity();
  ground(0, 0) = ground(1, 1) = -1;
  ground(0, 2) = pitch.length, ground(1, 2) = pitch.width;
  return ground;
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

marey::calibrate::ptz::PtzResult track_camera(corridor::Feed& feed, const PtzRun& run, const PtzRunOptions& options,
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
        "{}: the lines of the {}pitch were found in {:.0f} of {:.0f} frames; is it a video of one main camera over a football "
        "pitch, {} and is --size the pitch's?",
        video, run.searched ? "" : "clicked ", found, frames,
        run.searched ? "do two frames face different sides (--points decides)," : "are the clicks right,");
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
  run.rig.ground_from_world = run.searched && options.side == PtzSide::far
                                  ? ground_from_other_side(options.tracking.pitch)
                                  : ground_from_pitch(corner, run.clicked.reflected, options.tracking.pitch);
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

/// Single clicks that the others contradict.
void warn_of_odd_clicks(PtzRun& run, const PtzRunOptions& options, cv::Size size) {
  const double limit = std::max(options.odd_click * options.tracking.tripod.click_px * size.width / 1280.0,
                                options.odd_click * run.clicked.median_px);
  for (std::size_t i = 0; i < run.clicks.size(); ++i) {
    for (std::size_t k = 0; k < run.clicks[i].locations.size(); ++k) {
      const double off = run.clicked.error_px[i][k];
      if (off > limit)
        run.warnings.push_back(
            fmt::format("frame {}: the click on {} is {:.0f} px from where the other clicks place it; is it on that line?",
                        run.clicks[i].frame, run.clicks[i].locations[k].name, off));
    }
  }
}

/// Enters clicks and the tripod by them; where their frame's corner of the pitch lies.
Vector<2> start_with_clicks(PtzRun& run, const corridor::Feed& feed, const PtzRunOptions& options, const std::string& clicks) {
  const geometry::PitchSize& pitch = options.tracking.pitch;
  const format::PitchClicks file = format::read_pitch_clicks(clicks);
  const Vector<2> corner = corner_of_clicks(file, pitch);
  run.clicks = by_frame(file, clicks, pitch, corner);
  check_in_image(run.clicks, clicks, feed.info().size);
  try {
    run.clicked = marey::calibrate::ptz::tripod_from_clicks(run.clicks, feed.info().size, pitch, options.tracking.tripod);
  } catch (const Error& error) {
    throw Error("{}: {}", clicks, error.what());
  }
  warn_of_odd_clicks(run, options, feed.info().size);
  if (run.clicked.either_hand)
    run.warnings.push_back(
        "all clicks lie on one line, which is the same in a pitch whose left and right are exchanged: y is taken to grow to the "
        "left of x; click a place beside that line to be sure");
  return corner;
}

/// What to do where the images do not decide.
Error unsearchable(const PtzStart& start, const std::string& video) {
  if (start.lines < kFewLines)
    return Error(
        "{}: no frame shows the lines of a pitch (frame {} shows most straight lines on grass: {}); is it a video of one main "
        "camera over a football pitch?",
        video, start.frame, start.lines);
  return Error(
      "{}: {} its lines; click in frame {}, which shows most of them ({}), and in one or more that face elsewhere (--points)",
      video, start.ambiguous ? "two places of a main camera explain" : "no place of a main camera over a football pitch explains",
      start.frame, start.lines);
}

/// Enters the tripod that the images give, and the headings of theirs that it explains.
void start_without_clicks(PtzRun& run, const corridor::Feed& feed, PtzRunOptions& options, const std::string& video,
                          const Hooks& hooks) {
  run.searched = true;
  const PtzStart start = start_of_video(feed, options.tracking.pitch, options.tracking.tripod, hooks);
  if (!start.found) throw unsearchable(start, video);
  run.clicked.tripod = start.found->tripod;
  run.clicked.covariance = start.found->covariance;
  for (const auto& view : start.found->views) {
    run.clicks.push_back({view.frame, {}});
    run.clicked.headings.push_back(view.heading);
    run.clicked.error_px.emplace_back();
  }
  options.tracking.tripod.near = marey::calibrate::ptz::main_camera_prior(options.tracking.pitch);
  if (!options.side)
    run.warnings.push_back(
        "without clicks the camera is taken to stand behind the touchline y = 0; turned by half a turn the pitch has the same "
        "image "
        "(--side far)");
}

/// The frames of the start beside the track of the whole video.
void check_start(const PtzRun& run, const corridor::Feed& feed, const PtzRunOptions& options, const std::string& video) {
  std::size_t agree = 0;
  for (std::size_t i = 0; i < run.clicks.size(); ++i) {
    const auto at = static_cast<std::size_t>(run.clicks[i].frame);
    if (at >= run.result.camera.rotations.size() || !run.result.camera.rotations[at].heading) continue;
    const GroundView start(geometry::camera_of(run.clicked.tripod, run.clicked.headings[i], feed.info().size)),
        tracked(geometry::camera_of(run.result.camera.tripod, *run.result.camera.rotations[at].heading, feed.info().size));
    const Vector<2> low(feed.info().size.width / 2.0, feed.info().size.height * 0.7);
    const auto a = start.location(low), b = tracked.location(low);
    agree += a && b && (a->ground - b->ground).norm() < options.start_agrees ? 1 : 0;
  }
  if (static_cast<double>(agree) < options.starts_that_agree * static_cast<double>(run.clicks.size()))
    throw Error(
        "{}: the places that lines give in single frames contradict what moves between them (in {} of {} frames they agree); "
        "click in frame {} and in one or more that face elsewhere (--points)",
        video, agree, run.clicks.size(), run.clicks.front().frame);
}

}  // namespace

PtzRun calibrate_ptz(const std::string& video, const std::string& clicks, const PtzRunOptions& given, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  PtzRun run;
  PtzRunOptions options = given;
  corridor::Feed feed(camera_of_video(video, options.name), CameraId{});
  Vector<2> corner = Vector<2>::Zero();
  if (clicks.empty())
    start_without_clicks(run, feed, options, video, hooks);
  else
    corner = start_with_clicks(run, feed, options, clicks);
  const auto begin = std::chrono::steady_clock::now();
  run.result = track_camera(feed, run, options, hooks);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (run.searched) check_start(run, feed, options, video);
  check_result(run, video);
  enter_camera(run, feed, corner, options);
  if (!options.overlay.empty()) draw_overlay(feed, run, options, hooks);
  return run;
}

}  // namespace marey::pipeline::calibrate
