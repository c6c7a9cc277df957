#include "marey/track/ground/camera_bias.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "marey/geometry/median.h"
#include "marey/track/ground/ground_lasting.h"

namespace marey::track::ground {
namespace {

constexpr std::size_t kMaxInstants = 400;  // that are inspected, evenly over those that were kept
constexpr std::size_t kMinPairCount = 300;
constexpr double kDistinctly = 1.6;                  // times the nearest's distance: this much farther the second nearest must be
constexpr double kFirstGate = 2.2;                   // m
constexpr double kLastGate = 1.0;                    // m, of fields; what lasts is measured within the first
constexpr double kCell = 1;                          // m
constexpr std::array<double, 3> kFinest{5, 10, 18};  // fields vary over such a part of the view, but
constexpr double kMinWidth = 2.5;                    // m at least
constexpr double kPriorPairs = 12;                   // with which a field holds to 0
constexpr int kRounds = 12;
constexpr double kMinGain = 0.97;         // of the distances of pairs held out, that must be left by fields that are kept
constexpr double kLag = 0.1;              // s, after which an error that is still there lasts
constexpr double kLatest = 0.6;           // s, likewise, at low rates
constexpr double kStill = 1, kSpeed = 6;  // m and m/s: how far who is seen goes in the meantime, with errors
constexpr double kMaxByChance = 0.2;      // of links
constexpr double kFew = 0.01;             // of the places lie beyond the grid on each side: some are near the horizon

constexpr double kChiSquareMedian = 1.386;  // of two degrees
constexpr std::size_t kMinRatios = 30;
constexpr double kMinNoise = 0.5, kMaxNoise = 3;
constexpr double kOwnErrors = 0.42;  // of a deviation, that is taken to last where it cannot be measured: gait, height, clothes

struct Detected {
  Vector<2> location;  // m, as the camera has it
  Matrix<2> covariance;
};

/// One instant: what each camera saw.
using Shot = std::vector<std::vector<Detected>>;

struct Pair {
  int a = 0, b = 0;  // cameras
  const Detected* of_a = nullptr;
  const Detected* of_b = nullptr;
};

/// One pair, and the same people's a little later.
struct Link {
  Pair first, second;
};

Shot shot_of(const GroundInstant& instant, int cameras) {
  Shot shot(static_cast<std::size_t>(cameras));
  for (const CameraObservations& view : instant.cameras) {
    for (const Observation<2>& one : view.detected) {
      if (!one.shared) shot[static_cast<std::size_t>(number(view.camera))].push_back({one.value, *one.covariance});
    }
  }
  return shot;
}

/// An instant, and a little later where there is one.
struct Shots {
  std::vector<Shot> first, later;
  std::vector<double> between;  // s; 0 where nothing is later
};

Shots shots_of(std::span<const GroundInstant> instants, int cameras) {
  Shots shots;
  const std::size_t step = std::max<std::size_t>(1, instants.size() / kMaxInstants);
  for (std::size_t k = 0; k < instants.size(); k += step) {
    shots.first.push_back(shot_of(instants[k], cameras));
    std::size_t next = k + 1;
    const auto after = [&](std::size_t i) { return seconds(instants[i].time - instants[k].time); };
    while (next < instants.size() && after(next) < 0.9 * kLag) ++next;
    const bool is_near = next < instants.size() && after(next) <= kLatest;
    shots.later.push_back(is_near ? shot_of(instants[next], cameras) : Shot(static_cast<std::size_t>(cameras)));
    shots.between.push_back(is_near ? after(next) : 0);
  }
  return shots;
}

class Agreeing {
 public:
  Agreeing(const Shots& shots, int cameras) : shots_(shots.first), all_(shots), cameras_(static_cast<std::size_t>(cameras)) {
    std::array<std::vector<double>, 2> all;
    for (const Shot& shot : shots_) {
      for (const std::vector<Detected>& camera : shot) {
        for (const Detected& one : camera) all[0].push_back(one.location.x()), all[1].push_back(one.location.y());
      }
    }
    const Vector<2> minimum(geometry::quantile(all[0], kFew), geometry::quantile(all[1], kFew)),
        maximum(geometry::quantile(all[0], 1 - kFew), geometry::quantile(all[1], 1 - kFew));
    grid_ = GroundGrid::over(minimum, maximum, kCell);
    extent_ = std::max(1.0, (maximum - minimum).maxCoeff());
    bias_.assign(cameras_, GroundField(grid_));
  }

  /// By the shots of odd or even blocks of time, or all.
  std::vector<GroundField> fields(std::optional<bool> odd, double finest_part) {
    bias_.assign(cameras_, GroundField(grid_));
    for (int round = 0; round < kRounds; ++round) {
      const double fraction = std::min(1.0, 1.5 * round / (kRounds - 1));
      const double finest = std::max(kMinWidth, extent_ / finest_part);
      improve(pairs(odd, kFirstGate + fraction * (kLastGate - kFirstGate)), extent_ * std::pow(finest / extent_, fraction));
    }
    return bias_;
  }

  /// Those who are each other's nearest, and plainly so.
  std::vector<Pair> pairs(std::optional<bool> odd, double gate) const {
    std::vector<Pair> found;
    for (std::size_t k = 0; k < shots_.size(); ++k) {
      if (odd && (k * kBlocks / shots_.size() % 2 == 1) != *odd) continue;
      pair_up(shots_[k], gate, found);
    }
    return found;
  }

  /// Pairs of one instant that are plainly the same people's a little later; or half of the recording later, where no person's are.
  std::vector<Link> links(double gate, bool by_chance) const {
    std::vector<Link> found;
    for (std::size_t k = 0; k < shots_.size(); ++k) {
      if (all_.between[k] == 0) continue;
      std::vector<Pair> now, later;
      pair_up(shots_[k], gate, now);
      pair_up(by_chance ? shots_[(k + shots_.size() / 2) % shots_.size()] : all_.later[k], gate, later);
      link_up(now, later, std::min(kStill + kSpeed * all_.between[k], gate), found);
    }
    return found;
  }

  Vector<2> difference(const Pair& pair) const { return located(pair.b, *pair.of_b) - located(pair.a, *pair.of_a); }

  void set(std::vector<GroundField> fields) { bias_ = std::move(fields); }
  const std::vector<GroundField>& fields() const { return bias_; }
  void forget() { bias_.assign(cameras_, GroundField(grid_)); }

 private:
  static constexpr std::size_t kBlocks = 10;  // of time, by turns learned from and held out

  Vector<2> located(int camera, const Detected& one) const {
    return one.location - bias_[static_cast<std::size_t>(camera)].at(one.location);
  }

  std::vector<std::vector<Vector<2>>> corrected(const Shot& shot) const {
    std::vector<std::vector<Vector<2>>> locations(cameras_);
    for (std::size_t c = 0; c < cameras_; ++c) {
      for (const Detected& one : shot[c]) locations[c].push_back(located(static_cast<int>(c), one));
    }
    return locations;
  }

  struct Nearest {
    std::size_t index = 0;
    double first = std::numeric_limits<double>::infinity(), second = first;  // m²

    /// Within the gate, and no other nearly as near.
    bool is_plain(double gate) const { return first <= gate * gate && second >= kDistinctly * kDistinctly * first; }
  };

  /// Who is farther than `kDistinctly` times the gate changes nothing.
  static Nearest nearest(const Vector<2>& location, const std::vector<Vector<2>>& among, double gate) {
    Nearest found;
    for (std::size_t i = 0; i < among.size(); ++i) {
      const Vector<2> apart = among[i] - location;
      if (std::abs(apart.x()) > kDistinctly * gate) continue;
      const double square = apart.squaredNorm();
      if (square < found.first) {
        found.second = found.first;
        found.first = square;
        found.index = i;
      } else {
        found.second = std::min(found.second, square);
      }
    }
    return found;
  }

  void pair_up(const Shot& shot, double gate, std::vector<Pair>& found) const {
    const std::vector<std::vector<Vector<2>>> locations = corrected(shot);
    for (std::size_t a = 0; a < cameras_; ++a) {
      for (std::size_t b = a + 1; b < cameras_; ++b) pair_up(shot, locations, a, b, gate, found);
    }
  }

  /// Where the two cameras of a pair together have it.
  Vector<2> middle(const Pair& pair) const { return (located(pair.a, *pair.of_a) + located(pair.b, *pair.of_b)) / 2; }

  /// Pairs of the same cameras that are each other's nearest, and plainly so. Pairs come by cameras.
  void link_up(const std::vector<Pair>& now, const std::vector<Pair>& later, double reach, std::vector<Link>& found) const {
    const auto of = [](const std::vector<Pair>& pairs, std::size_t from) {
      std::size_t to = from;
      while (to < pairs.size() && pairs[to].a == pairs[from].a && pairs[to].b == pairs[from].b) ++to;
      return std::span(pairs).subspan(from, to - from);
    };
    const auto middles = [this](std::span<const Pair> pairs) {
      std::vector<Vector<2>> all;
      for (const Pair& pair : pairs) all.push_back(middle(pair));
      return all;
    };
    for (std::size_t i = 0, j = 0; i < now.size() && j < later.size();) {
      const auto of_now = of(now, i), of_later = of(later, j);
      const std::pair first(now[i].a, now[i].b), second(later[j].a, later[j].b);
      if (first <= second) i += of_now.size();
      if (second <= first) j += of_later.size();
      if (first != second) continue;
      const std::vector<Vector<2>> from = middles(of_now), to = middles(of_later);
      for (std::size_t m = 0; m < from.size(); ++m) {
        const Nearest there = nearest(from[m], to, reach);
        if (!there.is_plain(reach)) continue;
        const Nearest back = nearest(to[there.index], from, reach);
        if (back.index == m && back.is_plain(reach)) found.push_back({of_now[m], of_later[there.index]});
      }
    }
  }

  void pair_up(const Shot& shot, const std::vector<std::vector<Vector<2>>>& locations, std::size_t a, std::size_t b, double gate,
               std::vector<Pair>& found) const {
    for (std::size_t i = 0; i < locations[a].size(); ++i) {
      const Nearest there = nearest(locations[a][i], locations[b], gate);
      if (!there.is_plain(gate)) continue;
      const Nearest back = nearest(locations[b][there.index], locations[a], gate);
      if (back.index != i || !back.is_plain(gate)) continue;
      found.push_back({static_cast<int>(a), static_cast<int>(b), &shot[a][i], &shot[b][there.index]});
    }
  }

  /// Each camera of a pair comes half of the distance to the other.
  void improve(const std::vector<Pair>& pairs, double sigma) {
    std::vector<std::array<std::vector<double>, 3>> sums(cameras_);
    for (auto& of : sums) of.fill(std::vector<double>(grid_.size(), 0));
    for (const Pair& pair : pairs) {
      const Vector<2> half = difference(pair) / 2;
      const double spread = pair.of_a->covariance.trace() + pair.of_b->covariance.trace();
      const double weight = 0.1 / (0.1 + spread);
      const auto add = [&](int camera, const Vector<2>& location, const Vector<2>& error) {
        auto& of = sums[static_cast<std::size_t>(camera)];
        const std::size_t cell = grid_.index(location);
        of[0][cell] += weight * error.x();
        of[1][cell] += weight * error.y();
        of[2][cell] += weight;
      };
      add(pair.a, pair.of_a->location, -half);
      add(pair.b, pair.of_b->location, half);
    }
    for (std::size_t c = 0; c < cameras_; ++c) {
      for (auto& sum : sums[c]) sum = spread_over(grid_, sum, sigma);
      for (std::size_t cell = 0; cell < grid_.size(); ++cell)
        bias_[c].add(cell, Vector<2>(sums[c][0][cell], sums[c][1][cell]) / (sums[c][2][cell] + kPriorPairs));
    }
  }

  const std::vector<Shot>& shots_;
  const Shots& all_;
  std::size_t cameras_;
  GroundGrid grid_;
  double extent_ = 1;
  std::vector<GroundField> bias_;
};

double median_distance(const Agreeing& agreeing, bool odd) {
  std::vector<double> distances;
  for (const Pair& pair : agreeing.pairs(odd, kFirstGate)) distances.push_back(agreeing.difference(pair).norm());
  return distances.empty() ? 0 : geometry::quantile(distances, 0.5);
}

/// How finely fields vary that best bring pairs together which they were not learned from; nothing if none is worth it.
std::optional<double> best_part(Agreeing& agreeing) {
  agreeing.forget();
  double minimum = kMinGain * (median_distance(agreeing, false) + median_distance(agreeing, true));
  std::optional<double> best;
  for (const double part : kFinest) {
    double left = 0;
    for (const bool odd : {false, true}) {
      agreeing.set(agreeing.fields(odd, part));
      left += median_distance(agreeing, !odd);
    }
    if (left >= minimum) continue;
    minimum = left;
    best = part;
  }
  return best;
}

/// From single instants: by camera what its deviations are to be multiplied by, and of all errors the share that is taken to last.
LastingDisagreement of_single_instants(const Agreeing& agreeing, int cameras) {
  std::vector<double> squares;
  std::vector<std::vector<double>> ratios(static_cast<std::size_t>(cameras));
  for (const Pair& pair : agreeing.pairs({}, kLastGate)) {
    const Vector<2> apart = agreeing.difference(pair);
    const Matrix<2> S = pair.of_a->covariance + pair.of_b->covariance;
    const double ratio = apart.dot(S.inverse() * apart);
    squares.push_back(apart.squaredNorm());
    ratios[static_cast<std::size_t>(pair.a)].push_back(ratio);
    ratios[static_cast<std::size_t>(pair.b)].push_back(ratio);
  }
  LastingDisagreement found;
  for (std::vector<double>& of : ratios) {
    const bool enough = of.size() >= kMinRatios;
    found.noise.push_back(enough ? std::clamp(std::sqrt(geometry::quantile(of, 0.5) / kChiSquareMedian), kMinNoise, kMaxNoise)
                                 : 1.0);
  }
  found.deviation = kOwnErrors * std::sqrt(geometry::quantile(squares, 0.5) / kChiSquareMedian / 2);  // of two cameras
  return found;
}

/// Where people cannot be linked (too few, or a crowd at a low rate, in which as many are linked to people of another time) a share
/// of all errors is taken to last.
LastingDisagreement lasting_of(const Agreeing& agreeing, int cameras) {
  std::vector<LinkedDifferences> differences;
  const std::vector<Link> links = agreeing.links(kFirstGate, false);
  for (const auto& [first, second] : links) {
    differences.push_back({first.a, first.b, agreeing.difference(first), agreeing.difference(second),
                           first.of_a->covariance + first.of_b->covariance + second.of_a->covariance + second.of_b->covariance});
  }
  const LastingDisagreement lasting = lasting_disagreement(differences, cameras);
  const auto by_chance = static_cast<double>(agreeing.links(kFirstGate, true).size());
  const bool linked = lasting.deviation && by_chance <= kMaxByChance * static_cast<double>(links.size());
  return linked ? lasting : of_single_instants(agreeing, cameras);
}

}  // namespace

CameraBias CameraBias::learn(std::span<const GroundInstant> instants, int cameras) {
  CameraBias agreement;
  if (cameras < 2 || instants.empty()) return agreement;
  const Shots shots = shots_of(instants, cameras);
  Agreeing agreeing(shots, cameras);
  if (agreeing.pairs({}, kFirstGate).size() < kMinPairCount) return agreement;
  if (const std::optional<double> part = best_part(agreeing)) {
    agreement.bias_ = agreeing.fields({}, *part);
  } else {
    agreeing.forget();
  }
  const LastingDisagreement lasting = lasting_of(agreeing, cameras);
  agreement.noise_ = lasting.noise;
  agreement.disagreement_ = lasting.deviation;
  return agreement;
}

Observation<2> CameraBias::corrected(Observation<2> detected) const {
  const auto camera = static_cast<std::size_t>(number(detected.camera));
  if (!bias_.empty()) detected.value -= bias_[camera].at(detected.value);
  if (!noise_.empty()) *detected.covariance *= noise_[camera] * noise_[camera];
  return detected;
}

}  // namespace marey::track::ground
