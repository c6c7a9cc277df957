#include "marey/solve/labels/initialise_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "marey/assign/no_index.h"
#include "marey/solve/labels/four_points.h"

namespace marey::solve::labels {
namespace {

using assign::kNoIndex;

constexpr double kRigid = 0.005;                               // m: what varies less has a side that stays
constexpr double kRigidFraction = 0.5;                         // of its height, at most
constexpr double kSideShift = 0.015, kSideFraction = 0.06;     // m, and of a distance: by how much it may be another than learned
constexpr std::size_t kSideNeighbours = 8;                     // of each name that sides are taken of
constexpr std::size_t kMinDistance = 6;                        // neighbours whose directions count
constexpr double kDirectionTop = 0.5, kDirectionFloor = -1.5;  // log-likelihood ratio of a direction
constexpr double kMinDirection = 0.01;                         // m, of its deviation
constexpr std::size_t kNoPerson = std::numeric_limits<std::size_t>::max();
constexpr int kSweeps = 6;  // of exchanges

/// Whether a height is that of the mirror image: what is nearly a plane, or higher by far, says nothing.
bool is_mirrored(double height, double learned) {
  return height * learned < 0 && std::abs(height) > 0.5 * std::abs(learned) && std::abs(height) < 2.5 * std::abs(learned);
}

/// Four names, in rising order, that are not plane.
struct Side {
  std::array<std::size_t, 4> names{};
  double height = 0;  // m, where the set was learned
};

class Beam {
 public:
  Beam(const InitialiseScene& scene, const LearnedMarkers& learned, const DistanceModel& model, const LabelInitOptions& options,
       const std::optional<Matrix<3>>& learned_from_scene)
      : scene_(scene), learned_(learned), model_(model), options_(options), turn_(learned_from_scene), sides_(model.size()) {
    if (turn_) find_nearest();
    find_sides();
  }

  double side_cost_of(const LabelHypothesis& answer, std::size_t name) const {
    const int point = answer.point_of[name];
    return point == kNoIndex ? 0 : side_cost(answer, name, static_cast<std::size_t>(point), kNoPerson);
  }

  LabelHypothesis run() {
    std::vector<LabelHypothesis> answers(1);
    answers[0].point_of.assign(model_.size(), kNoIndex);
    std::vector<std::size_t> before;
    for (const std::size_t name : model_.order()) {
      extend(answers, name, before);
      before.push_back(name);
    }
    LabelHypothesis best = answers.front();
    interchange(best);
    return best;
  }

 private:
  std::size_t points() const { return scene_.locations.size(); }

  bool has_position(std::size_t name) const { return !learned_.locations[name].isZero(0); }

  /// Fours of neighbours that stand high over each other.
  void find_sides() {
    std::set<std::array<std::size_t, 4>> tried;
    for (std::size_t name = 0; name < model_.size(); ++name) {
      std::vector<std::size_t> near;
      for (const std::size_t other : model_.partners(name)) {
        if (near.size() < kSideNeighbours && has_position(other)) near.push_back(other);
      }
      if (!has_position(name)) continue;
      for (std::size_t i = 2; i < near.size(); ++i) {
        for (std::size_t j = 1; j < i; ++j) {
          for (std::size_t k = 0; k < j; ++k) {
            std::array<std::size_t, 4> names{name, near[i], near[j], near[k]};
            std::sort(names.begin(), names.end());
            if (tried.insert(names).second) add_side(names);
          }
        }
      }
    }
  }

  void add_side(const std::array<std::size_t, 4>& names) {
    const auto& locations = learned_.locations;
    const double height = signed_height({locations[names[0]], locations[names[1]], locations[names[2]], locations[names[3]]});
    if (std::abs(height) < options_.height) return;
    for (const std::size_t name : names) sides_[name].push_back({names, height});
  }

  /// Whether two names' points are on one segment: they keep their distance, and it is the learned one, or one that an exchange
  /// among neighbours makes of it.
  bool is_rigid(std::size_t name, std::size_t other, std::size_t point, std::size_t its, double height) const {
    const DistanceObserved& detected = scene_.between(point, its);
    const double maximum = std::min(kRigid, kRigidFraction * height), mean = model_.mean(name, other);
    return detected.variance < maximum * maximum &&
           std::abs(detected.mean - mean) < model_.tolerance(name, other, kSideShift + kSideFraction * mean);
  }

  /// What the sides cost on which the points lie that `name` and its neighbours have; those of which `besides` is one are omitted.
  double side_cost(const LabelHypothesis& answer, std::size_t name, std::size_t point, std::size_t besides) const {
    double cost = 0;
    for (const Side& side : sides_[name]) {
      std::array<std::size_t, 4> its{};
      bool known = true;
      for (std::size_t i = 0; i < 4 && known; ++i) {
        const std::size_t other = side.names[i];
        its[i] = other == name ? point : static_cast<std::size_t>(answer.point_of[other]);
        known = other != besides && (other == name || answer.point_of[other] != kNoIndex);
        for (std::size_t j = 0; j < i && known; ++j) known = is_rigid(other, side.names[j], its[i], its[j], std::abs(side.height));
      }
      if (!known) continue;
      const double height =
          signed_height({scene_.locations[its[0]], scene_.locations[its[1]], scene_.locations[its[2]], scene_.locations[its[3]]});
      if (is_mirrored(height, side.height)) cost += options_.wrong_side;
    }
    return cost;
  }

  void find_nearest() {
    nearest_.resize(model_.size());
    for (std::size_t name = 0; name < model_.size(); ++name) {
      const Vector<3>& location = learned_.locations[name];
      if (location.isZero(0)) continue;
      for (std::size_t other = 0; other < model_.size(); ++other) {
        if (other != name && !learned_.locations[other].isZero(0)) nearest_[name].push_back(other);
      }
      std::stable_sort(nearest_[name].begin(), nearest_[name].end(), [&](std::size_t a, std::size_t b) {
        return (learned_.locations[a] - location).norm() < (learned_.locations[b] - location).norm();
      });
      if (nearest_[name].size() > kMinDistance) nearest_[name].resize(kMinDistance);
    }
  }

  /// How well the vectors from its neighbours fit the learned posture.
  double direction_gain(const LabelHypothesis& answer, std::size_t name, std::size_t point) const {
    double sum = 0;
    for (const std::size_t other : nearest_[name]) {
      if (answer.point_of[other] == kNoIndex) continue;
      const Vector<3> expected = learned_.locations[name] - learned_.locations[other];
      const Vector<3> detected =
          *turn_ * (scene_.locations[point] - scene_.locations[static_cast<std::size_t>(answer.point_of[other])]);
      const double deviation = options_.direction * expected.norm() + kMinDirection;
      sum += std::max(kDirectionTop - (detected - expected).squaredNorm() / (2 * deviation * deviation), kDirectionFloor);
    }
    return sum;
  }

  /// Without what sides cost: no less than the whole.
  double max_gain(const LabelHypothesis& answer, std::size_t name, std::size_t point,
                  const std::vector<std::size_t>& others) const {
    double sum = 0;
    for (const std::size_t other : others) {
      const int its = answer.point_of[other];
      if (its != kNoIndex && other != name) sum += model_.ratio(name, other, scene_.between(point, static_cast<std::size_t>(its)));
    }
    if (turn_) sum += direction_gain(answer, name, point);
    return sum;
  }

  struct Next {
    double score;
    std::size_t answer;
    int point;
    bool whole;  // or what its sides cost is still to be counted
    bool operator<(const Next& other) const {
      return std::tie(score, other.answer, other.point) < std::tie(other.score, answer, point);
    }
  };

  /// How well the distance between each two points fits the name and each of those before it: by the one before, its point, the
  /// name's point.
  void tabulate(std::size_t name, const std::vector<std::size_t>& before) {
    ratios_.assign(before.size() * points() * points(), 0);
    for (std::size_t k = 0; k < before.size(); ++k) {
      for (std::size_t its = 0; its < points(); ++its) {
        double* row = &ratios_[(k * points() + its) * points()];
        for (std::size_t point = 0; point < points(); ++point) {
          if (point != its) row[point] = model_.ratio(name, before[k], scene_.between(point, its));
        }
      }
    }
  }

  /// All continuations of one answer, without what sides cost.
  void continue_with(const std::vector<LabelHypothesis>& answers, std::size_t a, std::size_t name,
                     const std::vector<std::size_t>& before, std::vector<Next>& nexts) const {
    const LabelHypothesis& answer = answers[a];
    std::vector<char> taken(points(), 0);
    std::vector<double> gains(points(), 0);
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (answer.point_of[before[k]] == kNoIndex) continue;
      const auto its = static_cast<std::size_t>(answer.point_of[before[k]]);
      taken[its] = 1;
      const double* row = &ratios_[(k * points() + its) * points()];
      for (std::size_t point = 0; point < points(); ++point) gains[point] += row[point];
    }
    nexts.push_back({answer.score, a, kNoIndex, true});
    for (std::size_t point = 0; point < points(); ++point) {
      if (taken[point]) continue;
      const double gain = gains[point] + (turn_ ? direction_gain(answer, name, point) : 0);
      nexts.push_back({answer.score + gain, a, static_cast<int>(point), before.size() < 3});
    }
  }

  void extend(std::vector<LabelHypothesis>& answers, std::size_t name, const std::vector<std::size_t>& before) {
    tabulate(name, before);
    std::vector<Next> nexts;
    for (std::size_t a = 0; a < answers.size(); ++a) continue_with(answers, a, name, before, nexts);
    // While barely anything is known, many answers are alike: more of them are kept.
    const std::size_t maximum = static_cast<std::size_t>(options_.answers) * (before.size() < 4 ? 8 : before.size() < 8 ? 2 : 1);
    std::make_heap(nexts.begin(), nexts.end());
    std::vector<LabelHypothesis> extended;
    while (!nexts.empty() && extended.size() < maximum) {  // sides cost time: they are asked of the best alone
      std::pop_heap(nexts.begin(), nexts.end());
      Next& next = nexts.back();
      if (!next.whole) {
        next.score -= side_cost(answers[next.answer], name, static_cast<std::size_t>(next.point), kNoPerson);
        next.whole = true;
        std::push_heap(nexts.begin(), nexts.end());
        continue;
      }
      LabelHypothesis& answer = extended.emplace_back(answers[next.answer]);
      answer.score = next.score;
      answer.point_of[name] = next.point;
      nexts.pop_back();
    }
    answers = std::move(extended);
  }

  /// Moves single names to free points, and exchanges two, as long as that gains.
  void interchange(LabelHypothesis& answer) {
    count_scores(answer);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      bool changed = false;
      std::vector<int> name_of(points(), kNoIndex);
      for (std::size_t name = 0; name < model_.size(); ++name) {
        if (answer.point_of[name] != kNoIndex) name_of[static_cast<std::size_t>(answer.point_of[name])] = static_cast<int>(name);
      }
      for (std::size_t name = 0; name < model_.size(); ++name) {
        for (int point = kNoIndex; point < static_cast<int>(points()); ++point) {
          if (point == answer.point_of[name]) continue;
          const int holder = point == kNoIndex ? kNoIndex : name_of[static_cast<std::size_t>(point)];
          if (try_swap(answer, name, point, holder)) {
            changed = true;
            std::fill(name_of.begin(), name_of.end(), kNoIndex);
            for (std::size_t n = 0; n < model_.size(); ++n) {
              if (answer.point_of[n] != kNoIndex) name_of[static_cast<std::size_t>(answer.point_of[n])] = static_cast<int>(n);
            }
          }
        }
      }
      if (!changed) return;
    }
  }

  double merit(const LabelHypothesis& answer, std::size_t name, std::size_t besides = kNoPerson) const {
    if (answer.point_of[name] == kNoIndex) return 0;
    const auto point = static_cast<std::size_t>(answer.point_of[name]);
    return max_gain(answer, name, point, model_.order()) - side_cost(answer, name, point, besides);
  }

  /// What the name's point is worth at most, and the holder's, if there is one; what both have of each other counts once.
  double score_upper_bound(const LabelHypothesis& answer, std::size_t name, int holder) const {
    const auto of = [&](std::size_t each) {
      if (answer.point_of[each] == kNoIndex) return 0.0;
      return max_gain(answer, each, static_cast<std::size_t>(answer.point_of[each]), model_.order());
    };
    if (holder == kNoIndex) return of(name);
    return of(name) + of(static_cast<std::size_t>(holder)) - between_both(answer, name, static_cast<std::size_t>(holder));
  }

  double between_both(const LabelHypothesis& answer, std::size_t name, std::size_t other) const {
    if (answer.point_of[name] == kNoIndex || answer.point_of[other] == kNoIndex) return 0;
    return model_.ratio(
        name, other,
        scene_.between(static_cast<std::size_t>(answer.point_of[name]), static_cast<std::size_t>(answer.point_of[other])));
  }

  double score_of_both(const LabelHypothesis& answer, std::size_t name, int holder) const {
    if (holder == kNoIndex) return merit(answer, name);
    const auto other = static_cast<std::size_t>(holder);
    return merit(answer, name) + merit(answer, other, name) - between_both(answer, name, other);
  }

  bool try_swap(LabelHypothesis& answer, std::size_t name, int point, int holder) {
    const int was = answer.point_of[name];
    const auto put = [&](int its, int holders) {
      answer.point_of[name] = its;
      if (holder != kNoIndex) answer.point_of[static_cast<std::size_t>(holder)] = holders;
    };
    // What it is worth now is no less than this: of the holder's sides those count twice of which the name is one.
    double minimum = score_now_[name];
    if (holder != kNoIndex)
      minimum += score_now_[static_cast<std::size_t>(holder)] - between_both(answer, name, static_cast<std::size_t>(holder));
    put(point, was);
    const double maximum = score_upper_bound(answer, name, holder);
    put(was, point);
    if (maximum <= minimum + 1e-9) return false;
    const double before = score_of_both(answer, name, holder);
    put(point, was);
    const double after = score_of_both(answer, name, holder);
    if (after > before + 1e-9) {
      answer.score += after - before;
      count_scores(answer);
      return true;
    }
    put(was, point);
    return false;
  }

  void count_scores(const LabelHypothesis& answer) {
    score_now_.resize(model_.size());
    for (std::size_t name = 0; name < model_.size(); ++name) score_now_[name] = merit(answer, name);
  }

  const InitialiseScene& scene_;
  const LearnedMarkers& learned_;
  const DistanceModel& model_;
  const LabelInitOptions& options_;
  std::optional<Matrix<3>> turn_;
  std::vector<std::vector<std::size_t>> nearest_;  // by name, where directions count
  std::vector<std::vector<Side>> sides_;
  std::vector<double> ratios_;     // of the name at hand
  std::vector<double> score_now_;  // of each name, where single ones are exchanged
};

}  // namespace

struct SideCosts::Parts {
  InitialiseScene scene;
  Beam beam;
  LabelHypothesis answer = {};

  Parts(InitialiseScene its, const LearnedMarkers& learned, const DistanceModel& model, const LabelInitOptions& options)
      : scene(std::move(its)), beam(scene, learned, model, options, std::nullopt) {}
};

SideCosts::SideCosts(InitialiseScene scene, const LearnedMarkers& learned, const DistanceModel& model,
                     const LabelInitOptions& options)
    : parts_(std::make_unique<Parts>(std::move(scene), learned, model, options)) {}
SideCosts::~SideCosts() = default;
SideCosts::SideCosts(SideCosts&&) noexcept = default;

double SideCosts::of(const std::vector<int>& point_of, std::size_t name) const {
  parts_->answer.point_of = point_of;
  return parts_->beam.side_cost_of(parts_->answer, name);
}

LabelHypothesis initialise_labels(const InitialiseScene& scene, const LearnedMarkers& learned, const DistanceModel& model,
                                  const LabelInitOptions& options, const std::optional<Matrix<3>>& learned_from_scene) {
  return Beam(scene, learned, model, options, learned_from_scene).run();
}

}  // namespace marey::solve::labels
