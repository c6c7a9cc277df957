#include "marey/detect/shirts/number_votes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace marey::detect::shirts {
namespace {

constexpr int kNumbers = 100;                                // by definition
constexpr Duration kGroup = std::chrono::milliseconds(500);  // chosen on figures in bench/tuning.md
constexpr double kMinLegible = 0.3;                          // chosen on figures in bench/tuning.md
constexpr double kOverlooked = 0.05, kInvented = 0.14;       // of a digit
constexpr double kElsewhere = 0.03;                          // the string is not a part of the number
constexpr double kWithoutNumber = 0.5;                       // share of the people: referees, passers-by

// Probability that a digit (row) is read as another one (column), of 1,043 legible crops of rendered shirts of people of 60 to 150
// px, at least 0.001.
constexpr std::array<std::array<double, kDigits>, kDigits> kConfusions{{
    {0.975, 0.001, 0.001, 0.001, 0.001, 0.001, 0.002, 0.001, 0.010, 0.007},
    {0.001, 0.967, 0.016, 0.006, 0.001, 0.001, 0.001, 0.005, 0.001, 0.001},
    {0.001, 0.001, 0.991, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001},
    {0.001, 0.001, 0.001, 0.988, 0.001, 0.001, 0.001, 0.001, 0.004, 0.001},
    {0.002, 0.001, 0.001, 0.001, 0.989, 0.001, 0.002, 0.001, 0.001, 0.001},
    {0.001, 0.001, 0.001, 0.003, 0.001, 0.989, 0.001, 0.001, 0.001, 0.001},
    {0.002, 0.001, 0.001, 0.001, 0.001, 0.021, 0.968, 0.001, 0.002, 0.001},
    {0.005, 0.005, 0.010, 0.002, 0.001, 0.001, 0.001, 0.973, 0.001, 0.001},
    {0.003, 0.001, 0.001, 0.008, 0.001, 0.001, 0.001, 0.001, 0.981, 0.002},
    {0.004, 0.001, 0.001, 0.005, 0.001, 0.001, 0.001, 0.001, 0.006, 0.979},
}};

double substituted(int digit, int read) {
  return kConfusions[static_cast<std::size_t>(digit)][static_cast<std::size_t>(read)];
}

/// Probability that `number` is read as the string of this index.
double read_as(int number, int index) {
  const double elsewhere = kElsewhere / (kStrings - 1);
  const int tens = number / kDigits, units = number % kDigits;
  const bool one = index <= kDigits;
  const int second = (index - 1) % kDigits, first = (index - 1 - kDigits) / kDigits;  // of a string of two
  if (number < kDigits) {
    if (one) return elsewhere + (1 - kElsewhere - kInvented) * substituted(number, index - 1);
    return elsewhere + kInvented * (substituted(number, first) + substituted(number, second)) / (2 * kDigits);
  }
  if (one) return elsewhere + kOverlooked * (substituted(tens, index - 1) + substituted(units, index - 1)) / 2;
  return elsewhere + (1 - kElsewhere - kOverlooked) * substituted(tens, first) * substituted(units, second);
}

using Table = std::array<std::array<double, kStrings>, kNumbers>;

const Table& read_as_table() {
  static const Table table = [] {
    Table made{};
    for (int number = 0; number < kNumbers; ++number) {
      for (int index = 1; index < kStrings; ++index)
        made[static_cast<std::size_t>(number)][static_cast<std::size_t>(index)] = read_as(number, index);
    }
    return made;
  }();
  return table;
}

/// Of each number, over that of no number, of which any string is as likely as another.
double log_ratio(int number, const ShirtReading& reading) {
  const auto& row = read_as_table()[static_cast<std::size_t>(number)];
  double read = 0;
  for (std::size_t index = 1; index < row.size(); ++index) read += row[index] * reading.strings[index];
  const double nothing = 1.0 / (kStrings - 1);
  const double says_nothing = 1 - reading.legibility * (1 - reading.strings[0]);
  return std::log((reading.legibility * read + says_nothing * nothing) / nothing);
}

}  // namespace

void NumberVotes::add(Timestamp time, const ShirtReading& reading) {
  if (totals_.empty()) totals_.assign(kNumbers, 0), group_.assign(kNumbers, 0);
  if (in_group_ > 0 && time - group_began_ >= kGroup) {
    totals_ = totals_with(group_, in_group_);
    std::fill(group_.begin(), group_.end(), 0);
    in_group_ = 0;
  }
  const bool begins = in_group_ == 0;
  if (begins) group_began_ = time;
  ++in_group_;
  for (int number = 0; number < kNumbers; ++number) group_[static_cast<std::size_t>(number)] += log_ratio(number, reading);
  if (reading.legibility < kMinLegible) return;
  ++legible_;
  if (clear_.empty() || clear_.back().time < group_began_) {
    clear_.push_back({time, reading});
  } else if (reading.legibility > clear_.back().read.legibility) {
    clear_.back() = {time, reading};
  }
}

std::vector<double> NumberVotes::totals_with(const std::vector<double>& group, int count) const {
  std::vector<double> sums = totals_;
  for (std::size_t i = 0; i < sums.size() && count > 0; ++i) sums[i] += group[i] / count;
  return sums;
}

Timestamp NumberVotes::clearest(int number) const {
  return std::max_element(clear_.begin(), clear_.end(),
                          [&](const Reading& a, const Reading& b) { return log_ratio(number, a.read) < log_ratio(number, b.read); })
      ->time;
}

std::optional<TrackNumber> NumberVotes::result() const {
  if (legible_ == 0) return std::nullopt;
  const std::vector<double> sums = totals_with(group_, in_group_);
  const auto best = std::max_element(sums.begin(), sums.end());
  const double top = std::max(0.0, *best), prior = (1 - kWithoutNumber) / kNumbers;
  double total = kWithoutNumber * std::exp(-top);
  for (const double sum : sums) total += prior * std::exp(sum - top);
  TrackNumber found{.number = static_cast<int>(best - sums.begin()), .readings = legible_};
  found.probability = prior * std::exp(*best - top) / total;
  found.clearest = clearest(found.number);
  return found;
}

}  // namespace marey::detect::shirts
