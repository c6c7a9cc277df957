// Where names begin: instants of which most of the set is recognised at once.
#include <algorithm>
#include <cmath>

#include "marey/core/error.h"
#include "marey/geometry/layout.h"
#include "marey/solve/labels/labelling.h"

namespace marey::solve::labels {
namespace {

using assign::kNoIndex;

constexpr double kInitialiseS = 0.15;    // s: a chain that a name is searched for from nothing is at least this long
constexpr double kMinInitialised = 0.4;  // of the set's markers, below which nothing is reported
constexpr std::size_t kMaxPointsToInitialise = 160;

std::pair<double, double> extent_of(std::vector<double> heights) {
  std::sort(heights.begin(), heights.end());
  return {heights[heights.size() / 20], heights[heights.size() - 1 - heights.size() / 20]};
}

}  // namespace

/// Instants at which long chains are many, spread over the recording.
std::vector<std::size_t> Labelling::initialise_instants(int count) const {
  const auto merit = [&](std::size_t instant) {
    double sum = 0;
    for (const auto& point : chains_.at(instant))
      sum += std::min(chains_.chains()[static_cast<std::size_t>(point.chain)].points, 200);
    return sum;
  };
  std::vector<std::size_t> best;
  const auto parts = static_cast<std::size_t>(count);
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * chains_.instants() / parts, end = (part + 1) * chains_.instants() / parts;
    std::size_t its = begin;
    double maximum = -1;
    const std::size_t step = std::max<std::size_t>(1, (end - begin) / 50);
    for (std::size_t i = begin; i < end; i += step) {
      if (const double value = merit(i); value > maximum) maximum = value, its = i;
    }
    if (begin < end) best.push_back(its);
  }
  return best;
}

/// Sizes of the subject that come into question: by how high it reaches, against the posture it was learned in.
std::vector<double> Labelling::scales(std::size_t instant) const {
  if (!is_scaled()) return {1};
  std::vector<double> here, there;
  for (const auto& point : chains_.at(instant)) here.push_back(point.location.z());
  for (const Vector<3>& location : learned_.locations) there.push_back(location.z());
  if (here.size() < 4) return {1};
  const auto [low, high] = extent_of(here);
  const auto [learned_low, learned_high] = extent_of(there);
  const double ratio = std::clamp((high - low) / std::max(learned_high - learned_low, 0.1), 0.5, 2.0);
  return {ratio, 0.95 * ratio, 1.05 * ratio, 0.9 * ratio, 1.1 * ratio};
}

/// If the learned model stems from others, their posture distinguishes left and right: how that lies to the subject as it was named
/// first. (One's own posture, standing still, is less informative than one's own distances.)
std::optional<Matrix<3>> Labelling::turn_to_learned(const InitialiseScene& scene, const LabelHypothesis& answer) const {
  if (!is_scaled()) return std::nullopt;
  std::vector<Vector<3>> from, to;
  for (std::size_t name = 0; name < learned_.size(); ++name) {
    if (answer.point_of[name] == kNoIndex || learned_.locations[name].isZero(0)) continue;
    from.push_back(scene.locations[static_cast<std::size_t>(answer.point_of[name])]);
    to.push_back(learned_.locations[name]);
  }
  if (from.size() < 4) return std::nullopt;
  return geometry::rigid_fit(from, to).rotation;
}

/// Once more, with what the first answer says of directions and, where that was not learned, of what is rigid.
LabelHypothesis Labelling::initialise_again(const InitialiseScene& scene, const LabelHypothesis& first, DistanceModel model,
                                            const Matrix<3>& turn) const {
  for (std::size_t a = 1; a < learned_.size() && !learned_.moves; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (first.point_of[a] == kNoIndex || first.point_of[b] == kNoIndex) continue;
      const auto& detected =
          scene.between(static_cast<std::size_t>(first.point_of[a]), static_cast<std::size_t>(first.point_of[b]));
      model.set_rank(a, b, std::sqrt(detected.variance) + 0.002);
    }
  }
  model.rank();
  return initialise_labels(scene, learned_, model, options_.initialise, turn);
}

void Labelling::fail_to_initialise(std::ptrdiff_t booted, std::size_t crowd) const {
  const std::vector<std::string> near = too_near_for_markers(learned_);
  if (!near.empty())
    throw Error(
        "{}: of the {} points of the set {} can be reported by their distances: {} of them, as {} and {}, lie within 10 mm of "
        "another, "
        "as points do that a program computed (joints' centres); learn the set again and name the markers alone: "
        "\"marey label learn --markers ...\"",
        recording_.header.name, learned_.size(), booted, near.size(), near.front(), near.back());
  if (crowd > 0)
    throw Error(
        "{}: {} points stand in a frame, and names are searched for among {} at most; where a program computed most of them "
        "(joints' centres), leave those out first",
        recording_.header.name, crowd, kMaxPointsToInitialise);
  throw Error("{}: of the {} markers of the set {} can be reported by their distances; is it this subject's, and in metres?",
              recording_.header.name, learned_.size(), booted);
}

/// Names from nothing at one instant; none if too few points, or too many, are there.
LabelHypothesis Labelling::answer_at(std::size_t instant, double scale, std::vector<int>& chains, std::size_t& crowd) const {
  const auto shortest = static_cast<std::int32_t>(std::max(4.0, kInitialiseS * recording_.header.rate_hz));
  InitialiseScene scene;
  scene.detected = chains_.distances_at(instant, shortest, chains, scene.locations);
  if (chains.size() > kMaxPointsToInitialise) crowd = std::max(crowd, chains.size());
  if (chains.size() < 4 || chains.size() > kMaxPointsToInitialise) return {};
  const DistanceModel model = taught(scale);
  LabelHypothesis answer = initialise_labels(scene, learned_, model, options_.initialise);
  if (const auto turn = turn_to_learned(scene, answer)) return initialise_again(scene, answer, model, *turn);
  return answer;
}

void Labelling::initialise() {
  double best_score = 0;
  std::vector<int> best_chains;
  LabelHypothesis best;
  std::size_t crowd = 0;  // points of the fullest instant that was skipped for them
  for (const std::size_t instant : initialise_instants(options_.initialises)) {
    hooks_.advance({.step = "naming", .done = 0, .total = options_.rounds + 1});
    for (const double scale : (best_score > 0 || scale_known_) && is_scaled() ? std::vector{scale_} : scales(instant)) {
      std::vector<int> chains;
      LabelHypothesis answer = answer_at(instant, scale, chains, crowd);
      if (answer.score <= best_score) continue;
      best_score = answer.score, best = std::move(answer), best_chains = std::move(chains), scale_ = scale;
    }
  }
  const auto booted = std::count_if(best.point_of.begin(), best.point_of.end(), [](int point) { return point != kNoIndex; });
  if (static_cast<double>(booted) < kMinInitialised * static_cast<double>(learned_.size())) fail_to_initialise(booted, crowd);
  model_ = std::make_unique<DistanceModel>(taught(scale_));
  for (std::size_t name = 0; name < learned_.size(); ++name) {
    if (best.point_of[name] != kNoIndex)
      chains_.set_name(best_chains[static_cast<std::size_t>(best.point_of[name])], static_cast<int>(name));
  }
}

}  // namespace marey::solve::labels
