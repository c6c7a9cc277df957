// Rigid bodies among points without names.
//
// The distances between all points are sorted by length. Of a body's edges those are searched for whose length is rarest there, and
// which share no marker, so that one of them is whole though some markers are hidden. Each pair of points of that length, with a
// third point at the right distances from both, proposes a pose, which all other markers must then confirm. A pose is a turn, never
// a mirror image: what lies mirrored does not confirm it, unless it lies in a plane.
// Cost: points² for the distances, and points for each pair of a right length. Reference for the rarest feature first: the pruning
// of interpretation trees (Grimson & Lozano-Pérez 1987).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/rigid.h"

namespace marey::solve::bodies {

/// A body, where it may be.
struct PoseCandidate {
  int body = 0;  ///< index into the layouts
  Rigid3 world_from_body;
  std::vector<std::optional<int>> point_of;  ///< by marker
  int matched = 0;
  double rms = 0;  ///< m
  /// How many sets of points that fit the body as well as these are to be expected by chance, of points that lie as densely as
  /// those round about: the number of false alarms of a-contrario tests (Desolneux, Moisan, Morel 2000).
  double by_chance = 0;
};

/// This many markers must be seen before a body of `markers` is trusted to be there.
constexpr int min_to_initialise(int markers) {
  return markers <= 4 ? 3 : (3 * markers + 3) / 4;
}

class BodyInitialiser {
 public:
  /// Markers by body, in the body's frame; a marker is where it should be within `tolerance` m.
  BodyInitialiser(std::vector<std::vector<Vector<3>>> layouts, double tolerance);

  /// Where the `wanted` bodies may be, each set of points once for a body; a point may be in several candidates.
  const std::vector<PoseCandidate>& find(std::span<const Vector<3>> points, std::span<const int> required);

 private:
  struct Edge {
    int a = 0, b = 0;
    double length = 0;
    std::size_t count = 0;  // pairs of points of that length
  };

  /// Three markers: their edge that is rarest among the points, and how far the third is from it.
  struct Triangle {
    double others = 0;  // pairs of points as long as the edge, without the candidate's own
    double height = 0;  // m
  };

  void sort_pairs(std::span<const Vector<3>> points, double longest);
  std::pair<std::size_t, std::size_t> pairs_near(double length) const;
  std::vector<Edge> rarest_edges(const std::vector<Vector<3>>& layout) const;
  void try_pair(std::span<const Vector<3>> points, int body, const Edge& edge, int p, int q);
  void confirm(std::span<const Vector<3>> points, int body, Rigid3 pose);
  /// Of a body that is there in part: its markers that are almost in a plane lie in its mirror image's places too, and that image
  /// has more.
  bool fits_better_mirrored(std::span<const Vector<3>> points, const PoseCandidate& candidate) const;

  /// Of the markers `matched`, whose points are `lengths` apart. Of edges that are equally rare, that with the farthest third.
  Triangle rarest_triangle(std::span<const Vector<3>> layout, std::span<const std::size_t> matched,
                           std::span<const double> lengths) const;
  double expected_by_chance(std::span<const Vector<3>> points, const PoseCandidate& candidate) const;

  struct Pair {
    double length;
    int a, b;
  };
  std::vector<std::vector<Vector<3>>> layouts_;
  double tolerance_;
  std::vector<Pair> pairs_;
  std::vector<PoseCandidate> found_;
};

}  // namespace marey::solve::bodies
