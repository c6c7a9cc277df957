// How a camera turned since an earlier frame, from what moves in its pictures: corners are followed from a reference frame by
// pyramidal Lucas-Kanade, and pan, tilt and zoom fitted to them with a loss that cuts off people. What stands on the picture (a
// scoreboard, graphics) stands still while the rest moves together: where enough moves together, what stands is left out.
//
// Corners are followed from the same reference as long as enough are left, so that a camera that stands does not drift at all.
// Works on pictures of about 640 px. Cost: 6 ms a frame of 720p.
// Reference: Lucas & Kanade 1981; Shi & Tomasi, "Good features to track", CVPR 1994; Bouguet 2000 (pyramids).
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::turning {

struct OdometryOptions {
  int corners = 280;
  int width = 640;        ///< px: pictures are shrunk to about this
  double agree_px = 1.2;  ///< of the shrunk picture: corners that fit better go with the camera
  int fewest = 24;        ///< corners that have to agree,
  double share = 0.25;    ///< and the share of those that could be followed
  int longest = 40;       ///< frames that one reference serves
};

struct Turned {
  Vector<3> by = Vector<3>::Zero();  ///< pan, tilt (rad) and ln f since the last frame
  double log_focal = 0;              ///< that was assumed: pan and tilt are right for this focal length
  int agreeing = 0, followed = 0;
};

class Odometry {
 public:
  Odometry(cv::Size size, const OdometryOptions& options = {});

  /// `luma` CV_8UC1, the next frame; `last` is where the camera looked in the one before, as far as is known. Nothing at the first
  /// frame and where the picture does not go on from the last (a cut).
  std::optional<Turned> step(const cv::Mat& luma, const geometry::Tripod& tripod, const geometry::Heading& last);

 private:
  struct Match {
    Vector<3> place;     // m, in the world
    Vector<2> seen;      // half widths from the middle
    bool still = false;  // it has not moved on the picture
  };
  void refer(const geometry::Tripod& tripod, const geometry::Heading& heading);
  std::vector<Match> follow();
  std::optional<Turned> fit(const geometry::Tripod& tripod, const std::vector<Match>& matches,
                            const geometry::Heading& start) const;

  OdometryOptions options_;
  cv::Size size_;  // shrunk
  std::vector<cv::Mat> pyramid_, reference_;
  std::vector<cv::Point2f> corners_, now_;
  std::vector<Vector<3>> places_;
  geometry::Tripod reference_tripod_;  // a tripod that is refined meanwhile must not move the places
  geometry::Heading reference_heading_, chained_;
  int age_ = 0;
  std::size_t begun_with_ = 0;
};

}  // namespace marey::calibrate::turning
