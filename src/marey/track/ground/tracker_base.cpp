#include "marey/track/ground/tracker_base.h"

#include <algorithm>
#include <cmath>

#include "marey/track/check_frame.h"

namespace marey::track::ground {

GroundTrackerBase::GroundTrackerBase(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views)
    : rules_(options, views->cameras()), visibility_(std::move(views)) {}

std::span<const Track<2>> GroundTrackerBase::step(Timestamp now, std::span<const CameraObservations> views) {
  check_time(now, now_);
  for (const CameraObservations& view : views) visibility_.check(view);
  predict_to(now);
  matches_.clear();
  for (const int i : surest_first(views)) take_in(i, views[i]);
  merge_duplicates();
  std::erase_if(targets_, [&](const GroundTarget& target) { return rules_.lost(target, *now_); });
  return report();
}

std::span<const Track<2>> GroundTrackerBase::expected(Timestamp now) {
  const double dt = std::max(0.0, seconds_to(now));
  tracks_.clear();
  for (const GroundTarget& target : targets_) {
    if (!target.confirmed()) continue;
    GroundTarget ahead = target;
    rules_.predict(ahead, dt);
    tracks_.push_back(rules_.report(ahead));
  }
  return tracks_;
}

double GroundTrackerBase::gain_of(std::span<const GroundTarget> targets, const GroundPair& pair) const {
  const double visible = targets[pair.target].presence.visible();
  return pair.log_ratio + std::log(visible) - std::log1p(-visible * rules_.options().detected);
}

void GroundTrackerBase::predict_to(Timestamp now) {
  const double dt = seconds_to(now);
  now_ = now;
  for (GroundTarget& target : targets_) rules_.predict(target, dt);
}

void GroundTrackerBase::take_in(int index, const CameraObservations& view) {
  const double late = seconds(view.time - *now_);
  visibility_.set_view(view, rules_.options().evidence.confident);
  target_of_.assign(view.detected.size(), std::nullopt);
  explained_.assign(view.detected.size(), 0);
  find_pairs(view.detected, late);
  associate(targets_, view.detected, late, pairs_);
  note_missed();
  for (int i = 0; i < std::ssize(view.detected); ++i) {
    if (target_of_[i]) matches_.push_back({targets_[*target_of_[i]].id, index, i});
  }
  start_unmatched(index, view);
}

void GroundTrackerBase::find_pairs(std::span<const Observation<2>> detected, double late) {
  pairs_.clear();
  points_.clear();
  double widest = 0;
  for (const Observation<2>& one : detected) {
    points_.push_back(one.value);
    widest = std::max(widest, one.covariance->trace());
  }
  grid_.build(points_, 1 + 2 * std::sqrt(widest));
  for (int i = 0; i < std::ssize(targets_); ++i) {
    const GroundTarget& target = targets_[i];
    const double radius = rules_.search_radius(target, widest) + std::abs(late) * rules_.options().max_speed;
    const std::size_t first = pairs_.size();
    grid_.for_each_near(target.filter.position(), radius, [&](int o) {
      if (detected[o].score < rules_.options().evidence.min_score) return;
      const auto ratio = rules_.log_ratio(target, detected[o], rules_.at_instant(target, detected[o], late), *now_);
      if (ratio) pairs_.push_back({i, o, *ratio});
    });
    std::sort(pairs_.begin() + static_cast<std::ptrdiff_t>(first), pairs_.end(),
              [](const auto& a, const auto& b) { return a.observation < b.observation; });
  }
}

void GroundTrackerBase::note_missed() {
  observed_now_.assign(targets_.size(), 0);
  for (const std::optional<int>& target : target_of_) {
    if (target) observed_now_[*target] = 1;
  }
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (!observed_now_[i]) rules_.miss(targets_[i], visibility_.visible(targets_[i].filter.position()));
  }
}

void GroundTrackerBase::start_unmatched(int index, const CameraObservations& view) {
  for (int i = 0; i < std::ssize(view.detected); ++i) {
    const Observation<2>& one = view.detected[i];
    if (target_of_[i] || explained_[i] || one.score < rules_.options().evidence.confident || is_duplicate(i, view.detected))
      continue;
    target_of_[i] = static_cast<int>(targets_.size());
    targets_.push_back(rules_.start(TrackId{next_id_++}, *now_, one));
    matches_.push_back({targets_.back().id, index, i});
  }
}

/// A detector's second box around what a target is matched with already.
bool GroundTrackerBase::is_duplicate(int index, std::span<const Observation<2>> detected) const {
  if (!detected[index].box) return false;
  for (std::size_t i = 0; i < detected.size(); ++i) {
    if (target_of_[i] && detected[i].box &&
        geometry::iou(*detected[i].box, *detected[index].box) > rules_.options().evidence.duplicate_iou)
      return true;
  }
  return false;
}

void GroundTrackerBase::merge_duplicates() {
  members_.clear();
  for (const GroundTarget& target : targets_)
    members_.push_back({target.id, target.filter.position(), target.filter.covariance(), target.cameras});
  const auto& merges = duplicates_.find(*now_, members_, rules_.options().disagreement);
  for (const auto& [kept, gone] : merges) {
    const auto target = at(gone);
    const auto into = at(kept);
    rules_.absorb(*into, *target);
    for (ObservationMatch& one : matches_) {
      if (one.track == gone) one.track = kept;
    }
    targets_.erase(target);
  }
}

std::vector<GroundTarget>::iterator GroundTrackerBase::at(TrackId id) {
  return std::lower_bound(targets_.begin(), targets_.end(), id,
                          [](const GroundTarget& t, TrackId required) { return t.id < required; });
}

std::span<const Track<2>> GroundTrackerBase::report() {
  tracks_.clear();
  for (const GroundTarget& target : targets_) tracks_.push_back(rules_.report(target));
  return tracks_;
}

}  // namespace marey::track::ground
