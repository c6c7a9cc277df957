#include "marey/solve/labels/check_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "marey/assign/no_index.h"
#include "marey/geometry/layout.h"
#include "marey/geometry/median.h"

namespace marey::solve::labels {
namespace {

using assign::kNoIndex;

constexpr std::size_t kNear = 6;        // neighbours with which names are exchanged
constexpr std::size_t kMaxRow = 5;      // names that shift by one at once
constexpr double kLooseFraction = 0.2;  // of a distance that is not among the tightest
constexpr std::size_t kSideInstants = 5;
constexpr int kMaxChanges = 40;
constexpr std::size_t kTightest = 3;

using Holders = std::vector<int>;  // by name: whose points it has

class Check {
 public:
  Check(const NamedChains& chains, const LearnedMarkers& learned, const DistanceModel& model, const LabelInitOptions& options,
        std::size_t neighbours, double margin)
      : options_(options),
        learned_(learned),
        model_(model),
        detected_(chains.named_distances()),
        neighbours_(neighbours),
        margin_(margin),
        holders_(model.size(), kNoIndex) {
    for (std::size_t name = 0; name < model.size(); ++name) {
      for (std::size_t other = 0; other < model.size(); ++other) {
        if (other != name && between(name, other).count > 0) holders_[name] = static_cast<int>(name);
      }
    }
    add_sides(chains, learned, options);
    near_.resize(model.size());
    for (std::size_t name = 0; name < model.size(); ++name) {
      const auto& partners = model.partners(name);
      near_[name].assign(partners.begin(), partners.begin() + static_cast<std::ptrdiff_t>(std::min(kNear, partners.size())));
    }
  }

  CheckedNames run() {
    for (int change = 0; change < kMaxChanges; ++change) {
      best_ = {};
      try_all();
      if (!(best_.loss < -1e-6)) break;
      holders_ = best_.holders;
    }
    undecided_.assign(model_.size(), kNoIndex);
    marking_ = true;
    try_all();
    return {holders_, undecided_};
  }

 private:
  struct Best {
    double loss = 0;
    Holders holders;
  };

  const DistanceObserved& between(std::size_t a, std::size_t b) const { return detected_[LearnedMarkers::index_of(a, b)]; }

  void add_sides(const NamedChains& chains, const LearnedMarkers& learned, const LabelInitOptions& options) {
    for (std::size_t part = 0; part < kSideInstants; ++part) {
      const std::size_t begin = part * chains.instants() / kSideInstants, end = (part + 1) * chains.instants() / kSideInstants;
      std::size_t best = begin, maximum = 0;
      for (std::size_t instant = begin; instant < end; instant += std::max<std::size_t>(1, (end - begin) / 20)) {
        std::size_t count = 0;
        for (std::size_t name = 0; name < model_.size(); ++name) count += chains.holder(instant, name).chain != kNoIndex;
        if (count > maximum) maximum = count, best = instant;
      }
      if (maximum < 4) continue;
      auto& posture = postures_.emplace_back(model_.size());
      InitialiseScene scene;
      std::vector<int> point_of(model_.size(), kNoIndex);
      std::vector<std::size_t> names;
      for (std::size_t name = 0; name < model_.size(); ++name) {
        if (chains.holder(best, name).chain == kNoIndex) continue;
        point_of[name] = static_cast<int>(names.size());
        for (const std::size_t other : names) scene.detected.push_back(between(name, other));
        names.push_back(name);
        posture[name] = chains.holder(best, name).location;
        scene.locations.push_back(chains.holder(best, name).location);
      }
      sides_.push_back({std::make_unique<SideCosts>(std::move(scene), learned, model_, options), std::move(point_of)});
    }
  }

  /// How well a name fits the points that it has.
  double fit(const Holders& holders, std::size_t name) const {
    if (holders[name] == kNoIndex) return 0;
    const auto its = static_cast<std::size_t>(holders[name]);
    double sum = 0;
    std::size_t requested = 0;
    for (const std::size_t other : model_.partners(name)) {
      if (holders[other] == kNoIndex) continue;
      const DistanceObserved& detected = between(its, static_cast<std::size_t>(holders[other]));
      if (detected.count == 0) continue;
      sum += (requested++ < neighbours_ ? 1 : kLooseFraction) * model_.ratio(name, other, detected);
    }
    return sum;
  }

  double side_cost(const Holders& holders, std::span<const std::size_t> moved) const {
    double sum = 0;
    for (const auto& [costs, point_of] : sides_) {
      std::vector<int> points(holders.size(), kNoIndex);
      for (std::size_t name = 0; name < holders.size(); ++name) {
        if (holders[name] != kNoIndex) points[name] = point_of[static_cast<std::size_t>(holders[name])];
      }
      for (const std::size_t name : moved) sum += costs->of(points, name);
    }
    return sides_.empty() ? 0 : sum / static_cast<double>(sides_.size());
  }

  bool has_posture(std::size_t name) const { return !learned_.locations[name].isZero(0); }

  /// The names that have points and are not among `moved`, the nearest to these in the learned posture first; none if the posture
  /// has none of `moved`.
  std::vector<std::size_t> neighbours_in_posture(std::span<const std::size_t> moved) const {
    Vector<3> centre = Vector<3>::Zero();
    double known = 0;
    for (const std::size_t name : moved) {
      if (!has_posture(name)) continue;
      centre += learned_.locations[name];
      ++known;
    }
    if (known == 0) return {};
    centre /= known;
    std::vector<std::size_t> near;
    for (std::size_t name = 0; name < model_.size(); ++name) {
      if (holders_[name] == kNoIndex || !has_posture(name) || std::find(moved.begin(), moved.end(), name) != moved.end()) continue;
      near.push_back(name);
    }
    std::stable_sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
      return (learned_.locations[a] - centre).norm() < (learned_.locations[b] - centre).norm();
    });
    return near;
  }

  /// What it costs that points lie elsewhere about their neighbours than in the learned posture: `other` against now.
  double posture_loss(const Holders& other, std::span<const std::size_t> moved) const {
    const std::vector<std::size_t> near = neighbours_in_posture(moved);
    double sum = 0;
    for (const auto& posture : postures_) {
      std::vector<Vector<3>> from, to;
      for (const std::size_t name : near) {
        const auto& location = posture[static_cast<std::size_t>(holders_[name])];
        if (!location) continue;
        from.push_back(*location), to.push_back(learned_.locations[name]);
        if (from.size() == options_.posture_neighbours) break;
      }
      if (from.size() < 4) continue;
      const Rigid3 fit = geometry::rigid_fit(from, to);
      double square = 0;
      Vector<3> middle = Vector<3>::Zero();
      for (std::size_t i = 0; i < from.size(); ++i)
        square += (fit * from[i] - to[i]).squaredNorm() / static_cast<double>(from.size()),
            middle += to[i] / static_cast<double>(from.size());
      const auto cost = [&](const Holders& holders) {
        double its = 0;
        for (const std::size_t name : moved) {
          if (holders[name] == kNoIndex || !has_posture(name)) continue;
          const auto& location = posture[static_cast<std::size_t>(holders[name])];
          if (!location) continue;
          const double variance = square + options_.posture * options_.posture * (learned_.locations[name] - middle).squaredNorm();
          its += std::min((fit * *location - learned_.locations[name]).squaredNorm() / (2 * variance), options_.posture_max);
        }
        return its;
      };
      sum += cost(other) - cost(holders_);
    }
    return options_.posture_weight * sum / static_cast<double>(std::max<std::size_t>(1, postures_.size()));
  }

  /// The loss if each of `moved` gets the points of the next, and the last those of the first; or, if the first has none, the
  /// last gets none.
  void try_ring(std::span<const std::size_t> moved) {
    try_change([&](Holders& holders) { turn(holders, moved); }, moved);
  }

  void turn(Holders& holders, std::span<const std::size_t> ring) const {
    const int first = holders_[ring.front()];
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) holders[ring[i]] = holders_[ring[i + 1]];
    holders[ring.back()] = first;
  }

  template <typename Change>
  void try_change(const Change& change, std::span<const std::size_t> moved) {
    Holders other = holders_;
    change(other);
    double loss = 0;
    for (const std::size_t name : moved) loss += fit(holders_, name) - fit(other, name);
    if (loss > (marking_ ? margin_ : 0) + 1000) return;
    loss += side_cost(other, moved) - side_cost(holders_, moved) + posture_loss(other, moved);
    if (marking_) {
      if (loss < margin_) mark(other, moved);
    } else if (loss < best_.loss) {
      best_ = {loss, std::move(other)};
    }
  }

  void mark(const Holders& other, std::span<const std::size_t> moved) {
    for (const std::size_t name : moved) {
      if (holders_[name] == kNoIndex || undecided_[name] != kNoIndex) continue;
      const auto its = std::find(other.begin(), other.end(), holders_[name]);
      undecided_[name] = its == other.end() ? static_cast<int>(name) : static_cast<int>(its - other.begin());
    }
  }

  void try_all() {
    for (std::size_t a = 0; a < model_.size(); ++a) {
      if (holders_[a] == kNoIndex) {
        std::vector<std::size_t> row{a};
        try_rows(row);
        continue;
      }
      for (std::size_t b = 0; b < a; ++b) {
        if (holders_[b] != kNoIndex) try_ring(std::array{a, b});
      }
      for (const std::size_t b : near_[a]) {
        for (const std::size_t c : near_[b]) {
          if (c != a && holders_[b] != kNoIndex && holders_[c] != kNoIndex) try_ring(std::array{a, b, c});
        }
      }
      try_two_pairs(a);
    }
  }

  /// A cluster turned over: two pairs of neighbours at once.
  void try_two_pairs(std::size_t a) {
    for (const std::size_t b : near_[a]) {
      for (const std::size_t c : near_[a]) {
        for (const std::size_t d : near_[a]) {
          if (b >= a || c >= d || b == c || b == d) continue;
          if (holders_[b] == kNoIndex || holders_[c] == kNoIndex || holders_[d] == kNoIndex) continue;
          const std::array moved{a, b, c, d};
          try_change(
              [&](Holders& holders) {
                turn(holders, std::span(moved).first(2));
                turn(holders, std::span(moved).last(2));
              },
              moved);
        }
      }
    }
  }

  /// The first of a row has no points: it gets those of the next, and so on; the last is left without.
  void try_rows(std::vector<std::size_t>& row) {
    if (row.size() > 1) try_ring(row);
    if (row.size() > kMaxRow) return;
    for (const std::size_t next : near_[row.back()]) {
      if (holders_[next] == kNoIndex || std::find(row.begin(), row.end(), next) != row.end()) continue;
      row.push_back(next);
      try_rows(row);
      row.pop_back();
    }
  }

  LabelInitOptions options_;
  const LearnedMarkers& learned_;
  const DistanceModel& model_;
  std::vector<DistanceObserved> detected_;  // by those whose points they are
  std::size_t neighbours_;
  double margin_;
  Holders holders_;
  std::vector<std::vector<std::size_t>> near_;
  std::vector<std::vector<std::optional<Vector<3>>>> postures_;  // at the same instants, by those whose points they are
  std::vector<std::pair<std::unique_ptr<SideCosts>, std::vector<int>>> sides_;  // at some instants, with the points by name
  Best best_;
  bool marking_ = false;
  std::vector<int> undecided_;
};

}  // namespace

CheckedNames check_names(const NamedChains& chains, const LearnedMarkers& learned, const DistanceModel& learned_model,
                         const LabelInitOptions& options, std::size_t neighbours, double margin) {
  return Check(chains, learned, learned_model, options, neighbours, margin).run();
}

Misfit misfit_of(const std::vector<DistanceObserved>& named, const DistanceModel& learned_model) {
  std::vector<double> ratios, off;
  for (std::size_t name = 0; name < learned_model.size(); ++name) {
    std::size_t requested = 0;
    for (const std::size_t other : learned_model.partners(name)) {
      const DistanceObserved& detected = named[LearnedMarkers::index_of(name, other)];
      const auto deviation = learned_model.rigid_deviation(name, other, detected);
      if (detected.count == 0 || !deviation) continue;
      off.push_back(std::abs(detected.mean - learned_model.mean(name, other)));
      ratios.push_back(off.back() / *deviation);
      if (++requested == kTightest) break;
    }
  }
  if (off.empty()) return {};
  constexpr double kMedianOfNormal = 0.6745;
  return {.ratio = geometry::median(ratios) / kMedianOfNormal, .off_m = geometry::median(off)};
}

}  // namespace marey::solve::labels
