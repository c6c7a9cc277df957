#include "marey/analyse/smooth_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "marey/core/error.h"
#include "marey/filter/human_motion.h"
#include "marey/filter/position_smoother.h"
#include "marey/geometry/butterworth.h"
#include "marey/geometry/local_polynomial.h"
#include "marey/geometry/median.h"

namespace marey::analyse {
namespace {

constexpr double kReported = 0.2;  // s before and after: measured places within give a speed; smoothing reaches about so far

constexpr double kSureSpeed =
    0.75;  // m/s, standard deviation: half of the narrowest of the typical zones. What is less sure is not one

struct Row {
  double time = 0;  // s
  Vector<2> location;
  Matrix<2> covariance;  // m²
  std::optional<Vector<2>> velocity = {};
  bool measured = true;
};

bool is_measured(const Row& nearest, double time, double step_s) {
  return nearest.measured && std::abs(nearest.time - time) <= step_s;
}

/// The places of one piece at an even rate: the median of its steps. Velocities likewise, where all are known.
Path evenly(std::span<const Row> piece) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < piece.size(); ++i) steps.push_back(piece[i].time - piece[i - 1].time);
  Path path;
  path.start_s = piece.front().time;
  path.step_s = geometry::median(steps);
  const double span = piece.back().time - path.start_s;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round(span / path.step_s))) + 1;
  path.step_s = span / static_cast<double>(count - 1);
  const bool moving = std::all_of(piece.begin(), piece.end(), [](const Row& row) { return row.velocity.has_value(); });
  std::size_t after = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = path.start_s + path.step_s * static_cast<double>(i);
    while (after + 1 < piece.size() && piece[after].time < time) ++after;
    const Row &a = piece[after - 1], &b = piece[after];
    const double fraction = std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0);
    path.location.emplace_back(a.location + fraction * (b.location - a.location));
    if (moving) path.velocity.emplace_back(*a.velocity + fraction * (*b.velocity - *a.velocity));
    path.detected.push_back(is_measured(fraction < 0.5 ? a : b, time, path.step_s));
  }
  return path;
}

/// Half of the instants round each, at least, are measured: one missed row does not take a speed away, and one inspection in a gap
/// gives none. At its ends a path is not seen from both sides: `ends` states whether they are known all the same.
std::vector<bool> reported_by_measured(const std::vector<bool>& measured, double step_s, bool ends) {
  const auto reach = static_cast<std::ptrdiff_t>(std::floor(kReported / step_s + 1e-9));
  const auto count = std::ssize(measured);
  std::vector<std::ptrdiff_t> until(measured.size() + 1, 0);
  for (std::size_t i = 0; i < measured.size(); ++i) until[i + 1] = until[i] + (measured[i] ? 1 : 0);
  std::vector<bool> reported(measured.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto from = std::max<std::ptrdiff_t>(0, i - reach), to = std::min(count, i + reach + 1);
    const auto detected = until[static_cast<std::size_t>(to)] - until[static_cast<std::size_t>(from)];
    reported[static_cast<std::size_t>(i)] = 2 * detected >= to - from && (ends || to - from == 2 * reach + 1);
  }
  return reported;
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

void savitzky_golay(Path& path, double window_s) {
  const auto half = std::max<std::ptrdiff_t>(1, std::lround(window_s / path.step_s / 2));
  const auto count = static_cast<std::ptrdiff_t>(path.location.size());
  std::vector<Vector<2>> location(path.location.size()), velocity(path.location.size()), acceleration(path.location.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    geometry::LocalPolynomial<3, 2> parabola;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - half); j <= std::min(count - 1, i + half); ++j) {
      const double t = path.step_s * static_cast<double>(j - i);
      parabola.add(Vector<3>(1, t, t * t / 2), 1, path.location[static_cast<std::size_t>(j)].transpose());
    }
    const Eigen::Matrix<double, 3, 2> fit = parabola.fit();
    location[static_cast<std::size_t>(i)] = fit.row(0);
    velocity[static_cast<std::size_t>(i)] = fit.row(1);
    acceleration[static_cast<std::size_t>(i)] = fit.row(2);
  }
  path.location = std::move(location);
  path.velocity = std::move(velocity);
  path.acceleration = std::move(acceleration);
}

// --- Kalman, from both ends -----------------------------------------------------------------------------------------------------

void rauch_tung_striebel(Path& path, double position_noise, double acceleration) {
  constexpr double unknown_speed = 5;  // m/s
  std::vector<double> times;
  std::vector<Eigen::Matrix<double, 1, 2>> locations;
  for (const Vector<2>& location : path.location) {
    times.push_back(path.step_s * static_cast<double>(times.size()));
    locations.emplace_back(location.transpose());
  }
  const std::vector<double> variances(locations.size(), position_noise * position_noise);
  const auto states = filter::smoothed_positions<filter::WhiteAcceleration, 2>({.noise = acceleration}, times, locations, variances,
                                                                               unknown_speed * unknown_speed);
  path.velocity.resize(path.location.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    path.location[i] = states[i].row(0);
    path.velocity[i] = states[i].row(1);
  }
}

void smooth(Path& path, const PathOptions& options) {
  switch (options.method) {
    case PathOptions::Method::lowpass:
      low_pass(path.location, options.cutoff_hz, 1 / path.step_s);
      break;
    case PathOptions::Method::savgol:
      savitzky_golay(path, options.window_s);
      break;
    case PathOptions::Method::kalman:
      rauch_tung_striebel(path, options.position_noise, options.acceleration);
      break;
    case PathOptions::Method::raw:
      break;
  }
}

/// By which a speed's deviation is a place's, 1/s. Left after smoothing are errors slower than the cut-off; of errors whose
/// power is even up to there the derivative has 2π/√3 times the cut-off. Where nothing is smoothed, differences have it all.
double speed_per_position(const PathOptions& options, double step_s, bool smoothed) {
  if (!smoothed && options.method == PathOptions::Method::raw) return 1 / (std::numbers::sqrt2 * step_s);
  const double cutoff = !smoothed && options.method == PathOptions::Method::lowpass ? options.cutoff_hz : PathOptions().cutoff_hz;
  return 2 * std::numbers::pi * cutoff / std::numbers::sqrt3;
}

/// Of each instant, by the covariance of the row that is nearest, along the path.
std::vector<double> speed_sigmas(const Path& path, std::span<const Row> piece, double per_place) {
  std::vector<double> sigmas;
  std::size_t near = 0;
  for (std::size_t i = 0; i < path.location.size(); ++i) {
    const double time = path.start_s + path.step_s * static_cast<double>(i);
    while (near + 1 < piece.size() && std::abs(piece[near + 1].time - time) <= std::abs(piece[near].time - time)) ++near;
    const Matrix<2>& P = piece[near].covariance;
    const double speed = path.velocity[i].norm();
    const Vector<2> ahead = path.velocity[i] / speed;
    sigmas.push_back(per_place * std::sqrt(speed > 1e-9 ? ahead.dot(P * ahead) : P.trace() / 2));
  }
  return sigmas;
}

/// A piece without a gap, with what it has no smoother of its own for: differences.
Path path_of(std::span<const Row> piece, const PathOptions& options, bool smoothed) {
  Path path = evenly(piece);
  if (!smoothed) smooth(path, options);
  if (path.velocity.empty()) path.velocity = slope(path.location, path.step_s);
  if (path.acceleration.empty()) path.acceleration = slope(path.velocity, path.step_s);
  path.detected = reported_by_measured(path.detected, path.step_s, smoothed);
  path.speed_sigma = speed_sigmas(path, piece, speed_per_position(options, path.step_s, smoothed));
  const bool raw = !smoothed && options.method == PathOptions::Method::raw;  // asked for as it is
  for (std::size_t i = 0; i < path.detected.size() && !raw; ++i)
    path.detected[i] = path.detected[i] && path.speed_sigma[i] <= kSureSpeed;
  return path;
}

/// Takes rows in which a person did what no person can out. `cut`: the rows, of those left, before which another person begins.
std::vector<ImpossibleSegment> leave_impossible_out(std::vector<Row>& rows, std::vector<bool>& cut) {
  std::vector<filter::TimedPosition> locations;
  std::vector<std::size_t> row_of;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].measured) continue;
    locations.push_back({rows[i].time, rows[i].location, rows[i].covariance});
    row_of.push_back(i);
  }
  std::vector<ImpossibleSegment> impossible;
  std::vector<bool> out(rows.size(), false), begins(rows.size(), false);
  for (const filter::ImpossiblePiece& piece : filter::impossible_pieces(locations)) {
    impossible.push_back({locations[piece.first].time, locations[piece.last].time, piece.one_person});
    for (std::size_t i = row_of[piece.first]; i <= row_of[piece.last]; ++i) out[i] = true;
    if (!piece.one_person) begins[row_of[piece.last]] = true;
  }
  cut.clear();
  bool other = false;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    other = other || begins[i];
    if (out[i]) continue;
    cut.push_back(std::exchange(other, false));
    rows[kept++] = rows[i];
  }
  rows.resize(kept);
  return impossible;
}

/// Pieces without a long gap, and without a cut before any but their first row.
std::vector<Path> pieces_of(std::span<const Row> rows, const std::vector<bool>& cut, const PathOptions& options, bool smoothed) {
  std::vector<Path> paths;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin + 1;
    while (end < rows.size() && !cut[end] && rows[end].time - rows[end - 1].time <= options.longest_gap_s) ++end;
    if (end - begin >= 2) paths.push_back(path_of(rows.subspan(begin, end - begin), options, smoothed));
    begin = end;
  }
  return paths;
}

/// A place that was not measured is known no better than the measured ones before and after it.
void widen_unmeasured(std::vector<Row>& rows) {
  const auto raise_unmeasured = [](auto from, auto to) {
    const Row* last = nullptr;
    for (auto row = from; row != to; ++row) {
      if (row->measured) last = &*row;
      if (!row->measured && last != nullptr && last->covariance.trace() > row->covariance.trace())
        row->covariance = last->covariance;
    }
  };
  raise_unmeasured(rows.begin(), rows.end());
  raise_unmeasured(rows.rbegin(), rows.rend());
}

/// Puts rows that were not measured straight between those that were, and omits those before the first and after the last:
/// whatever followed the person there, smoothing would carry it into the speeds beside.
void bridge_unmeasured(std::vector<Row>& rows) {
  const auto measured = [](const Row& row) { return row.measured; };
  rows.erase(std::find_if(rows.rbegin(), rows.rend(), measured).base(), rows.end());
  rows.erase(rows.begin(), std::find_if(rows.begin(), rows.end(), measured));
  std::size_t next = 0;  // measured, behind the row at hand
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].measured) continue;
    for (next = std::max(next, i); !rows[next].measured; ++next) {
    }
    const Row &before = rows[i - 1], &after = rows[next];
    rows[i].location =
        before.location + (rows[i].time - before.time) / (after.time - before.time) * (after.location - before.location);
  }
}

Matrix<2> default_covariance(const PathOptions& options) {
  return options.position_sigma * options.position_sigma * Matrix<2>::Identity();
}

}  // namespace

PathOptions::Method parse_path_method(std::string_view name) {
  if (name == "lowpass") return PathOptions::Method::lowpass;
  if (name == "savgol") return PathOptions::Method::savgol;
  if (name == "kalman") return PathOptions::Method::kalman;
  if (name == "raw") return PathOptions::Method::raw;
  throw Error("\"{}\" is not a way to smooth; these are: lowpass, savgol, kalman, raw", name);
}

std::vector<Path> smooth_paths(std::span<const double> times, std::span<const double> x, std::span<const double> y,
                               const PathOptions& options) {
  std::vector<Row> rows;
  rows.reserve(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (rows.empty() || times[i] > rows.back().time) rows.push_back({times[i], {x[i], y[i]}, default_covariance(options)});
  }
  return pieces_of(rows, std::vector<bool>(rows.size(), false), options, false);
}

PersonPaths paths_of(const Recording& recording, const TrackColumns& track, const PathOptions& options) {
  const bool smoothed = recording.header.smoothed;
  std::vector<Row> rows;
  rows.reserve(track.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double time = recording.seconds_at(static_cast<std::size_t>(track.at()[i]));
    if (!rows.empty() && time <= rows.back().time) continue;
    const Sample sample = track.sample(i);
    Row& row = rows.emplace_back(Row{time, track.location(i), default_covariance(options)});
    if (sample.covariance) row.covariance = sample.covariance->topLeftCorner<2, 2>();
    row.measured = sample.provenance == Provenance::measured;
    if (smoothed && sample.velocity) row.velocity = sample.velocity->head<2>();
  }
  PersonPaths person;
  person.measured = std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.measured; });
  widen_unmeasured(rows);
  if (!smoothed) bridge_unmeasured(rows);
  std::vector<bool> cut;
  person.impossible = leave_impossible_out(rows, cut);
  person.paths = pieces_of(rows, cut, options, smoothed);
  return person;
}

}  // namespace marey::analyse
