#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/image.h"
#include "marey/core/source.h"
#include "marey/simulate/background_image.h"
#include "marey/simulate/camera_shake.h"
#include "marey/simulate/people/figure.h"
#include "marey/simulate/people/people_renderer.h"

namespace marey::simulate::people {

/// What people do in a video.
enum class PeopleSituation {
  apart,     ///< each walks and runs in a lane of the image's own: no one is hidden
  crossing,  ///< two players pass, the farther one partly hidden for some twenty frames (Arnaut & Costa, Figure 6)
  post,      ///< each passes behind a board of its own, which hides it wholly for a while
  abrupt,    ///< apart, but they stop, start, turn round, squat and throw up their arms as abruptly as people can
  border,    ///< each walks out of the image and in again at its sides, in a lane of its own
  overlap,   ///< two players, one in part behind the other for two seconds, by 15 to 75 %; half of them turn back
  crowd,     ///< each goes anywhere: every kind of occlusion, entering and leaving
  standing,  ///< half of them stand from the beginning and walk off in the video's second half; the others go anywhere
  returns,   ///< each goes anywhere, and out at the sides for 2 to 10 s; one in six stays away, and another person comes instead
};

struct NamedPeopleSituation {
  std::string_view name;
  PeopleSituation situation;
};
/// All situations with the names that the command line uses.
std::span<const NamedPeopleSituation> people_situations();

enum class LightChange { constant, gradual, sudden };

struct PeopleVideoOptions {
  cv::Size size{768, 576};    ///< px
  double rate_hz = 25;        ///< frames a second
  std::optional<int> frames;  ///< nothing: 100 of crossing, 200 of the others
  std::optional<int> people;  ///< nothing: 2 of crossing and post, 6 of the others. As many as fit where they keep apart.
  double height_px = 60;      ///< of a person of 1.78 m who stands in the middle of the image
  double pace = 1;            ///< factor on all speeds
  double noise = 2;           ///< standard deviation of luma, grey levels
  double shake_px = 0;        ///< the camera shakes: what pan and tilt each move the image by, root mean square
  LightChange light = LightChange::constant;
  bool shadows = true;
  ImageDegradation degradation;        ///< what lens, sharpening and codec make of the image
  bool own_clothes = false;            ///< every person in clothes of their own; else in those of two teams
  bool same_shirts = false;            ///< overlap: both of one team; else of either
  double hidden_s = 2;                 ///< post: the longest time that a person is hidden
  std::optional<double> min_hidden_s;  ///< post: the shortest; nothing: a fifth of the longest
  bool in_pairs = false;    ///< post: at each board a second person comes from the other side, and both are hidden at once
  int overlap_frames = 20;  ///< crossing: about how long the two overlap
  Image ground;             ///< the empty scene, scaled to `size`; empty for a lawn
  int samples = 4;          ///< lattice points per pixel and axis, for edges and silhouettes
};

/// A video of people whose truth is known: the same for the same seed.
class PeopleVideo {
 public:
  static constexpr double kExposure = 0.01;  ///< s; people stand still for that long, a shaking camera does not

  /// Throws Error if an option is out of its domain.
  PeopleVideo(PeopleSituation situation, std::uint64_t seed, const PeopleVideoOptions& options = {});

  PeopleSituation situation() const { return situation_; }
  const PeopleVideoOptions& options() const { return options_; }
  int frames() const { return static_cast<int>(conditions_.size()); }
  const LevelCamera& camera() const { return camera_; }
  /// All who are in the video at all, in the order of their ids 1, 2, …
  const std::vector<Figure>& figures() const { return figures_; }

  /// How many are there at a time, at most: where they keep apart, fewer than asked for if there is no room.
  int max_at_a_time() const;

  /// The turn of a shaking camera from its rest, in frame 0 ≤ `index` < frames(): as CameraShake has it.
  Vector<3> turn(int index) const;

  /// Frame 0 ≤ `index` < frames(): image and truth, which is that of the camera at rest. Safe to call from several threads.
  RenderedFrame render(int index) const;
  /// What the camera saw before the video began, in the light of the video: other people who keep apart, instants apart. To learn
  /// the scene from. 0 ≤ `index` < kEarlier.
  Image render_earlier(int index) const;
  static constexpr int kEarlier = 20;

 private:
  PeopleSituation situation_;
  PeopleVideoOptions options_;
  LevelCamera camera_;
  std::vector<Figure> figures_;
  std::vector<std::vector<PosedFigure>> people_;  ///< by frame; their figures are ours
  std::vector<FrameConditions> conditions_;       ///< by frame
  std::vector<Figure> earlier_figures_;
  std::vector<std::vector<PosedFigure>> earlier_;
  std::optional<CameraShake> shake_;
  std::unique_ptr<PeopleRenderer> renderer_;
};

/// The video as a camera gives it. Holds `film`.
std::unique_ptr<Source> make_source(std::shared_ptr<const PeopleVideo> video);

}  // namespace marey::simulate::people
