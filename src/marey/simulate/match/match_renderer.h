#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/geometry/camera.h"
#include "marey/geometry/pitch.h"
#include "marey/simulate/camera_shake.h"
#include "marey/simulate/match/match_view.h"
#include "marey/simulate/people/image_degradation.h"

namespace marey::simulate::match {

struct MatchVideoOptions {
  bool shadows = true;                        ///< that people and goal posts cast
  double shadow_level = 0.7;                  ///< what a shadow leaves of the ground's brightness: the sun behind thin clouds
  double noise = 1.2;                         ///< standard deviation of luma, grey levels
  double light_change = 0.08;                 ///< the light swings by this share of itself, over half a minute and more
  double contact = 0;                         ///< share of the light that shoes keep from the ground right under them
  bool ball = false;                          ///< there is one
  double exposure_s = 1.0 / 150;              ///< s, for which the shutter is open: what moves faster is smeared; only the ball is
  double shake_px = 0;                        ///< cameras shake: what pan and tilt each move the image by, root mean square
  people::ImageDegradation degradation = {};  ///< what lens, sharpening and codec make of the image
};

/// A match as one camera videos it; `view` holds the whole camera. Its empty scene is drawn once.
class MatchRenderer {
 public:
  MatchRenderer(const GroundView& view, const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch,
                const MatchVideoOptions& options, std::uint64_t seed);

  /// The frame `index` at `time`, s since the kick-off. Safe to call from several threads.
  Image render(std::span<const people::Figure, kMatchPeople> figures, std::span<const people::Stance, kMatchPeople> stances,
               double time, std::int64_t index) const;
  /// The same with the ball, in the world's frame, and what of it is seen.
  people::RenderedFrame render_with(std::span<const people::Figure, kMatchPeople> figures,
                                    std::span<const people::Stance, kMatchPeople> stances, std::span<const people::PosedBall> balls,
                                    double time, std::int64_t index) const;

 private:
  MatchVideoOptions options_;
  std::uint64_t seed_;
  Camera camera_;
  std::optional<CameraShake> shake_;
  people::PeopleRenderer renderer_;
};

/// A user's click on a crossing of lines or another place that is easily recognised.
struct MatchClick {
  Vector<2> ground;  ///< m, on the pitch
  Vector<2> pixel;
};

/// What a user would click in a camera's image: every such place that it sees, `noise` px off in each axis. Of these `wrong`
/// lie elsewhere or have another place's name.
std::vector<MatchClick> match_clicks(const GroundView& view, const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch,
                                     double noise, int wrong, std::uint64_t seed);

}  // namespace marey::simulate::match
