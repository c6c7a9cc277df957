#include "marey/track/ground/offline/ground_paths.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "marey/assign/successors.h"

namespace marey::track::ground::offline {
namespace {

using assign::kNoIndex;

constexpr double kTwoNames = 60;         // what a path loses that has two
constexpr std::size_t kMaxDistance = 8;  // meetings of two paths between two of which they may have been exchanged
constexpr double kMinTaken = 0.1;        // what a move must gain

}  // namespace

GroundPaths::GroundPaths(const SegmentGraph& graph)
    : graph_(graph), next_(graph.successors), swapped_(graph.crossings.size(), false) {
  const int nodes = static_cast<int>(graph.nodes.size());
  std::vector<assign::GatedPair> pairs;
  for (const SegmentGraph::Gap& gap : graph.gaps) pairs.push_back({gap.before, gap.after, gap.gain});
  const std::vector<int> bridged = assign::best_successors(nodes, pairs);
  for (int node = 0; node < nodes; ++node) {
    if (bridged[static_cast<std::size_t>(node)] != kNoIndex)
      next_[static_cast<std::size_t>(node)] = bridged[static_cast<std::size_t>(node)];
  }
  lay_out();
}

void GroundPaths::lay_out() {
  const std::size_t nodes = next_.size();
  previous_.assign(nodes, kNoIndex);
  for (std::size_t node = 0; node < nodes; ++node) {
    if (next_[node] != kNoIndex) previous_[static_cast<std::size_t>(next_[node])] = static_cast<int>(node);
  }
  paths_.clear(), sums_.clear(), named_.clear(), merit_.clear();
  path_.assign(nodes, 0), position_.assign(nodes, 0);
  for (std::size_t first = 0; first < nodes; ++first) {
    if (previous_[first] != kNoIndex) continue;
    auto& path = paths_.emplace_back();
    auto& sums = sums_.emplace_back(1);
    auto& named = named_.emplace_back();
    for (int node = static_cast<int>(first); node != kNoIndex; node = next_[static_cast<std::size_t>(node)]) {
      const SegmentGraph::Node& segment = graph_.nodes[static_cast<std::size_t>(node)];
      path_[static_cast<std::size_t>(node)] = static_cast<int>(paths_.size()) - 1;
      position_[static_cast<std::size_t>(node)] = static_cast<int>(path.size());
      if (segment.names.any()) named.push_back(static_cast<int>(path.size()));
      path.push_back(node);
      sums.push_back(sums.back() + segment.role);
    }
    const Part whole = tail(static_cast<int>(paths_.size()) - 1, 0);
    merit_.push_back(merit({&whole, 1}));
  }
}

double GroundPaths::merit(std::span<const Part> parts) const {
  RoleSum role;
  NameSet names;
  for (const Part& part : parts) {
    const auto path = static_cast<std::size_t>(part.path);
    role += sums_[path][static_cast<std::size_t>(part.to)] - sums_[path][static_cast<std::size_t>(part.from)];
    for (const int at : named_[path]) {
      if (part.from <= at && at < part.to)
        names |= graph_.nodes[static_cast<std::size_t>(paths_[path][static_cast<std::size_t>(at)])].names;
    }
  }
  return log_evidence(role) - (names.count() > 1 ? kTwoNames * static_cast<double>(names.count() - 1) : 0);
}

double GroundPaths::gap_gain(int before, int after) const {
  if (before == kNoIndex || after == kNoIndex) return 0;
  return graph_.gain_of_gap.at({before, after});
}

double GroundPaths::crossing_gain(int crossing) const {
  const double log_odds = graph_.crossings[static_cast<std::size_t>(crossing)].log_odds;
  return swapped(crossing) ? -log_odds : log_odds;
}

/// From a meeting on, the two have what the other had.
void GroundPaths::add_crossing_moves(double minimum, std::vector<Move>& moves) const {
  for (std::size_t c = 0; c < graph_.crossings.size(); ++c) {
    const auto [a, b] = graph_.crossings[c].before;
    const int P = path_of(a), Q = path_of(b);
    if (P == Q) continue;
    const int i = position_[static_cast<std::size_t>(a)] + 1, j = position_[static_cast<std::size_t>(b)] + 1;
    const double gain = crossing_gain(static_cast<int>(c)) + merit(std::array{head(P, i), tail(Q, j)}) +
                        merit(std::array{head(Q, j), tail(P, i)}) - score_of(P) - score_of(Q);
    if (gain > minimum) moves.push_back({gain, {{a, next(b)}, {b, next(a)}}, {static_cast<int>(c)}, {P, Q}});
  }
}

/// Between two of their meetings the two have what the other had.
void GroundPaths::add_double_crossing_moves(double minimum, std::vector<Move>& moves) const {
  std::map<std::pair<int, int>, std::vector<int>> by_pair;
  for (std::size_t c = 0; c < graph_.crossings.size(); ++c) {
    const auto [P, Q] = std::minmax({path_of(graph_.crossings[c].before[0]), path_of(graph_.crossings[c].before[1])});
    if (P != Q) by_pair[{P, Q}].push_back(static_cast<int>(c));
  }
  for (const auto& [pair, crossings] : by_pair) {
    const auto [P, Q] = pair;
    const auto at = [&](int crossing, int path) {
      const auto [a, b] = graph_.crossings[static_cast<std::size_t>(crossing)].before;
      return path_of(a) == path ? a : b;
    };
    for (std::size_t k = 0; k < crossings.size(); ++k) {
      for (std::size_t l = k + 1; l < std::min(crossings.size(), k + 1 + kMaxDistance); ++l) {
        const int p1 = at(crossings[k], P), q1 = at(crossings[k], Q), p2 = at(crossings[l], P), q2 = at(crossings[l], Q);
        const int i1 = position_[static_cast<std::size_t>(p1)] + 1, i2 = position_[static_cast<std::size_t>(p2)] + 1;
        const int j1 = position_[static_cast<std::size_t>(q1)] + 1, j2 = position_[static_cast<std::size_t>(q2)] + 1;
        if (i1 >= i2 || j1 >= j2) continue;
        const double gain = crossing_gain(crossings[k]) + crossing_gain(crossings[l]) +
                            merit(std::array{head(P, i1), Part{Q, j1, j2}, tail(P, i2)}) +
                            merit(std::array{head(Q, j1), Part{P, i1, i2}, tail(Q, j2)}) - score_of(P) - score_of(Q);
        if (gain > minimum)
          moves.push_back(
              {gain, {{p1, next(q1)}, {q1, next(p1)}, {p2, next(q2)}, {q2, next(p2)}}, {crossings[k], crossings[l]}, {P, Q}});
      }
    }
  }
}

/// The end and the beginning are joined; what they were joined to before is joined where it can be.
GroundPaths::Move GroundPaths::gap_move(const SegmentGraph::Gap& gap) const {
  const int u = gap.before, v = gap.after, u2 = previous_[static_cast<std::size_t>(v)], v2 = next(u);
  const int P = path_of(u), Q = path_of(v);
  const int i = position_[static_cast<std::size_t>(u)] + 1, j = position_[static_cast<std::size_t>(v)];
  Move move{.gain = gap.gain - gap_gain(u, v2) - gap_gain(u2, v), .arcs = {{u, v}}, .crossings = {}, .paths = {P}};
  if (Q != P) move.paths.push_back(Q);
  for (const int path : move.paths) move.gain -= score_of(path);
  move.gain += merit(std::array{head(P, i), tail(Q, j)});
  if (P == Q) {
    move.gain += merit(std::array{Part{P, i, j}});
  } else if (u2 != kNoIndex && v2 != kNoIndex && graph_.gain_of_gap.contains({u2, v2})) {
    move.gain += graph_.gain_of_gap.at({u2, v2}) + merit(std::array{head(Q, j), tail(P, i)});
    move.arcs.push_back({u2, v2});
    return move;
  } else {
    move.gain += merit(std::array{head(Q, j)}) + merit(std::array{tail(P, i)});
  }
  if (u2 != kNoIndex) move.arcs.push_back({u2, kNoIndex});
  return move;
}

void GroundPaths::add_gap_moves(double minimum, std::vector<Move>& moves) const {
  for (const SegmentGraph::Gap& gap : graph_.gaps) {
    if (next(gap.before) == gap.after) continue;
    const bool same = path_of(gap.before) == path_of(gap.after);
    if (same && position_[static_cast<std::size_t>(gap.after)] < position_[static_cast<std::size_t>(gap.before)]) continue;
    Move move = gap_move(gap);
    if (move.gain > minimum) moves.push_back(std::move(move));
  }
}

void GroundPaths::add_cuts(double minimum, std::vector<Move>& moves) const {
  for (const SegmentGraph::Gap& gap : graph_.gaps) {
    if (next(gap.before) != gap.after) continue;
    const int P = path_of(gap.before), i = position_[static_cast<std::size_t>(gap.before)] + 1;
    const double gain = merit(std::array{head(P, i)}) + merit(std::array{tail(P, i)}) - score_of(P) - gap.gain;
    if (gain > minimum) moves.push_back({gain, {{gap.before, kNoIndex}}, {}, {P}});
  }
}

std::vector<GroundPaths::Move> GroundPaths::moves(double minimum) const {
  std::vector<Move> moves;
  add_crossing_moves(minimum, moves);
  add_double_crossing_moves(minimum, moves);
  add_gap_moves(minimum, moves);
  add_cuts(minimum, moves);
  return moves;
}

void GroundPaths::take(const Move& move) {
  for (const Move::Arc& arc : move.arcs) next_[static_cast<std::size_t>(arc.node)] = arc.next;
  for (const int crossing : move.crossings) swapped_[static_cast<std::size_t>(crossing)].flip();
}

void GroundPaths::search(int maximum) {
  for (int round = 0; round < maximum; ++round) {
    std::vector<Move> better = moves(kMinTaken);
    if (better.empty()) return;
    std::stable_sort(better.begin(), better.end(), [](const Move& a, const Move& b) { return a.gain > b.gain; });
    std::vector<bool> changed(paths_.size(), false);
    for (const Move& move : better) {
      // What other moves of this round have changed may no longer gain.
      const auto is_changed = [&](int path) { return changed[static_cast<std::size_t>(path)]; };
      if (std::any_of(move.paths.begin(), move.paths.end(), is_changed)) continue;
      take(move);
      for (const int path : move.paths) changed[static_cast<std::size_t>(path)] = true;
    }
    lay_out();
  }
}

}  // namespace marey::track::ground::offline
