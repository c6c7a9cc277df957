// Bundle adjustment: cameras, what they saw, and where it was, brought to agree.
//
// Everything that was seen is a body: a free point (an LED), a wand (its place and its direction, so that the markers' distances
// hold exactly) or a board (its pose). Minimised is the sum of squared distances, in px, between where a marker is seen and where
// it should be, over the cameras' poses, as much of their lenses as is free, their time offsets, and the bodies, by
// Levenberg-Marquardt on the cameras' Schur complement (Ceres). Observations far off are put out, round by round, evaluated by the
// noise that the others show. Cost: linear in observations, cubic in cameras.
// Reference: Triggs, McLauchlan, Hartley & Fitzgibbon, "Bundle adjustment: a modern synthesis", 1999.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/lens.h"
#include "marey/geometry/rigid.h"

namespace marey::calibrate::bundle {

/// How far each number of a lens may move from where it starts: 0 holds it, infinity frees it, anything between is the standard
/// deviation of the prior value.
struct LensFreedom {
  static constexpr double free = std::numeric_limits<double>::infinity();

  double focal = 0;                    ///< both focal lengths together, relative: 0.1 is 10 %
  double aspect = 0;                   ///< their ratio, relative
  double principal = 0;                ///< px, each axis
  std::array<double, 8> distortion{};  ///< of the model's coefficients, in their order; those it lacks are ignored
};

struct BundleCamera {
  geometry::Lens lens;
  Rigid3 camera_from_world;  ///< m
  double offset_s = 0;       ///< added to the camera's times, beyond what its observations were taken with
  LensFreedom freedom = {};
  bool refine_pose = true;
  bool refine_offset = false;
  std::optional<geometry::Lens> known = std::nullopt;  ///< where `freedom` counts from; nothing: from where the lens starts
};

/// Where a wand is: marker i at origin + distance i · direction.
struct WandPose {
  Vector<3> origin = Vector<3>::Zero();      ///< m
  Vector<3> direction = Vector<3>::UnitX();  ///< length 1
};

/// A free point (m), a wand, or a board as world_from_board.
using Body = std::variant<Vector<3>, WandPose, Rigid3>;

struct BundleObservation {
  int camera = 0;
  int body = 0;
  int marker = 0;  ///< on the body; 0 for a free point
  Vector<2> pixel = Vector<2>::Zero();
  Vector<2> velocity = Vector<2>::Zero();  ///< px/s, of the marker in the image: needed where the time offset is refined
};

/// The prior values, and after `adjust` the result.
struct Bundle {
  std::vector<BundleCamera> cameras;
  std::vector<double> wand;      ///< m: distances of a wand's markers along it
  std::vector<Vector<3>> board;  ///< m: a board's points, in its frame
  std::vector<Body> bodies;
  std::vector<BundleObservation> observations;
};

struct BundleOptions {
  double noise_px = 0.5;        ///< expected of an observation, each axis: weighs the prior values
  double loss_sigmas = 3;       ///< beyond this many times the noise an error counts linearly (Huber)
  double outlier_sigmas = 5;    ///< beyond this many times the noise that the others show, an observation is put out
  double min_outlier_px = 0.2;  ///< what is nearer is never put out
  int rounds = 3;               ///< how often outliers are evaluated again, at most; 0: none is ever put out
  int iterations = 50;          ///< a round, at most
  double tolerance = 1e-10;     ///< relative change of the cost at which a round ends
  bool deviations = true;       ///< compute `BundleResult::deviations`
};

/// Standard deviations of a camera's numbers, by the noise seen. 0 for what was held, as the pose that is the frame.
struct CameraDeviation {
  Vector<3> rotation = Vector<3>::Zero();  ///< rad, about the camera's axes
  Vector<3> centre = Vector<3>::Zero();    ///< m, in the world
  double focal = 0;                        ///< relative
  double aspect = 0;
  Vector<2> principal = Vector<2>::Zero();  ///< px
  std::array<double, 8> distortion{};
  double offset_s = 0;
};

struct BundleResult {
  std::vector<char> inlier;  ///< for each observation
  double mean_px = 0;        ///< of the inliers' 2-D distances
  double rms_px = 0;
  double noise_px = 0;  ///< each axis, by the inliers, degrees of freedom taken off
  int inliers = 0;
  bool converged = false;
  std::vector<CameraDeviation> deviations;  ///< for each camera, where asked for
};

/// Where a marker of a body is, m.
Vector<3> marker_position(const Bundle& bundle, const BundleObservation& detected);

/// Its pixel by the bundle's camera, offset and velocity not regarded; nothing if it lies behind the camera.
std::optional<Vector<2>> predicted_pixel(const Bundle& bundle, const BundleObservation& detected);

/// Seen minus predicted, px, with the camera's time offset in it; nothing if the marker lies behind the camera. For each
/// observation.
std::vector<std::optional<Vector<2>>> errors_of(const Bundle& bundle);

/// Refines `bundle` in place. Observations behind their camera at the start are put out. A body with fewer observations than hold
/// it stays where it is and its observations are not inliers. The frame is that of the cameras with
/// `refine_pose` false, of which there should be one; where only free points are seen the scale is the start's.
BundleResult adjust(Bundle& bundle, const BundleOptions& options = {});

}  // namespace marey::calibrate::bundle
