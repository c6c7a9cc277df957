// Left and right corrected over time. A network that sees one image at a time takes a left leg for a right one now and then: from
// the side, from behind, where legs cross. Limbs do not jump, so the labels follow from the path that costs least (Viterbi) over
// four states: legs as the network has them or mirrored, arms likewise.
//
// A state costs a prior for each mirrored group (the network is right more often than not), and something where hips and shoulders
// then face opposite directions. A step between states costs how far the points of a group moved against the trunk, over what their
// covariances and a person's speed allow, capped. Where limbs meet in the image a step costs nothing, so an error before it lasts
// no longer than the prior lets it. Cost: 16 steps an image and person.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "marey/core/keypoints.h"

namespace marey::detect::keypoints {

struct SwapOptions {
  double prior = 1.5;     ///< nats that a mirrored group costs in each image
  double facing = 1.5;    ///< nats if hips and shoulders face opposite directions
  double speed = 0.6;     ///< of a limb's point against the trunk, standard deviation, body heights a second
  double maximum = 4;     ///< nats that one point's step costs at most
  double together = 2.5;  ///< independent points that a group is worth: they move together
};

/// The points of one person in one camera's images.
class LimbSwaps {
 public:
  explicit LimbSwaps(const KeypointSet& set, const SwapOptions& options = {});

  /// The next image's, `step_s` after the last one's; complete as a landmark network gives them.
  void add(const Keypoints<2>& body, double step_s);
  /// How many were added and not taken.
  std::size_t size() const { return waiting_.size(); }
  /// The oldest of them with its limbs named as all that were added say: the more came after it, the surer.
  Keypoints<2> take();

 private:
  static constexpr int kStates = 4;  // bit 0: legs are mirrored; bit 1: arms
  struct Waiting {
    Keypoints<2> body;
    std::array<double, kStates> cost{};
    std::array<int, kStates> from{};
  };

  double here(const Keypoints<2>& body, int state) const;
  std::array<double, 2> step(const Keypoints<2>& before, const Keypoints<2>& now, std::size_t group, double step_s) const;
  Keypoints<2> named(const Keypoints<2>& body, int state) const;

  SwapOptions options_;
  std::vector<int> mirrored_;
  std::array<std::vector<std::size_t>, 2> groups_;            // legs, arms
  std::array<std::pair<std::size_t, std::size_t>, 2> roots_;  // left and right hip, shoulder
  std::deque<Waiting> waiting_;
  std::optional<Waiting> last_;  // the last one that was taken
};

}  // namespace marey::detect::keypoints
