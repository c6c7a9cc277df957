// The second pass over a camera's headings: every frame from what was seen before it and after it.
//
// Forwards an extended Kalman filter over what was kept of each frame (flow, paint), backwards the smoother of Rauch, Tung &
// Striebel (1965): in pan, tilt and ln f, where a turning camera is smooth, and not in the picture. A frame whose picture does not
// go on from the one before begins a new piece.
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/turning/aim.h"
#include "marey/calibrate/turning/odometry.h"
#include "marey/calibrate/turning/paint.h"

namespace marey::calibrate::turning {

/// What is kept of a frame.
struct TurnRecord {
  double time_s = 0;
  std::optional<Turned> turned;      ///< since the frame before; nothing where the picture did not go on
  std::optional<Aim> found;          ///< as it was followed; nothing where the camera was lost
  std::vector<PaintSighting> paint;  ///< that agreed with it
};

struct SmoothOptions {
  AimOptions aim;
  double flow_px = 0.25, flow_zoom = 3e-4, moving_share = 0.02;  ///< as FollowOptions has them
};

/// How unsure the flow's step is, at a focal length.
Matrix<3> flow_covariance(const Turned& turned, double log_focal, const SmoothOptions& options);

/// The aim of every frame; nothing where the camera was lost, but for a few frames before it was found.
std::vector<std::optional<Aim>> smooth_turns(const std::vector<TurnRecord>& records, const geometry::Tripod& tripod, cv::Size size,
                                             const SmoothOptions& options);

}  // namespace marey::calibrate::turning
