#include "marey/track/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>

#include <Eigen/Cholesky>

namespace marey::track {
namespace {
static double env(const char* n, double d) { const char* s = std::getenv(n); return s ? std::atof(s) : d; }
using geometry::Similarity2;

constexpr std::size_t kMostPeople = 40;
constexpr std::size_t kFewestPeople = 3;
constexpr double kFarthestShift = 0.7;     // sizes; a camera does not turn more between two frames than it was expected to
constexpr double kSameHeight = 0.25;    // difference of logarithms
const double kPerfectFit = env("CM_FIT", 20);   // likelihood of a person who is just where expected, beside anybody else's
const double kJolt = env("CM_JOLT", 6);      // log-likelihood that a sudden motion costs, at most
const double kUnrestMemory = env("CM_MEM", 1);      // s over which the camera's unrest is learned
const double kRateMemory = env("CM_RATE", 0.15); // s over which its speed is learned
const double kRateLasts = env("CM_LAST", 2);  // s
constexpr double kLeastUnrest = 1e-6; // squared sizes
const double kFirstShift = env("CM_FIRST", 0.02);   // sizes
const double kFirstTurn = env("CM_TURN", 0.001);    // of zoom and roll, for the first frames
const double kMostTurn = env("CM_MOSTTURN", 0.03);
const int kFitRounds = 3;

std::vector<Sighting> largest(std::span<const Sighting> all) {
  std::vector<Sighting> kept(all.begin(), all.end());
  std::sort(kept.begin(), kept.end(), [](const Sighting& a, const Sighting& b) {
    return std::tuple(-a.size, a.place.x(), a.place.y()) < std::tuple(-b.size, b.place.x(), b.place.y());
  });
  if (kept.size() > kMostPeople) kept.resize(kMostPeople);
  return kept;
}

bool may_be_one(const Sighting& expected, const Sighting& seen) {
  return std::abs(std::log(seen.size / expected.size)) <= kSameHeight &&
         (seen.place - expected.place).squaredNorm() <= kFarthestShift * kFarthestShift * expected.size * expected.size;
}

}  // namespace

/// One person, as expected and as seen.
struct CameraMotion::Pair {
  Vector<2> expected, seen;
  double variance;
};

void CameraMotion::predict(double dt) {
  dt_ = dt;
  if (dt <= 0) return;
  view_from_scene_ =
      Similarity2::about(middle_, std::exp(dt * rate_.zoom), dt * rate_.roll, dt * rate_.shift) * view_from_scene_;
}

/// Whom each expected person would be under this shift: the best of those seen, where there is one.
std::vector<CameraMotion::Pair> CameraMotion::pairs_under(const Vector<2>& shift, std::span<const Sighting> expected,
                                                          std::span<const Sighting> seen) const {
  std::vector<Pair> pairs;
  for (const Sighting& person : expected) {
    const Sighting* best = nullptr;
    double nearest = 9 * 2 * person.variance;
    for (const Sighting& one : seen) {
      const double away = (one.place - person.place - shift).squaredNorm();
      if (away >= nearest || !may_be_one(person, one)) continue;
      nearest = away;
      best = &one;
    }
    if (best != nullptr) pairs.push_back({person.place, best->place, person.variance});
  }
  return pairs;
}

Vector<2> CameraMotion::likeliest_shift(std::span<const Sighting> expected, std::span<const Sighting> seen) const {
  struct Proposal {
    std::size_t person;
    Vector<2> shift;
  };
  std::vector<Proposal> proposals;
  for (std::size_t person = 0; person < expected.size(); ++person) {
    for (const Sighting& one : seen) {
      if (may_be_one(expected[person], one)) proposals.push_back({person, one.place - expected[person].place});
    }
  }
  const double unrest = (shift_unrest_ + kLeastUnrest) * size_ * size_;
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
  double most = likelihood(best);
  for (const Proposal& proposal : proposals) {
    const double here = likelihood(proposal.shift);
    if (here > most) {
      most = here;
      best = proposal.shift;
    }
  }
  return best;
}

void CameraMotion::correct(std::span<const Sighting> all_expected, std::span<const Sighting> seen) {
  if (dt_ <= 0) return;
  const std::vector<Sighting> expected = largest(all_expected);
  if (expected.size() < kFewestPeople || std::getenv("CM_OFF")) return;
  Vector<2> shift = likeliest_shift(expected, seen);
  const std::vector<Pair> pairs = pairs_under(shift, expected, seen);
  if (pairs.size() < kFewestPeople) return;
  double sizes = 0;
  for (const Sighting& person : expected) sizes += person.size;
  size_ = sizes / static_cast<double>(expected.size());
  Vector<2> middle = Vector<2>::Zero();
  for (const Pair& pair : pairs) middle += pair.expected / static_cast<double>(pairs.size());
  // About the middle a person at p = (x, y) moves by shift + zoom · p + roll · (−y, x).
  const double unrest = (shift_unrest_ + kLeastUnrest) * size_ * size_;
  const bool jolted = shift.squaredNorm() / (2 * unrest) > kJolt;
  Eigen::Vector4d prior;
  prior << Vector<2>::Constant(1 / (jolted ? size_ * size_ : unrest)), Vector<2>::Constant(1 / (turn_unrest_ + 1e-10));
  Eigen::Vector4d solution(shift.x(), shift.y(), 0, 0);
  Eigen::Matrix4d information;
  for (int round = 0; round < kFitRounds; ++round) {
    information = prior.asDiagonal();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Pair& pair : pairs) {
      const Vector<2> from = pair.expected - middle;
      Eigen::Matrix<double, 2, 4> A;
      A << 1, 0, from.x(), -from.y(), 0, 1, from.y(), from.x();
      const Vector<2> moved = pair.seen - pair.expected;
      const double away = (moved - A * solution).squaredNorm() / pair.variance;
      const double weight = 1 / (pair.variance * (1 + away / 4));
      information += weight * A.transpose() * A;
      right += weight * A.transpose() * moved;
    }
    solution = information.ldlt().solve(right);
  }
  const Eigen::Matrix4d covariance = information.inverse();
  const Eigen::Vector2d turn(std::clamp(solution[2], -kMostTurn, kMostTurn), std::clamp(solution[3], -kMostTurn, kMostTurn));
  view_from_scene_ = Similarity2::about(middle, std::exp(turn[0]), turn[1], solution.head<2>()) * view_from_scene_;
  middle_ = middle;
  learn({solution.head<2>(), turn[0], turn[1]}, (covariance(0, 0) + covariance(1, 1)) / 2, (covariance(2, 2) + covariance(3, 3)) / 2);
}

/// The expectation step of the prior's variance (EM): the mean square of what was found and its own variance.
void CameraMotion::learn(const Increment& surprise, double shift_variance, double turn_variance) {
  const double share = 1 - std::exp(-dt_ / kUnrestMemory);
  const double scale = size_ * size_;
  const double shift = (surprise.shift.squaredNorm() / 2 + shift_variance) / scale;
  const double turn = (surprise.zoom * surprise.zoom + surprise.roll * surprise.roll) / 2 + turn_variance;
  shift_unrest_ += share * (shift - shift_unrest_);
  turn_unrest_ += share * (turn - turn_unrest_);
  const double follow = 1 - std::exp(-dt_ / kRateMemory);
  const double keep = std::exp(-dt_ / kRateLasts);
  rate_.shift = keep * rate_.shift + follow * surprise.shift / dt_;
  rate_.zoom = keep * rate_.zoom + follow * surprise.zoom / dt_;
  rate_.roll = keep * rate_.roll + follow * surprise.roll / dt_;
}

}  // namespace marey::track
