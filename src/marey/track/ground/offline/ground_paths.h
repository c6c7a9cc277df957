// Paths through a graph of segments, one per person, and what moves from one set of paths to another gain.
#pragma once

#include <span>
#include <vector>

#include "marey/track/ground/offline/segment_graph.h"

namespace marey::track::ground::offline {

class GroundPaths {
 public:
  /// As the tracker had it; gaps bridged where that is worth it.
  explicit GroundPaths(const SegmentGraph& graph);

  /// New successors for some nodes, or assign::kNoIndex, and what that gains. `crossings` are settled conversely by it.
  struct Move {
    struct Arc {
      int node = 0, next = 0;
    };
    double gain = 0;
    std::vector<Arc> arcs;
    std::vector<int> crossings;
    std::vector<int> paths;  ///< that are changed
  };

  /// All moves that gain more than `least`.
  std::vector<Move> moves(double minimum) const;
  /// Takes moves of positive gain, the best first, until no such move is left; or `most` times.
  void search(int maximum);

  const std::vector<std::vector<int>>& paths() const { return paths_; }
  int path_of(int node) const { return path_[static_cast<std::size_t>(node)]; }
  int next(int node) const { return next_[static_cast<std::size_t>(node)]; }
  bool swapped(int crossing) const { return swapped_[static_cast<std::size_t>(crossing)]; }

 private:
  /// A segment of a path: its nodes from one position up to another.
  struct Part {
    int path = 0, from = 0, to = 0;
  };
  double merit(std::span<const Part> parts) const;
  double score_of(int path) const { return merit_[static_cast<std::size_t>(path)]; }
  Part head(int path, int to) const { return {path, 0, to}; }
  Part tail(int path, int from) const { return {path, from, static_cast<int>(paths_[static_cast<std::size_t>(path)].size())}; }
  double gap_gain(int before, int after) const;
  double crossing_gain(int crossing) const;

  void add_crossing_moves(double minimum, std::vector<Move>& moves) const;
  void add_double_crossing_moves(double minimum, std::vector<Move>& moves) const;
  void add_gap_moves(double minimum, std::vector<Move>& moves) const;
  void add_cuts(double minimum, std::vector<Move>& moves) const;
  Move gap_move(const SegmentGraph::Gap& gap) const;
  void take(const Move& move);
  void lay_out();

  const SegmentGraph& graph_;
  std::vector<int> next_, previous_;
  std::vector<bool> swapped_;
  std::vector<std::vector<int>> paths_;     // nodes
  std::vector<std::vector<RoleSum>> sums_;  // of each path up to each position
  std::vector<std::vector<int>> named_;     // of each path the positions at which a person was named
  std::vector<double> merit_;
  std::vector<int> path_, position_;  // of each node
};

}  // namespace marey::track::ground::offline
