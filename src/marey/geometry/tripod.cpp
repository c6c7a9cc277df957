#include "marey/geometry/tripod.h"

namespace marey::geometry {

Camera camera_of(const Tripod& tripod, const Heading& heading, cv::Size size) {
  const auto numbers = tripod.as_numbers();
  const Vector<3> rotated = heading.as_vector();
  const TripodFrame<double> frame(numbers.data(), rotated.data());
  Rigid3 pose;
  pose.rotation << frame.right.transpose(), frame.down.transpose(), frame.ahead.transpose();
  pose.translation = -(pose.rotation * frame.centre);
  BrownLens lens;
  lens.focal.setConstant(frame.focal * size.width / 2);
  lens.principal = to_pixel({0, 0}, size);
  lens.distortion[0] = tripod.bend * frame.focal * frame.focal;
  return {lens, pose, size};
}

}  // namespace marey::geometry
