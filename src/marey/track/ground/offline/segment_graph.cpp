#include "marey/track/ground/offline/segment_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/assign/successors.h"

namespace marey::track::ground::offline {
namespace {

constexpr double kStep = 0.2;      // s between places that are counted
constexpr double kMaxStep = 1;     // s that one place counts for
constexpr double kMinGain = -12;   // of pairs of an end and a beginning that come into question
constexpr double kMaxTrusted = 3;  // in either direction, of the evidence of place and velocity
constexpr double kTouching = 0.8;  // m: people farther apart than this are less often exchanged,
constexpr double kPassing = -3;    // for each metre more, as a logarithm of odds

class GraphOfSegments {
 public:
  GraphOfSegments(std::span<const GroundTracklet> tracklets, std::span<const int> teams, std::span<const Timestamp> times,
                  const GroundIdentityOptions& options)
      : tracklets_(tracklets), teams_(teams), times_(times), options_(options) {}

  SegmentGraph graph(std::span<const IdentityAnnotation> namings) {
    cut(find_encounters(tracklets_, times_, options_.close_encounter.near), namings);
    find_middles();
    for (SegmentGraph::Node& node : graph_.nodes) node.role = role_of(node);
    for (const IdentityAnnotation& naming : namings)
      node_at(naming.tracklet, naming.instant).names.set(static_cast<std::size_t>(naming.name));
    find_gaps();
    return std::move(graph_);
  }

 private:
  /// Where a tracklet is cut: from this instant on.
  struct Cut {
    std::int32_t from = 0;
    int close_encounter = assign::kNoIndex;  // or two names that nothing lies between
  };

  void cut(const std::vector<CloseEncounter>& close_encounters, std::span<const IdentityAnnotation> namings) {
    std::vector<std::vector<Cut>> cuts(tracklets_.size());
    for (std::size_t m = 0; m < close_encounters.size(); ++m) {
      for (const int tracklet : {close_encounters[m].a, close_encounters[m].b})
        cuts[static_cast<std::size_t>(tracklet)].push_back({close_encounters[m].nearest, static_cast<int>(m)});
      graph_.crossings.push_back({.instant = close_encounters[m].nearest, .log_odds = log_odds_of(close_encounters[m])});
    }
    cut_between_names(cuts, namings);
    for (std::size_t t = 0; t < tracklets_.size(); ++t) add_nodes(static_cast<int>(t), cuts[t], close_encounters);
  }

  /// Where nothing lies between two names of a tracklet, it is cut half-way.
  static void cut_between_names(std::vector<std::vector<Cut>>& cuts, std::span<const IdentityAnnotation> namings) {
    std::vector<IdentityAnnotation> sorted(namings.begin(), namings.end());
    std::sort(sorted.begin(), sorted.end(), [](const IdentityAnnotation& a, const IdentityAnnotation& b) {
      return std::pair(a.tracklet, a.instant) < std::pair(b.tracklet, b.instant);
    });
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      const IdentityAnnotation &one = sorted[i - 1], &other = sorted[i];
      if (one.tracklet != other.tracklet || one.name == other.name) continue;
      std::vector<Cut>& here = cuts[static_cast<std::size_t>(one.tracklet)];
      const auto between = [&](const Cut& c) { return one.instant < c.from && c.from <= other.instant; };
      if (std::any_of(here.begin(), here.end(), between)) continue;
      const Cut half{.from = one.instant + (other.instant - one.instant + 1) / 2};
      here.insert(std::upper_bound(here.begin(), here.end(), half, [](const Cut& a, const Cut& b) { return a.from < b.from; }),
                  half);
    }
  }

  void add_nodes(int tracklet, const std::vector<Cut>& cuts, const std::vector<CloseEncounter>& close_encounters) {
    const std::vector<GroundSample>& samples = tracklets_[static_cast<std::size_t>(tracklet)].samples;
    std::int32_t from = samples.front().instant;
    first_.push_back(static_cast<int>(graph_.nodes.size()));
    for (const Cut& cut : cuts) {
      const int node = static_cast<int>(graph_.nodes.size());
      graph_.nodes.push_back({.tracklet = tracklet, .first = from, .last = std::max(cut.from, from) - 1, .role = {}, .names = {}});
      from = std::max(cut.from, from);
      graph_.successors.push_back(cut.close_encounter == assign::kNoIndex ? assign::kNoIndex : node + 1);
      if (cut.close_encounter == assign::kNoIndex) continue;
      SegmentGraph::Crossing& crossing = graph_.crossings[static_cast<std::size_t>(cut.close_encounter)];
      const std::size_t side = close_encounters[static_cast<std::size_t>(cut.close_encounter)].a == tracklet ? 0 : 1;
      crossing.before[side] = node;
      crossing.after[side] = node + 1;
    }
    graph_.nodes.push_back({.tracklet = tracklet, .first = from, .last = samples.back().instant, .role = {}, .names = {}});
    graph_.successors.push_back(assign::kNoIndex);
    last_.push_back(static_cast<int>(graph_.nodes.size()) - 1);
  }

  double log_odds_of(const CloseEncounter& close_encounter) const {
    const auto gain = gain_of_swap(tracklets_[static_cast<std::size_t>(close_encounter.a)].samples,
                                   tracklets_[static_cast<std::size_t>(close_encounter.b)].samples, close_encounter, times_,
                                   colours_, options_.close_encounter);
    const double reported = gain ? std::clamp(options_.trusted * *gain, -kMaxTrusted, kMaxTrusted) : 0;
    return options_.swapped + reported + kPassing * std::max(0.0, std::sqrt(close_encounter.distance) - kTouching);
  }

  /// The mean place of all that are there, by instant.
  void find_middles() {
    middles_.assign(times_.size(), Vector<2>::Zero());
    std::vector<int> counts(times_.size(), 0);
    for (const GroundTracklet& tracklet : tracklets_) {
      for (const GroundSample& sample : tracklet.samples) {
        middles_[static_cast<std::size_t>(sample.instant)] += sample.at();
        ++counts[static_cast<std::size_t>(sample.instant)];
      }
    }
    for (std::size_t i = 0; i < counts.size(); ++i) middles_[i] /= std::max(1, counts[i]);
  }

  RoleSum role_of(const SegmentGraph::Node& node) const {
    const std::span<const GroundSample> samples = tracklets_[static_cast<std::size_t>(node.tracklet)].samples;
    RoleSum role;
    std::size_t i = index_from(samples, node.first);
    while (i < samples.size() && samples[i].instant <= node.last) {
      const Timestamp now = times_[static_cast<std::size_t>(samples[i].instant)];
      std::size_t next = i + 1;
      while (next < samples.size() && samples[next].instant <= node.last &&
             seconds(times_[static_cast<std::size_t>(samples[next].instant)] - now) < kStep)
        ++next;
      const auto end = std::min(next < samples.size() ? samples[next].instant : node.last, node.last);
      role.add(samples[i].at() - middles_[static_cast<std::size_t>(samples[i].instant)],
               std::min(kMaxStep, seconds(times_[static_cast<std::size_t>(end)] - now)),
               teams_[static_cast<std::size_t>(node.tracklet)]);
      i = next;
    }
    return role;
  }

  SegmentGraph::Node& node_at(int tracklet, std::int32_t instant) {
    const auto begin = graph_.nodes.begin() + first_[static_cast<std::size_t>(tracklet)];
    const auto end = graph_.nodes.begin() + last_[static_cast<std::size_t>(tracklet)] + 1;
    const auto after = std::upper_bound(begin, end, instant,
                                        [](std::int32_t sought, const SegmentGraph::Node& node) { return sought < node.first; });
    return after == begin ? *begin : *std::prev(after);
  }

  void find_gaps() {
    auto [heads, tails] = ends_of(tracklets_, times_, options_.join.motion);
    for (GroundEnd& head : heads) head.coming = options_.coming;
    const auto gain = [&](int tail, int head) {
      return gain_of_joining(tails[static_cast<std::size_t>(tail)], heads[static_cast<std::size_t>(head)], colours_, options_.join);
    };
    for (const assign::GatedPair& pair :
         assign::successor_pairs(tails, heads, duration_from_seconds(options_.join.longest_gap), gain, kMinGain)) {
      const SegmentGraph::Gap gap{last_[static_cast<std::size_t>(pair.row)], first_[static_cast<std::size_t>(pair.column)],
                                  pair.gain};
      graph_.gaps.push_back(gap);
      graph_.gain_of_gap[{gap.before, gap.after}] = gap.gain;
    }
  }

  std::span<const GroundTracklet> tracklets_;
  std::span<const int> teams_;
  std::span<const Timestamp> times_;
  const GroundIdentityOptions& options_;
  GroundColours colours_{{}};
  SegmentGraph graph_;
  std::vector<Vector<2>> middles_;
  std::vector<int> first_, last_;  // of each tracklet its first and last node
};

}  // namespace

SegmentGraph graph_of_segments(std::span<const GroundTracklet> tracklets, std::span<const int> teams,
                               std::span<const Timestamp> times, std::span<const IdentityAnnotation> namings,
                               const GroundIdentityOptions& options) {
  return GraphOfSegments(tracklets, teams, times, options).graph(namings);
}

}  // namespace marey::track::ground::offline
