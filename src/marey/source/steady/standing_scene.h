// The scene that a fixed camera looks at, as corners of it that stand, and where a picture looks against it. A picture is compared
// with the scene itself, never with the picture before, so that nothing adds up: pictures of the beginning are laid over each
// other and their median, in which nobody walks, is what corners are taken from. Each is followed into the new picture by its
// gradient (Lucas & Kanade 1981, on pyramids, Bouguet 2001), from where the camera was last; if that fails, from where phase
// correlation sees the whole picture. Where too few corners agree on a motion the picture is lost, rather than moved wrongly.
//
// As light and things change, fewer corners are found again. Then corners are taken anew from the mean of recent pictures, which
// lies where the scene lay; earlier ones are kept, for the light that comes back. Each change may cost a few hundredths of a pixel.
//
// Assumes that most of what can be followed stands, and that the camera keeps its lens. Pictures are shrunk to 400 to 800 px
// across, which a corner's place needs no more of. Cost: 2 ms a picture on one core, whatever its size.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/picture.h"
#include "marey/source/steady/scene_looks.h"
#include "marey/source/steady/scene_motion.h"

namespace marey::source::steady {

/// In shrunk px where nothing else is said.
struct StandingSceneOptions {
  int most_across = 800;       ///< px of a shrunk picture
  int corners = 240;           ///< at most
  double least_corner = 8;     ///< squared grey levels of gradient over a window of 7 px, along the direction where it is less
  double agree = 0.7;          ///< px from the scene's motion: the corner stands
  int fewest = 12;             ///< corners that agree, or the picture is lost
  double share_of_all = 0.12;  ///< of all corners that agree, or it is lost
  double farthest = 0.3;       ///< of the picture's width: what is moved further is lost
  double share = 0.3;          ///< of the corners within the picture that agree, or it is lost
  double least_spread = 0.05;  ///< of the picture's height that those cover, as a standard deviation
  double renew = 0.5;          ///< share of what agreed with the corners when they were new: fewer, and new ones are taken
  double tells_focal = 1.5;    ///< px of motion, from which on the focal length shows
};

class StandingScene {
 public:
  /// `known` is the lens where it is calibrated, px of the whole picture; else the focal length is found out.
  StandingScene(cv::Size picture, const std::optional<PinholeView>& known, const StandingSceneOptions& options = {});

  /// Learns from pictures of the beginning, at any distance in time: the rest is then the middle of what they show, the focal
  /// length is settled, and nobody who walks is among the corners. False where nothing is seen that stands: it then knows nothing.
  bool learn(std::span<const Picture> samples);

  /// Where the camera looks; nothing where that cannot be told, or the picture has another size. Pictures come in order. The first
  /// one with corners is the rest where nothing was learned.
  std::optional<SceneMotion> find(const Picture& picture);

  /// The lens as known now, px of the whole picture.
  PinholeView view() const;

 private:
  struct Corners {
    std::vector<cv::Mat> pyramid;
    std::vector<cv::Point2f> at;
    double agreed = 0;  // share of them, when they were new
  };
  struct Sampled {
    cv::Mat shrunk;
    std::vector<FollowedPlace> places;
    std::optional<SceneMotion> motion;
  };

  static std::vector<cv::Mat> pyramid_of(const cv::Mat& picture, bool gradients);
  cv::Mat shrunk(const Picture& picture) const;
  bool take_corners(const cv::Mat& from);
  std::vector<FollowedPlace> follow(const Corners& corners, const std::vector<cv::Mat>& pyramid, const SceneMotion& start,
                                    int& within) const;
  std::optional<SceneFit> fit(const std::vector<FollowedPlace>& places, int within, std::size_t all) const;
  std::optional<SceneFit> find_from(const Corners& corners, const std::vector<cv::Mat>& pyramid, const SceneMotion& start,
                                    std::vector<FollowedPlace>* places = nullptr) const;
  std::optional<SceneFit> find_anywhere(const cv::Mat& now, const std::vector<cv::Mat>& pyramid);
  std::size_t begin_with(std::vector<Sampled>& samples, std::size_t anchor);
  std::size_t begin_with_all_pixels(std::vector<Sampled>& samples, std::size_t anchor);
  bool begin(std::vector<Sampled>& samples);
  cv::Mat laid_over(const std::vector<Sampled>& samples, const SceneMotion& rest) const;
  void settle_focal(const std::vector<std::vector<FollowedPlace>>& pictures);
  bool learn_focal(const std::vector<FollowedPlace>& places, const SceneMotion& motion);
  std::optional<SceneFit> find_by_corners(const cv::Mat& now, const std::vector<cv::Mat>& pyramid);
  std::optional<SceneMotion> find_by_all_pixels(const cv::Mat& now);
  std::optional<SceneMotion> find_from_before(const cv::Mat& now, const std::vector<cv::Mat>& pyramid);
  bool remember(const cv::Mat& now, const SceneMotion& motion);
  void keep_up(const cv::Mat& now, const SceneFit& fit);
  cv::Mat at_rest(const cv::Mat& now, const SceneMotion& motion) const;
  cv::Mat coarse(const cv::Mat& picture) const;

  StandingSceneOptions options_;
  cv::Size picture_;
  int shrink_ = 1;
  cv::Size size_;
  PinholeView view_;  // shrunk
  bool focal_known_;
  std::vector<std::vector<FollowedPlace>> for_focal_;
  std::vector<Corners> corners_;  // the last few kinds of light; the first are from the beginning
  std::size_t used_ = 0;
  SceneLooks looks_;            // of the beginning
  bool looks_learned_ = false;  // from several pictures
  SceneMotion last_;
  Corners before_;          // of a picture of late whose motion was known
  cv::Mat before_picture_;  // that picture, until its corners are wanted
  SceneMotion before_motion_;
  int by_before_ = 0;  // pictures in turn whose motion only that one told
  cv::Mat mean_;       // CV_32F, at rest, of recent pictures
  int in_mean_ = 0, since_mean_ = 0, lost_run_ = 0;
  double agreed_ = 0;  // share of corners, of late
};

}  // namespace marey::source::steady
