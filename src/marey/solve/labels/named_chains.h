// The state between the rounds: chains of tracklets, which of them has which name, and where the named ones are.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/assign/no_index.h"
#include "marey/core/recording.h"
#include "marey/solve/labels/distance_model.h"
#include "marey/solve/labels/tracklets.h"

namespace marey::solve::labels {

class NamedChains {
 public:
  /// One point at an instant.
  struct Point {
    int chain = 0, tracklet = 0;
    Vector<3> location = Vector<3>::Zero();
  };
  struct Chain {
    std::vector<int> tracklets;
    std::int32_t points = 0;  // instants at which it is there
    int name = assign::kNoIndex;
  };
  /// How well names fit, mean over its life, by name.
  using Fits = std::vector<double>;

  NamedChains(std::vector<Tracklet> tracklets, const std::vector<int>& chain_of, std::size_t instants, std::size_t names);

  const std::vector<Tracklet>& tracklets() const { return tracklets_; }
  const std::vector<Chain>& chains() const { return chains_; }
  int chain_of(int tracklet) const { return chain_of_[static_cast<std::size_t>(tracklet)]; }
  std::span<const Point> at(std::size_t instant) const { return points_[instant]; }
  std::size_t instants() const { return points_.size(); }

  void set_name(int chain, int name) { chains_[static_cast<std::size_t>(chain)].name = name; }
  /// Puts the named chains' places where `fits` finds them; of two with one name at one instant the longer counts.
  void gather();
  /// The chain that has a name at an instant, and where.
  struct Holder {
    int chain = assign::kNoIndex;
    Vector<3> location = Vector<3>::Zero();
  };
  const Holder& holder(std::size_t instant, std::size_t name) const { return holders_[instant * names_ + name]; }

  /// By the chain's, or one tracklet's, points, against those that have names now; itself omitted.
  Fits fits_of_chain(int chain, const DistanceModel& model, std::size_t neighbours) const;
  Fits fits_of_tracklet(int tracklet, const DistanceModel& model, std::size_t neighbours) const;

  /// Distances between the named ones, by pair of names.
  std::vector<DistanceObserved> named_distances() const;
  /// Distances between the points of one instant, over all instants at which both chains are there. Chains of fewer than `shortest`
  /// points are omitted; `chains` gets those that are in.
  std::vector<DistanceObserved> distances_at(std::size_t instant, std::int32_t shortest, std::vector<int>& chains,
                                             std::vector<Vector<3>>& locations) const;
  /// The tracklet becomes a chain of its own, without a name.
  void cut_off(int tracklet);
  bool overlap(int chain, int other) const;

 private:
  void add_fits(const Tracklet& tracklet, int self, std::int32_t step, const DistanceModel& model, std::size_t neighbours,
                Fits& sums, int& count) const;

  std::vector<Tracklet> tracklets_;
  std::vector<Chain> chains_;
  std::vector<int> chain_of_;
  std::vector<std::vector<Point>> points_;  // by instant
  std::size_t names_;
  std::vector<Holder> holders_;  // by instant and name
};

}  // namespace marey::solve::labels
