#include "marey/track/ground/ground_teams.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace marey::track::ground {
namespace {

// All of these are unswept: inspected on one video of a match and on simulated shirts.
constexpr std::size_t kMinColours = 300;
constexpr std::size_t kMaxColours = 20000;
constexpr int kTeamRounds = 20;
constexpr double kUnlikeBoth = 9;    // squared deviations: a keeper, a referee
constexpr double kMinApart = 4.5;    // deviations; two halves of one round cloud are 2.7 apart, of an even one 3.5
constexpr double kMinTeam = 0.2;     // of the observations
constexpr double kMinOfBoth = 0.75;  // likewise, both together
constexpr double kMinSpread = 4;     // squared L*a*b*: what compression leaves uncertain
constexpr double kAnyPerson = 0.02;  // likelihood of a colour that is neither's, of that of a shirt in the middle of its own,
constexpr double kAnyPersonForLong =
    0.001;  // and of one that was seen for a while; with this at every sight blue ones were lost in groups

Vector<3> point_in_lab(const Appearance& colour) {
  return {colour.lightness, colour.a, colour.b};
}

double squared_distance(const Vector<3>& difference, const Matrix<3>& precision) {
  return difference.dot(precision * difference);
}

/// Two means and the precision about them, from a first guess: by turns.
class TwoShirts {
 public:
  explicit TwoShirts(std::vector<Vector<3>> points) : points_(std::move(points)) {
    Vector<3> mean = Vector<3>::Zero();
    for (const Vector<3>& point : points_) mean += point / static_cast<double>(points_.size());
    Matrix<3> covariance = Matrix<3>::Zero();
    for (const Vector<3>& point : points_)
      covariance += (point - mean) * (point - mean).transpose() / static_cast<double>(points_.size());
    const Eigen::SelfAdjointEigenSolver<Matrix<3>> axes(covariance);
    const Vector<3> longest = std::sqrt(std::max(axes.eigenvalues()[2], 1e-6)) * axes.eigenvectors().col(2);
    means = {mean - longest, mean + longest};
    precision = (covariance + kMinSpread * Matrix<3>::Identity()).inverse();
    for (int round = 0; round < kTeamRounds; ++round) turn(round == 0);
  }

  std::array<Vector<3>, 2> means;
  Matrix<3> precision = Matrix<3>::Identity();
  std::array<double, 2> fraction{};  ///< of all points: the wearers of each

 private:
  void turn(bool all) {
    std::array<Vector<3>, 2> sums{Vector<3>::Zero(), Vector<3>::Zero()};
    std::array<Matrix<3>, 2> products{Matrix<3>::Zero(), Matrix<3>::Zero()};
    std::array<double, 2> counts{};
    for (const Vector<3>& point : points_) {
      const double first = squared_distance(point - means[0], precision), second = squared_distance(point - means[1], precision);
      const std::size_t team = second < first ? 1 : 0;
      if (!all && std::min(first, second) > kUnlikeBoth) continue;
      sums[team] += point;
      products[team] += point * point.transpose();
      counts[team] += 1;
    }
    if (counts[0] < 1 || counts[1] < 1) return;
    Matrix<3> within = Matrix<3>::Zero();
    for (std::size_t team = 0; team < 2; ++team) {
      means[team] = sums[team] / counts[team];
      within += products[team] - counts[team] * means[team] * means[team].transpose();
      fraction[team] = counts[team] / static_cast<double>(points_.size());
    }
    precision = (within / (counts[0] + counts[1]) + kMinSpread * Matrix<3>::Identity()).inverse();
  }

  std::vector<Vector<3>> points_;
};

}  // namespace

std::optional<GroundTeams> GroundTeams::learn(std::span<const Appearance> detected) {
  if (detected.size() < kMinColours) return std::nullopt;
  std::vector<Vector<3>> points;
  const std::size_t step = 1 + detected.size() / kMaxColours;
  for (std::size_t i = 0; i < detected.size(); i += step) points.push_back(point_in_lab(detected[i]));
  const TwoShirts shirts(std::move(points));
  GroundTeams teams;
  teams.means_ = shirts.means;
  teams.precision_ = shirts.precision;
  teams.apart_ = std::sqrt(squared_distance(shirts.means[1] - shirts.means[0], shirts.precision));
  if (teams.apart_ < kMinApart || std::min(shirts.fraction[0], shirts.fraction[1]) < kMinTeam ||
      shirts.fraction[0] + shirts.fraction[1] < kMinOfBoth)
    return std::nullopt;
  return teams;
}

double GroundTeams::likelihood(const Vector<3>& colour, double variance, int team) const {
  const Vector<3> off = colour - means_[static_cast<std::size_t>(team)];
  const Matrix<3> spread = precision_.inverse() + variance * Matrix<3>::Identity();
  return std::exp(-0.5 * squared_distance(off, spread.inverse()));
}

double GroundTeams::log_odds(const Appearance& colour) const {
  return log_odds(colour, kAnyPerson);
}

double GroundTeams::log_odds(const Appearance& colour, double anybody) const {
  const double variance = static_cast<double>(colour.deviation) * colour.deviation / 4;
  const Vector<3> point = point_in_lab(colour);
  return std::log((likelihood(point, variance, 1) + anybody) / (likelihood(point, variance, 0) + anybody));
}

/// The probability that both are of one team.
double GroundTeams::agreement(const Appearance& known, const Appearance& detected, double anybody) const {
  const double known_odds = std::exp(log_odds(known, anybody)), seen_odds = std::exp(log_odds(detected, anybody));
  const double second = known_odds / (1 + known_odds);  // the probability that it is of the second team
  const double given = seen_odds / (1 + seen_odds);
  return second * given + (1 - second) * (1 - given);
}

double GroundTeams::same(const Appearance& known, const Appearance& detected) const {
  return std::log(2 * agreement(known, detected, kAnyPerson));
}

double GroundTeams::same_for_long(const Appearance& known, const Appearance& detected) const {
  return std::log(2 * agreement(known, detected, kAnyPersonForLong));
}

}  // namespace marey::track::ground
