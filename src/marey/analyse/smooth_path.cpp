#include "marey/analyse/smooth_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>

#include "marey/core/error.h"
#include "marey/geometry/butterworth.h"
#include "marey/geometry/decompositions.h"

namespace marey::analyse {
namespace {

struct Row {
  double time = 0;  // s
  Vector<2> place;
  std::optional<Vector<2>> velocity = {};
};

/// The places of one piece at an even rate: the median of its steps. Velocities likewise, where all are known.
Path evenly(std::span<const Row> piece) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < piece.size(); ++i) steps.push_back(piece[i].time - piece[i - 1].time);
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  Path path;
  path.start_s = piece.front().time;
  path.step_s = steps[steps.size() / 2];
  const double span = piece.back().time - path.start_s;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round(span / path.step_s))) + 1;
  path.step_s = span / static_cast<double>(count - 1);
  const bool moving = std::all_of(piece.begin(), piece.end(), [](const Row& row) { return row.velocity.has_value(); });
  std::size_t after = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = path.start_s + path.step_s * static_cast<double>(i);
    while (after + 1 < piece.size() && piece[after].time < time) ++after;
    const Row &a = piece[after - 1], &b = piece[after];
    const double share = std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0);
    path.place.emplace_back(a.place + share * (b.place - a.place));
    if (moving) path.velocity.emplace_back(*a.velocity + share * (*b.velocity - *a.velocity));
  }
  return path;
}

/// Central differences; one-sided at the ends.
std::vector<Vector<2>> slope(const std::vector<Vector<2>>& values, double step) {
  std::vector<Vector<2>> result(values.size(), Vector<2>::Zero());
  const std::size_t last = values.size() - 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, last);
    if (after > before) result[i] = (values[after] - values[before]) / (step * static_cast<double>(after - before));
  }
  return result;
}

void low_pass(std::vector<Vector<2>>& values, double cutoff_hz, double rate_hz) {
  const double each = std::min(geometry::cutoff_of_one_pass(cutoff_hz), 0.45 * rate_hz);
  geometry::low_pass(std::span(values), each / rate_hz, static_cast<std::size_t>(std::ceil(2 * rate_hz / cutoff_hz)));
}

// --- Savitzky-Golay
// ---------------------------------------------------------------------------------------------------------------

/// Of N x = v with N symmetric and not negative; the shortest where several solve it, as with fewer places than coefficients.
Eigen::Matrix<double, 3, 2> least_norm_solution(const Matrix<3>& N, const Eigen::Matrix<double, 3, 2>& v) {
  const auto [values, vectors] = geometry::eigenpairs<3>(N);
  const double least = 3 * std::numeric_limits<double>::epsilon() * values[2];
  Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
  for (int i = 0; i < 3; ++i) {
    if (values[i] > least) x += vectors.col(i) * (vectors.col(i).transpose() * v / values[i]);
  }
  return x;
}

void savitzky_golay(Path& path, double window_s) {
  const auto half = std::max<std::ptrdiff_t>(1, std::lround(window_s / path.step_s / 2));
  const auto count = static_cast<std::ptrdiff_t>(path.place.size());
  std::vector<Vector<2>> place(path.place.size()), velocity(path.place.size()), acceleration(path.place.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Matrix<3> N = Matrix<3>::Zero();
    Eigen::Matrix<double, 3, 2> v = Eigen::Matrix<double, 3, 2>::Zero();
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - half); j <= std::min(count - 1, i + half); ++j) {
      const double t = path.step_s * static_cast<double>(j - i);
      const Vector<3> basis(1, t, t * t / 2);
      N += basis * basis.transpose();
      v += basis * path.place[static_cast<std::size_t>(j)].transpose();
    }
    const Eigen::Matrix<double, 3, 2> fit = least_norm_solution(N, v);
    place[static_cast<std::size_t>(i)] = fit.row(0);
    velocity[static_cast<std::size_t>(i)] = fit.row(1);
    acceleration[static_cast<std::size_t>(i)] = fit.row(2);
  }
  path.place = std::move(place);
  path.velocity = std::move(velocity);
  path.acceleration = std::move(acceleration);
}

// --- Kalman, from both ends -----------------------------------------------------------------------------------------------------

/// Position and velocity of one axis; both axes share their covariance.
struct Moment {
  Eigen::Matrix2d mean;  // rows: position, velocity; columns: x, y
  Matrix<2> P;
};

void rauch_tung_striebel(Path& path, double place_noise, double acceleration) {
  const double dt = path.step_s, q = acceleration * acceleration;
  Matrix<2> A, Q;
  A << 1, dt, 0, 1;
  Q << q * dt * dt * dt / 3, q * dt * dt / 2, q * dt * dt / 2, q * dt;
  const double R = place_noise * place_noise;
  constexpr double unknown_speed = 5;  // m/s
  std::vector<Moment> ahead(path.place.size()), corrected(path.place.size());
  Moment now;
  now.mean.row(0) = path.place.front();
  now.mean.row(1).setZero();
  now.P = Vector<2>(R, unknown_speed * unknown_speed).asDiagonal();
  ahead[0] = corrected[0] = now;
  for (std::size_t i = 1; i < path.place.size(); ++i) {
    now.mean = A * now.mean;
    now.P = A * now.P * A.transpose() + Q;
    ahead[i] = now;
    const Vector<2> K = now.P.col(0) / (now.P(0, 0) + R);
    now.mean += K * (path.place[i].transpose() - now.mean.row(0));
    now.P -= K * now.P.row(0);
    corrected[i] = now;
  }
  path.velocity.resize(path.place.size());
  for (std::size_t i = path.place.size(); i-- > 0;) {
    if (i + 1 < path.place.size()) {
      const Matrix<2> G = corrected[i].P * A.transpose() * ahead[i + 1].P.inverse();
      corrected[i].mean += G * (corrected[i + 1].mean - ahead[i + 1].mean);
      corrected[i].P += G * (corrected[i + 1].P - ahead[i + 1].P) * G.transpose();
    }
    path.place[i] = corrected[i].mean.row(0);
    path.velocity[i] = corrected[i].mean.row(1);
  }
}

void smooth(Path& path, const PathOptions& options) {
  switch (options.method) {
    case PathOptions::Method::lowpass:
      low_pass(path.place, options.cutoff_hz, 1 / path.step_s);
      break;
    case PathOptions::Method::savgol:
      savitzky_golay(path, options.window_s);
      break;
    case PathOptions::Method::kalman:
      rauch_tung_striebel(path, options.place_noise, options.acceleration);
      break;
    case PathOptions::Method::raw:
      break;
  }
}

/// Pieces without a long gap, each with what it has no smoother of its own for: differences.
std::vector<Path> pieces_of(std::span<const Row> rows, const PathOptions& options, bool smoothed) {
  std::vector<Path> paths;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin + 1;
    while (end < rows.size() && rows[end].time - rows[end - 1].time <= options.longest_gap_s) ++end;
    if (end - begin >= 2) {
      Path& path = paths.emplace_back(evenly(rows.subspan(begin, end - begin)));
      if (!smoothed) smooth(path, options);
      if (path.velocity.empty()) path.velocity = slope(path.place, path.step_s);
      if (path.acceleration.empty()) path.acceleration = slope(path.velocity, path.step_s);
    }
    begin = end;
  }
  return paths;
}

}  // namespace

PathOptions::Method parse_path_method(std::string_view name) {
  if (name == "lowpass") return PathOptions::Method::lowpass;
  if (name == "savgol") return PathOptions::Method::savgol;
  if (name == "kalman") return PathOptions::Method::kalman;
  if (name == "raw") return PathOptions::Method::raw;
  throw Error("\"{}\" is no way to smooth; these are: lowpass, savgol, kalman, raw", name);
}

std::vector<Path> smooth_paths(std::span<const double> times, std::span<const double> x, std::span<const double> y,
                               const PathOptions& options) {
  std::vector<Row> rows;
  rows.reserve(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (rows.empty() || times[i] > rows.back().time) rows.push_back({times[i], {x[i], y[i]}});
  }
  return pieces_of(rows, options, false);
}

std::vector<Path> paths_of(const Recording& recording, const TrackColumns& track, const PathOptions& options) {
  const bool smoothed = recording.header.smoothed;
  std::vector<Row> rows;
  rows.reserve(track.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double time = recording.seconds_at(static_cast<std::size_t>(track.at()[i]));
    if (!rows.empty() && time <= rows.back().time) continue;
    rows.push_back({time, track.place(i)});
    const auto velocity = smoothed ? track.velocity(i) : std::nullopt;
    if (velocity) rows.back().velocity = velocity->head<2>();
  }
  return pieces_of(rows, options, smoothed);
}

}  // namespace marey::analyse
