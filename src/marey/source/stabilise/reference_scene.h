// The scene that a fixed camera faces, as corners of it that stand, and an image's aim relative to it. An image is compared
// with the scene itself, never with the image before, so that nothing adds up: images of the beginning are laid over each
// other and their median, in which no person walks, is what corners are taken from. Each is followed into the new image by its
// gradient (Lucas & Kanade 1981, on pyramids, Bouguet 2001), from where the camera was last; if that fails, from where phase
// correlation sees the whole image. Where too few corners agree on a motion the image is lost, rather than moved wrongly.
//
// As light and things change, fewer corners are found again. Then corners are taken again from the mean of recent images, which
// lies where the scene lay; earlier ones are kept, for the light that comes back. Each change may cost a few hundredths of a pixel.
//
// Assumes that most of what can be followed stands, and that the camera keeps its lens. Images are shrunk to 400 to 800 px
// across, which a corner's place needs no more of. Cost: 2 ms an image on one core, whatever its size.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/image.h"
#include "marey/source/stabilise/scene_appearance.h"
#include "marey/source/stabilise/scene_motion.h"

namespace marey::source::stabilise {

/// In shrunk px where nothing else is said.
struct ReferenceSceneOptions {
  int max_across = 800;           ///< px of a shrunk image
  int corners = 240;              ///< at most
  double min_corner = 8;          ///< squared grey levels of gradient over a window of 7 px, along the direction where it is less
  double agree = 0.7;             ///< px from the scene's motion: the corner stands
  int min_corners = 12;           ///< corners that agree, or the image is lost
  double fraction_of_all = 0.12;  ///< of all corners that agree, or it is lost
  double farthest = 0.3;          ///< of the image's width: what is moved further is lost
  double fraction = 0.3;          ///< of the corners within the image that agree, or it is lost
  double min_spread = 0.05;       ///< of the image's height that those cover, as a standard deviation
  double renew = 0.5;             ///< share of what agreed with the corners when they were new: fewer, and new ones are taken
  double reports_focal = 1.5;     ///< px of motion, from which on the focal length shows
};

class ReferenceScene {
 public:
  /// `known` is the lens where it is calibrated, px of the whole image; else the focal length is found out.
  ReferenceScene(cv::Size image, const std::optional<PinholeView>& known, const ReferenceSceneOptions& options = {});

  /// Learns from images of the beginning, at any distance in time: the rest is then the middle of what they show, the focal
  /// length is settled, and no person who walks is among the corners. False where nothing is seen that stands: it then knows
  /// nothing.
  bool learn(std::span<const Image> samples);

  /// The camera's aim; nothing if that cannot be reported, or the image has another size. Images come in order. The first
  /// one with corners is the rest where nothing was learned.
  std::optional<SceneMotion> find(const Image& image);

  /// The lens as known now, px of the whole image.
  PinholeView view() const;

 private:
  struct Corners {
    std::vector<cv::Mat> pyramid;
    std::vector<cv::Point2f> at;
    double agreed = 0;  // share of them, when they were new
  };
  struct Sampled {
    cv::Mat shrunk;
    std::vector<TrackedPosition> locations;
    std::optional<SceneMotion> motion;
  };

  static std::vector<cv::Mat> pyramid_of(const cv::Mat& image, bool gradients);
  cv::Mat shrunk(const Image& image) const;
  bool take_corners(const cv::Mat& from);
  std::vector<TrackedPosition> track_corners(const Corners& corners, const std::vector<cv::Mat>& pyramid, const SceneMotion& start,
                                             int& within) const;
  std::optional<SceneFit> fit(const std::vector<TrackedPosition>& locations, int within, std::size_t all) const;
  std::optional<SceneFit> find_from(const Corners& corners, const std::vector<cv::Mat>& pyramid, const SceneMotion& start,
                                    std::vector<TrackedPosition>* locations = nullptr) const;
  std::optional<SceneFit> find_anywhere(const cv::Mat& now, const std::vector<cv::Mat>& pyramid);
  std::size_t begin_with(std::vector<Sampled>& samples, std::size_t anchor);
  std::size_t begin_with_all_pixels(std::vector<Sampled>& samples, std::size_t anchor);
  bool begin(std::vector<Sampled>& samples);
  cv::Mat laid_over(const std::vector<Sampled>& samples, const SceneMotion& rest) const;
  void settle_focal(const std::vector<std::vector<TrackedPosition>>& images);
  bool learn_focal(const std::vector<TrackedPosition>& locations, const SceneMotion& motion);
  std::optional<SceneFit> find_by_corners(const cv::Mat& now, const std::vector<cv::Mat>& pyramid);
  std::optional<SceneMotion> find_by_all_pixels(const cv::Mat& now);
  std::optional<SceneMotion> find_from_before(const cv::Mat& now, const std::vector<cv::Mat>& pyramid);
  bool remember(const cv::Mat& now, const SceneMotion& motion);
  void keep_up(const cv::Mat& now, const SceneFit& fit);
  cv::Mat at_rest(const cv::Mat& now, const SceneMotion& motion) const;
  cv::Mat coarse(const cv::Mat& image) const;

  ReferenceSceneOptions options_;
  cv::Size image_;
  int shrink_ = 1;
  cv::Size size_;
  PinholeView view_;  // shrunk
  bool focal_known_;
  std::vector<std::vector<TrackedPosition>> for_focal_;
  std::vector<Corners> corners_;  // the last few kinds of light; the first are from the beginning
  std::size_t used_ = 0;
  SceneAppearance appearances_;        // of the beginning
  bool learned_from_several_ = false;  // from several images
  SceneMotion last_;
  Corners before_;        // of an image of late whose motion was known
  cv::Mat before_image_;  // that image, until its corners are wanted
  SceneMotion before_motion_;
  int by_before_ = 0;  // images in turn whose motion came only from that one
  cv::Mat mean_;       // CV_32F, at rest, of recent images
  int in_mean_ = 0, since_mean_ = 0, lost_run_ = 0;
  double agreed_ = 0;  // share of corners, of late
};

}  // namespace marey::source::stabilise
