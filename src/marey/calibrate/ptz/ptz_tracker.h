// Tracks where a camera on a tripod is aimed in a video: predicted by what moves in the image, corrected on the paint.
//
// Every frame: the optical flow predicts pan, tilt and ln f (odometry.h); paint is searched for where the model's lines then lie,
// as far about as the prediction is unsure; a robust fit with the prediction as prior gives the frame's aim and covariance, as an
// extended Kalman filter would. Where the image does not continue (a cut), where the lines that ought to be seen are not there, or
// where the aim has become too unsure, the camera is lost until one image alone gives its aim (relocalise.h). The content
// of frames that face different sides sharpens the tripod as the video continues. At the end everything is solved again with the
// final tripod from the record of each frame, forwards, and smoothed backwards (smooth_ptz.h).
//
// Clicks are measurements of their frame. Wherever the camera is found from clicks or one image alone, the frames before are walked
// back as well, as far as their images are kept: those that were lost get an aim, those that were followed to another place are
// taken over where more speaks for it, and where neither is better they are in set_ambiguous, which is lost. At the end the result
// is compared with every click, and what contradicts one is lost. Cost: about 12 ms a frame of 720p. Memory: about 2 kB a frame,
// and the last images.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "marey/calibrate/ptz/frame_fit.h"
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
  double moving_fraction = 0.02;   ///< and this much of how far it turns and zooms,
  double moving_zoom = 0.02;       ///< and of its ln f for each half image width that it turns: a thrown pan is blurred
  double unsure_px = 8;            ///< standard deviation of the aim, px at 1280: beyond, the camera is lost
  double fraction = 0.3;           ///< of the paint that ought to be seen: with less the lines are not those of the pitch;
  double line_present = 0.15;      ///< of the samples of a line: with less it is not there;
  int line_in_view = 15;           ///< samples: lines with fewer do not count;
  double lines_present = 0.5;      ///< of the lines in view: where no more than this fraction is there,
  int patience = 8;                ///< for this many frames in a row, the camera is lost
  int search_interval = 5;         ///< frames between attempts to find it again
  double model_px = 0.4;           ///< px at 1280: what no such camera explains (a lens that breathes), in every frame,
  double model_zoom = 4e-4;        ///< and in its ln f
  double click_agrees = 4;         ///< deviations of a click: a frame half of whose clicks lie farther off contradicts them
  int click_about = 50;            ///< frames to both sides of one that contradicts its clicks, which are lost with it,
  int contact_about = 6;           ///< and of one where two directions meet and contradict each other
  double click_advantage = 0.8;    ///< ratio of merits from which frames before clicks replace earlier aims,
  double image_advantage = 1.2;    ///< and frames before one that was found from its image alone
  double prefers = 1.15;           ///< ratio of merits from which one of two groups of corners is used
  double image_over_clicks = 2;    ///< ratio of merits from which an image overrules its clicks, which are reported
  int search_everywhere = 3;       ///< attempts to find it again of which one is not about the last heading alone
  double kept_mb = 160;            ///< of images, for walking back
  std::size_t max_keyframes = 24;  ///< that the tripod is solved on
};

/// A clicked frame beside the result.
struct ClickCheck {
  std::int64_t frame = 0;
  std::optional<double> off_px;  ///< the middle of the distances from its clicks; nothing if the camera was lost there
  bool contradicts = false;
};

struct PtzResult {
  PtzCamera camera;          ///< a turn a frame; times as given
  int found_again = 0;       ///< how often the camera was found from one image alone
  int cuts = 0;              ///< where the image did not continue
  int lost = 0;              ///< frames
  int ambiguous_frames = 0;  ///< of the lost ones: two directions, or a result and clicks, contradict each other there
  double median_px = 0;      ///< of the distances of agreeing paint, over all frames
  std::vector<ClickCheck> clicks;
};

class PtzTracker {
 public:
  PtzTracker(const geometry::Tripod& tripod, cv::Size size, const TrackingOptions& options = {});

  /// A frame whose heading is known about, from clicks: frames that the tripod is solved on besides. Without clicks the heading is
  /// taken where the camera is lost.
  void know(std::int64_t frame, const geometry::Heading& heading, const std::vector<ClickedPosition>& clicks);
  /// The image of a frame that is known about, before any is added: its lines sharpen the tripod. CV_8UC1.
  void prepare(std::int64_t frame, const cv::Mat& luma);
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
    std::vector<PaintSighting> paint;  // of its image, once that was given
  };
  struct Keyframe {
    std::size_t record;
    geometry::Heading heading;
  };

  std::optional<Aim> predicted(const std::optional<Rotated>& rotated) const;
  void choose_corners(Rotated& rotated, const cv::Mat& luma, const geometry::Heading& last);
  std::optional<Aim> held(const cv::Mat& luma) const;
  std::optional<Aim> found_in(const Image& image);
  std::optional<Correction> clicked(const cv::Mat& luma, const std::optional<Aim>& expected, bool& contradicts) const;
  const Known* known_at(std::size_t frame) const;
  std::vector<PaintSighting> clicks_at(std::size_t frame) const;
  Correction corrected(const cv::Mat& luma, const Aim& expected, std::size_t frame) const;
  bool missing(const Correction& detected) const;
  bool plausible(const Correction& detected);
  void keep(const cv::Mat& luma);
  void enter(TurnRecord& record, const Correction& detected, std::size_t frame) const;
  void walk_back(double advantage);
  void set_ambiguous(std::size_t from, std::size_t to);
  void forget_ambiguous();
  void note_keyframe(std::size_t index);
  void refine_tripod(int rounds);
  void check_clicks(std::vector<std::optional<Aim>>& smooth);

  geometry::Tripod tripod_;
  Matrix<geometry::Tripod::numbers> tripod_covariance_ = Matrix<geometry::Tripod::numbers>::Zero();
  cv::Size size_;
  TrackingOptions options_;
  std::vector<geometry::PitchLine> lines_;
  SearchLines search_;
  Odometry odometry_;
  std::vector<Known> known_;
  std::vector<TurnRecord> records_;
  std::deque<cv::Mat> images_;  // of the last frames
  std::vector<Keyframe> keyframes_;
  std::optional<Aim> aim_;
  geometry::Heading last_;       // where it was aimed when it was last known, and how the image has moved since
  std::optional<int> lost_for_;  // frames since it was last known; nothing if it never was, or the image did not continue
  int ambiguous_ = 0, waited_ = 0;
  PtzResult result_;
  std::vector<float> medians_;
};

}  // namespace marey::calibrate::ptz
