#include "marey/solve/labels/labelled_result.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "marey/geometry/median.h"

namespace marey::solve::labels {
namespace {

using assign::kNoIndex;

constexpr double kOutlier = 4;               // deviations
constexpr double kMinOutlier = 0.012;        // m
constexpr std::size_t kOutlierPartners = 5;  // that are asked
constexpr std::size_t kMinPartners = 3;

class Result {
 public:
  Result(const Recording& recording, const LearnedMarkers& learned, const NamedChains& chains, const DistanceModel& model)
      : recording_(recording), learned_(learned), chains_(chains), model_(model), of_name_(learned.size()) {
    for (std::size_t name = 0; name < learned.size(); ++name) index_[learned.labels[name]] = static_cast<int>(name);
    for (int t = 0; t < std::ssize(chains.tracklets()); ++t) {
      const int name = chains.chains()[static_cast<std::size_t>(chains.chain_of(t))].name;
      if (name == kNoIndex) {
        nameless_[tracklet(t).track].push_back(t);
      } else {
        of_name_[static_cast<std::size_t>(name)].push_back(t);
      }
    }
    labelled_.recording = Recording(recording.header);
    labelled_.recording.edits = recording.edits;
    labelled_.recording.head = recording.head;
    for (const Recording::TimeStep& time_step : recording.instants()) labelled_.recording.add_time_step(time_step);
  }

  Labelled made(const std::map<int, NameCandidates>& candidates) && {
    for (std::size_t name = 0; name < learned_.size(); ++name) add_named(name);
    for (const auto& [track, tracklets] : nameless_) add_nameless(tracklets, candidates);
    return std::move(labelled_);
  }

 private:
  const Tracklet& tracklet(int index) const { return chains_.tracklets()[static_cast<std::size_t>(index)]; }

  /// The name of the set that a track had before; a prefix "Subject:" is skipped.
  int name_before(TrackId track) const {
    std::string label = recording_.find(track)->name.label;
    if (!index_.contains(label) && label.find(':') != std::string::npos) label = label.substr(label.find(':') + 1);
    const auto found = index_.find(label);
    return found == index_.end() ? kNoIndex : found->second;
  }

  void add_named(std::size_t name) {
    MarkerHealth health;
    health.label = learned_.labels[name];
    for (const int t : of_name_[name]) {
      const Tracklet& its = tracklet(t);
      health.detected += its.length();
      const int before = name_before(its.track);
      if (before == kNoIndex || before == static_cast<int>(name)) continue;
      health.renamed += its.length();
      ++labelled_.renamed;
    }
    const TrackColumns track = joined({.id = next_id(), .label = learned_.labels[name], .team = {}}, of_name_[name]);
    for (std::size_t row = 1; row < track.size(); ++row) health.gaps += track.at()[row] != track.at()[row - 1] + 1;
    for (const std::int32_t at : track.at()) health.outliers += is_outlier(name, static_cast<std::size_t>(at));
    labelled_.health.push_back(std::move(health));
    labelled_.recording.put(track);
  }

  /// Whether most of its steadiest neighbours are at a wrong distance.
  bool is_outlier(std::size_t name, std::size_t instant) const {
    std::vector<double> off;
    for (const std::size_t other : model_.partners(name)) {
      if (chains_.holder(instant, other).chain == kNoIndex) continue;
      const double distance = (chains_.holder(instant, name).location - chains_.holder(instant, other).location).norm();
      off.push_back(std::abs(distance - model_.mean(name, other)) /
                    std::max(model_.deviation(name, other), kMinOutlier / kOutlier));
      if (off.size() == kOutlierPartners) break;
    }
    if (off.size() < kMinPartners) return false;
    return geometry::median(off) > kOutlier;
  }

  /// One track's pieces that stay without a name.
  void add_nameless(const std::vector<int>& tracklets, const std::map<int, NameCandidates>& candidates) {
    const TrackId id = next_id();
    const auto word = [&](int name) { return name == kNoIndex ? std::string() : learned_.labels[static_cast<std::size_t>(name)]; };
    for (const int t : tracklets) {
      const auto found = candidates.find(chains_.chain_of(t));
      const NameCandidates named = found == candidates.end() ? NameCandidates{} : found->second;
      labelled_.unnamed.push_back(
          {id, tracklet(t).first, tracklet(t).last, word(named.best), word(named.next), named.fit, named.margin});
    }
    labelled_.recording.put(joined({.id = id, .label = {}, .team = {}}, tracklets));
  }

  TrackColumns joined(TrackName name, std::vector<int> tracklets) const {
    std::sort(tracklets.begin(), tracklets.end(), [&](int a, int b) { return tracklet(a).first < tracklet(b).first; });
    TrackColumns track(std::move(name), recording_.dimensions());
    for (const int t : tracklets) {
      const TrackColumns& from = *recording_.find(tracklet(t).track);
      for (std::size_t row = tracklet(t).first_row; row <= tracklet(t).last_row; ++row) {
        Sample sample = from.sample(row);
        sample.track = track.id();
        track.add(from.at()[row], sample);
      }
    }
    return track;
  }

  TrackId next_id() { return TrackId{++last_id_}; }

  const Recording& recording_;
  const LearnedMarkers& learned_;
  const NamedChains& chains_;
  const DistanceModel& model_;
  std::map<std::string, int> index_;              // of each label
  std::vector<std::vector<int>> of_name_;         // tracklets
  std::map<TrackId, std::vector<int>> nameless_;  // tracklets, by the track that they were
  Labelled labelled_;
  int last_id_ = 0;
};

}  // namespace

Labelled labelled_result(const Recording& recording, const LearnedMarkers& learned, const NamedChains& chains,
                         const DistanceModel& model, const std::map<int, NameCandidates>& candidates, double scale) {
  Labelled labelled = Result(recording, learned, chains, model).made(candidates);
  labelled.scale = scale;
  return labelled;
}

}  // namespace marey::solve::labels
