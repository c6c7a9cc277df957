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

constexpr int kMostRounds = 2000;
constexpr double kLeastAlternative = -12;  // gain of moves that still count against a decision
constexpr double kCaution =
    1.5;  // by which gains are divided before they are taken for logarithms of odds: roles tell less than they seem to
constexpr double kStranger = 0;  // logarithm of odds that an unnamed path is nobody's who was named

double seconds_between(std::int32_t from, std::int32_t until, std::span<const Timestamp> times) {
  return seconds(times[static_cast<std::size_t>(until)] - times[static_cast<std::size_t>(from)]);
}

class Teller {
 public:
  Teller(std::span<const GroundTracklet> tracklets, std::span<const Timestamp> times, const StretchGraph& graph,
         const GroundPaths& found, const GroundIdentityOptions& options)
      : tracklets_(tracklets), times_(times), graph_(graph), found_(found), options_(options) {}

  GroundIdentities identities() {
    for (const StretchGraph::Node& node : graph_.nodes) told_.stretches.push_back({node.tracklet, node.first, node.last, 0});
    for (std::size_t path = 0; path < found_.paths().size(); ++path) name(found_.paths()[path]);
    weigh();
    for (std::size_t path = 0; path < told_.paths.size(); ++path) {
      if (told_.paths[path].name < 0) add_candidates(static_cast<int>(path));
    }
    return std::move(told_);
  }

 private:
  /// One path of those found; where it has two names, the second begins where it was given.
  void name(const std::vector<int>& nodes) {
    told_.paths.emplace_back();
    for (const int node : nodes) {
      const NameSet& names = graph_.nodes[static_cast<std::size_t>(node)].names;
      for (std::size_t name = 0; names.any() && name < names.size(); ++name) {
        if (!names[name] || told_.paths.back().name == static_cast<int>(name)) continue;
        if (told_.paths.back().name >= 0) told_.paths.emplace_back();
        told_.paths.back().name = static_cast<int>(name);
      }
      told_.paths.back().stretches.push_back(node);
      told_.stretches[static_cast<std::size_t>(node)].path = static_cast<int>(told_.paths.size()) - 1;
    }
  }

  /// How much all that could have been decided otherwise weighs against each decision.
  void weigh() {
    std::vector<double> against_crossing(graph_.crossings.size(), 0);
    std::map<int, double> against_link;  // by the node before it
    for (const GroundPaths::Move& move : found_.moves(kLeastAlternative)) {
      const double weight = std::exp(std::min(move.gain, 30.0) / kCaution);
      for (const int crossing : move.crossings) against_crossing[static_cast<std::size_t>(crossing)] += weight;
      if (!move.crossings.empty()) continue;
      for (const GroundPaths::Move::Arc& arc : move.arcs) against_link[arc.node] += weight;
    }
    const auto share = [](double against) { return against / (1 + against); };
    for (std::size_t c = 0; c < graph_.crossings.size(); ++c) {
      const StretchGraph::Crossing& crossing = graph_.crossings[c];
      told_.meetings.push_back({crossing.instant, crossing.before[0], crossing.before[1], found_.exchanged(static_cast<int>(c)),
                                share(against_crossing[c])});
    }
    for (const StretchGraph::Gap& gap : graph_.gaps) {
      if (found_.next(gap.before) == gap.after) told_.links.push_back({gap.before, gap.after, share(against_link[gap.before])});
    }
    std::sort(told_.links.begin(), told_.links.end(), [](const auto& a, const auto& b) { return a.before < b.before; });
  }

  RoleSum role_of(const GroundIdentities::Path& path) const {
    RoleSum role;
    for (const int node : path.stretches) role += graph_.nodes[static_cast<std::size_t>(node)].role;
    return role;
  }

  /// Whether one person may have made both: never at the same time, and never too fast between.
  bool may_be_one(const GroundIdentities::Path& one, const GroundIdentities::Path& other) const {
    std::vector<int> both = one.stretches;
    both.insert(both.end(), other.stretches.begin(), other.stretches.end());
    std::erase_if(both, [&](int node) { return is_empty(node); });
    std::sort(both.begin(), both.end(), [&](int a, int b) { return stretch(a).first < stretch(b).first; });
    for (std::size_t i = 1; i < both.size(); ++i) {
      if (stretch(both[i]).first <= stretch(both[i - 1]).last) return false;
      if (stretch(both[i]).path == stretch(both[i - 1]).path) continue;
      const auto& before = tracklets_[static_cast<std::size_t>(stretch(both[i - 1]).tracklet)].samples;
      const auto& after = tracklets_[static_cast<std::size_t>(stretch(both[i]).tracklet)].samples;
      const GroundSample& last = before[index_from(before, stretch(both[i - 1]).last + 1) - 1];
      const GroundSample& first = after[index_from(after, stretch(both[i]).first)];
      const double far = options_.join.max_speed * seconds_between(last.instant, first.instant, times_);
      if ((first.at() - last.at()).norm() > far + 2) return false;
    }
    return true;
  }

  const GroundIdentities::Stretch& stretch(int node) const { return told_.stretches[static_cast<std::size_t>(node)]; }
  bool is_empty(int node) const {
    const auto& samples = tracklets_[static_cast<std::size_t>(stretch(node).tracklet)].samples;
    const std::size_t first = index_from(samples, stretch(node).first);
    return first == samples.size() || samples[first].instant > stretch(node).last;
  }

  void add_candidates(int path) {
    const GroundIdentities::Path& unnamed = told_.paths[static_cast<std::size_t>(path)];
    const RoleSum role = role_of(unnamed);
    std::map<int, double> weights;
    double all = std::exp(kStranger);
    for (const GroundIdentities::Path& named : told_.paths) {
      if (named.name < 0 || !may_be_one(named, unnamed)) continue;
      const RoleSum theirs = role_of(named);
      double gain = log_evidence(theirs + role) - log_evidence(theirs) - log_evidence(role);
      if (const auto after = graph_.gain_of_gap.find({named.stretches.back(), unnamed.stretches.front()});
          after != graph_.gain_of_gap.end())
        gain += after->second;
      if (const auto before = graph_.gain_of_gap.find({unnamed.stretches.back(), named.stretches.front()});
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
    told_.candidates.insert(told_.candidates.end(), candidates.begin(), candidates.end());
  }

  std::span<const GroundTracklet> tracklets_;
  std::span<const Timestamp> times_;
  const StretchGraph& graph_;
  const GroundPaths& found_;
  const GroundIdentityOptions& options_;
  GroundIdentities told_;
};

}  // namespace

GroundIdentities identify(std::span<const GroundTracklet> tracklets, std::span<const int> teams, std::span<const Timestamp> times,
                          std::span<const GroundNaming> namings, const GroundIdentityOptions& options) {
  const StretchGraph graph = graph_of_stretches(tracklets, teams, times, namings, options);
  GroundPaths paths(graph);
  paths.search(kMostRounds);
  return Teller(tracklets, times, graph, paths, options).identities();
}

}  // namespace marey::track::ground::offline
