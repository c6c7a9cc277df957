// Follows where a camera on a tripod looks through a film: predicted by what moves in the picture, corrected on the paint.
//
// Every frame: the optical flow predicts pan, tilt and ln f (odometry.h); paint is looked for where the model's lines then lie, as
// far about as the prediction is unsure; a robust fit with the prediction as prior gives the frame's aim and covariance, as an
// extended Kalman filter would. Where the picture does not go on (a cut), where the lines that ought to be seen are not there, or
// where the aim has become too unsure, the camera is lost until one picture alone tells where it looks (find_again.h). What is seen
// of frames that look to different sides sharpens the tripod as the film goes on. At the end everything is solved anew with the
// final tripod from what was kept of each frame, forwards, and smoothed backwards (smooth_turns.h). Cost: about 12 ms a frame of
// 720p. Memory: about 2 kB a frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "marey/calibrate/turning/find_again.h"
#include "marey/calibrate/turning/odometry.h"
#include "marey/calibrate/turning/smooth_turns.h"
#include "marey/calibrate/turning/tripod_solve.h"
#include "marey/core/picture.h"
#include "marey/core/turning_camera.h"

namespace marey::calibrate::turning {

struct FollowOptions {
  geometry::PitchSize pitch;
  OdometryOptions odometry;
  AimOptions aim;
  TripodSolveOptions tripod;
  FindAgainOptions again;
  double flow_px = 0.25;            ///< standard deviation of the odometry's pan and tilt, px of the picture at 1280 px across,
  double flow_zoom = 3e-4;          ///< and of its ln f, a frame
  double moving_share = 0.02;       ///< and so much of how far it turned
  double unsure_px = 8;             ///< standard deviation of the aim, px at 1280: beyond, the camera is lost
  double share = 0.3;               ///< of the paint that ought to be seen: with less,
  int patience = 8;                 ///< for so many frames in a row, the camera is lost
  int look_again = 5;               ///< frames between attempts to find it again
  double tripod_px = 0.4;           ///< px at 1280: what is left of the tripod's own error in every frame,
  double tripod_zoom = 4e-4;        ///< and in its ln f
  std::size_t most_keyframes = 24;  ///< that the tripod is solved on
};

struct TurningResult {
  TurningCamera camera;  ///< a turn a frame; times as given
  int found_again = 0;   ///< how often the camera was found from one picture alone
  int cuts = 0;          ///< where the picture did not go on
  int lost = 0;          ///< frames
  double median_px = 0;  ///< of the distances of agreeing paint, over all frames
};

class TurningFollower {
 public:
  TurningFollower(const geometry::Tripod& tripod, cv::Size size, const FollowOptions& options = {});

  /// A frame whose heading is known about, from clicks: frames that the tripod is solved on besides.
  void know(std::int64_t frame, const geometry::Heading& heading, const std::vector<ClickedPlace>& clicks);
  /// The next frame; its time by the camera's clock, s.
  void add(const Picture& picture, double time_s);
  /// Solves everything anew and smooths it.
  TurningResult finish();

  const geometry::Tripod& tripod() const { return tripod_; }
  /// Where the camera looked in the last frame; nothing where it is lost.
  std::optional<Aim> now() const { return aim_; }

 private:
  struct Known {
    std::int64_t frame;
    geometry::Heading heading;
    std::vector<ClickedPlace> clicks;
  };
  struct Keyframe {
    std::size_t record;
    geometry::Heading heading;
  };
  struct Correction {
    AimFit fit;
    Paint paint;
  };

  std::optional<Aim> predicted(const std::optional<Turned>& turned) const;
  std::optional<Aim> held(const cv::Mat& luma) const;
  std::optional<Aim> from_scratch(const Picture& picture);
  Correction corrected(const cv::Mat& luma, const Aim& expected) const;
  bool believable(const Correction& seen);
  void forget_doubtful();
  void note_keyframe();
  void refine_tripod(int rounds);
  double unsure_px(const Matrix<3>& covariance, double log_focal) const;

  geometry::Tripod tripod_;
  cv::Size size_;
  FollowOptions options_;
  std::vector<geometry::PitchLine> lines_;
  Odometry odometry_;
  std::vector<Known> known_;
  std::vector<TurnRecord> records_;
  std::vector<Keyframe> keyframes_;
  std::optional<Aim> aim_;
  geometry::Heading last_;  // where it looked when it was last known
  int doubtful_ = 0, waited_ = 0;
  TurningResult result_;
  std::vector<float> medians_;
};

}  // namespace marey::calibrate::turning
