#include "marey/pipeline/markers/set_in_space.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/assign/no_index.h"
#include "marey/core/error.h"
#include "marey/pipeline/corridor/stopwatch.h"

namespace marey::pipeline::markers {
namespace {

using assign::kNoIndex;

constexpr double kMinLabelled = 0.6;  // of the set, on average, below which it is doubtful
constexpr std::size_t kMinMarkers = 4;

class NamedReader final : public RecordingReader {
 public:
  NamedReader(std::unique_ptr<RecordingReader> recording, std::shared_ptr<const LearnedMarkers> set, SetInSpaceOptions options)
      : recording_(std::move(recording)), named_(std::move(set), recording_->header().rate_hz, options) {
    for (const TrackName& track : recording_->tracks()) named_.name(track);
  }

  const RecordingHeader& header() const override { return recording_->header(); }
  std::vector<TrackName> tracks() const override { return {}; }  // they are other tracks
  std::optional<std::int64_t> instant_count() const override { return recording_->instant_count(); }
  std::optional<Instant> next() override {
    auto instant = recording_->next();
    if (instant) named_.add_to(*instant);
    return instant;
  }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = recording_->warnings();
    for (std::string& warning : named_.warnings()) all.push_back(std::move(warning));
    return all;
  }

 private:
  std::unique_ptr<RecordingReader> recording_;
  LiveLabelling named_;
};

}  // namespace

LiveLabelling::LiveLabelling(std::shared_ptr<const LearnedMarkers> set, double rate_hz, const SetInSpaceOptions& options)
    : set_(std::move(set)),
      names_hold_(options.names_hold),
      search_(set_, rate_hz, options),
      check_(set_->size()),
      ids_(set_->size()),
      counts_{.observed = std::vector<std::int64_t>(set_->size(), 0), .found_at_s = {}} {
  if (set_->size() < kMinMarkers) throw Error("the set has {} markers; names are distinguished from four on", set_->size());
  for (std::size_t name = 0; name < set_->size(); ++name) name_of_label_[set_->labels[name]] = static_cast<int>(name);
}

void LiveLabelling::add_to(Instant& instant) {
  const corridor::Stopwatch taken;
  note_points(instant);
  search_.remember(instant.index, instant.time, points_now_);
  take_answer(instant.time);
  label_points(instant.time);
  relabel(instant);
  search_.begin_if_due(instant.time, points_now_.size(),
                       target_tracker_ == nullptr ? std::nullopt : std::optional(target_tracker_->held()));
  times_.add(taken.seconds());
}

void LiveLabelling::note_points(const Instant& instant) {
  for (const TrackName& track : instant.named) name(track);
  points_now_.clear();
  for (const Sample& sample : instant.samples) {
    if (sample.provenance == Provenance::predicted || sample.provenance == Provenance::solved || sample.position.isZero(0))
      continue;
    points_now_.push_back({sample.track, sample.position, fixed_name(sample.track)});
  }
  counts_.max_points = std::max(counts_.max_points, points_now_.size());
}

int LiveLabelling::fixed_name(TrackId track) const {
  if (!names_hold_) return kNoIndex;
  const auto named = names_before_.find(track);
  if (named == names_before_.end()) return kNoIndex;
  const auto found = name_of_label_.find(named->second.label);
  return found == name_of_label_.end() ? kNoIndex : found->second;
}

void LiveLabelling::take_answer(Timestamp now) {
  auto found = search_.answer(now);
  if (!found) return;
  if (!counts_.found_at_s) counts_.found_at_s = seconds(now);
  // With a set of a person who stood still, rigid distances are known the better the longer they were observed.
  if (target_tracker_ == nullptr || !set_->moves ||
      static_cast<double>(target_tracker_->held()) < SetSearch::kMinObserved * static_cast<double>(set_->size())) {
    if (target_tracker_ != nullptr) found->tracker->take(target_tracker_->borne());
    target_tracker_ = std::move(found->tracker);
  }
  target_tracker_->take(found->name_of);
  check_.add(*found);
}

void LiveLabelling::label_points(Timestamp now) {
  given_.clear();
  if (target_tracker_ == nullptr) return;
  const auto names = target_tracker_->step(now, points_now_);
  for (std::size_t p = 0; p < names.size(); ++p) {
    if (names[p] == kNoIndex) continue;
    const auto name = static_cast<std::size_t>(names[p]);
    if (points_now_[p].fixed == kNoIndex && check_.is_ambiguous(name)) continue;
    given_[points_now_[p].track] = names[p];
    ++counts_.observed[name];
    ++counts_.named;
  }
  counts_.points += std::ssize(points_now_);
}

/// Under which ID and label a track is reported.
TrackName LiveLabelling::reported_name(TrackId track) {
  const auto given = given_.find(track);
  const int name = given == given_.end() ? kNoIndex : given->second;
  TrackName reported{ids_.id_of(track, name), {}, {}};
  if (const auto before = names_before_.find(track); before != names_before_.end()) {
    reported.team = before->second.team;
    reported.colour = before->second.colour;
    if (names_hold_ || !name_of_label_.contains(before->second.label)) reported.label = before->second.label;
  }
  if (name != kNoIndex) reported.label = set_->labels[static_cast<std::size_t>(name)];
  return reported;
}

void LiveLabelling::relabel(Instant& instant) {
  instant.named.clear();
  std::map<TrackId, TrackId> id_of;
  const auto is_idle = [&](const Sample& sample) {  // the label that it had is another track's
    if (sample.provenance != Provenance::predicted || given_.contains(sample.track)) return false;
    return target_tracker_ != nullptr && !ids_.is_unlabelled(sample.track);
  };
  std::erase_if(instant.samples, is_idle);
  for (Sample& sample : instant.samples) {
    TrackName reported = reported_name(sample.track);
    id_of[sample.track] = reported.id;
    sample.track = reported.id;
    if (ids_.report(reported)) instant.named.push_back(std::move(reported));
  }
  std::sort(instant.samples.begin(), instant.samples.end(), [](const Sample& a, const Sample& b) { return a.track < b.track; });
  for (ImageObservation& detected : instant.detected) {
    if (detected.track) detected.track = id_of.contains(*detected.track) ? std::optional(id_of.at(*detected.track)) : std::nullopt;
  }
  for (BoxInView& box : instant.boxes) {
    if (const auto found = id_of.find(box.track); found != id_of.end()) box.track = found->second;
  }
}

/// How many of the set's markers were observed.
std::size_t LiveLabelling::found() const {
  const auto& observed = counts_.observed;
  return static_cast<std::size_t>(std::count_if(observed.begin(), observed.end(), [](std::int64_t points) { return points > 0; }));
}

std::vector<std::string> LiveLabelling::news() {
  auto message_text = check_.new_misfit(found(), set_->size());
  if (!message_text) return {};
  return {std::move(*message_text)};
}

std::vector<std::string> LiveLabelling::warnings() const {
  const double size = static_cast<double>(set_->size());
  if (!counts_.found_at_s) {
    if (static_cast<double>(counts_.max_points) < SetSearch::min_points(*set_))
      return {fmt::format("nothing was named: never more than {} markers were seen at once, of the set's {}", counts_.max_points,
                          set_->size())};
    const std::string& failure = search_.failure();
    return {"nothing was named: " + (failure.empty() ? std::string("the recording ended before names were found") : failure)};
  }
  std::vector<std::string> stated, missing;
  for (std::size_t name = 0; name < set_->size(); ++name) {
    if (counts_.observed[name] == 0) missing.push_back(set_->labels[name]);
  }
  if (!missing.empty()) stated.push_back(fmt::format("the set's markers {} were not found", fmt::join(missing, ", ")));
  if (auto message_text = check_.misfit(found(), set_->size())) {
    stated.push_back(std::move(*message_text));
    return stated;
  }
  const double frames = static_cast<double>(*std::max_element(counts_.observed.begin(), counts_.observed.end()));
  if (static_cast<double>(counts_.named) < kMinLabelled * size * frames)
    stated.push_back(fmt::format("of the set's {} markers only {:.0f} had names at a time; is it this subject's?", set_->size(),
                                 static_cast<double>(counts_.named) / std::max(frames, 1.0)));
  return stated;
}

std::unique_ptr<RecordingReader> with_set(std::unique_ptr<RecordingReader> recording, std::shared_ptr<const LearnedMarkers> set,
                                          SetInSpaceOptions options) {
  if (recording->header().frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: holds no points in space; a set's names are for markers in space", recording->header().name);
  return std::make_unique<NamedReader>(std::move(recording), std::move(set), options);
}

}  // namespace marey::pipeline::markers
