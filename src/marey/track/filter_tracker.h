// The tracker of the spine: predict, gate, assign, correct; birth and death by evidence.
//
// A pair of target and observation is gated by chi-square distance and by speed, and weighed by the logarithm of its likelihood
// against that of clutter: place, size, overlap. The assignment that maximises the sum over all pairs wins (globally nearest
// neighbour), confident observations first, then what weak ones can still explain (after Zhang et al., "ByteTrack", 2022).
// A target begins with a confident observation that no target claims, is confirmed by further evidence, and is given up when it
// has not been seen for too long: sooner where it should be visible, later where another target hides it.
// Cost a frame: near linear in targets + observations while gates hold few observations (assign/gated_assignment.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/point_grid.h"
#include "marey/core/geometry.h"
#include "marey/geometry/chi_square.h"
#include "marey/track/check_frame.h"
#include "marey/track/common_motion.h"
#include "marey/track/crowd.h"
#include "marey/track/reidentification.h"
#include "marey/track/target.h"
#include "marey/track/tracker.h"

namespace marey::track {

template <typename F>
class FilterTracker final : public Tracker<F::dimension> {
 public:
  static constexpr int D = F::dimension;

  FilterTracker(const TrackerOptions& options, const typename F::Options& filter_options)
      : options_(options),
        filter_options_(filter_options),
        size_options_{.noise = options.size_noise, .drift = options.size_drift},
        gate_(geometry::chi_square_quantile(D, options.gate_probability)) {}

  std::span<const Track<D>> step(Timestamp now, std::span<const Observation<D>> seen) override {
    check_time(now, now_);
    check_finite(now, seen);
    predict_to(now);
    follow_camera(seen);
    if constexpr (D == 2) crowd_.mark_crowded(targets_, camera_);
    claim(seen, [&](const Observation<D>& o) { return o.score >= options_.confident; });
    claim(seen, [&](const Observation<D>& o) { return o.score < options_.confident && o.score >= options_.weak; });
    claim_overlapped(seen);
    if constexpr (D == 2) {
      if (options_.reclaim)
        reclaim_.claim(targets_, seen, now, options_.confident, size_options_, gate_,
                       [&](const Observation<D>& o, const Target<F>& target) { return place_of(o, target); });
    }
    keep_merged(seen);
    correct(now, seen);
    retire_lost(now);
    start_unclaimed(now, seen);
    return report(now);
  }

  std::span<const Track<D>> expected(Timestamp now) override {
    const double dt = now_ ? std::max(0.0, seconds(now - *now_)) : 0.0;
    tracks_.clear();
    for (const Target<F>& target : targets_) {
      if (!target.confirmed) continue;
      Target<F> ahead = target;
      ahead.filter.predict(dt);
      tracks_.push_back(track_of(ahead));
      tracks_.back().state = Track<D>::State::predicted;
      tracks_.back().observation.reset();
    }
    return tracks_;
  }

 private:
  void predict_to(Timestamp now) {
    const double dt = now_ ? seconds(now - *now_) : 0.0;
    dt_ = dt;
    now_ = now;
    for (Target<F>& target : targets_) {
      target.filter.predict(dt);
      if (target.size) target.size->predict(dt, size_options_);
      target.observation = -1;
      target.hidden = false;
    }
  }

  /// Filters run in coordinates that stand still while the camera turns and shakes: pixels less `camera_`.
  void follow_camera(std::span<const Observation<D>> seen) {
    if constexpr (D == 2) {
      if (options_.steady_camera) return;
      expected_.clear();
      sightings_.clear();
      for (const Target<F>& target : targets_) {
        if (target.confirmed && target.size && seconds(*now_ - target.last_seen) < recently)
          expected_.push_back({in_view(target), target.unit});
      }
      for (const Observation<D>& one : seen) {
        if (one.box && one.score >= options_.confident && !one.box->empty())
          sightings_.push_back({one.box->centre(), one.box->height});
      }
      camera_ += common_motion(expected_, sightings_);
    }
  }

  Vector<D> in_view(const Target<F>& target) const { return target.filter.position() + camera_; }

  /// Where the observation puts the target: the centre of its box, if need be corrected for a size that is not believed.
  Vector<D> place_of(const Observation<D>& observation, const Target<F>& target) const {
    if constexpr (D == 2) {
      if (observation.box && !observation.box->empty()) {
        if (!target.size) return observation.box->centre() - camera_;
        return target.size->centre_in(*observation.box, in_view(target), size_options_) - camera_;
      }
    }
    return observation.value - camera_;
  }

  Matrix<D> noise_of(const Observation<D>& observation, const Target<F>& target) const {
    Matrix<D> R = observation.covariance;
    if (!target.size || !observation.box) return R;
    const bool believed = !observation.shared && target.size->believes(*observation.box, size_options_);
    const double sigma = options_.place_noise * target.unit * (believed ? 1 : doubt);
    R.diagonal() = R.diagonal().cwiseMax(Vector<D>::Constant(sigma * sigma));
    return R;
  }

  /// How far from its prediction a target may be: as far as it can have gone since it was last seen.
  double reach(const Target<F>& target) const {
    const double since = seconds(*now_ - target.last_seen);
    return target.unit * (options_.max_speed * since + 4 * options_.place_noise);
  }

  /// What the pair is worth: logarithm of its likelihood against that of clutter; 0 or less where it is out of the question.
  double gain(const Target<F>& target, const Observation<D>& observation) const {
    const Matrix<D> R = noise_of(observation, target);
    const Matrix<D> S = target.filter.innovation_covariance(R);
    const Vector<D> residual = place_of(observation, target) - target.filter.position();
    const double distance = residual.dot(S.inverse() * residual);
    if (!(distance <= gate_) || residual.norm() > reach(target)) return 0;
    const double spread = std::log(S.determinant());
    if (!target.size || !observation.box) {
      // Nothing is known of how dense clutter is: the gate decides, and of two targets the one that is surer of its place wins.
      const double against_noise = std::clamp(spread - std::log(R.determinant()), 0.0, 2 * gate_);
      return (3 * gate_ - distance - against_noise) / 2;
    }
    double cost = distance + spread - 2 * D * std::log(target.unit * reference_sigma);
    double room = clutter_room - 2 * seconds(*now_ - target.last_seen) / fading;
    if (!observation.shared) {
      const double distance_of_size = target.size->distance(*observation.box, size_options_);
      cost += target.crowded ? std::min(distance_of_size, crowded_size_limit) : distance_of_size;
      room += size_room;
    }
    if (!target.confirmed) cost += newcomer_cost;
    return (room - cost) / 2;
  }

  template <typename Chosen>
  void claim(std::span<const Observation<D>> seen, Chosen&& chosen) {
    candidates_.clear();
    points_.clear();
    for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
      if (!chosen(seen[i])) continue;
      candidates_.push_back(i);
      points_.push_back(centre_of(seen[i]));
    }
    free_targets_.clear();
    double widest = 0;
    for (int i = 0; i < static_cast<int>(targets_.size()); ++i) {
      if (targets_[i].observation >= 0) continue;
      free_targets_.push_back(i);
      widest += search_radius(targets_[i]);
    }
    if (candidates_.empty() || free_targets_.empty()) return;
    grid_.build(points_, std::max(1e-9, 2 * widest / static_cast<double>(free_targets_.size())));
    pairs_.clear();
    for (int row = 0; row < static_cast<int>(free_targets_.size()); ++row) {
      const Target<F>& target = targets_[free_targets_[row]];
      grid_.for_each_near(in_view(target), search_radius(target), [&](int column) {
        const double worth = gain(target, seen[candidates_[column]]);
        if (worth > 0) pairs_.push_back({row, column, worth});
      });
    }
    const auto columns = assigner_.assign(static_cast<int>(free_targets_.size()), static_cast<int>(candidates_.size()), pairs_);
    for (int row = 0; row < static_cast<int>(free_targets_.size()); ++row) {
      if (columns[row] != assign::GatedAssigner::nobody) targets_[free_targets_[row]].observation = candidates_[columns[row]];
    }
  }

  /// Who turns sharply leaves the gate, yet not at once the place: a confirmed target that claimed nothing takes what lies on its
  /// box and nobody claimed, before somebody new begins there (after Cao et al., "Observation-centric SORT", 2023).
  void claim_overlapped(std::span<const Observation<D>> seen) {
    if constexpr (D == 2) {
      claimed_.assign(seen.size(), 0);
      for (const Target<F>& target : targets_) {
        if (target.observation >= 0) claimed_[target.observation] = 1;
      }
      candidates_.clear();
      points_.clear();
      for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
        if (claimed_[i] || !seen[i].box || seen[i].box->empty() || seen[i].score < options_.confident) continue;
        candidates_.push_back(i);
        points_.push_back(centre_of(seen[i]));
      }
      if (candidates_.empty() || crowd_.widest() <= 0) return;
      grid_.build(points_, crowd_.widest());
      pairs_.clear();
      for (int row = 0; row < static_cast<int>(targets_.size()); ++row) {
        const Target<F>& target = targets_[row];
        if (!target.confirmed || target.observation >= 0 || !target.size || seconds(*now_ - target.last_seen) > recently) continue;
        const Box box = target.size->around(in_view(target));
        grid_.for_each_near(in_view(target), target.unit, [&](int column) {
          const double overlap = geometry::iou(box, *seen[candidates_[column]].box);
          if (overlap > overlapped) pairs_.push_back({row, column, overlap});
        });
      }
      const auto columns = assigner_.assign(static_cast<int>(targets_.size()), static_cast<int>(candidates_.size()), pairs_);
      for (int row = 0; row < static_cast<int>(targets_.size()); ++row) {
        if (columns[row] != assign::GatedAssigner::nobody) targets_[row].observation = candidates_[columns[row]];
      }
    }
  }

  static Vector<D> centre_of(const Observation<D>& observation) {
    if constexpr (D == 2) {
      if (observation.box) return observation.box->centre();
    }
    return observation.value;
  }

  /// No observation farther than this can pass the gate: a box whose size is not believed may lie off by half a size more.
  double search_radius(const Target<F>& target) const { return reach(target) + (target.size ? target.unit : 0.0); }

  void correct(Timestamp now, std::span<const Observation<D>> seen) {
    for (Target<F>& target : targets_) {
      if (target.observation < 0) {
        continue;
      }
      const Observation<D>& observation = seen[target.observation];
      const bool merged = merged_[target.observation] != 0;
      if (merged) {
        stay_within(target, observation);
      } else {
        target.filter.correct(place_of(observation, target), noise_of(observation, target));
      }
      if (!merged && observation.box && !observation.box->empty() && !observation.shared) {
        if (target.size) {
          target.size->correct(*observation.box, size_options_);
          target.unit = target.size->height();
        }
      }
      if (options_.reclaim && observation.box) {
        const bool sure = !merged && !observation.shared && observation.score >= options_.confident;
        target.cruise.see(now, dt_, target.filter.position(), target.filter.velocity(), observation.box->height, sure);
      }
      target.last_seen = now;
      target.score = observation.score;
      target.evidence = std::min(most_evidence, target.evidence + evidence_of(observation.score));
      if (target.evidence >= options_.confirm) target.confirmed = true;
    }
    if constexpr (D == 2) crowd_.mark_hidden(targets_, seen);
    for (Target<F>& target : targets_) {
      if (target.observation < 0)
        target.evidence -=
            target.hidden ? hidden_evidence : std::min(miss_evidence, (options_.reclaim ? hidden_misses : misses_a_second) * dt_);
    }
  }

  static double evidence_of(double score) { return 0.4 + 0.8 * std::clamp(score, 0.0, 1.0); }

  /// Who has merged with others stays within their region, keeps its size and waits for it to part; nobody new begins there.
  void keep_merged(std::span<const Observation<D>> seen) {
    merged_.assign(seen.size(), 0);
    if constexpr (D == 2) {
      crowd_.find_merged(targets_, seen, merged_,
                         [&](Target<F>& target, const Observation<D>& region) { stay_within(target, region); });
    }
  }

  void stay_within(Target<F>& target, const Observation<D>& region) {
    if constexpr (D == 2) {
      const double sigma = doubt * options_.place_noise * target.unit;
      const Matrix<D> R = region.covariance + sigma * sigma * Matrix<D>::Identity();
      target.filter.correct(target.size->centre_within(*region.box, in_view(target)) - camera_, R);
      target.hidden = true;
    }
  }

  void retire_lost(Timestamp now) {
    std::erase_if(targets_, [&](const Target<F>& target) {
      const double unseen = seconds(now - target.last_seen);
      if (unseen <= 0) return false;
      if (target.evidence < 0) return true;
      if (!target.confirmed) return unseen > tentative_patience;
      const double patience = target.hidden ? options_.hidden_patience : options_.patience;
      return unseen > std::min(patience, seconds(target.last_seen - target.born) + young_patience);
    });
  }

  void start_unclaimed(Timestamp now, std::span<const Observation<D>> seen) {
    claimed_.assign(seen.size(), 0);
    for (const Target<F>& target : targets_) {
      if (target.observation >= 0) claimed_[target.observation] = 1;
    }
    points_.clear();
    double widest = 1e-9;
    for (const Observation<D>& one : seen) {
      points_.push_back(centre_of(one));
      if (one.box) widest = std::max(widest, one.box->height / 2);
    }
    grid_.build(points_, widest);
    for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
      if (claimed_[i] || merged_[i] || seen[i].score < options_.confident || is_duplicate(i, seen)) continue;
      start(now, seen[i], i);
      claimed_[i] = 1;
    }
  }

  /// A detector's second box around what a target has claimed already. `grid_` holds the centres of all that was seen.
  bool is_duplicate(int index, std::span<const Observation<D>> seen) const {
    bool found = false;
    if (!seen[index].box) return found;
    grid_.for_each_near(centre_of(seen[index]), seen[index].box->height / 2, [&](int other) {
      found = found || (claimed_[other] && seen[other].box && iou(*seen[other].box, *seen[index].box) > duplicate_iou);
    });
    return found;
  }

  void start(Timestamp now, const Observation<D>& observation, int index) {
    const bool has_box = observation.box && !observation.box->empty();
    const double unit = has_box ? observation.box->height : 1.0;
    Matrix<D> R = observation.covariance;
    if (has_box) R.diagonal() = R.diagonal().cwiseMax(Vector<D>::Constant(std::pow(options_.place_noise * unit, 2)));
    Target<F> target{.id = TrackId{next_id_++},
                             .filter = F(filter_options_.scaled(unit), centre_of(observation) - camera_, R),
                             .size = {},
                             .unit = unit,
                             .born = now,
                             .last_seen = now,
                             .evidence = evidence_of(observation.score),
                             .confirmed = false,
                             .score = observation.score,
                             .observation = index,
                             .hidden = false};
    if (has_box) target.size.emplace(*observation.box, size_options_);
    target.confirmed = target.evidence >= options_.confirm;
    targets_.push_back(target);
  }

  Track<D> track_of(const Target<F>& target) const {
    Track<D> track;
    track.id = target.id;
    track.position = in_view(target);
    track.velocity = target.filter.velocity();
    track.covariance = target.filter.covariance();
    track.state = target.observation >= 0 ? Track<D>::State::observed : Track<D>::State::predicted;
    if (target.observation >= 0) track.observation = target.observation;
    track.confirmed = target.confirmed;
    if constexpr (D == 2) {
      if (target.size) track.box = target.size->around(track.position);
    }
    track.score = target.score;
    return track;
  }

  std::span<const Track<D>> report(Timestamp /*now*/) {
    tracks_.clear();
    for (const Target<F>& target : targets_) tracks_.push_back(track_of(target));
    return tracks_;
  }

  static constexpr double doubt = 2.5;             // an unbelieved box places its target this much less surely
  static constexpr double reference_sigma = 0.08;  // sizes: innovations of a well followed target
  static constexpr double clutter_room = 6;        // twice the log-likelihood ratio of a perfect fit against clutter
  static constexpr double size_room = 3;           // the same for its size
  static constexpr double recently = 0.35;         // s; a target seen since tells of the camera's motion
  static constexpr double fading = 0.6;            // s unseen after which a target is e times less likely to be there
  static constexpr double crowded_size_limit = 9;  // a box whose size is not believed costs no more than this
  static constexpr double newcomer_cost = 1;       // a confirmed target has the first claim
  static constexpr double miss_evidence = 0.7;
  static constexpr double hidden_misses = 3;    // the same where who vanished is expected back
  static constexpr double misses_a_second = 5;  // of evidence: neighbouring frames miss somebody for the same reason
  static constexpr double hidden_evidence = 0.1;
  static constexpr double most_evidence = 10;
  static constexpr double overlapped = 0.25;         // IoU of a target's box and what must be the target, there being nobody else
  static constexpr double tentative_patience = 0.4;  // s
  static constexpr double young_patience = 0.4;      // s
  static constexpr double duplicate_iou = 0.75;

  TrackerOptions options_;
  typename F::Options filter_options_;
  BoxSizeOptions size_options_;
  double gate_;
  std::optional<Timestamp> now_;
  double dt_ = 0;                         // s since the frame before
  Vector<D> camera_ = Vector<D>::Zero();  // by how far the camera has moved the picture since the beginning
  int next_id_ = 1;
  std::vector<Target<F>> targets_;  // in the order of their ids
  std::vector<Track<D>> tracks_;
  // What a frame needs, kept so that it is allocated once.
  std::vector<int> candidates_, free_targets_;
  std::vector<Vector<D>> points_;
  std::vector<Sighting> expected_, sightings_;
  std::vector<assign::GatedPair> pairs_;
  std::vector<char> claimed_, merged_;
  assign::PointGrid<D> grid_;  // of observations
  Crowd<F> crowd_;
  Reidentification<F> reclaim_;
  assign::GatedAssigner assigner_;
};

}  // namespace marey::track
