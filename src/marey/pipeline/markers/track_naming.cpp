#include "marey/pipeline/markers/track_naming.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"

namespace marey::pipeline::markers {
namespace {

class NamedStage final : public corridor::Stage {
 public:
  NamedStage(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<TrackNaming> naming)
      : stage_(std::move(stage)), naming_(std::move(naming)) {}

  RecordingHeader header() const override { return stage_->header(); }
  void need_boxes() override { stage_->need_boxes(); }
  std::span<const Instant> step(const FrameSet& frames) override { return naming_->enter(stage_->step(frames)); }
  std::vector<std::string> news() override { return stage_->news(); }
  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override { return stage_->finish(hooks); }
  void report(corridor::Summary& summary) const override { stage_->report(summary); }

 private:
  std::unique_ptr<corridor::Stage> stage_;
  std::shared_ptr<TrackNaming> naming_;
};

}  // namespace

std::unique_ptr<corridor::Stage> with_naming(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<TrackNaming> naming) {
  if (naming == nullptr) return stage;
  return std::make_unique<NamedStage>(std::move(stage), std::move(naming));
}

const std::string& TrackNaming::label_of(TrackId track) const {
  const auto given = given_.find(track);
  return given != given_.end() ? given->second.label : own_.at(track).label;
}

void TrackNaming::name(TrackId track, const std::string& label) {
  const std::lock_guard lock(mutex_);
  if (!own_.contains(track)) throw Error("there is no track {} to be named", number(track));
  for (const TrackId other : present_) {
    if (other != track && !label.empty() && label_of(other) == label)
      throw Error("track {} is called {} and is seen now; give that another name first", number(other), label);
  }
  if (label.empty()) {
    given_.erase(track);
  } else {
    given_[track] = {label, ++rotations_};
  }
  fresh_.insert(track);
}

/// It has its own name again; none, where that is the one that it must not have.
void TrackNaming::take_name(TrackId track) {
  const std::string label = label_of(track);
  if (own_.at(track).label == label) {
    given_[track] = {};
  } else {
    given_.erase(track);
  }
  fresh_.insert(track);
}

void TrackNaming::resolve_duplicates(const Instant& instant) {
  if (given_.empty()) return;
  const auto order_of = [&](TrackId track) { return given_.contains(track) ? given_.at(track).order : 0; };
  std::map<std::string, TrackId> bearers;
  for (const Sample& sample : instant.samples) {
    const std::string label = label_of(sample.track);
    if (label.empty()) continue;
    const auto [bearer, first] = bearers.try_emplace(label, sample.track);
    if (first || bearer->second == sample.track || order_of(bearer->second) == order_of(sample.track)) continue;
    TrackId loser = sample.track;
    if (order_of(bearer->second) < order_of(loser)) std::swap(bearer->second, loser);
    take_name(loser);
  }
}

std::span<const Instant> TrackNaming::enter(std::span<const Instant> instants) {
  const std::lock_guard lock(mutex_);
  bool reported = !fresh_.empty();
  for (const Instant& instant : instants) {
    for (const TrackName& name : instant.named) {
      own_[name.id] = name;
      reported = reported || given_.contains(name.id);
    }
    for (const Sample& sample : instant.samples) own_.try_emplace(sample.track, TrackName{sample.track, {}, {}});
  }
  if (instants.empty()) return instants;
  present_.clear();
  for (const Sample& sample : instants.back().samples) present_.insert(sample.track);
  for (const Instant& instant : instants) resolve_duplicates(instant);
  if (!reported && fresh_.empty()) return instants;
  changed_.assign(instants.begin(), instants.end());
  for (const TrackId track : fresh_) changed_.front().named.push_back(own_.at(track));
  fresh_.clear();
  for (Instant& instant : changed_) {
    for (TrackName& name : instant.named) name.label = label_of(name.id);
  }
  return changed_;
}

}  // namespace marey::pipeline::markers
