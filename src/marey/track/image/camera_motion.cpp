#include "marey/track/image/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <Eigen/Cholesky>

namespace marey::track::image {
namespace {
using geometry::Similarity2;

// Of these kRateLasts alone was tried at another value (bench/tuning.md); the others are unswept.
constexpr std::size_t kMaxPeople = 40;
constexpr std::size_t kMinPeople = 3;
constexpr double kMaxShift = 0.7;         // sizes; a camera does not turn more between two frames than it was expected to
constexpr double kSameHeight = 0.25;      // difference of logarithms
constexpr double kPerfectFit = 20;        // likelihood of a person who is just where expected, beside any other person's
constexpr double kJolt = 6;               // log-likelihood that a sudden motion costs, at most
constexpr double kUnrestMemory = 1;       // s over which the camera's unrest is learned
constexpr double kRateMemory = 0.15;      // s over which its speed is learned
constexpr double kRateLasts = 2;          // s
constexpr double kMinUnrest = 1e-6;       // squared sizes, numerical
constexpr double kMaxTurn = 0.03;         // of zoom and roll, between two frames
constexpr double kMinTurnUnrest = 1e-10;  // numerical: no division by 0
constexpr double kCauchy = 4;             // squared deviations at which a person counts half
constexpr int kFitRounds = 3;

std::vector<Sighting> largest(std::span<const Sighting> all) {
  std::vector<Sighting> kept(all.begin(), all.end());
  std::sort(kept.begin(), kept.end(), [](const Sighting& a, const Sighting& b) {
    return std::tuple(-a.size, a.location.x(), a.location.y()) < std::tuple(-b.size, b.location.x(), b.location.y());
  });
  if (kept.size() > kMaxPeople) kept.resize(kMaxPeople);
  return kept;
}

bool may_be_one(const Sighting& expected, const Sighting& detected) {
  return std::abs(std::log(detected.size / expected.size)) <= kSameHeight &&
         (detected.location - expected.location).squaredNorm() <= kMaxShift * kMaxShift * expected.size * expected.size;
}

}  // namespace

/// One person, as expected and as seen.
struct CameraMotion::Pair {
  Vector<2> expected, detected;
  double variance;
};

void CameraMotion::predict(double dt) {
  dt_ = dt;
  if (dt > 0) view_from_scene_ = view_from_scene(dt);
}

Similarity2 CameraMotion::view_from_scene(double dt) const {
  return Similarity2::about(middle_, std::exp(dt * rate_.zoom), dt * rate_.roll, dt * rate_.shift) * view_from_scene_;
}

/// The match of each expected person under this shift: the best of those seen, where there is one.
std::vector<CameraMotion::Pair> CameraMotion::pairs_under(const Vector<2>& shift, std::span<const Sighting> expected,
                                                          std::span<const Sighting> detected) const {
  std::vector<Pair> pairs;
  for (const Sighting& person : expected) {
    const Sighting* best = nullptr;
    double nearest = 9 * 2 * person.variance;
    for (const Sighting& one : detected) {
      const double away = (one.location - person.location - shift).squaredNorm();
      if (away >= nearest || !may_be_one(person, one)) continue;
      nearest = away;
      best = &one;
    }
    if (best != nullptr) pairs.push_back({person.location, best->location, person.variance});
  }
  return pairs;
}

Vector<2> CameraMotion::likeliest_shift(std::span<const Sighting> expected, std::span<const Sighting> detected) const {
  struct Proposal {
    std::size_t person;
    Vector<2> shift;
  };
  std::vector<Proposal> proposals;
  for (std::size_t person = 0; person < expected.size(); ++person) {
    for (const Sighting& one : detected) {
      if (may_be_one(expected[person], one)) proposals.push_back({person, one.location - expected[person].location});
    }
  }
  const double unrest = (shift_unrest_ + kMinUnrest) * size_ * size_;
  const auto likelihood = [&](const Vector<2>& shift) {
    double sum = -std::min(kJolt, shift.squaredNorm() / (2 * unrest));
    for (std::size_t i = 0; i < proposals.size();) {
      const std::size_t person = proposals[i].person;
      double away = std::numeric_limits<double>::infinity();
      for (; i < proposals.size() && proposals[i].person == person; ++i)
        away = std::min(away, (proposals[i].shift - shift).squaredNorm());
      sum += std::log1p(kPerfectFit * std::exp(-away / (2 * expected[person].variance)));
    }
    return sum;
  };
  Vector<2> best = Vector<2>::Zero();
  double maximum = likelihood(best);
  for (const Proposal& proposal : proposals) {
    const double here = likelihood(proposal.shift);
    if (here > maximum) {
      maximum = here;
      best = proposal.shift;
    }
  }
  return best;
}

void CameraMotion::correct(std::span<const Sighting> all_expected, std::span<const Sighting> detected) {
  if (dt_ <= 0) return;
  const std::vector<Sighting> expected = largest(all_expected);
  if (expected.size() < kMinPeople) return;
  const Vector<2> shift = likeliest_shift(expected, detected);
  const std::vector<Pair> pairs = pairs_under(shift, expected, detected);
  if (pairs.size() < kMinPeople) return;
  double sizes = 0;
  for (const Sighting& person : expected) sizes += person.size;
  size_ = sizes / static_cast<double>(expected.size());
  Vector<2> middle = Vector<2>::Zero();
  for (const Pair& pair : pairs) middle += pair.expected / static_cast<double>(pairs.size());
  const Fit fit = fitted(pairs, middle, shift);
  const Increment& found = fit.increment;
  view_from_scene_ = Similarity2::about(middle, std::exp(found.zoom), found.roll, found.shift) * view_from_scene_;
  middle_ = middle;
  learn(fit);
}

/// Iteratively reweighted least squares (Cauchy's weights), from the shift that said who is who, with what the camera usually does
/// as prior knowledge. About the middle a person at p = (x, y) moves by shift + zoom · p + roll · (−y, x).
CameraMotion::Fit CameraMotion::fitted(std::span<const Pair> pairs, const Vector<2>& middle, const Vector<2>& shift) const {
  const double typical = (shift_unrest_ + kMinUnrest) * size_ * size_;
  const bool jolted = shift.squaredNorm() / (2 * typical) > kJolt;
  Eigen::Vector4d prior;
  prior << Vector<2>::Constant(1 / (jolted ? size_ * size_ : typical)), Vector<2>::Constant(1 / (turn_unrest_ + kMinTurnUnrest));
  Eigen::Vector4d solution(shift.x(), shift.y(), 0, 0);
  Eigen::Matrix4d information;
  for (int round = 0; round < kFitRounds; ++round) {
    information = prior.asDiagonal();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Pair& pair : pairs) {
      const Vector<2> from = pair.expected - middle, moved = pair.detected - pair.expected;
      Eigen::Matrix<double, 2, 4> A;
      A << 1, 0, from.x(), -from.y(), 0, 1, from.y(), from.x();
      const double away = (moved - A * solution).squaredNorm() / pair.variance;
      const double weight = 1 / (pair.variance * (1 + away / kCauchy));
      information += weight * A.transpose() * A;
      right += weight * A.transpose() * moved;
    }
    solution = information.ldlt().solve(right);
  }
  const Eigen::Vector4d variance = information.inverse().diagonal();
  return {.increment = {.shift = solution.head<2>(),
                        .zoom = std::clamp(solution[2], -kMaxTurn, kMaxTurn),
                        .roll = std::clamp(solution[3], -kMaxTurn, kMaxTurn)},
          .shift_variance = (variance[0] + variance[1]) / 2,
          .turn_variance = (variance[2] + variance[3]) / 2};
}

/// The variance of what the camera does beside what was predicted: the mean, over the last second, of the square of the result
/// and of that one's own variance (expectation-maximisation). Its speed is a mean over fewer frames.
void CameraMotion::learn(const Fit& fit) {
  const Increment& found = fit.increment;
  const double fraction = 1 - std::exp(-dt_ / kUnrestMemory);
  const double shift = (found.shift.squaredNorm() / 2 + fit.shift_variance) / (size_ * size_);
  const double turn = (found.zoom * found.zoom + found.roll * found.roll) / 2 + fit.turn_variance;
  shift_unrest_ += fraction * (shift - shift_unrest_);
  turn_unrest_ += fraction * (turn - turn_unrest_);
  const double tracking = (1 - std::exp(-dt_ / kRateMemory)) / dt_;
  const double keep = std::exp(-dt_ / kRateLasts);
  rate_.shift = keep * rate_.shift + tracking * found.shift;
  rate_.zoom = keep * rate_.zoom + tracking * found.zoom;
  rate_.roll = keep * rate_.roll + tracking * found.roll;
}

}  // namespace marey::track::image
