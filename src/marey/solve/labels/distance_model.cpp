#include "marey/solve/labels/distance_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace marey::solve::labels {
namespace {

constexpr double kAnyDistance = 1.5;     // m: distances of any two markers are spread evenly over this much
constexpr int kOftenEnough = 40;         // instants
constexpr std::size_t kTies = 3;         // to those before it, that say how well a label is tied
constexpr double kMinVariation = 0.001;  // m: numerical, so that a logarithm is finite
constexpr double kStillCount = 2;        // times a variance counts against being rigid

/// log of a normal density at its mean against that of any distance.
double top_of(double deviation) {
  return std::log(kAnyDistance / (deviation * std::sqrt(2 * std::numbers::pi)));
}

}  // namespace

DistanceModel::DistanceModel(const LearnedMarkers& learned, double scale, const DistanceOptions& options)
    : size_(learned.size()), options_(options), moves_(learned.moves) {
  for (const LearnedMarkers::Distance& distance : learned.distances) {
    Term& term = terms_.emplace_back();
    const double mean = scale * distance.mean;
    const double spread = moves_ ? scale * distance.deviation : options_.still_spread * mean;
    const double shift = moves_ ? options_.shift : options_.still_shift,
                 fraction = (moves_ ? options_.fraction : options_.still_fraction) * mean;
    set(term, mean, std::sqrt(spread * spread + shift * shift + fraction * fraction));
  }
  rank();
}

DistanceModel::DistanceModel(const LearnedMarkers& learned, double scale, const DistanceOptions& options,
                             const AnotherPerson& person)
    : DistanceModel(learned, scale, options) {
  person_ = person;
  for (std::size_t a = 1; a < size_; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      Term& term = terms_[LearnedMarkers::index_of(a, b)];
      const double segment = person.scale_of.empty() ? 1 : std::sqrt(person.scale_of[a] * person.scale_of[b]);
      const double mean = segment * term.mean, fraction = options_.person_fraction * mean;
      const double elsewhere = std::min(std::hypot(options_.person_shift, fraction), options_.person_max);
      const double rank = term.deviation;  // what is tight on one is on the other
      set(term, mean, std::hypot(term.deviation, elsewhere));
      term.deviation = rank;
      term.motion = std::log(std::max(scale * learned.between(a, b).deviation, kMinVariation));
    }
  }
}

/// How well the deviation of a distance fits.
double DistanceModel::motion_ratio(const Term& term, const DistanceObserved& detected) const {
  if (detected.count < kOftenEnough) return 0;
  const double log_deviation = std::log(std::max(std::sqrt(detected.variance), kMinVariation));
  const double off = (log_deviation - term.motion) / options_.person_variation,
               any = (log_deviation - person_->any_log) / person_->any_spread;
  return std::log(person_->any_spread / options_.person_variation) + (any * any - off * off) / 2;
}

void DistanceModel::set(Term& term, double mean, double deviation) const {
  term.mean = mean;
  term.deviation = deviation;
  term.top = top_of(deviation);
  term.weight = 1 / (2 * deviation * deviation);
}

double DistanceModel::ratio(std::size_t a, std::size_t b, const DistanceObserved& detected) const {
  const Term& term = terms_[LearnedMarkers::index_of(a, b)];
  const double off = detected.mean - term.mean;
  if (person_ && moves_ && !term.adopted)
    return std::max(term.top - off * off * term.weight + motion_ratio(term, detected), options_.floor);
  if (moves_ || term.adopted) return std::max(term.top - (off * off + detected.variance) * term.weight, options_.floor);
  // Learned from one who stood still: either both are on one segment, and the distance is as it was; or the posture is another.
  const double fraction = options_.still_fraction * term.mean, other = options_.still_spread * term.mean + options_.still_joint;
  const double rigid = options_.still_shift * options_.still_shift + fraction * fraction, loose = other * other;
  const double same = options_.same_segment * std::exp(-term.mean / options_.segment);
  const double square = off * off + detected.variance;
  const double as_segment = std::log(same) + top_of(std::sqrt(rigid)) - (off * off + kStillCount * detected.variance) / (2 * rigid);
  const double as_posture = std::log(1 - same) + options_.posture * (top_of(other) - square / (2 * loose));
  const double maximum = std::max(as_segment, as_posture);
  return std::max(maximum + std::log1p(std::exp(-std::abs(as_segment - as_posture))), options_.floor);
}

std::optional<double> DistanceModel::rigid_deviation(std::size_t a, std::size_t b, const DistanceObserved& detected) const {
  if (person_) return 1 / std::sqrt(2 * terms_[LearnedMarkers::index_of(a, b)].weight);
  if (moves_) return deviation(a, b);
  if (detected.variance > options_.shift * options_.shift) return std::nullopt;
  return std::hypot(options_.still_shift, options_.still_fraction * mean(a, b));
}

void DistanceModel::adopt(std::size_t a, std::size_t b, const DistanceObserved& detected) {
  Term& term = terms_[LearnedMarkers::index_of(a, b)];
  if (detected.count < kOftenEnough) return;
  term.adopted = true;
  set(term, detected.mean, std::sqrt(detected.variance + options_.shift * options_.shift / 2));
}

void DistanceModel::rank_partners(std::size_t label) {
  std::vector<std::size_t>& its = partners_[label];
  its.clear();
  for (std::size_t b = 0; b < size_; ++b) {
    if (b != label) its.push_back(b);
  }
  std::stable_sort(its.begin(), its.end(), [&](std::size_t b, std::size_t c) { return deviation(label, b) < deviation(label, c); });
}

void DistanceModel::rank() {
  partners_.resize(size_);
  for (std::size_t a = 0; a < size_; ++a) rank_partners(a);
  // Begins with the label whose best ties are the tightest; then always the one best tied to those that are there.
  const auto tightness = [&](std::size_t label, const std::vector<std::size_t>& among) {
    std::vector<double> ties;
    for (const std::size_t other : among) {
      if (other != label) ties.push_back(deviation(label, other));
    }
    std::sort(ties.begin(), ties.end());
    double sum = 0;
    for (std::size_t i = 0; i < std::min(kTies, ties.size()); ++i) sum -= std::log(ties[i]);
    return sum;
  };
  order_.clear();
  std::vector<std::size_t> left;
  for (std::size_t a = 0; a < size_; ++a) left.push_back(a);
  while (!left.empty()) {
    const std::vector<std::size_t>& among = order_.empty() ? left : order_;
    std::size_t best = 0;
    double maximum = -std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < left.size(); ++i) {
      const double its = tightness(left[i], among);
      if (its > maximum) maximum = its, best = i;
    }
    order_.push_back(left[best]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
}

}  // namespace marey::solve::labels
