// People in space from one calibrated camera: the feet say where a person is, and the body is taken to lie in a vertical plane
// there that faces the camera.
//
// Each foot's points are carried along their viewing rays to the height at which they are above the ground when the foot stands on
// it. The person is at the mean of both feet, if they are a step apart at most; else one foot is in the air, which puts it too far
// away, and the nearer one counts. All keypoints then lie where their rays meet the plane, so arms and legs that reach towards the
// camera or away from it are seen from the front only: their depth is not known, and the covariance says so. People are given their
// number by where they were last. Assumed: the world's z = 0 is the floor, and all people stand on it. Cost: a few operations a
// keypoint.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/keypoints.h"
#include "marey/geometry/camera.h"
#include "marey/reconstruct/keypoints/people_in_views.h"

namespace marey::reconstruct::keypoints {

struct OneCameraOptions {
  double min_confidence = 0.3;  ///< visibility × presence of a foot's point, unswept
  double step_m = 1;            ///< longest distance between feet that both stand, unswept
  double depth_sigma_m = 0.2;   ///< of a keypoint before or behind the plane, one standard deviation, unswept
  double gate_m = 0.7;          ///< how far from where they were a person may be in the next image, unswept
  double speed_m_s = 3;         ///< and how that grows while they are not seen, unswept
  double lost_s = 1;            ///< after which a person gets a new number, unswept
};

class PeopleBeforeCamera {
 public:
  /// `number` and `cameras`: which of how many cameras the people are seen by.
  PeopleBeforeCamera(const KeypointSet& set, const Camera& camera, int number, int cameras, const OneCameraOptions& options = {});

  /// The people of an image, `seconds` after the last one; a person that shows no foot, or none on the ground, is not placed. Valid
  /// until the next call.
  const std::vector<LocatedPerson>& step(double seconds, std::span<const Keypoints<2>> people);

  /// Where a person stands, z = 0.
  std::optional<Vector<3>> stands_at(const Keypoints<2>& person) const;

 private:
  struct FootPoint {
    std::size_t point = 0;
    double height_m = 0;
  };
  struct Known {
    int id = 0;
    Vector<3> location = Vector<3>::Zero();
    double unobserved_s = 0;
  };

  std::optional<Vector<3>> foot_at(const Keypoints<2>& person, const std::vector<FootPoint>& foot) const;
  std::vector<std::optional<SpacePoint>> points_at(const Keypoints<2>& person, const Vector<3>& location) const;
  std::vector<int> numbers_of(std::span<const std::optional<Vector<3>>> locations);

  KeypointSet set_;
  Camera camera_;
  int number_, cameras_;
  OneCameraOptions options_;
  std::vector<FootPoint> left_, right_;
  std::vector<Known> known_;
  std::vector<LocatedPerson> located_;
  int next_id_ = 1;
};

}  // namespace marey::reconstruct::keypoints
