#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/image.h"
#include "marey/simulate/background_image.h"
#include "marey/simulate/camera_shake.h"
#include "marey/simulate/people/people_motion.h"
#include "marey/simulate/people/people_video.h"

namespace marey::simulate::people {

/// What in a scene changes besides the people. Nothing by itself.
struct Unrest {
  double leaves_px = 0;      ///< trees before the house front: how far gusts move their leaves, px
  double calm = 0;           ///< share of the video before the leaves move
  double jitter_px = 0;      ///< the camera shakes: root mean square of either axis, px, besides jolts
  double exposure_step = 0;  ///< every two seconds the exposure changes by up to this share, within a fifth of a second
  double lamp = 0;           ///< after two fifths of the video a lamp adds this share of the light at its brightest place
  double clouds = 0;         ///< their shadows pass: the share of light that the darkest takes
  int rain = 0;              ///< streaks in each image
};

struct RestlessVideoOptions {
  cv::Size size{320, 240};  ///< px
  double rate_hz = 25;
  int frames = 300;
  int people = 5;
  double height_px = 60;  ///< of a person of 1.78 m who stands in the middle of the image
  double noise = 2;       ///< standard deviation of luma, grey levels
  PeopleSituation situation = PeopleSituation::crowd;
  ImageDegradation degradation{.blur = 0.5, .quantizer = 6};
  bool lawn = false;  ///< the ground; else a street
  Unrest unrest;
};

struct RestlessFrame {
  Image image;     ///< colour, limited range
  cv::Mat people;  ///< CV_8UC1, 255 where at least half of a pixel shows a person
};

/// A video of people in front of a scene that does not keep still, with the truth pixel by pixel: to evaluate background models on.
/// The same for the same seed.
class RestlessVideo {
 public:
  RestlessVideo(std::uint64_t seed, const RestlessVideoOptions& options);

  int frames() const { return options_.frames; }
  double rate_hz() const { return options_.rate_hz; }
  /// Frame 0 ≤ `index` < frames(). Safe to call from several threads.
  RestlessFrame render(int index) const;

 private:
  Planes ground(int index) const;
  cv::Mat light(int index) const;
  void rain(cv::Mat& luma, int index) const;
  Vector<2> shift(double time) const;

  std::uint64_t seed_;
  RestlessVideoOptions options_;
  LevelCamera detected_;  ///< of the image with its margin
  PeopleMotion motion_;
  CameraShake shake_;
  Planes still_;                   ///< the ground
  Planes leaves_;                  ///< CV_32FC1
  cv::Mat cover_;                  ///< CV_32FC1, 0 … 1: where there are leaves
  std::vector<double> exposures_;  ///< of each frame
};

}  // namespace marey::simulate::people
