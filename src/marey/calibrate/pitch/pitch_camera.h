// A camera over a pitch, from points whose place on the pitch is known: clicked by hand, some on the wrong spot, some misnamed.
//
// A start (pitch_start.h) gives the lens's strength, the inliers and, its columns being those of a rotation seen through a focal
// length, focal length and pose; of all that result from the starts, cameras that face down upon the points count. Then lens and
// pose are refined together on the pixels with a robust loss, and points evaluated again. Assumes a level pitch (z = 0), square
// pixels and a principal point near the image's middle. Reference: Zhang, "A flexible new technique for camera calibration", PAMI
// 2000 (pose from H).
#pragma once

#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::pitch {

/// A place on the pitch and the pixel where it is seen.
struct PitchPoint {
  Vector<2> ground = Vector<2>::Zero();  ///< m, in the frame of the one who clicked
  Vector<2> pixel = Vector<2>::Zero();
  std::string name;  ///< as the file has it, for messages
};

/// A piece of a white line: a point of the model and where along the normal in the image the paint is seen.
struct LineSighting {
  Vector<2> ground = Vector<2>::Zero();  ///< m, in the world
  Vector<2> pixel = Vector<2>::Zero();
  Vector<2> normal = Vector<2>::UnitX();  ///< length 1, in the image, across the line
  double pixels_per_metre = 1;            ///< across the line
  double sigma_px = 0.35;                 ///< of the place found, across the line: paint is found so well
  int line = 0;                           ///< which line of the model
};

/// A straight line of the pitch that a user clicked along.
struct PitchClickedLine {
  Vector<2> from = Vector<2>::Zero(), to = Vector<2>::Zero();  ///< m, in the frame of the one who clicked
  std::vector<Vector<2>> pixels;
};

struct PitchCamera {
  Camera camera;
  std::vector<char> inlier;      ///< for each point
  std::vector<double> error_px;  ///< for each point
};

/// In a right-handed world whose ground is z = 0 and which the camera faces down upon: the points' frame must be so too (see
/// `is_left_handed`). Throws Error, `name` in front, where there are fewer than four points, all on a line, or no camera that most
/// of them agree with.
PitchCamera camera_from_points(const std::string& name, const std::vector<PitchPoint>& points, cv::Size size);

/// Whether the points, as seen from above, are in a left-handed frame (y grows to the right of x): a camera sees the ground from
/// above, so that the sign of the map decides; where both signs fit nearly as well, the camera that fits better. Throws Error as
/// `camera_from_points`.
bool is_left_handed(const std::string& name, const std::vector<PitchPoint>& points, cv::Size size);

/// Refines lens and pose on points (those not `inlier` are omitted) and sightings of lines, both with a robust loss.
/// `free_lens`: all coefficients of the lens move, else only those of a simple lens.
Camera refine(const Camera& start, const std::vector<PitchPoint>& points, const std::vector<char>& inlier,
              const std::vector<LineSighting>& sightings, bool free_lens);

}  // namespace marey::calibrate::pitch
