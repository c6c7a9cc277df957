// The second pass over a camera's headings: every frame from the observations before it and after it.
//
// Forwards an extended Kalman filter over the record of each frame (flow, paint), backwards the smoother of Rauch, Tung &
// Striebel (1965): in pan, tilt and ln f, where a PTZ camera is smooth, and not in the image. A frame whose image does not
// continue from the one before begins a new piece.
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/ptz/line_markings.h"
#include "marey/calibrate/ptz/odometry.h"
#include "marey/calibrate/ptz/ptz_fit.h"

namespace marey::calibrate::ptz {

/// The record of a frame.
struct TurnRecord {
  double time_s = 0;
  std::optional<Rotated> rotated;    ///< since the frame before; nothing if the image did not continue
  std::optional<Aim> found;          ///< as it was followed; nothing if the camera was lost
  std::vector<PaintSighting> paint;  ///< that agreed with it
};

struct SmoothOptions {
  AimOptions aim;
  double same_px = 4, same_deviations = 3;  ///< two aims of a frame agree within this many px at 1280 and deviations
  double flow_px = 0.25, flow_zoom = 3e-4, moving_fraction = 0.02, moving_zoom = 0.02;  ///< as TrackingOptions has them
};

/// How unsure the flow's step is, at a focal length.
Matrix<3> flow_covariance(const Rotated& rotated, double log_focal, const SmoothOptions& options);

/// An aim after a step of the flow, and before one.
Aim next_aim(const Aim& before, const Rotated& rotated, const SmoothOptions& options);
Aim previous_aim(const Aim& after, const Rotated& rotated, const SmoothOptions& options);

/// Whether two aims of one frame, found independently, say the same.
bool same_aim(const Aim& a, const Aim& b, const SmoothOptions& options);

/// The aim of every frame; nothing if the camera was lost, but for a few frames before it was found.
std::vector<std::optional<Aim>> smooth_ptz(const std::vector<TurnRecord>& records, const geometry::Tripod& tripod, cv::Size size,
                                           const SmoothOptions& options);

}  // namespace marey::calibrate::ptz
