// How a camera turned since an earlier frame, from what moves in its images: corners are followed from a reference frame by
// pyramidal Lucas-Kanade, and pan, tilt and zoom fitted to them with a loss that cuts off people. What stands on the image (a
// scoreboard, graphics) stands still while the rest moves together: where enough moves together, what stands is omitted.
//
// Corners are followed from the same reference as long as enough are left, so that a static camera does not drift at all.
// Works on images of about 640 px. Cost: 6 ms a frame of 720p.
// Reference: Lucas & Kanade 1981; Shi & Tomasi, "Good features to track", CVPR 1994; Bouguet 2000 (pyramids).
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::ptz {

struct OdometryOptions {
  int corners = 280;
  double quality = 0.001;   ///< of the strongest corner: weaker ones are not followed. Grass is weak beside a scoreboard's letters
  int width = 640;          ///< px: images are shrunk to about this
  double agree_px = 1.2;    ///< of the shrunk image: corners that fit better go with the camera
  int min_corners = 24;     ///< corners that have to agree,
  double fraction = 0.25;   ///< and the share of those that could be followed
  int longest = 40;         ///< frames that one reference serves
  int graphics_reach = 12;  ///< shrunk px round a corner that may be of graphics, where no other is taken
};

struct Rotated {
  Vector<3> by = Vector<3>::Zero();  ///< pan, tilt (rad) and ln f since the last frame
  double log_focal = 0;              ///< that was assumed: pan and tilt are right for this focal length
  int agreeing = 0, tracked = 0;
  /// What the other of two groups of corners says, where some stand on the image, others move together, and numbers do not decide
  /// which of them are graphics.
  std::optional<Vector<3>> otherwise = std::nullopt;
  Vector<3> ambiguity = Vector<3>::Zero();  ///< how far the two are apart, where paint does not decide either
};

class Odometry {
 public:
  Odometry(cv::Size size, const OdometryOptions& options = {});

  /// `luma` CV_8UC1, the next frame; `last` is where the camera faced in the one before, as far as is known. Nothing at the first
  /// frame and where the image does not continue from the last (a cut).
  std::optional<Rotated> step(const cv::Mat& luma, const geometry::Tripod& tripod, const geometry::Heading& last);
  /// The last step was as the other group says: the two change places in `rotated`. `last` as it was given there.
  void prefer_other(Rotated& rotated, const geometry::Heading& last);

 private:
  struct Match {
    Vector<3> location;  // m, in the world
    Vector<2> detected;  // half widths from the middle
    bool still = false;  // it has not moved on the image
  };
  void refer(const geometry::Tripod& tripod, const geometry::Heading& heading);
  std::vector<Match> track_corners();
  std::optional<Rotated> fit(const geometry::Tripod& tripod, const std::vector<Match>& matches);

  OdometryOptions options_;
  cv::Size size_;  // shrunk
  std::vector<cv::Mat> pyramid_, reference_;
  std::vector<cv::Point2f> corners_, now_;
  std::vector<Vector<3>> locations_;
  geometry::Tripod reference_tripod_;  // a tripod that is refined in the meantime must not move the places
  geometry::Heading reference_heading_;
  std::vector<geometry::Heading> chains_;  // where each group says that the last image was aimed; one where they agree
  std::vector<cv::Point2f> standing_;      // in the last image, where others contradict them: they may be graphics
  int age_ = 0;
  std::size_t begun_with_ = 0;
};

}  // namespace marey::calibrate::ptz
