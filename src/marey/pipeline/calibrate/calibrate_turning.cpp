#include "marey/pipeline/calibrate/calibrate_turning.h"

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

using marey::calibrate::turning::ClickedFrame;

constexpr double kLeastFound = 0.1;    // of the frames: a film with less is not of the pitch that was clicked
constexpr double kWorthSaying = 0.02;  // of the frames that are lost

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
      throw Error("{}: the click on {} does not say its frame; give the file a header with the columns frame,x,y,u,v", path,
                  point.name);
    const Vector<2> at = point.ground - corner;
    if (at.x() < -1 || at.y() < -1 || at.x() > pitch.length + 1 || at.y() > pitch.width + 1)
      throw Error("{}: the click on {} in frame {} is not on a pitch of {} x {} m; is --size the pitch's?", path, point.name,
                  *point.frame, pitch.length, pitch.width);
    ClickedFrame& frame = frames[*point.frame];
    frame.frame = *point.frame;
    frame.places.push_back({at, point.pixel, point.name});
  }
  std::vector<ClickedFrame> result;
  for (auto& [number, frame] : frames) result.push_back(std::move(frame));
  return result;
}

void check_in_picture(const std::vector<ClickedFrame>& clicks, const std::string& path, cv::Size size) {
  const cv::Rect picture({}, size);
  for (const ClickedFrame& frame : clicks) {
    for (const auto& click : frame.places) {
      if (picture.contains(cv::Point(cvRound(click.pixel.x()), cvRound(click.pixel.y())))) continue;
      throw Error(
          "{}: the click on {} in frame {} at ({:.0f}, {:.0f}) is outside the picture of {} x {} px; is it another film's file?",
          path, click.name, frame.frame, click.pixel.x(), click.pixel.y(), size.width, size.height);
    }
  }
}

/// 8-bit luma with the colours beside it.
Picture in_bytes(const Picture& picture) {
  if (picture.luma().type() == CV_8UC1) return picture;
  cv::Mat bytes;
  picture.luma().convertTo(bytes, CV_8U, 1.0 / 257);
  return Picture(bytes);
}

RigCamera camera_of_film(const std::string& film, const std::string& name) {
  RigCamera camera;
  camera.name = name;
  camera.source = film;
  return camera;
}

/// Frames that follow each other evenly, so that what another program detected in them has their times.
bool is_even(const std::vector<TurningCamera::Turn>& turns, double rate) {
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (std::abs(turns[i].time_s - static_cast<double>(i) / rate) > 0.4 / rate) return false;
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

marey::calibrate::turning::TurningResult follow(corridor::Feed& feed, const TurningRun& run, const TurningRunOptions& options,
                                                const Hooks& hooks) {
  marey::calibrate::turning::TurningFollower follower(run.clicked.tripod, feed.info().size, options.follow);
  for (std::size_t i = 0; i < run.clicks.size(); ++i) {
    std::vector<marey::calibrate::turning::ClickedPlace> places = run.clicks[i].places;
    for (auto& place : places) {
      if (run.clicked.reflected) place.ground.y() = options.follow.pitch.width - place.ground.y();
    }
    follower.know(run.clicks[i].frame, run.clicked.headings[i], places);
  }
  std::int64_t frames = 0;
  while (const auto given = feed.next()) {
    stop_point();
    follower.add(in_bytes(given->frame.picture), seconds(given->frame.time));
    hooks.advance({"following the camera", ++frames, feed.info().frame_count.value_or(0)});
  }
  if (frames == 0) throw Error("{}: not one frame could be read", feed.info().name);
  if (run.clicks.back().frame >= frames)
    throw Error("a click is in frame {}, and the film has {} frames, counted from 0; is it another film's file?",
                run.clicks.back().frame, frames);
  return follower.finish();
}

void check_result(TurningRun& run, const std::string& film) {
  const auto frames = static_cast<double>(run.result.camera.turns.size());
  const double found = frames - run.result.lost;
  if (found < kLeastFound * frames)
    throw Error(
        "{}: the lines of the clicked pitch were found in {:.0f} of {:.0f} frames; is it a film of one main camera over a football "
        "pitch, are the clicks right, and is --size the pitch's?",
        film, found, frames);
  if (run.result.lost > kWorthSaying * frames)
    run.warnings.push_back(fmt::format("in {} of {:.0f} frames it is not known where the camera looked; nobody has a place there",
                                       run.result.lost, frames));
}

void enter_camera(TurningRun& run, const corridor::Feed& feed, const Vector<2>& corner, const TurningRunOptions& options) {
  RigCamera camera = camera_of_film(feed.camera().source, options.name);
  camera.size = feed.info().size;
  camera.offset_s = 0;
  if (is_even(run.result.camera.turns, feed.rate_hz())) camera.rate_hz = feed.rate_hz();
  run.rig.cameras = {std::move(camera)};
  run.rig.ground_from_world = ground_from_pitch(corner, run.clicked.reflected, options.follow.pitch);
  run.rig.calibration.emplace().method = "pitch";
}

void draw_overlay(const corridor::Feed& feed, const TurningRun& run, const TurningRunOptions& options, const Hooks& hooks) {
  corridor::Feed again = feed.again();
  draw::MovieWriter movie(options.overlay, feed.info().size, feed.rate_hz());
  const auto lines = geometry::pitch_lines(options.follow.pitch, 0.25);
  const TurningCamera& turning = run.result.camera;
  std::size_t index = 0;
  while (const auto given = again.next()) {
    stop_point();
    if (index >= turning.turns.size()) break;
    const TurningCamera::Turn& turn = turning.turns[index++];
    if (turn.heading) {
      movie.write(draw::draw_pitch(given->frame.picture,
                                   GroundView(geometry::camera_of(turning.tripod, *turn.heading, feed.info().size)), lines, {}, {}),
                  given->frame.time);
    } else {
      draw::Canvas canvas(given->frame.picture);
      canvas.tag("lost", {12, 30}, {255, 90, 0}, feed.info().size.height / 30.0);
      movie.write(canvas.take(), given->frame.time);
    }
    hooks.advance({"drawing", static_cast<std::int64_t>(index), std::ssize(turning.turns)});
  }
  movie.finish();
}

}  // namespace

TurningRun calibrate_turning(const std::string& film, const std::string& clicks, const TurningRunOptions& options,
                             const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  TurningRun run;
  const geometry::PitchSize& pitch = options.follow.pitch;
  const format::PitchClicks file = format::read_pitch_clicks(clicks);
  const Vector<2> corner = corner_of_clicks(file, pitch);
  run.clicks = by_frame(file, clicks, pitch, corner);
  corridor::Feed feed(camera_of_film(film, options.name), CameraId{});
  check_in_picture(run.clicks, clicks, feed.info().size);
  try {
    run.clicked = marey::calibrate::turning::tripod_from_clicks(run.clicks, feed.info().size, pitch, options.follow.tripod);
  } catch (const Error& error) {
    throw Error("{}: {}", clicks, error.what());
  }
  const auto begin = std::chrono::steady_clock::now();
  run.result = follow(feed, run, options, hooks);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  check_result(run, film);
  enter_camera(run, feed, corner, options);
  if (!options.overlay.empty()) draw_overlay(feed, run, options, hooks);
  return run;
}

}  // namespace marey::pipeline::calibrate
