// Tracks where a camera on a tripod is aimed in a video: predicted by what moves in the image, corrected on the paint.
//
// Every frame: the optical flow predicts pan, tilt and ln f (odometry.h); paint is searched for where the model's lines then lie,
// as far about as the prediction is unsure; a robust fit with the prediction as prior gives the frame's aim and covariance, as an
// extended Kalman filter would. Where the image does not continue (a cut), where the lines that ought to be seen are not there, or
// where the aim has become too unsure, the camera is lost until one image alone gives its aim (relocalise.h). The content
// of frames that face different sides sharpens the tripod as the video continues. At the end everything is solved again with the
// final tripod from the record of each frame, forwards, and smoothed backwards (smooth_ptz.h). Cost: about 12 ms a frame of
// 720p. Memory: about 2 kB a frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "marey/calibrate/ptz/odometry.h"
#include "marey/calibrate/ptz/relocalise.h"
#include "marey/calibrate/ptz/smooth_ptz.h"
#include "marey/calibrate/ptz/tripod_solve.h"
#include "marey/core/image.h"
#include "marey/core/ptz_camera.h"

namespace marey::calibrate::ptz {

struct TrackingOptions {
  geometry::PitchSize pitch;
  OdometryOptions odometry;
  AimOptions aim;
  TripodSolveOptions tripod;
  FindAgainOptions again;
  double flow_px = 0.25;           ///< standard deviation of the odometry's pan and tilt, px of the image at 1280 px across,
  double flow_zoom = 3e-4;         ///< and of its ln f, a frame
  double moving_fraction = 0.02;   ///< and this much of how far it turned
  double unsure_px = 8;            ///< standard deviation of the aim, px at 1280: beyond, the camera is lost
  double fraction = 0.3;           ///< of the paint that ought to be seen: with less,
  int patience = 8;                ///< for this many frames in a row, the camera is lost
  int inspect_again = 5;           ///< frames between attempts to find it again
  double tripod_px = 0.4;          ///< px at 1280: the remainder of the tripod's own error in every frame,
  double tripod_zoom = 4e-4;       ///< and in its ln f
  std::size_t max_keyframes = 24;  ///< that the tripod is solved on
};

struct PtzResult {
  PtzCamera camera;      ///< a turn a frame; times as given
  int found_again = 0;   ///< how often the camera was found from one image alone
  int cuts = 0;          ///< where the image did not continue
  int lost = 0;          ///< frames
  double median_px = 0;  ///< of the distances of agreeing paint, over all frames
};

class PtzTracker {
 public:
  PtzTracker(const geometry::Tripod& tripod, cv::Size size, const TrackingOptions& options = {});

  /// A frame whose heading is known about, from clicks: frames that the tripod is solved on besides.
  void know(std::int64_t frame, const geometry::Heading& heading, const std::vector<ClickedPosition>& clicks);
  /// The next frame; its time by the camera's clock, s.
  void add(const Image& image, double time_s);
  /// Solves everything again and smooths it.
  PtzResult finish();

  const geometry::Tripod& tripod() const { return tripod_; }
  /// Where the camera was aimed in the last frame; nothing if it is lost.
  std::optional<Aim> now() const { return aim_; }

 private:
  struct Known {
    std::int64_t frame;
    geometry::Heading heading;
    std::vector<ClickedPosition> clicks;
  };
  struct Keyframe {
    std::size_t record;
    geometry::Heading heading;
  };
  struct Correction {
    AimFit fit;
    Paint paint;
  };

  std::optional<Aim> predicted(const std::optional<Rotated>& rotated) const;
  std::optional<Aim> held(const cv::Mat& luma) const;
  std::optional<Aim> from_scratch(const Image& image);
  Correction corrected(const cv::Mat& luma, const Aim& expected) const;
  bool plausible(const Correction& detected);
  void forget_ambiguous();
  void note_keyframe();
  void refine_tripod(int rounds);
  double unsure_px(const Matrix<3>& covariance, double log_focal) const;

  geometry::Tripod tripod_;
  cv::Size size_;
  TrackingOptions options_;
  std::vector<geometry::PitchLine> lines_;
  Odometry odometry_;
  std::vector<Known> known_;
  std::vector<TurnRecord> records_;
  std::vector<Keyframe> keyframes_;
  std::optional<Aim> aim_;
  geometry::Heading last_;  // where it was aimed when it was last known
  int ambiguous_ = 0, waited_ = 0;
  PtzResult result_;
  std::vector<float> medians_;
};

}  // namespace marey::calibrate::ptz
