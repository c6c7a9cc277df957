// A match as one main camera on a tripod videos it, panning, tilting and zooming after the play; with what television adds: motion
// blur, a scoreboard, graphics over a part of the image, and cuts to another camera. The truth is the camera of every frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/labelled_box.h"
#include "marey/core/ptz_camera.h"
#include "marey/simulate/match/match_motion.h"
#include "marey/simulate/match/match_renderer.h"
#include "marey/simulate/match/match_view.h"
#include "marey/simulate/match/operator_motion.h"
#include "marey/simulate/match/ptz_background.h"
#include "marey/simulate/people/image_degradation.h"

namespace marey::simulate::match {

/// s since the beginning, `to` not included.
struct VideoSpan {
  double from = 0, to = 0;
  bool holds(double time) const { return time >= from && time < to; }
};

struct PtzMatchOptions {
  cv::Size size{1280, 720};
  double rate_hz = 25;
  geometry::PitchSize pitch;
  OperatorOptions operates;
  PtzPaint paint;
  double exposure = 0.01;  ///< s that each frame is exposed: how long motion smears
  double noise = 1.5;      ///< grey levels
  people::ImageDegradation degradation{0.7, 0.2, 2, 1.2, 0, 8};
  double lens_breathes = 0.006;  ///< the radial term changes by this much for each e-fold of the focal length
  bool people = true, scoreboard = true;
  double screen = 0;            ///< px at 1280: the match is recorded by hand off a screen, and the hand shakes by this deviation
  std::vector<VideoSpan> cuts;  ///< another camera is shown
  std::vector<VideoSpan> graphics;  ///< the lower half of the image is covered
};

class PtzMatch {
 public:
  PtzMatch(const PtzMatchOptions& options, std::uint64_t seed);

  const geometry::Tripod& tripod() const { return tripod_; }
  const PtzMatchOptions& options() const { return options_; }

  /// Goes to the next frame, the first one to begin with.
  void advance();

  std::int64_t frame() const { return frame_; }
  double time() const { return static_cast<double>(frame_) / options_.rate_hz; }
  /// The aim of the main camera; nothing while another is shown. Recorded off a screen: of the camera that comes nearest to what
  /// the hand makes of it, within some pixels.
  std::optional<geometry::Heading> heading() const;
  /// Whichever camera is shown.
  const Camera& camera() const { return *camera_; }

  Image image() const;
  std::span<const MatchPerson, kMatchPeople> people() const { return motion_.people(); }
  std::span<const ObservedPerson> detected() const { return detected_; }
  std::vector<LabelledBox> detect(const MatchDetectorOptions& detector);
  /// Corners and crossings in this frame's image, `noise` px off in each axis.
  std::vector<MatchClick> clicks(double noise) const;

 private:
  Camera camera_now(const geometry::Heading& heading) const;
  geometry::Heading on_screen(const geometry::Heading& heading) const;
  cv::Mat blurred(const cv::Mat& sharp) const;
  cv::Mat off_screen(const cv::Mat& shown) const;
  void add_graphics(cv::Mat& image) const;

  PtzMatchOptions options_;
  std::uint64_t seed_;
  Random random_, detections_;
  geometry::Tripod tripod_;
  PtzBackground ground_;
  MatchMotion motion_;
  OperatorMotion operator_;
  std::array<people::Figure, kMatchPeople> figures_;
  std::array<people::Stance, kMatchPeople> stances_{};
  std::int64_t frame_ = -1;
  geometry::Heading now_, before_;
  std::optional<Camera> camera_, drawn_;  // as the video shows it, and what a screen shows that is recorded
  std::vector<ObservedPerson> detected_;
};

}  // namespace marey::simulate::match
