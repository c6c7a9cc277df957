// Where a hidden marker must be, predicted from the markers that move rigidly with it.
//
// Markers on one bone keep their distances, whatever the body does. The mean and the spread of the distance of every two markers
// are learned while both are seen. When a marker vanishes, the places of all others at that instant are kept; while it is hidden,
// the rigid motion that takes those places to where they are now, each weighted by the fourth power of how steady its distance to
// the hidden one has been, moves the hidden one too. A marker on the same bone thus outweighs the rest of the body, which only
// settles what its own bone leaves open. Good for as long as the bone stays seen; after seconds of coasting no motion model is.
// The same distances identify a marker: a place whose distances to a marker's steadiest neighbours are not what they always were
// is not that marker's. Seven in ten of the neighbours decide, so that one of them that is mistaken itself does no harm.
// Cost: a share of the pairs a frame for learning, and 50 operations a neighbour and one 3 × 3 decomposition for each hidden
// marker. Reference: Arun, Huang, Blostein, "Least-squares fitting of two 3-D point sets", PAMI 1987.
#pragma once

#include <optional>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::track::roster {

class RigidNeighbours {
 public:
  struct Location {
    Vector<3> position;   ///< m
    double variance = 0;  ///< along each axis, m²
  };

  /// A new marker's number: 0, 1, …, or one that is free again. Nothing when there are too many for pairs to be kept.
  std::optional<int> enrol();

  /// Marker `number` was seen there in the frame at hand. Between `begin_frame` and `end_frame`, each at most once.
  void begin_frame();
  void observe_frame(int number, const Vector<3>& position);
  /// `dt` is what passed since the frame before, s.
  void end_frame(double dt);

  /// Where a marker is that the frame before the last `end_frame` or an earlier one saw last; nothing if too little is known of
  /// it or of those that move with it.
  std::optional<Location> position_of(int number) const;

  /// How badly a place in the frame at hand fits a marker: what the squared change of distance, in variances, of seven in ten of
  /// its steadiest neighbours that are seen stays below; about 1 for the marker itself. Nothing if too few are seen or known
  /// well enough.
  std::optional<double> misfit(int number, const Vector<3>& location) const;

  /// How badly the distances that two numbers keep to others fit to be one marker's: the median over their steadiest common
  /// neighbours of the squared difference of the mean distances, in variances. Nothing if too little is known of one of them, or
  /// where both were seen at once.
  std::optional<double> difference(int a, int b) const;

  /// `number` turned out to be `other`: the data learned of it become other's, and the number is free for another marker.
  void merge(int number, int other);
  /// No person needs the number any more.
  void release(int number);

  /// What was thought to be this marker is not: the places kept of it are worth nothing.
  void disown(int number);

 private:
  struct Distance {
    float mean = 0, variance = 0;  // m, m²
    int count = 0;
  };
  struct Member {
    Vector<3> position = Vector<3>::Zero();
    bool detected = false, was_observed = false;
    std::vector<int> steadiest;        // its neighbours, the steadiest distance first
    std::vector<Vector<3>> locations;  // of all when it was last seen
    std::vector<char> known;           // which of them were seen then
  };

  Distance& between(int a, int b) {
    return distances_[static_cast<std::size_t>(a > b ? a * (a - 1) / 2 + b : b * (b - 1) / 2 + a)];
  }
  const Distance& between(int a, int b) const { return const_cast<RigidNeighbours*>(this)->between(a, b); }
  void learn(int row);
  void rank(int number);
  double observed_together(const Distance& distance) const { return distance.count * sample_s_; }
  double unknown(const Distance& distance, double after_a_second) const;
  void keep_positions(Member& member) const;

  std::vector<Member> members_;
  std::vector<int> free_;
  std::vector<Vector<3>> last_positions_;
  std::vector<char> last_observed_;
  std::vector<Distance> distances_;  // of each two, the lower triangle
  std::size_t frames_ = 0;
  double sample_s_ = 0;  // between two samples of a pair
};

}  // namespace marey::track::roster
