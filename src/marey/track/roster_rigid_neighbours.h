#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "marey/track/rigid_neighbours.h"
#include "marey/track/roster_target.h"

namespace marey::track {

/// What the roster tracker asks of the markers that move together: in space, and where the options say so.
template <typename F>
class RosterRigidNeighbours {
 public:
  static constexpr int D = F::dimension;
  using Target = RosterTarget<F>;

  explicit RosterRigidNeighbours(const RosterTrackerOptions& options) : used_(D == 3 && options.companions) {}

  bool used() const { return used_; }
  const RigidNeighbours& all() const { return companions_; }

  /// Who is followed without a break is known to the others of this frame; unless they find, frame after frame, that it is somebody
  /// else: then it is lost, and who it is will be asked anew.
  void tell(std::span<Target> targets, std::span<const Observation<D>> seen, std::vector<char>& claimed) {
    if constexpr (D == 3) {
      companions_.begin_frame();
      for (const Target& target : targets) {
        if (target.member && target.observation != kNone) companions_.see(*target.member, seen[target.observation].value);
      }
      for (Target& target : targets) {
        if (!target.member || target.observation == kNone) continue;
        const auto misfit = companions_.misfit(*target.member, seen[target.observation].value);
        target.doubts = misfit && *misfit > kForeign ? target.doubts + 1 : 0;
        if (target.doubts < kMostDoubts) continue;
        target.doubts = 0;
        claimed[target.observation] = 0;
        target.observation = kNone;
        target.guided = 0;
        companions_.disown(*target.member);
      }
    }
  }

  /// Whether companions have nothing against it that a target that was lost is at a place.
  bool agree(const Target& target, const Vector<D>& place, double dt) const {
    if constexpr (D == 3) {
      if (!used() || target.unseen < 1.5 * dt) return true;
      const auto misfit = target.member ? companions_.misfit(*target.member, place) : std::nullopt;
      if (misfit) return *misfit < kForeign;
      return (place - target.filter.position()).norm() < kAstray * target.width;
    }
    return true;
  }

  /// Those who are established and seen teach how markers move together.
  void learn(std::vector<Target>& targets) {
    if constexpr (D == 3) {
      if (!used()) return;
      for (Target& target : targets) {
        if (target.standing != Standing::established || target.observation == kNone) continue;
        if (!target.member && target.seen > kEnrolled) target.member = companions_.enrol();
        if (target.member) companions_.see(*target.member, target.last_place);
      }
      companions_.end_frame();
      merge_doubles(targets);
      for (Target& target : targets) guide(target);
    }
  }

 private:
  using Standing = typename Target::Standing;
  static constexpr int kNone = Target::kNone;

  /// A target that this frame does not see is where its companions went.
  void guide(Target& target) {
    target.guided = 0;
    if constexpr (D == 3) {
      if (!target.member || target.observation != kNone) return;
      const auto place = companions_.place_of(*target.member);
      if (!place) return;
      // Followed closely: how unsure the place is, `guided` says.
      target.filter.correct(place->position, Matrix<D>::Identity() * (kFollowed * place->variance));
      target.guided = place->variance;
    }
  }

  /// A marker that was given a second name while it was lost gets its first one back.
  void merge_doubles(std::vector<Target>& targets) {
    std::optional<TrackId> doubled;
    for (Target& lost : targets) {
      if (!lost.member || lost.observation != kNone) continue;
      for (Target& other : targets) {
        if (!other.member || other.observation == kNone || other.id < lost.id || !other.label.empty()) continue;
        if (!companions_.same(*lost.member, *other.member)) continue;
        std::swap(lost.filter, other.filter);
        std::swap(lost.observation, other.observation);
        std::swap(lost.last_place, other.last_place);
        std::swap(lost.unseen, other.unseen);
        companions_.see(*lost.member, lost.last_place);
        doubled = other.id;
        break;
      }
    }
    if (doubled) std::erase_if(targets, [&](const Target& target) { return target.id == *doubled; });
  }

  static constexpr double kAstray = 5;       // marker widths that who is lost and not known yet may have gone astray
  static constexpr double kFollowed = 0.04;  // of the variance of what companions say, when it is followed
  static constexpr double kEnrolled = 0.2;   // s after which a target is one of the companions
  static constexpr double kForeign = 9;      // variances of its distances from which companions find a target changed
  static constexpr int kMostDoubts = 8;      // frames that they do

  bool used_;
  RigidNeighbours companions_;
};

}  // namespace marey::track
