#include "marey/analyse/colour_mixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "marey/core/colour.h"

namespace marey::analyse {
namespace {

constexpr double narrowest = 3, widest = 10;    // of one kind: standard deviation, as perceived
constexpr double all_colours = 60 * 70 * 70.0;  // volume over which odd colours are spread, as perceived
constexpr double thinned = 0.6;                 // deviation as perceived, of one in L*a*b*
constexpr double min_odd = 0.02;
constexpr int beginnings = 12;
constexpr int iterations = 60;

struct Fit {
  std::vector<Vector<3>> centres;
  std::vector<double> fractions;
  double odd = 0.1;
  double variance = 36;
  double log_likelihood = -std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> membership;
};

class Fitter {
 public:
  explicit Fitter(std::span<const ColourObserved> detected) {
    for (const ColourObserved& one : detected) {
      points_.push_back(perceived(one.colour));
      own_.push_back(std::pow(thinned * one.colour.deviation, 2));
      weights_.push_back(one.weight);
    }
    total_ = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    by_weight_.resize(detected.size());
    std::iota(by_weight_.begin(), by_weight_.end(), 0);
    std::stable_sort(by_weight_.begin(), by_weight_.end(), [&](int a, int b) { return weights_[a] > weights_[b]; });
  }

  Fit best(int kinds) const {
    Fit best;
    for (int k = 0; k < std::min<int>(beginnings, static_cast<int>(points_.size())); ++k) {
      Fit fit = begin(kinds, by_weight_[k]);
      for (int i = 0; i < iterations; ++i) improve(fit);
      assess(fit);
      if (fit.log_likelihood > best.log_likelihood) best = std::move(fit);
    }
    return best;
  }

  /// Schwarz's: twice the logarithm of the likelihood, less what the parameters cost.
  double criterion(const Fit& fit) const {
    const double parameters = 4.0 * static_cast<double>(fit.centres.size());
    return 2 * fit.log_likelihood - parameters * std::log(std::max(2.0, total_));
  }

 private:
  /// The first centre is given; each further one is where most weight is far from all before.
  Fit begin(int kinds, int first) const {
    Fit fit;
    fit.centres = {points_[first]};
    while (static_cast<int>(fit.centres.size()) < kinds) {
      double maximum = -1;
      Vector<3> next = points_[first];
      for (std::size_t i = 0; i < points_.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vector<3>& centre : fit.centres) nearest = std::min(nearest, (points_[i] - centre).squaredNorm());
        if (weights_[i] * nearest <= maximum) continue;
        maximum = weights_[i] * nearest;
        next = points_[i];
      }
      fit.centres.push_back(next);
    }
    fit.fractions.assign(fit.centres.size(), 0.9 / kinds);
    assess(fit);
    return fit;
  }

  /// Whose everything is under the fit, and how likely that makes the data.
  void assess(Fit& fit) const {
    fit.log_likelihood = 0;
    fit.membership.assign(points_.size(), {});
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double variance = fit.variance + own_[i];
      double sum = fit.odd / all_colours;
      for (std::size_t k = 0; k < fit.centres.size(); ++k) {
        const double distance = (points_[i] - fit.centres[k]).squaredNorm() / variance;
        fit.membership[i].push_back(fit.fractions[k] * std::exp(-distance / 2) * std::pow(2 * std::numbers::pi * variance, -1.5));
        sum += fit.membership[i].back();
      }
      for (double& probability : fit.membership[i]) probability /= sum;
      fit.log_likelihood += weights_[i] * std::log(sum);
    }
  }

  void improve(Fit& fit) const {
    double odd = total_;
    double squares = 0;
    double count = 0;
    for (std::size_t k = 0; k < fit.centres.size(); ++k) {
      double mass = 0, certain = 0;
      Vector<3> sum = Vector<3>::Zero();
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const double mine = weights_[i] * fit.membership[i][k];
        mass += mine;
        const double weight = mine / (fit.variance + own_[i]);  // who was measured badly says less of the centre
        certain += weight;
        sum += weight * points_[i];
      }
      fit.fractions[k] = mass / total_;
      odd -= mass;
      if (certain <= 0) continue;
      fit.centres[k] = sum / certain;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const double mine = weights_[i] * fit.membership[i][k];
        squares += mine * std::max(0.0, (points_[i] - fit.centres[k]).squaredNorm() / 3 - own_[i]);
        count += mine;
      }
    }
    fit.odd = std::max(min_odd, odd / total_);
    if (count > 0) fit.variance = std::clamp(squares / count, narrowest * narrowest, widest * widest);
    assess(fit);
  }

  std::vector<Vector<3>> points_;
  std::vector<double> own_;  // variance of each
  std::vector<double> weights_;
  double total_ = 0;
  std::vector<int> by_weight_;
};

}  // namespace

ColourMixture find_colours(std::span<const ColourObserved> detected, int maximum) {
  ColourMixture mixture;
  if (detected.empty()) return mixture;
  const Fitter fitter(detected);
  std::optional<Fit> best;
  for (int kinds = 1; kinds <= std::min<int>(maximum, static_cast<int>(detected.size())); ++kinds) {
    Fit fit = fitter.best(kinds);
    if (!best || fitter.criterion(fit) > fitter.criterion(*best)) best = std::move(fit);
  }
  std::vector<std::size_t> order(best->centres.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return best->fractions[a] > best->fractions[b]; });
  for (const std::size_t k : order) {
    mixture.kinds.push_back({colour_at(best->centres[k], std::sqrt(best->variance) / thinned), best->fractions[k]});
  }
  mixture.odd = best->odd;
  for (const std::vector<double>& probabilities : best->membership) {
    mixture.membership.emplace_back();
    for (const std::size_t k : order) mixture.membership.back().push_back(probabilities[k]);
  }
  return mixture;
}

}  // namespace marey::analyse
