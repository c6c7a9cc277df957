#include "marey/calibrate/two_views.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "marey/calibrate/draw_below.h"
#include "marey/geometry/decompositions.h"
#include "marey/geometry/median.h"

namespace marey::calibrate {
namespace {

using Ray = Vector<3>;

struct Match {
  Ray a, b;
};

/// A linear map that makes the bearings' second moments equal in all directions.
Matrix<3> whitening(std::span<const Match> matches, Ray Match::* side) {
  Matrix<3> time_steps = Matrix<3>::Zero();
  for (const Match& match : matches) time_steps += (match.*side) * (match.*side).transpose();
  const geometry::Eigenpairs<3> eigen = geometry::eigenpairs<3>(time_steps / static_cast<double>(matches.size()));
  const Vector<3> scale = eigen.values.cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  return eigen.vectors * scale.asDiagonal() * eigen.vectors.transpose();
}

/// The 3 × 3 matrix whose rows of constraints are the given ones in the least-squares sense: smallest singular vector.
Matrix<3> null_matrix(const Eigen::Matrix<double, 9, 9>& normal) {
  const geometry::Eigenpairs<9> eigen = geometry::eigenpairs<9>(normal);
  const Eigen::Matrix<double, 9, 1> v = eigen.vectors.col(0);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(v.data());
}

/// bᵀ E a = 0 for all matches, E with singular values 1, 1, 0.
Matrix<3> essential_of(std::span<const Match> matches) {
  const Matrix<3> A = whitening(matches, &Match::a), B = whitening(matches, &Match::b);
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const Match& match : matches) {
    const Vector<3> a = A * match.a, b = B * match.b;
    Eigen::Matrix<double, 9, 1> row;
    row << b.x() * a, b.y() * a, b.z() * a;
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  const Matrix<3> E = B.transpose() * null_matrix(normal.selfadjointView<Eigen::Lower>()) * A;
  const geometry::SingularValues3 svd = geometry::singular_values(E);
  return svd.U * Vector<3>(1, 1, 0).asDiagonal() * svd.V.transpose();
}

/// b ~ H a for all matches.
Matrix<3> homography_of(std::span<const Match> matches) {
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const Match& match : matches) {
    Matrix<3> cross;
    cross << 0, -match.b.z(), match.b.y(), match.b.z(), 0, -match.b.x(), -match.b.y(), match.b.x(), 0;
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix<double, 9, 1> row;
      row << cross(i, 0) * match.a, cross(i, 1) * match.a, cross(i, 2) * match.a;
      normal += row * row.transpose();
    }
  }
  return null_matrix(normal);
}

Matrix<3> rotation_of(std::span<const Match> matches) {
  Matrix<3> time_steps = Matrix<3>::Zero();
  for (const Match& match : matches) time_steps += match.b * match.a.transpose();
  const geometry::SingularValues3 svd = geometry::singular_values(time_steps);
  const double sign = (svd.U * svd.V.transpose()).determinant();
  return svd.U * Vector<3>(1, 1, sign).asDiagonal() * svd.V.transpose();
}

constexpr double kMatchGate = 3;  // standard deviations within which a match is one

double angle_between(const Vector<3>& a, const Vector<3>& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Share of matches that `map` carries from a to b within the noise.
double explained(std::span<const Match> matches, const Matrix<3>& map, double sigma) {
  std::size_t count = 0;
  for (const Match& match : matches) {
    const double off = angle_between(map * match.a, match.b);
    count += std::min(off, std::acos(-1.0) - off) < kMatchGate * sigma ? 1 : 0;
  }
  return static_cast<double>(count) / static_cast<double>(matches.size());
}

class Relation {
 public:
  Relation(std::span<const MarkPair> pairs, const TwoViewOptions& options) : pairs_(pairs), options_(options) {}

  Match match(std::size_t pair, std::size_t marker, bool rotated) const {
    return {pairs_[pair].a[marker], pairs_[pair].b[rotated ? options_.markers - 1 - marker : marker]};
  }

  /// Squared Sampson error of one match in units of the noise.
  double error(const Matrix<3>& E, const Match& match) const {
    const Vector<3> to_b = E * match.a, to_a = E.transpose() * match.b;
    const double off = match.b.dot(to_b);
    const double spread = (to_b.squaredNorm() - off * off) * options_.sigma_b * options_.sigma_b +
                          (to_a.squaredNorm() - off * off) * options_.sigma_a * options_.sigma_a;
    return off * off / std::max(spread, 1e-300);
  }

  /// Mean squared error of a wand, in the better orientation.
  double error(const Matrix<3>& E, std::size_t pair, bool& rotated) const {
    double best = 0;
    rotated = false;
    for (const bool turn : {false, true}) {
      if (turn && !options_.reversible) break;
      double sum = 0;
      for (std::size_t m = 0; m < options_.markers; ++m) sum += error(E, match(pair, m, turn));
      if (!turn || sum < best) best = sum, rotated = turn;
    }
    return best / static_cast<double>(options_.markers);
  }

  double cost(const Matrix<3>& E, std::span<const std::size_t> sample) const {
    double sum = 0;
    bool rotated = false;
    for (const std::size_t pair : sample) sum += std::min(error(E, pair, rotated), kMatchGate * kMatchGate);
    return sum;
  }

  std::vector<Match> inliers(const Matrix<3>& E, std::span<const std::size_t> among, double gate) const {
    std::vector<Match> matches;
    for (const std::size_t pair : among) {
      bool rotated = false;
      if (error(E, pair, rotated) > gate * gate) continue;
      for (std::size_t m = 0; m < options_.markers; ++m) matches.push_back(match(pair, m, rotated));
    }
    return matches;
  }

  std::optional<Matrix<3>> search() const;
  TwoViews describe(const Matrix<3>& E) const;
  double fraction_of_a_plane() const;

 private:
  std::span<const MarkPair> pairs_;
  const TwoViewOptions& options_;
};

/// RANSAC over whole wands, each best model refitted to its inliers.
std::optional<Matrix<3>> Relation::search() const {
  constexpr std::size_t judges = 300;
  const int max_draws = options_.max_draws;
  std::vector<std::size_t> sample;
  const std::size_t step = std::max<std::size_t>(1, pairs_.size() / judges);
  for (std::size_t i = 0; i < pairs_.size(); i += step) sample.push_back(i);
  const std::size_t wands = (8 + options_.markers - 1) / options_.markers;
  if (pairs_.size() < wands) return std::nullopt;

  std::mt19937_64 engine(options_.seed);
  std::optional<Matrix<3>> best;
  double best_cost = std::numeric_limits<double>::infinity();
  int needed = max_draws;
  for (int i = 0; i < std::min(needed, max_draws); ++i) {
    std::vector<Match> drawn;
    for (std::size_t w = 0; w < wands; ++w) {
      const std::size_t pair = draw_below(engine, pairs_.size());
      const bool rotated = options_.reversible && draw_below(engine, 2) == 1;
      for (std::size_t m = 0; m < options_.markers; ++m) drawn.push_back(match(pair, m, rotated));
    }
    Matrix<3> E = essential_of(drawn);
    double cost_here = cost(E, sample);
    if (cost_here >= best_cost) continue;
    for (const double gate : {2 * kMatchGate, kMatchGate, kMatchGate}) {
      const auto matches = inliers(E, sample, gate);
      if (matches.size() < 16) break;
      const Matrix<3> refitted = essential_of(matches);
      const double refitted_cost = cost(refitted, sample);
      if (refitted_cost < cost_here) E = refitted, cost_here = refitted_cost;
    }
    best = E, best_cost = cost_here;
    const double good =
        static_cast<double>(inliers(E, sample, kMatchGate).size()) / static_cast<double>(sample.size() * options_.markers);
    const double orientations = options_.reversible ? std::pow(0.5, static_cast<double>(wands) - 1) : 1;
    const double hit = std::pow(good, static_cast<double>(wands)) * orientations;
    if (hit > 0) needed = static_cast<int>(std::clamp(std::log(1e-4) / std::log1p(-std::min(hit, 0.999999)), 60.0, 1e9));
  }
  return best;
}

/// The largest share of wands that one homography explains.
double Relation::fraction_of_a_plane() const {
  constexpr int draws = 200;
  const std::size_t wands = std::max<std::size_t>(2, (4 + options_.markers - 1) / options_.markers);
  const double sigma = std::hypot(options_.sigma_a, options_.sigma_b);
  std::mt19937_64 engine(options_.seed);
  std::size_t maximum = 0;
  for (int i = 0; i < draws; ++i) {
    std::vector<Match> drawn;
    for (std::size_t w = 0; w < wands; ++w) {
      const std::size_t pair = draw_below(engine, pairs_.size());
      const bool rotated = options_.reversible && draw_below(engine, 2) == 1;
      for (std::size_t m = 0; m < options_.markers; ++m) drawn.push_back(match(pair, m, rotated));
    }
    Matrix<3> H = homography_of(drawn);
    for (int refit = 0; refit < 2; ++refit) {
      std::vector<Match> near;
      for (std::size_t pair = 0; pair < pairs_.size(); ++pair) {
        for (const bool rotated : {false, true}) {
          std::vector<Match> wand;
          for (std::size_t m = 0; m < options_.markers; ++m) wand.push_back(match(pair, m, rotated));
          if ((rotated && !options_.reversible) || explained(wand, H, sigma) < 1) continue;
          near.insert(near.end(), wand.begin(), wand.end());
          break;
        }
      }
      maximum = std::max(maximum, near.size() / options_.markers);
      if (near.size() < 2 * drawn.size()) break;
      H = homography_of(near);
    }
    if (maximum > 0.95 * static_cast<double>(pairs_.size())) break;
  }
  return static_cast<double>(maximum) / static_cast<double>(pairs_.size());
}

/// Depths along both rays where they are nearest, baseline `t` from a's frame turned into b's.
Vector<2> depths(const Rigid3& b_from_a, const Match& match) {
  const Vector<3> a = b_from_a.rotation * match.a;
  const double c = a.dot(match.b), ta = a.dot(b_from_a.translation), tb = match.b.dot(b_from_a.translation);
  const double d = std::max(1e-12, 1 - c * c);
  return {(c * tb - ta) / d, (tb - c * ta) / d};
}

Rigid3 pose_of(const Matrix<3>& E, std::span<const Match> matches) {
  const geometry::SingularValues3 svd = geometry::singular_values(E);
  Matrix<3> W;
  W << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Rigid3 best;
  int maximum = -1;
  for (const Matrix<3>& turn : {W, Matrix<3>(W.transpose())}) {
    for (const double sign : {1.0, -1.0}) {
      Rigid3 pose{svd.U * turn * svd.V.transpose(), sign * svd.U.col(2)};
      if (pose.rotation.determinant() < 0) pose.rotation = -pose.rotation;
      int ahead = 0;
      for (const Match& match : matches) ahead += (depths(pose, match).array() > 0).all() ? 1 : 0;
      if (ahead > maximum) maximum = ahead, best = pose;
    }
  }
  return best;
}

TwoViews Relation::describe(const Matrix<3>& E) const {
  TwoViews views;
  std::vector<std::size_t> all(pairs_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::size_t count = 0;
  for (const std::size_t pair : all) {
    bool rotated = false;
    views.inlier.push_back(error(E, pair, rotated) <= kMatchGate * kMatchGate);
    views.rotated.push_back(rotated);
    count += static_cast<std::size_t>(views.inlier.back());
  }
  views.fraction = static_cast<double>(count) / static_cast<double>(pairs_.size());
  const auto matches = inliers(E, all, kMatchGate);
  views.b_from_a = pose_of(E, matches);
  std::vector<double> angles;
  for (const Match& match : matches) angles.push_back(angle_between(views.b_from_a.rotation * match.a, match.b));
  if (!angles.empty()) {
    views.parallax = geometry::median(angles);
  }
  if (matches.empty()) return views;
  const double sigma = std::hypot(options_.sigma_a, options_.sigma_b);
  views.plane = explained(matches, homography_of(matches), sigma) > 0.95;
  views.one_position = explained(matches, rotation_of(matches), sigma) > 0.95;
  return views;
}

}  // namespace

std::optional<TwoViews> relate(std::span<const MarkPair> pairs, const TwoViewOptions& options) {
  const Relation relation(pairs, options);
  constexpr double good = 0.5, minimum = 0.25, plane = 0.8;
  const auto E = relation.search();
  std::optional<TwoViews> views;
  if (E) views = relation.describe(*E);
  if ((!views || views->fraction < good) && pairs.size() * options.markers >= 8) {
    const double fraction = relation.fraction_of_a_plane();
    if (fraction > plane) return TwoViews{{}, {}, {}, fraction, 0, true, false};
  }
  if (views && views->fraction < minimum) return std::nullopt;
  return views;
}

}  // namespace marey::calibrate
