#include "marey/track/ground/offline/ground_identities.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "marey/assign/no_index.h"
#include "marey/track/ground/offline/ground_paths.h"

namespace marey::track::ground::offline {
namespace {

using assign::kNoIndex;

constexpr int kMaxRounds = 2000;         // numerical: the search ends earlier where no move gains
constexpr double kMinAlternative = -12;  // gain of moves that still count against a decision
constexpr double kCaution =
    1.5;  // by which gains are divided before they are taken for logarithms of odds: roles are weaker evidence than they seem
constexpr double kUntrustedSource = 0;  // logarithm of odds that an unnamed path is not that of a named person

double seconds_between(std::int32_t from, std::int32_t until, std::span<const Timestamp> times) {
  return seconds(times[static_cast<std::size_t>(until)] - times[static_cast<std::size_t>(from)]);
}

class IdentitySolver {
 public:
  IdentitySolver(std::span<const GroundTracklet> tracklets, std::span<const Timestamp> times, const SegmentGraph& graph,
                 const GroundPaths& found, const GroundIdentityOptions& options)
      : tracklets_(tracklets), times_(times), graph_(graph), found_(found), options_(options) {}

  GroundIdentities identities() {
    for (const SegmentGraph::Node& node : graph_.nodes) reported_.segments.push_back({node.tracklet, node.first, node.last, 0});
    for (std::size_t path = 0; path < found_.paths().size(); ++path) name(found_.paths()[path]);
    weigh();
    for (std::size_t path = 0; path < reported_.paths.size(); ++path) {
      if (reported_.paths[path].name < 0) add_candidates(static_cast<int>(path));
    }
    return std::move(reported_);
  }

 private:
  /// One path of those found; where it has two names, the second begins where it was given.
  void name(const std::vector<int>& nodes) {
    reported_.paths.emplace_back();
    for (const int node : nodes) {
      const NameSet& names = graph_.nodes[static_cast<std::size_t>(node)].names;
      for (std::size_t name = 0; names.any() && name < names.size(); ++name) {
        if (!names[name] || reported_.paths.back().name == static_cast<int>(name)) continue;
        if (reported_.paths.back().name >= 0) reported_.paths.emplace_back();
        reported_.paths.back().name = static_cast<int>(name);
      }
      reported_.paths.back().segments.push_back(node);
      reported_.segments[static_cast<std::size_t>(node)].path = static_cast<int>(reported_.paths.size()) - 1;
    }
  }

  /// How much all that could have been decided otherwise weighs against each decision.
  void weigh() {
    std::vector<double> against_crossing(graph_.crossings.size(), 0);
    std::map<int, double> against_link;  // by the node before it
    for (const GroundPaths::Move& move : found_.moves(kMinAlternative)) {
      const double weight = std::exp(std::min(move.gain, 30.0) / kCaution);
      for (const int crossing : move.crossings) against_crossing[static_cast<std::size_t>(crossing)] += weight;
      if (!move.crossings.empty()) continue;
      for (const GroundPaths::Move::Arc& arc : move.arcs) against_link[arc.node] += weight;
    }
    const auto fraction = [](double against) { return against / (1 + against); };
    for (std::size_t c = 0; c < graph_.crossings.size(); ++c) {
      const SegmentGraph::Crossing& crossing = graph_.crossings[c];
      reported_.close_encounters.push_back({crossing.instant, crossing.before[0], crossing.before[1],
                                            found_.swapped(static_cast<int>(c)), fraction(against_crossing[c])});
    }
    for (const SegmentGraph::Gap& gap : graph_.gaps) {
      if (found_.next(gap.before) == gap.after)
        reported_.links.push_back({gap.before, gap.after, fraction(against_link[gap.before])});
    }
    std::sort(reported_.links.begin(), reported_.links.end(), [](const auto& a, const auto& b) { return a.before < b.before; });
  }

  RoleSum role_of(const GroundIdentities::Path& path) const {
    RoleSum role;
    for (const int node : path.segments) role += graph_.nodes[static_cast<std::size_t>(node)].role;
    return role;
  }

  /// Whether one person may have made both: never at the same time, and never too fast between.
  bool may_be_one(const GroundIdentities::Path& one, const GroundIdentities::Path& other) const {
    std::vector<int> both = one.segments;
    both.insert(both.end(), other.segments.begin(), other.segments.end());
    std::erase_if(both, [&](int node) { return is_empty(node); });
    std::sort(both.begin(), both.end(), [&](int a, int b) { return segment(a).first < segment(b).first; });
    for (std::size_t i = 1; i < both.size(); ++i) {
      if (segment(both[i]).first <= segment(both[i - 1]).last) return false;
      if (segment(both[i]).path == segment(both[i - 1]).path) continue;
      const auto& before = tracklets_[static_cast<std::size_t>(segment(both[i - 1]).tracklet)].samples;
      const auto& after = tracklets_[static_cast<std::size_t>(segment(both[i]).tracklet)].samples;
      const GroundSample& last = before[index_from(before, segment(both[i - 1]).last + 1) - 1];
      const GroundSample& first = after[index_from(after, segment(both[i]).first)];
      const double far = options_.join.max_speed * seconds_between(last.instant, first.instant, times_);
      if ((first.at() - last.at()).norm() > far + 2) return false;
    }
    return true;
  }

  const GroundIdentities::TimeChunk& segment(int node) const { return reported_.segments[static_cast<std::size_t>(node)]; }
  bool is_empty(int node) const {
    const auto& samples = tracklets_[static_cast<std::size_t>(segment(node).tracklet)].samples;
    const std::size_t first = index_from(samples, segment(node).first);
    return first == samples.size() || samples[first].instant > segment(node).last;
  }

  void add_candidates(int path) {
    const GroundIdentities::Path& unnamed = reported_.paths[static_cast<std::size_t>(path)];
    const RoleSum role = role_of(unnamed);
    std::map<int, double> weights;
    double all = std::exp(kUntrustedSource);
    for (const GroundIdentities::Path& named : reported_.paths) {
      if (named.name < 0 || !may_be_one(named, unnamed)) continue;
      const RoleSum theirs = role_of(named);
      double gain = log_evidence(theirs + role) - log_evidence(theirs) - log_evidence(role);
      if (const auto after = graph_.gain_of_gap.find({named.segments.back(), unnamed.segments.front()});
          after != graph_.gain_of_gap.end())
        gain += after->second;
      if (const auto before = graph_.gain_of_gap.find({unnamed.segments.back(), named.segments.front()});
          before != graph_.gain_of_gap.end())
        gain += before->second;
      const double weight = std::exp(std::min(gain, 30.0));
      weights[named.name] += weight;
      all += weight;
    }
    std::vector<GroundIdentities::Candidate> candidates;
    for (const auto& [name, weight] : weights) candidates.push_back({path, name, weight / all});
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.probability > b.probability; });
    reported_.candidates.insert(reported_.candidates.end(), candidates.begin(), candidates.end());
  }

  std::span<const GroundTracklet> tracklets_;
  std::span<const Timestamp> times_;
  const SegmentGraph& graph_;
  const GroundPaths& found_;
  const GroundIdentityOptions& options_;
  GroundIdentities reported_;
};

}  // namespace

GroundIdentities identify(std::span<const GroundTracklet> tracklets, std::span<const int> teams, std::span<const Timestamp> times,
                          std::span<const IdentityAnnotation> namings, const GroundIdentityOptions& options) {
  const SegmentGraph graph = graph_of_segments(tracklets, teams, times, namings, options);
  GroundPaths paths(graph);
  paths.search(kMaxRounds);
  return IdentitySolver(tracklets, times, graph, paths, options).identities();
}

}  // namespace marey::track::ground::offline
