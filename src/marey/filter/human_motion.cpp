#include "marey/filter/human_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace marey::filter {
namespace {

constexpr std::size_t kMinPositionCount = 5;  // places that a parabola is laid through: with four, one wrong place is trusted
constexpr double kBangBang = 2.0 / 3;  // of the greatest acceleration of the cubic between two states: what the gentlest path needs

/// Place, velocity and acceleration at one instant, with their covariance.
struct LocalMotion {
  Vector<2> location, velocity, acceleration;
  Matrix<6> covariance;
};

class HumanEvaluate {
 public:
  HumanEvaluate(std::span<const TimedPosition> locations, const HumanMotionOptions& options)
      : locations_(locations), options_(options) {}

  std::vector<ImpossiblePiece> pieces() const {
    std::vector<ImpossiblePiece> found;
    for (std::size_t i = 0; i < locations_.size(); ++i) {
      const auto broken = broken_at(i);
      if (!broken) continue;
      if (!found.empty() && time(broken->first) - time(found.back().last) <= options_.reach) {
        found.back().last = std::max(found.back().last, broken->last);
      } else {
        found.push_back(*broken);
      }
    }
    for (ImpossiblePiece& piece : found) piece.one_person = bridged(piece);
    return found;
  }

 private:
  double time(std::size_t i) const { return locations_[i].time; }

  /// Nothing if a person can do what is done at this place.
  std::optional<ImpossiblePiece> broken_at(std::size_t i) const {
    if (i > 0 && jumps(i - 1, i)) return ImpossiblePiece{i, i};
    const auto motion = motion_at(time(i), time(i) - options_.reach, time(i) + options_.reach, kMinPositionCount);
    if (motion && breaks(*motion)) return ImpossiblePiece{i, i};
    return std::nullopt;
  }

  /// Whether no person is as fast from one place to the next, where too few are near to lay a parabola through them.
  bool jumps(std::size_t a, std::size_t b) const {
    if (time(b) - time(a) <= options_.reach / 2) return false;
    const Vector<2> displacement = locations_[b].location - locations_[a].location;
    const double length = displacement.norm();
    const double far = options_.limits.speed * (time(b) - time(a));
    if (length <= far) return false;
    const Matrix<2> both = locations_[a].covariance + locations_[b].covariance;
    return length - far > options_.sigmas * std::sqrt(displacement.dot(both * displacement)) / length;
  }

  /// The parabola at time `at` through the places of a segment of time; nothing if they are too few or lie to one side.
  std::optional<LocalMotion> motion_at(double at, double from, double to, std::size_t min_count) const {
    const auto earlier = [](const TimedPosition& one, double sought) { return one.time < sought; };
    const auto begin = std::lower_bound(locations_.begin(), locations_.end(), from - 1e-9, earlier);
    const auto end = std::lower_bound(begin, locations_.end(), to + 1e-9, earlier);
    const auto count = static_cast<std::size_t>(end - begin);
    if (count < min_count || std::prev(end)->time - begin->time < (to - from) / 2) return std::nullopt;
    Matrix<6> N = Matrix<6>::Zero();
    Vector<6> v = Vector<6>::Zero();
    for (auto one = begin; one != end; ++one) {
      const double t = one->time - at;
      const Vector<3> basis(1, t, t * t / 2);
      const Matrix<2> W = one->covariance.inverse();
      for (int r = 0; r < 3; ++r) {
        v.segment<2>(2 * r) += basis[r] * (W * one->location);
        for (int c = 0; c < 3; ++c) N.block<2, 2>(2 * r, 2 * c) += basis[r] * basis[c] * W;
      }
    }
    const Eigen::LDLT<Matrix<6>> solved(N);
    const Vector<6> x = solved.solve(v);
    const double step = (std::prev(end)->time - begin->time) / static_cast<double>(count - 1);
    const double echo = options_.error_memory > 0 ? 1 / std::tanh(step / 2 / options_.error_memory) : 1;
    return LocalMotion{x.head<2>(), x.segment<2>(2), x.tail<2>(), echo * solved.solve(Matrix<6>::Identity())};
  }

  bool breaks(const LocalMotion& motion) const {
    const double speed = motion.velocity.norm(), push = motion.acceleration.norm();
    const Matrix<2> V = motion.covariance.block<2, 2>(2, 2), A = motion.covariance.block<2, 2>(4, 4);
    const auto sigma = [](const Vector<2>& along, const Matrix<2>& P) { return std::sqrt(along.dot(P * along)); };
    if (speed > 1e-9) {
      const Vector<2> ahead = motion.velocity / speed;
      const double unsure = options_.sigmas * sigma(ahead, V);
      if (speed - unsure > options_.limits.speed) return true;
      const double can = options_.limits.acceleration * (1 - std::max(0.0, speed - unsure) / options_.limits.speed);
      if (motion.acceleration.dot(ahead) - options_.sigmas * sigma(ahead, A) > can) return true;
    }
    return push > 1e-9 && push - options_.sigmas * sigma(motion.acceleration / push, A) > options_.limits.acceleration;
  }

  /// Whether one body can have gone over the piece, from how it moved before to how it moves after.
  bool bridged(const ImpossiblePiece& piece) const {
    if (piece.first == 0 || piece.last + 1 >= locations_.size()) return true;  // no person lies on the other side
    const double begin = time(piece.first - 1), end = time(piece.last + 1), span = 2 * options_.reach;
    const auto before = motion_at(begin, begin - span, begin, 3), after = motion_at(end, end, end + span, 3);
    if (!before || !after) return true;
    const double T = end - begin;
    const Vector<2> displacement = after->location - before->location;
    const Vector<2> first = 6 * displacement / (T * T) - (4 * before->velocity + 2 * after->velocity) / T;
    const Vector<2> last = -6 * displacement / (T * T) + (2 * before->velocity + 4 * after->velocity) / T;
    const Matrix<2> locations = before->covariance.topLeftCorner<2, 2>() + after->covariance.topLeftCorner<2, 2>();
    const Matrix<2> speeds = before->covariance.block<2, 2>(2, 2) + after->covariance.block<2, 2>(2, 2);
    const double unsure = std::sqrt(36 * locations.trace() / 2 / std::pow(T, 4) + 10 * speeds.trace() / 2 / (T * T));
    const double needed = kBangBang * std::max(first.norm(), last.norm());
    return needed - kBangBang * options_.sigmas * unsure <= options_.limits.acceleration &&
           displacement.norm() <= options_.limits.speed * T + options_.sigmas * std::sqrt(locations.trace());
  }

  std::span<const TimedPosition> locations_;
  const HumanMotionOptions& options_;
};

}  // namespace

std::vector<ImpossiblePiece> impossible_pieces(std::span<const TimedPosition> locations, const HumanMotionOptions& options) {
  return HumanEvaluate(locations, options).pieces();
}

}  // namespace marey::filter
