// How well a distance between two points fits two names: the logarithm of its likelihood under the names' distribution against that
// under any two names', bounded below, so that one mistaken neighbour does no more harm than that.
//
// A distribution is normal, as wide as the distance varied where the set was learned, and wider by what differs from one recording
// to the next: where markers sit, how skin moves. Where the set was learned from a person who stood still, what is rigid is not
// known from there: a distance is then of one segment, the more probably the shorter it is, and is what it was and stays; or it
// goes across a joint, and may be any that another posture makes of it.
//
// Of another person than the one who taught the set, a distance is as long as the segment's scale makes it, and that barely; how
// much it varies is what the two have in common: what is rigid on one is rigid on the other. How much any two points' distance
// varies in the recording at hand is what that is held against, so that one who stands still shows nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "marey/core/learned_markers.h"

namespace marey::solve::labels {

struct DistanceOptions {
  double shift = 0.005;        ///< m: what a rigid distance is off between two recordings
  double fraction = 0.008;     ///< of a distance, besides
  double still_shift = 0.008;  ///< the same where the set was learned from one who stood still
  double still_fraction = 0.02;
  double still_spread = 0.15;   ///< of a distance: how much another posture changes it
  double still_joint = 0.05;    ///< m, besides
  double posture = 0.2;         ///< what such a distance counts: all distances across a joint carry the same information
  double same_segment = 0.9;    ///< how probable it is that two markers close to each other are on one segment, which the distance
  double segment = 0.3;         ///< m: makes less so, by e
  double floor = -4;            ///< of a log-likelihood ratio
  double person_shift = 0.010;  ///< m: how far markers sit elsewhere on another person's body,
  double person_fraction = 0.08;  ///< of a distance, besides, how other its segments are,
  double person_max = 0.035;      ///< m, and at most
  double person_variation = 0.6;  ///< of the logarithm of a distance's deviation, from one person to another
};

/// Another person than the one who taught the set.
struct AnotherPerson {
  std::vector<double> scale_of;                        ///< by name: of its segment, against the whole; none: 1 each
  double any_log = std::log(0.015), any_spread = 1.3;  ///< of the logarithms of the deviations, m, of any two points' distance
};

/// The mean and the variance of a distance over the instants at which both points are there.
struct DistanceObserved {
  double mean = 0, variance = 0;  ///< m, m²
  int count = 0;
};

class DistanceModel {
 public:
  /// `scale`: of the subject at hand against the learned size.
  DistanceModel(const LearnedMarkers& learned, double scale, const DistanceOptions& options = {});
  DistanceModel(const LearnedMarkers& learned, double scale, const DistanceOptions& options, const AnotherPerson& person);

  std::size_t size() const { return size_; }
  /// Of one distance, or of the mean over many.
  double ratio(std::size_t a, std::size_t b, double distance) const {
    const Term& term = terms_[LearnedMarkers::index_of(a, b)];
    const double off = distance - term.mean;
    return std::max(term.top - off * off * term.weight, options_.floor);
  }
  double ratio(std::size_t a, std::size_t b, const DistanceObserved& detected) const;
  /// Standard deviation that a distance is trusted to have, m.
  double deviation(std::size_t a, std::size_t b) const { return terms_[LearnedMarkers::index_of(a, b)].deviation; }
  /// Standard deviation of a distance that was seen, if it is rigid: nothing if it was not learned, and varies here.
  std::optional<double> rigid_deviation(std::size_t a, std::size_t b, const DistanceObserved& detected) const;
  /// How far a distance may be off the learned one where it is still the same two markers', m: `own` of the one who taught.
  double tolerance(std::size_t a, std::size_t b, double own) const {
    if (!person_) return own;
    const Term& term = terms_[LearnedMarkers::index_of(a, b)];
    return std::max(own, std::sqrt(2 / term.weight));
  }
  double mean(std::size_t a, std::size_t b) const { return terms_[LearnedMarkers::index_of(a, b)].mean; }
  /// The others by the information in their distances, the most first.
  const std::vector<std::size_t>& partners(std::size_t label) const { return partners_[label]; }
  /// Labels in an order in which each is as well tied to those before it as may be.
  const std::vector<std::size_t>& order() const { return order_; }

  /// The result from the recording at hand: replaces the distances learned elsewhere, as far as it was seen often enough.
  void adopt(std::size_t a, std::size_t b, const DistanceObserved& detected);
  /// Only for the order in which names are asked for, where what is rigid was not learned: how much two of them vary, m.
  void set_rank(std::size_t a, std::size_t b, double deviation) { terms_[LearnedMarkers::index_of(a, b)].deviation = deviation; }
  /// To be called when all were adopted, or ranked.
  void rank();
  /// The same for one label's partners alone, and not for the order.
  void rank_partners(std::size_t label);

 private:
  struct Term {
    double mean = 0, deviation = 0, top = 0, weight = 0;
    double motion = 0;  // logarithm of the deviation as learned, m
    bool adopted = false;
  };
  void set(Term& term, double mean, double deviation) const;
  double motion_ratio(const Term& term, const DistanceObserved& detected) const;

  std::size_t size_;
  DistanceOptions options_;
  bool moves_;
  std::optional<AnotherPerson> person_;
  std::vector<Term> terms_;
  std::vector<std::vector<std::size_t>> partners_;
  std::vector<std::size_t> order_;
};

}  // namespace marey::solve::labels
