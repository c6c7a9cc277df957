// Which of all that looks like a ball is the ball, from frame to frame: hypotheses over how it moved (rolled, flew, was held, was
// not to be found) and what each camera saw of it, the best of which are kept (a beam), and the best one is reported some seconds
// late.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "marey/core/ground_views.h"
#include "marey/track/ball/ball_motion.h"
#include "marey/track/ball/ball_observations.h"

namespace marey::track::ball {

/// First guesses, as those of BallMotionOptions: no sweep was made yet.
struct BallSearchOptions {
  BallMotionOptions motion;
  int beam = 60;               ///< hypotheses that are kept from an instant to the next
  double decide_after = 3;     ///< s after which the best hypothesis decides
  double gate = 3.5;           ///< standard deviations within which something seen may be the ball
  int branches = 4;            ///< of things within the gate, how many are tried
  double found = 0.95;         ///< share of frames in which a ball in plain view is found
  double found_held = 0.5;     ///< the same of one at a person's feet
  double found_hidden = 0.15;  ///< the same where a person's limbs are, and a detection there decides little
  double reach = 1.6;          ///< m from a person within which that person may play the ball
  double p_kick = 0.02;        ///< of frames near a person: the ball is kicked
  double p_kick_alone = 1e-4;  ///< of frames with no person near: a post, a bump
  double p_take = 0.03;        ///< of frames near a person: the ball is taken
  double p_lose = 5e-4;        ///< of frames: nothing more is known
  double p_initiated = 0.02;   ///< of frames without a ball: it is found again
  double min_radius = 0.9;     ///< px; a smaller ball looks like any part of people far away: it is followed, and no evidence
  GroundRegion possible = {};  ///< where the ball may be: no hypothesis begins or continues elsewhere
  double false_observed = 8;   ///< things that are not ball in a frame, on average; fewer than are seen count as that many
};

/// What was decided of an instant.
struct BallStep {
  BallMode mode = BallMode::lost;
  BallEvent event = BallEvent::none;
  std::optional<TrackId> holder;  ///< who has it, where it is held
  std::vector<int> used;          ///< of each view, the index of what was the ball; −1 where it was not seen
  bool initiated = false;         ///< nothing was known of it before
  double evidence = 0;            ///< clear observations, away from people, add to the hypothesis' score
  BallBelief belief;              ///< after this instant, by what came until then
};

/// One hypothesis at one instant.
struct BallNode {
  BallStep step;
  double score = 0;  ///< logarithm of how much likelier all is than without any ball
  std::shared_ptr<BallNode> parent;
  int age = 0;  ///< instants since it was born
};

/// All that may result from a hypothesis at the next instant, `seconds` later: what follows by each mode and event, with each of
/// the things seen that may be the ball or none. Exhaustive but for `branches`.
std::vector<BallNode> successors(const std::shared_ptr<BallNode>& before, const BallObservations& time_step, double seconds,
                                 const GroundViews& views, const BallSearchOptions& options);

class BallSearch {
 public:
  /// Every view has a whole camera.
  BallSearch(std::shared_ptr<const GroundViews> views, const BallSearchOptions& options);

  /// Instants in the order of their time.
  void add(const BallObservations& time_step);
  /// What each instant was, one after the other; all of them after finish().
  std::vector<BallStep> take_decided();
  void finish();
  double best_score() const { return leaves_.front()->score; }

 private:
  using Leaves = std::vector<std::shared_ptr<BallNode>>;
  void keep_best(std::vector<BallNode> all);
  void decide(std::size_t time_steps);

  std::shared_ptr<const GroundViews> views_;
  BallSearchOptions options_;
  Leaves leaves_;               // the best first
  std::deque<Timestamp> open_;  // instants that are not decided
  std::optional<Timestamp> last_;
  std::vector<BallStep> decided_;
};

}  // namespace marey::track::ball
