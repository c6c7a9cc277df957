#include "marey/track/image/wardrobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "marey/geometry/median.h"

namespace marey::track::image {
namespace {

constexpr std::array<std::optional<Appearance> Clothes::*, 3> kPartsOfClothes{&Clothes::upper, &Clothes::lower, &Clothes::shanks};

constexpr std::array<double, 3> kWithinFirst{36, 6, 6}, kAllFirst{350, 50, 50};  // variances before anything is learned,
constexpr double kFirstWeight = 6;                                               // and how many tracklets they count for
constexpr double kWidened = 1.7;                       // variances: parts and components are not independent
constexpr double kUnobservedKinds = 1;                 // people who wear what no person wore yet, beside those who were seen
constexpr double kFirstAlike = 0.25, kFirstPairs = 5;  // pairs of people in equal clothes, of all, before any are seen
constexpr int kIterations = 10;
constexpr double kSurestSame = 6, kSurestOther = -12;

std::array<double, 3> values_of(const Appearance& colour) {
  return {colour.lightness, colour.a, colour.b};
}

/// From the median of what lies about 0, half of which may be anything.
double robust_variance(std::vector<double> values, double first) {
  if (values.empty()) return first;
  const double count = static_cast<double>(values.size());
  for (double& value : values) value = std::abs(value);
  const double deviation = 1.4826 * geometry::median(std::move(values));
  return (deviation * deviation * count + first * kFirstWeight) / (count + kFirstWeight);
}

double log_normal_density(double difference, double variance) {
  return -0.5 * (difference * difference / variance + std::log(2 * std::numbers::pi * variance));
}

/// The parts that both show.
Clothes parts_of_both(const Clothes& a, const Clothes& b) {
  Clothes both;
  for (const auto part : kPartsOfClothes) {
    if (a.*part && b.*part) both.*part = b.*part;
  }
  return both;
}

/// Of `one`'s time.
double fraction_together(const Worn& other, const Worn& one) {
  const double together = std::min(one.end, other.end) - std::max(one.begin, other.begin);
  return std::max(0.0, together) / std::max(0.1, one.end - one.begin);
}

int count_of(const Clothes& parts) {
  return static_cast<int>(
      std::count_if(kPartsOfClothes.begin(), kPartsOfClothes.end(), [&](auto part) { return (parts.*part).has_value(); }));
}

}  // namespace

Wardrobe::Wardrobe(std::span<const Worn> worn) : worn_(worn.begin(), worn.end()) {
  learn_within();
  learn_all();
  learn_alike();
}

void Wardrobe::learn_within() {
  for (std::size_t p = 0; p < kPartsOfClothes.size(); ++p) {
    for (std::size_t c = 0; c < kComponents; ++c) {
      std::vector<double> differences;
      for (const Worn& one : worn_) {
        if (!one.early || !one.late) continue;
        const auto &early = (*one.early).*kPartsOfClothes[p], &late = (*one.late).*kPartsOfClothes[p];
        if (early && late) differences.push_back(values_of(*late)[c] - values_of(*early)[c]);
      }
      within_[p][c] = robust_variance(std::move(differences), kWithinFirst[c]);
    }
  }
}

void Wardrobe::learn_all() {
  for (std::size_t p = 0; p < kPartsOfClothes.size(); ++p) {
    for (std::size_t c = 0; c < kComponents; ++c) {
      std::vector<double> values;
      for (const Worn& one : worn_) {
        if (const auto& colour = one.whole.*kPartsOfClothes[p]) values.push_back(values_of(*colour)[c]);
      }
      if (values.empty()) continue;
      middle_[p][c] = geometry::median(values);
      for (double& value : values) value -= middle_[p][c];
      all_[p][c] = std::max(within_[p][c], robust_variance(std::move(values), kAllFirst[c]));
    }
  }
}

/// Those who are there at the same time are different people, whatever they wear.
void Wardrobe::learn_alike() {
  std::vector<int> order(worn_.size());
  std::iota(order.begin(), order.end(), 0);
  const auto begins = [&](int k) { return worn_[static_cast<std::size_t>(k)].begin; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::pair(begins(a), a) < std::pair(begins(b), b); });
  std::vector<double> likelier;  // if they wear the same than if not, logarithms
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Worn& one = worn_[static_cast<std::size_t>(order[i])];
    for (std::size_t k = i + 1; k < order.size() && begins(order[k]) < one.end; ++k) {
      const Worn& other = worn_[static_cast<std::size_t>(order[k])];
      const Clothes parts = parts_of_both(one.whole, other.whole);
      if (count_of(parts) < 2) continue;
      likelier.push_back(log_density(one.whole, other.whole, parts) - log_density_of_any_person(other.whole, parts));
    }
  }
  alike_ = kFirstAlike / kFirstPairs;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double sum = kFirstAlike;
    for (const double one : likelier) sum += 1 / (1 + (1 - alike_) / alike_ * std::exp(-std::clamp(one, -100.0, 100.0)));
    alike_ = std::min(0.99, sum / (kFirstPairs + static_cast<double>(likelier.size())));
  }
}

double Wardrobe::log_density(const Clothes& known, const Clothes& detected, const Clothes& parts) const {
  double sum = 0;
  for (std::size_t p = 0; p < kPartsOfClothes.size(); ++p) {
    const auto &was = known.*kPartsOfClothes[p], &is = detected.*kPartsOfClothes[p];
    if (!(parts.*kPartsOfClothes[p])) continue;
    if (!was) return log_density_of_any_person(detected, parts);
    const double measured = was->deviation * was->deviation + is->deviation * is->deviation;
    for (std::size_t c = 0; c < kComponents; ++c)
      sum += log_normal_density(values_of(*is)[c] - values_of(*was)[c], kWidened * (within_[p][c] + measured));
  }
  return sum;
}

double Wardrobe::log_density_of_any_person(const Clothes& detected, const Clothes& parts) const {
  double sum = 0;
  for (std::size_t p = 0; p < kPartsOfClothes.size(); ++p) {
    if (!(parts.*kPartsOfClothes[p])) continue;
    const auto& is = detected.*kPartsOfClothes[p];
    for (std::size_t c = 0; c < kComponents; ++c)
      sum += log_normal_density(values_of(*is)[c] - middle_[p][c], all_[p][c] + kWidened * within_[p][c]);
  }
  return sum;
}

/// Of those who were there when either was, each as long as they were, and of a person who was not: in clothes that were not
/// seen yet, or, by the fraction of pairs in equal clothes, in the same.
double Wardrobe::log_density_of_others(int earlier, int later, const Clothes& parts, double same) const {
  const Worn &before = worn_[static_cast<std::size_t>(earlier)], &after = worn_[static_cast<std::size_t>(later)];
  std::vector<std::pair<double, double>> densities{{kUnobservedKinds * (1 - alike_), log_density_of_any_person(after.first, parts)},
                                                   {kUnobservedKinds * alike_, same}};
  for (std::size_t k = 0; k < worn_.size(); ++k) {
    if (static_cast<int>(k) == earlier || static_cast<int>(k) == later) continue;
    const double together = std::max(fraction_together(worn_[k], before), fraction_together(worn_[k], after));
    if (together > 0) densities.emplace_back(together, log_density(worn_[k].whole, after.first, parts));
  }
  double maximum = densities.front().second, weights = 0, sum = 0;
  for (const auto& [weight, density] : densities) maximum = std::max(maximum, density);
  for (const auto& [weight, density] : densities) {
    weights += weight;
    sum += weight * std::exp(density - maximum);
  }
  return maximum + std::log(sum / weights);
}

std::optional<double> Wardrobe::log_ratio(int earlier, int later) const {
  const Clothes &was = worn_[static_cast<std::size_t>(earlier)].last, &is = worn_[static_cast<std::size_t>(later)].first;
  const Clothes parts = parts_of_both(was, is);
  if (count_of(parts) < 2) return std::nullopt;
  const double same = log_density(was, is, parts);
  return std::clamp(same - log_density_of_others(earlier, later, parts, same), kSurestOther, kSurestSame);
}

}  // namespace marey::track::image
