#include "marey/edit/gap_methods.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "marey/filter/bridge.h"
#include "marey/geometry/decompositions.h"
#include "marey/geometry/rigid.h"

namespace marey::edit {
namespace {

using Path = std::vector<Vector<3>>;
using Dense = Eigen::MatrixXd;

constexpr std::size_t kMaxDonors = 12;
constexpr std::size_t kFrameDonors = 5;  // whose frame the marker is carried in
constexpr double kWeightFloor = 1e-3;    // m: donors more rigid than this count alike

/// Adds to each place what makes the ends meet: `at_first` before the first place, `at_last` behind the last, straight between.
void bend(Path& path, const Vector<3>& at_first, const Vector<3>& at_last) {
  const filter::Bridge<filter::RandomWalk, 3> missed(at_first.transpose(), 0, at_last.transpose(),
                                                     static_cast<double>(path.size() + 1));
  for (std::size_t i = 0; i < path.size(); ++i) path[i] += missed.at(static_cast<double>(i + 1)).transpose();
}

bool has_ends(const Locations& locations, std::size_t marker, const Hole& hole) {
  const auto& known = locations.markers[marker].known;
  return hole.first > 0 && hole.last + 1 < locations.size() && known[hole.first - 1] != 0 && known[hole.last + 1] != 0;
}

/// How far two markers' distance wanders, as a standard deviation; nothing if few frames have both.
std::optional<double> distance_deviation(const Locations::Marker& a, const Locations::Marker& b) {
  double count = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < a.location.size(); ++i) {
    if (a.known[i] == 0 || b.known[i] == 0) continue;
    const double distance = (a.location[i] - b.location[i]).norm();
    ++count;
    sum += distance;
    squares += distance * distance;
  }
  if (count < 10) return std::nullopt;
  return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
}

/// The donors' shape, and where it stands in each frame: the frame in which the marker is carried along.
class Carrier {
 public:
  /// The shape is the mean of the donors just before and after the hole.
  Carrier(const Locations& locations, std::size_t marker, std::span<const std::size_t> donors, const Hole& hole)
      : locations_(&locations),
        donors_(donors.begin(), donors.begin() + static_cast<std::ptrdiff_t>(std::min(donors.size(), kFrameDonors))) {
    for (const std::size_t donor : donors_) {
      const double wander = distance_deviation(locations.markers[marker], locations.markers[donor]).value_or(1);
      weights_.push_back(1 / (wander * wander + kWeightFloor * kWeightFloor));
    }
    shape_ = config(hole.first - 1);
    const Path after = config(hole.last + 1);
    if (const auto aligned = fit(after, shape_)) {
      for (std::size_t i = 0; i < shape_.size(); ++i) shape_[i] = 0.5 * (shape_[i] + *aligned * after[i]);
    }
  }

  /// world_from_shape; nothing if the donors lie on one line.
  std::optional<geometry::Rigid3> at(std::size_t frame) const { return fit(shape_, config(frame)); }

  bool knows(std::size_t frame) const {
    return std::all_of(donors_.begin(), donors_.end(),
                       [&](std::size_t donor) { return locations_->markers[donor].known[frame] != 0; });
  }

 private:
  Path config(std::size_t frame) const {
    Path locations;
    for (const std::size_t donor : donors_) locations.push_back(locations_->markers[donor].location[frame]);
    return locations;
  }

  /// to ≈ fit · from, by weighted least squares (Kabsch 1976).
  std::optional<geometry::Rigid3> fit(const Path& from, const Path& to) const {
    if (from.size() < 3) return std::nullopt;
    Vector<3> from_mean = Vector<3>::Zero(), to_mean = Vector<3>::Zero();
    double weight = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      from_mean += weights_[i] * from[i];
      to_mean += weights_[i] * to[i];
      weight += weights_[i];
    }
    from_mean /= weight;
    to_mean /= weight;
    Matrix<3> cross = Matrix<3>::Zero();
    for (std::size_t i = 0; i < from.size(); ++i)
      cross += weights_[i] / weight * (to[i] - to_mean) * (from[i] - from_mean).transpose();
    const auto [U, values, V] = geometry::singular_values(cross);
    if (values[1] < 1e-6) return std::nullopt;  // m²: within a millimetre of one line
    const double sign = (U * V.transpose()).determinant() < 0 ? -1 : 1;
    geometry::Rigid3 result;
    result.rotation = U * Vector<3>(1, 1, sign).asDiagonal() * V.transpose();
    result.translation = to_mean - result.rotation * from_mean;
    return result;
  }

  const Locations* locations_;
  std::vector<std::size_t> donors_;
  std::vector<double> weights_;
  Path shape_;
};

/// A linear map from features to a place, learned by ridge regression on principal components.
class Regression {
 public:
  /// Rows are frames.
  Regression(const Dense& features, const Dense& locations)
      : feature_mean_(features.colwise().mean()), position_mean_(locations.colwise().mean()) {
    const Dense centred = features.rowwise() - feature_mean_.transpose();
    const double frames = static_cast<double>(features.rows());
    const auto principal = geometry::eigenpairs<Eigen::Dynamic>(centred.transpose() * centred / frames);
    const Eigen::VectorXd& variance = principal.values;  // growing
    Eigen::Index components = 0;
    const double enough = 1e-4 * variance.sum();
    for (double left = variance.sum(); components < variance.size() && left > enough; ++components)
      left -= variance[variance.size() - 1 - components];
    components = std::min<Eigen::Index>(components, features.rows() / 8 + 1);
    basis_ = principal.vectors.rightCols(components);
    const Dense scores = centred * basis_;
    Dense normal = scores.transpose() * scores;
    normal.diagonal().array() += frames * kNoise * kNoise;
    map_ = geometry::solve_symmetric(normal, scores.transpose() * (locations.rowwise() - position_mean_.transpose()));
  }

  Vector<3> operator()(const Eigen::VectorXd& features) const {
    return position_mean_ + map_.transpose() * (basis_.transpose() * (features - feature_mean_));
  }

 private:
  static constexpr double kNoise = 1e-3;  // m, of a feature

  Eigen::VectorXd feature_mean_;
  Vector<3> position_mean_;
  Dense basis_, map_;
};

/// The donors' places in the carrier's frame.
Eigen::VectorXd features_at(const Locations& locations, std::span<const std::size_t> donors,
                            const geometry::Rigid3& shape_from_world, std::size_t frame) {
  Eigen::VectorXd features(3 * std::ssize(donors));
  for (std::size_t i = 0; i < donors.size(); ++i)
    features.segment<3>(3 * static_cast<Eigen::Index>(i)) = shape_from_world * locations.markers[donors[i]].location[frame];
  return features;
}

/// Frames that have the marker and all donors, outside both holes: six hundred at most, spread evenly.
std::vector<std::size_t> frames_to_learn_from(const Locations& locations, std::size_t marker, std::span<const std::size_t> donors,
                                              const Hole& hole, const Hole& hidden) {
  std::vector<std::size_t> frames;
  for (std::size_t frame = 0; frame < locations.size(); ++frame) {
    const auto in = [&](const Hole& one) { return one.first <= frame && frame <= one.last; };
    const auto known = [&](std::size_t one) { return locations.markers[one].known[frame] != 0; };
    if (!in(hole) && !in(hidden) && known(marker) && std::all_of(donors.begin(), donors.end(), known)) frames.push_back(frame);
  }
  constexpr std::size_t kMaxCount = 600;  // numerical: more frames only cost time
  if (frames.size() <= kMaxCount) return frames;
  std::vector<std::size_t> fewer;
  for (std::size_t i = 0; i < kMaxCount; ++i) fewer.push_back(frames[i * frames.size() / kMaxCount]);
  return fewer;
}

/// A polynomial over `t` by least squares, a column of coefficients for each coordinate; t is scaled to about one.
Dense fitted(const std::vector<double>& t, const Path& path, int degree) {
  Dense powers(std::ssize(t), degree + 1), values(std::ssize(t), 3);
  for (Eigen::Index i = 0; i < std::ssize(t); ++i) {
    double power = 1;
    for (int k = 0; k <= degree; ++k, power *= t[static_cast<std::size_t>(i)]) powers(i, k) = power;
    values.row(i) = path[static_cast<std::size_t>(i)].transpose();
  }
  return geometry::solve_symmetric(powers.transpose() * powers, powers.transpose() * values);
}

Vector<3> value_of(const Dense& polynomial, double t) {
  Vector<3> value = Vector<3>::Zero();
  for (Eigen::Index k = polynomial.rows() - 1; k >= 0; --k) value = value * t + polynomial.row(k).transpose();
  return value;
}

}  // namespace

bool Locations::Marker::spans(const Hole& hole) const {
  if (hole.first == 0 || hole.last + 1 >= known.size()) return false;
  const auto begin = known.begin() + static_cast<std::ptrdiff_t>(hole.first) - 1;
  return std::all_of(begin, begin + static_cast<std::ptrdiff_t>(hole.size()) + 2, [](char one) { return one != 0; });
}

std::vector<std::size_t> donors_of(const Locations& locations, std::size_t marker, const Hole& hole) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t other = 0; other < locations.markers.size(); ++other) {
    if (other == marker || !locations.markers[other].spans(hole)) continue;
    if (const auto wander = distance_deviation(locations.markers[marker], locations.markers[other]))
      ranked.emplace_back(*wander, other);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::size_t> donors;
  for (const auto& [wander, donor] : ranked) {
    if (donors.size() < kMaxDonors) donors.push_back(donor);
  }
  return donors;
}

std::optional<Path> spline_fill(const Locations& locations, std::size_t marker, const Hole& hole) {
  if (!has_ends(locations, marker, hole)) return std::nullopt;
  const Locations::Marker& detected = locations.markers[marker];
  const std::size_t reach = std::clamp<std::size_t>(hole.size() / 2 + 1, 4, 16);
  const double middle = 0.5 * static_cast<double>(hole.first + hole.last),
               scale = 0.5 * static_cast<double>(hole.size()) + static_cast<double>(reach);
  const auto scaled = [&](std::size_t frame) { return (static_cast<double>(frame) - middle) / scale; };
  std::vector<double> t;
  Path path;
  const auto take = [&](std::size_t frame) {
    if (detected.known[frame] == 0) return false;
    t.push_back(scaled(frame));
    path.push_back(detected.location[frame]);
    return true;
  };
  for (std::size_t i = 1; i <= reach && i <= hole.first && take(hole.first - i); ++i) {
  }
  const std::size_t before = t.size();
  for (std::size_t i = 1; i <= reach && hole.last + i < locations.size() && take(hole.last + i); ++i) {
  }
  const std::size_t fewer = std::min(before, t.size() - before);
  const Dense polynomial = fitted(t, path, fewer >= 4 ? 5 : fewer >= 2 ? 3 : 1);
  Path filled;
  for (std::size_t frame = hole.first; frame <= hole.last; ++frame) filled.push_back(value_of(polynomial, scaled(frame)));
  bend(filled, detected.location[hole.first - 1] - value_of(polynomial, scaled(hole.first - 1)),
       detected.location[hole.last + 1] - value_of(polynomial, scaled(hole.last + 1)));
  return filled;
}

std::optional<Path> rigid_fill(const Locations& locations, std::size_t marker, const Hole& hole,
                               std::span<const std::size_t> donors) {
  if (donors.size() < 3 || !has_ends(locations, marker, hole)) return std::nullopt;
  const Locations::Marker& detected = locations.markers[marker];
  const Carrier carrier(locations, marker, donors, hole);
  const auto before = carrier.at(hole.first - 1), after = carrier.at(hole.last + 1);
  if (!before || !after) return std::nullopt;
  Path filled(hole.size(), before->inverse() * detected.location[hole.first - 1]);
  bend(filled, Vector<3>::Zero(), after->inverse() * detected.location[hole.last + 1] - filled.front());
  for (std::size_t i = 0; i < filled.size(); ++i) {
    const auto pose = carrier.at(hole.first + i);
    if (!pose) return std::nullopt;
    filled[i] = *pose * filled[i];
  }
  return filled;
}

std::optional<Path> pattern_fill(const Locations& locations, std::size_t marker, const Hole& hole,
                                 std::span<const std::size_t> donors, const Hole& hidden) {
  if (donors.size() < 4 || !has_ends(locations, marker, hole)) return std::nullopt;
  const Locations::Marker& detected = locations.markers[marker];
  const Carrier carrier(locations, marker, donors, hole);
  const std::vector<std::size_t> frames = frames_to_learn_from(locations, marker, donors, hole, hidden);
  if (frames.size() < 40) return std::nullopt;
  Dense features(std::ssize(frames), 3 * std::ssize(donors)), targets(std::ssize(frames), 3);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto pose = carrier.at(frames[i]);
    if (!pose) return std::nullopt;
    const geometry::Rigid3 shape_from_world = pose->inverse();
    const auto row = static_cast<Eigen::Index>(i);
    features.row(row) = features_at(locations, donors, shape_from_world, frames[i]).transpose();
    targets.row(row) = (shape_from_world * detected.location[frames[i]]).transpose();
  }
  const Regression reported(features, targets);
  Path filled;
  std::vector<geometry::Rigid3> poses;
  for (std::size_t frame = hole.first - 1; frame <= hole.last + 1; ++frame) {
    const auto pose = carrier.at(frame);
    if (!pose) return std::nullopt;
    poses.push_back(*pose);
    filled.push_back(reported(features_at(locations, donors, pose->inverse(), frame)));
  }
  const Vector<3> at_first = poses.front().inverse() * detected.location[hole.first - 1] - filled.front();
  const Vector<3> at_last = poses.back().inverse() * detected.location[hole.last + 1] - filled.back();
  filled.erase(filled.begin());
  filled.pop_back();
  bend(filled, at_first, at_last);
  for (std::size_t i = 0; i < filled.size(); ++i) filled[i] = poses[i + 1] * filled[i];
  return filled;
}

}  // namespace marey::edit
