#include "marey/track/ground/ground_roles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace marey::track::ground {
namespace {

constexpr double kIndependent = 15;  // s, after which a place is new information
constexpr double kPriorSpread = 9;   // m per axis, of one person's places
constexpr double kSpreadKnown = 4;   // instants that this is worth
constexpr double kMeanKnown = 0.1;   // likewise of the middle: a person may be anywhere on a pitch
constexpr double kOtherTeam = 0.1;   // of instants at which a person is taken for one of the other team
constexpr double kMaxTeam = 8;       // instants of a team's colour that count at most: a track's team was found for all of it

/// Logarithm of the multivariate gamma function in two dimensions, but for a constant.
double log_gamma_2(double x) {
  return std::lgamma(x) + std::lgamma(x - 0.5);
}

double log_evidence_of_positions(const RoleSum& role) {
  if (role.count <= 0) return 0;
  const double n = role.count, kappa = kMeanKnown + n, nu = kSpreadKnown + n;
  const Vector<2> mean = role.sum / n;
  const Matrix<2> prior = kSpreadKnown * kPriorSpread * kPriorSpread * Matrix<2>::Identity();
  const Matrix<2> scatter = role.squares - n * mean * mean.transpose();
  const Matrix<2> posterior = prior + scatter + (kMeanKnown * n / kappa) * mean * mean.transpose();
  return -n * std::log(std::numbers::pi) + log_gamma_2(nu / 2) - log_gamma_2(kSpreadKnown / 2) +
         kSpreadKnown / 2 * std::log(prior.determinant()) - nu / 2 * std::log(posterior.determinant()) +
         std::log(kMeanKnown / kappa);
}

double log_evidence_of_teams(const RoleSum& role) {
  const double maximum = std::max(role.teams[0], role.teams[1]);
  const double scale = maximum > kMaxTeam ? kMaxTeam / maximum : 1;
  const auto as = [&](int team) {
    return scale * (role.teams[team] * std::log(1 - kOtherTeam) + role.teams[1 - team] * std::log(kOtherTeam));
  };
  const double one = as(0), other = as(1), better = std::max(one, other);
  return better + std::log(0.5 * std::exp(one - better) + 0.5 * std::exp(other - better));
}

}  // namespace

RoleSum& RoleSum::operator+=(const RoleSum& other) {
  count += other.count;
  sum += other.sum;
  squares += other.squares;
  for (std::size_t i = 0; i < teams.size(); ++i) teams[i] += other.teams[i];
  return *this;
}

RoleSum& RoleSum::operator-=(const RoleSum& other) {
  count = std::max(0.0, count - other.count);
  sum -= other.sum;
  squares -= other.squares;
  for (std::size_t i = 0; i < teams.size(); ++i) teams[i] = std::max(0.0, teams[i] - other.teams[i]);
  return *this;
}

void RoleSum::add(const Vector<2>& relative, double seconds, int team) {
  const double time_steps = seconds / kIndependent;
  count += time_steps;
  sum += time_steps * relative;
  squares += time_steps * relative * relative.transpose();
  if (team >= 0) teams[static_cast<std::size_t>(team)] += time_steps;
}

double log_evidence(const RoleSum& role) {
  return log_evidence_of_positions(role) + log_evidence_of_teams(role);
}

}  // namespace marey::track::ground
