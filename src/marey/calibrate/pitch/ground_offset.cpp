#include "marey/calibrate/pitch/ground_offset.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Core>

#include "marey/calibrate/pitch/ground_pair.h"
#include "marey/calibrate/pitch/ground_paths.h"
#include "marey/geometry/decompositions.h"

namespace marey::calibrate::pitch {
namespace {

constexpr double kAgree = 5;        // deviations within which a pair's shift takes part in the common adjustment
constexpr double kContradicts = 4;  // deviations
constexpr double kNegligible_s = 0.015;
constexpr double kSystematic = 0.008;  // s, of every pair's shift: what no least squares knows of

struct Edge {
  std::size_t a = 0, b = 0;
  GroundOffset shift;  // added to b's times gives a's
};

/// Two cameras, and what they see of each other's people.
struct CameraPair {
  std::size_t a = 0, b = 0;
  GroundPair pair;
};

/// Which cameras hang together, with an offset to the first of their group.
struct Tree {
  explicit Tree(std::size_t cameras) : group(cameras), offset(cameras, 0.0) { std::iota(group.begin(), group.end(), 0); }

  /// Joins the groups of two cameras: offset(b) = offset(a) + shift. The joined group moves as a whole.
  void join(const Edge& edge) {
    const std::size_t keep = std::min(group[edge.a], group[edge.b]), joined = std::max(group[edge.a], group[edge.b]);
    if (keep == joined) return;
    const double by = offset[edge.a] + edge.shift.offset_s - offset[edge.b];
    const double move = group[edge.b] == joined ? by : -by;
    for (std::size_t c = 0; c < group.size(); ++c) {
      if (group[c] == joined) group[c] = keep, offset[c] += move;
    }
  }

  std::vector<std::size_t> group;
  std::vector<double> offset;
};

/// Puts the offsets of the first camera's group right by all pairs that agree with them; their deviations.
std::vector<double> adjust(Tree& tree, const std::vector<Edge>& edges) {
  const auto n = static_cast<Eigen::Index>(tree.offset.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(n, n) * 1e-9;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  normal(0, 0) += 1e12;
  for (const Edge& edge : edges) {
    const double off = edge.shift.offset_s - (tree.offset[edge.b] - tree.offset[edge.a]);
    const double variance = edge.shift.deviation_s * edge.shift.deviation_s;
    if (std::abs(off) > kAgree * std::sqrt(variance)) continue;
    const auto a = static_cast<Eigen::Index>(edge.a), b = static_cast<Eigen::Index>(edge.b);
    normal(a, a) += 1 / variance, normal(b, b) += 1 / variance;
    normal(a, b) -= 1 / variance, normal(b, a) -= 1 / variance;
    right(b) += off / variance, right(a) -= off / variance;
  }
  const Eigen::VectorXd by = geometry::solve_symmetric(normal, right);
  const Eigen::MatrixXd covariance = geometry::solve_symmetric(normal, Eigen::MatrixXd::Identity(n, n));
  std::vector<double> deviations;
  for (Eigen::Index c = 0; c < n; ++c) {
    tree.offset[static_cast<std::size_t>(c)] += by(c);
    deviations.push_back(std::sqrt(covariance(c, c)));
  }
  return deviations;
}

/// Of a camera without a chain to the first: what speaks of its pairs, the most hopeful.
OffsetVerdict verdict_of(std::size_t camera, const std::vector<Edge>& all) {
  OffsetVerdict verdict = OffsetVerdict::no_overlap;
  for (const Edge& edge : all) {
    if (edge.a != camera && edge.b != camera) continue;
    // A pair may well be found, in a group that hangs together and not with the first.
    if (edge.shift.verdict == OffsetVerdict::ambiguous) verdict = OffsetVerdict::ambiguous;
    if (edge.shift.verdict == OffsetVerdict::no_motion && verdict == OffsetVerdict::no_overlap) verdict = edge.shift.verdict;
  }
  return verdict;
}

}  // namespace

std::string_view offset_verdict_name(OffsetVerdict verdict) {
  switch (verdict) {
    case OffsetVerdict::found:
      return "found";
    case OffsetVerdict::no_overlap:
      return "no overlap";
    case OffsetVerdict::no_motion:
      return "no person moves";
    case OffsetVerdict::ambiguous:
      return "ambiguous";
  }
  return {};
}

bool contradicts(const GroundOffset& found, double assumed_s, const GroundOffsetOptions& options) {
  if (found.verdict != OffsetVerdict::found || found.gain < options.min_score) return false;
  return std::abs(found.offset_s - assumed_s) > std::max(kContradicts * found.deviation_s, kNegligible_s);
}

std::vector<GroundOffset> find_ground_offsets(std::span<const std::vector<GroundPath>> cameras, std::span<const double> assumed,
                                              const GroundOffsetOptions& options) {
  std::vector<std::vector<SmoothPath>> paths(cameras.size());
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (const GroundPath& path : cameras[c]) paths[c].emplace_back(path);
  }
  std::vector<CameraPair> camera_pairs;
  for (std::size_t a = 0; a < cameras.size(); ++a) {
    for (std::size_t b = a + 1; b < cameras.size(); ++b) camera_pairs.push_back({a, b, GroundPair(paths[a], paths[b], options)});
  }
  std::stable_sort(camera_pairs.begin(), camera_pairs.end(),
                   [](const CameraPair& x, const CameraPair& y) { return x.pair.overlap_s() > y.pair.overlap_s(); });
  std::vector<Edge> all, found;
  std::vector<const GroundPair*> pairs;
  Tree tree(cameras.size());
  for (auto& [a, b, pair] : camera_pairs) {
    const bool joined = tree.group[a] == tree.group[b];
    Edge edge{a, b, pair.find(joined ? std::optional(tree.offset[b] - tree.offset[a]) : std::nullopt)};
    edge.shift.deviation_s = std::hypot(edge.shift.deviation_s, kSystematic);
    all.push_back(edge);
    if (edge.shift.verdict != OffsetVerdict::found) continue;
    found.push_back(edge);
    pairs.push_back(&pair);
    tree.join(edge);
  }
  const std::vector<double> deviations = adjust(tree, found);
  std::vector<GroundOffset> result(cameras.size());
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    if (tree.group[c] != tree.group[0]) {
      result[c].verdict = verdict_of(c, all);
      continue;
    }
    result[c] = {OffsetVerdict::found, tree.offset[c] - tree.offset[0], c == 0 ? 0 : deviations[c], 0};
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto [a, b, shift] = found[i];
      if (c != a && c != b) continue;
      result[c].gain += pairs[i]->score(tree.offset[b] - tree.offset[a]) - pairs[i]->score(assumed[b] - assumed[a]);
    }
  }
  return result;
}

}  // namespace marey::calibrate::pitch
