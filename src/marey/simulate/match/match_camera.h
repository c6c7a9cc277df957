#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/image.h"
#include "marey/core/instant.h"
#include "marey/core/rig.h"
#include "marey/simulate/match/foot_errors.h"
#include "marey/simulate/match/match_cameras.h"
#include "marey/simulate/match/match_motion.h"
#include "marey/simulate/match/match_renderer.h"
#include "marey/simulate/match/match_view.h"
#include "marey/simulate/people/figure.h"
#include "marey/simulate/random.h"

namespace marey::simulate::match {

/// A match with its people and the static cameras round it.
struct MatchScene {
  using Figures = std::array<people::Figure, kMatchPeople>;
  using Stances = std::array<people::Stance, kMatchPeople>;

  /// Throws Error if an option is out of its domain.
  MatchScene(const MatchCamerasOptions& how, std::uint64_t its_seed);

  /// s since the kick-off at a time of the rig's clock; no camera begins before it.
  double match_time(double rig_time) const;
  /// How each person stands in the world.
  Stances stances(std::span<const MatchPerson, kMatchPeople> people) const;

  MatchCamerasOptions options;
  std::uint64_t seed = 1;
  Rig rig;
  Matrix<3> world_from_pitch = Matrix<3>::Identity();
  Figures figures;
};

/// What one camera sees of a match, frame by frame, by its own clock.
class MatchCamera {
 public:
  /// Camera `index` of the scene's rig, which must outlive it. Without `film` it has no images.
  MatchCamera(const MatchScene& scene, std::size_t index, const MatchDetectorOptions& detector,
              const std::optional<MatchVideoOptions>& video);

  /// Goes to the next frame, the first one to begin with.
  void advance();

  std::int64_t frame() const { return frame_; }
  double time() const;                                                    ///< s, by its own clock
  std::span<const ObservedPerson> detected() const { return detected_; }  ///< the truth: the people seen
  /// What a detector says of this frame; errs again at each call.
  std::vector<LabelledBox> detect();
  Image image() const;
  /// A ball in the match as this camera sees it, halfway through the exposure.
  struct Shot {
    Image image;
    std::optional<people::TrueBall> ball;  ///< nothing if there is no ball, or it lies behind the camera
  };
  /// The image with the ball, where the video has one.
  Shot shoot() const;

  const RigCamera& rig_camera() const { return rig_camera_; }
  /// What a user would click in its image: see match_clicks.
  std::vector<MatchClick> clicks(double noise, int wrong) const;

 private:
  std::uint64_t video_seed() const { return scene_.seed * 64 + index_; }

  const MatchScene& scene_;
  std::size_t index_;
  const RigCamera& rig_camera_;
  GroundView view_;
  MatchMotion motion_;
  MatchDetectorOptions detector_;
  Random random_;
  std::optional<FootErrors> feet_;
  std::optional<MatchRenderer> video_;
  double exposure_s_ = 0;
  bool has_ball_ = false;
  std::int64_t frame_ = -1;  // before the first
  double match_time_ = 0;
  MatchScene::Stances stances_;
  std::vector<ObservedPerson> detected_;
};

/// Where each person truly is at the first camera's frames.
class MatchTruth {
 public:
  /// The scene must outlive it.
  explicit MatchTruth(const MatchScene& scene);

  const std::vector<TrackName>& people() const { return people_; }
  /// The next frame, in the pitch's own frame of reference, its samples in the order of `people`. `cameras`, all of the scene's,
  /// stand at the same frame: those that were started with the first one need not search again.
  Instant next(std::span<const MatchCamera> cameras);

 private:
  const MatchScene& scene_;
  MatchMotion motion_;
  std::vector<GroundView> views_;
  std::vector<TrackName> people_;
  std::int64_t frame_ = 0;
};

/// Where the ball truly is at the first camera's frames, in the pitch's own frame of reference.
class BallTruth {
 public:
  /// The scene must outlive it.
  explicit BallTruth(const MatchScene& scene) : scene_(scene), motion_(scene.seed, scene.options.pitch) {}
  /// At the next frame.
  BallPosition next();

 private:
  const MatchScene& scene_;
  MatchMotion motion_;
  std::int64_t frame_ = 0;
};

}  // namespace marey::simulate::match
