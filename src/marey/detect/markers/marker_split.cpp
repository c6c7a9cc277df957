// Two to four discs in one blob. The blob is reported as the union of k discs with one edge width and one brightness: a pixel's
// share is 1 − Π (1 − sᵢ), whichever disc lies in front. All centres and radii, the contrast, the background and the blur are
// fitted together by Levenberg-Marquardt, begun from k-means of the bright pixels along the blob's long axis. Where discs add up
// instead of hiding each other the overlap is brighter than a disc; such pixels are cut to the discs' own level first. The rival is
// one marker in motion: a disc swept along a segment (distance to the segment instead of the point). The blob is split when the
// discs leave clearly less than the swept disc does, their radii are alike, and their centres lie apart. Cost: about 10 steps of k
// error shares a pixel (marker_disc_models); the caller bounds the number of pairs.
#include "marey/detect/markers/marker_split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>

#include "marey/detect/markers/marker_disc_models.h"

namespace marey::detect::markers {
namespace {

constexpr double kDistinctly = 0.5;          // of the squares that one swept disc leaves
constexpr double kDistinctlyExpected = 0.8;  // where the tracker knows of several
constexpr double kCertainly = 20;            // noise variances: where discs fit to the noise, by how much they must fit better
constexpr double kCertainlyExpected = -9;    // the tracker saw both: nearly as good will do
constexpr double kModelError = 0.006;        // of the contrast
constexpr double kMinApart = 0.8;            // centres, in mean radii
constexpr double kMaxUnlike = 2.2;           // larger radius over smaller
constexpr double kMovingDistinctly = 0.9;    // of the squares that one swept disc leaves
constexpr double kSimpler = 1.3;             // of the squares that three or four discs at rest leave: it has fewer parameters
constexpr double kMovingApart = 1.2;         // centres of two in motion, in mean radii
constexpr double kGrain = 0.03;              // of the contrast: one swept disc that leaves no more is not asked whether it is two
constexpr int kMinMoving = 120, kMaxMoving = 4000;  // px, of a window in which two in motion are searched for
constexpr double kMinWithin = 0.7;                  // of a disc
constexpr double kWellReported = 0.08;              // of the contrast: what an explanation leaves at most

/// The level of a disc, where pixels are brighter than that: an overlap of discs that add up. Else nothing.
std::optional<float> level_below_overlap(const std::vector<float>& value, double noise) {
  std::vector<float> bright;
  std::copy_if(value.begin(), value.end(), std::back_inserter(bright), [](float v) { return v > 0.25f; });
  if (bright.size() < 8) return std::nullopt;
  const auto at = bright.begin() + static_cast<std::ptrdiff_t>(bright.size() * 6 / 10);
  std::nth_element(bright.begin(), at, bright.end());
  if (1.0f <= 1.2f * *at + 5.0f * static_cast<float>(noise)) return std::nullopt;
  return *at;
}

/// k centres by k-means over the pixels above half the contrast, begun in even steps along the long axis.
std::vector<Vector<2>> centres(const MarkerWindow& window, const std::vector<float>& value, int k, const Vector<2>& axis) {
  std::vector<Vector<2>> result;
  result.reserve(k);
  for (int i = 0; i < k; ++i) result.push_back(window.centroid + axis * (2.0 * i / (k - 1) - 1));
  for (int round = 0; round < 10; ++round) {
    std::array<Vector<2>, kMaxDiscs> sums;
    std::array<double, kMaxDiscs> counts{};
    sums.fill(Vector<2>::Zero());
    for (int i = 0; i < window.count; ++i) {
      if (value[i] < 0.4f) continue;
      const Vector<2> location(window.x[i], window.y[i]);
      const auto nearest = std::min_element(result.begin(), result.end(), [&](const auto& a, const auto& b) {
        return (a - location).squaredNorm() < (b - location).squaredNorm();
      });
      sums[nearest - result.begin()] += location;
      counts[nearest - result.begin()] += 1;
    }
    for (int j = 0; j < k; ++j) {
      if (counts[j] > 0) result[j] = sums[j] / counts[j];
    }
  }
  return result;
}

bool distinct(const DiscsModel& model, double least_apart = kMinApart) {
  for (int i = 0; i < model.discs; ++i) {
    for (int j = 0; j < i; ++j) {
      const auto a = model.p.segment<3>(kFirstDisc + 3 * i), b = model.p.segment<3>(kFirstDisc + 3 * j);
      const double apart = (a.head<2>() - b.head<2>()).norm();
      if (apart < least_apart * (a[2] + b[2]) / 2) return false;
      if (std::max(a[2], b[2]) > kMaxUnlike * std::min(a[2], b[2])) return false;
    }
  }
  return true;
}

std::vector<MarkerShape> shapes(const DiscsSolution& solution, const MarkerWindow& window, double stiffness) {
  const DiscsModel& model = solution.model;
  DiscsInformation information = solution.normal.information;
  information(kDiscsBlur, kDiscsBlur) += stiffness;
  information.diagonal().array() += 1e-9;
  const double left = solution.normal.squares / std::max<double>(1, window.count - static_cast<double>(model.p.size()));
  const DiscsInformation spread = information.llt().solve(DiscsInformation::Identity(model.p.size(), model.p.size())) * left;
  std::vector<MarkerShape> result;
  for (int i = 0; i < model.discs; ++i) {
    MarkerShape shape;
    const int at = kFirstDisc + 3 * i;
    shape.centre = window.origin + model.p.segment<2>(at);
    shape.covariance = spread.block<2, 2>(at, at) + Matrix<2>::Identity() * 1e-4;
    shape.radius = model.p[at + 2];
    shape.blur = model.p[kDiscsBlur];
    shape.contrast = model.p[kDiscsContrast] * window.scale;
    shape.misfit = std::sqrt(solution.normal.squares / window.count) / model.p[kDiscsContrast];
    shape.part = model.discs > 1;
    shape.fitted = true;
    result.push_back(shape);
  }
  std::sort(result.begin(), result.end(), [](const MarkerShape& a, const MarkerShape& b) {
    return std::pair(a.centre.x(), a.centre.y()) < std::pair(b.centre.x(), b.centre.y());
  });
  return result;
}

/// The ellipse of a blob's instants, px.
struct BlobEllipse {
  double half_length = 0, half_width = 0;
  Vector<2> along = Vector<2>::UnitX();
};

BlobEllipse ellipse_of(const MarkerBlob& blob) {
  const double mean = (blob.var_x + blob.var_y) / 2;
  const double spread = std::hypot((blob.var_x - blob.var_y) / 2, blob.cov_xy);
  const double angle = std::atan2(blob.cov_xy, (blob.var_x - blob.var_y) / 2) / 2;
  return {2 * std::sqrt(mean + spread), 2 * std::sqrt(std::max(mean - spread, 1.0 / 12)), {std::cos(angle), std::sin(angle)}};
}

/// One disc that moved while it was seen.
DiscsModel swept_disc(const BlobEllipse& ellipse, const MarkerWindow& window, double blur) {
  DiscsModel swept{DiscsParameters(kFirstDisc + 5), 1, true};
  const Vector<2> reach = ellipse.along * std::max(ellipse.half_length - ellipse.half_width, 0.3);
  swept.p << 0.9, 0.0, blur, window.centroid.x(), window.centroid.y(), std::max(ellipse.half_width - 0.3, 0.4), reach.x(),
      reach.y();
  return swept;
}

/// This many discs, whose places are still to be set.
DiscsModel several_discs(int count, const MarkerWindow& window, const MarkerSurroundings& around, double blur) {
  DiscsModel discs{DiscsParameters(kFirstDisc + 3 * count), count};
  discs.ceiling = around.dark ? window.background / window.scale : std::abs(around.white - window.background) / window.scale;
  discs.p.head<kFirstDisc>() << 0.9, 0.0, blur;
  return discs;
}

/// What is the same for each number of discs.
struct SplitTask {
  const MarkerWindow& window;
  const MarkerSurroundings& around;
  BlobEllipse ellipse;
  double noise = 0, stiffness = 0, blur = 0, floor = 0;
  std::vector<float> whole, value;  // all light; cut to a disc's own level where discs add up
  std::optional<float> overlap;
};

SplitTask task_of(const MarkerWindow& window, const MarkerBlob& blob, const MarkerSurroundings& around) {
  SplitTask task{.window = window, .around = around, .ellipse = ellipse_of(blob), .whole = {}, .value = {}, .overlap = {}};
  task.noise = around.noise / window.scale;
  task.stiffness = task.noise * task.noise / 0.01;
  task.blur = around.blur.value_or(0.65);
  task.floor = window.count * (1.5 * task.noise * task.noise + kModelError * kModelError);  // what right models leave
  task.whole = window.value;
  task.value = task.whole;
  task.overlap = level_below_overlap(task.whole, task.noise);
  if (task.overlap) {
    for (float& v : task.value) v = std::min(v, 1.05f * *task.overlap);
  }
  return task;
}

/// Whether the discs lie where the blob does: beside the edge of something dimmer, which reaches further than that, a fit takes the
/// dimmer level for that of discs, one disc for where they add up, and lays others half out of the window.
bool within_window(const DiscsModel& model, const MarkerWindow& window) {
  for (int i = 0; i < model.discs; ++i) {
    const auto disc = model.p.segment<3>(kFirstDisc + 3 * i);
    int inside = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(window.count); ++k)
      inside += std::hypot(window.x[k] - disc[0], window.y[k] - disc[1]) < disc[2] ? 1 : 0;
    if (inside < kMinWithin * std::numbers::pi * disc[2] * disc[2]) return false;
  }
  return true;
}

DiscsSolution fit_several(const SplitTask& task, int count) {
  DiscsModel discs = several_discs(count, task.window, task.around, task.blur);
  const double radius = std::max(0.4, std::sqrt(task.window.half_area / (count * std::numbers::pi)));
  const auto locations = centres(task.window, task.value, count, task.ellipse.along * task.ellipse.half_length * (1 - 1.0 / count));
  for (int i = 0; i < count; ++i)
    discs.p.segment<3>(kFirstDisc + 3 * i) << locations[static_cast<std::size_t>(i)].x(),
        locations[static_cast<std::size_t>(i)].y(), radius;
  DiscsSolution solution = fit_discs(discs, task.window, task.value, task.stiffness);
  if (!task.overlap || count != 2) return solution;  // more discs that add up could explain any streak
  discs.adds = true;
  discs.p[kDiscsContrast] = *task.overlap;
  DiscsSolution sum = fit_discs(discs, task.window, task.whole, task.stiffness);
  return sum.normal.squares < std::min(task.floor, solution.normal.squares) ? std::move(sum) : std::move(solution);
}

/// Two discs as far from each other and on such a trajectory as begins a fit.
DiscsModel moving_pair(const SplitTask& task, const Vector<2>& apart, const Vector<2>& path, double radius) {
  DiscsModel pair = several_discs(2, task.window, task.around, task.blur);
  pair.p.conservativeResize(kFirstDisc + 8);
  pair.swept = true;
  for (int i = 0; i < 2; ++i) {
    const Vector<2> location = task.window.centroid + (i == 0 ? -0.5 : 0.5) * apart;
    pair.p.segment<3>(kFirstDisc + 3 * i) << location.x(), location.y(), radius;
  }
  pair.p.tail<2>() = path;
  return pair;
}

/// Two that touch and moved together while they were seen: across the line between them, along it with the blob's length for the
/// one or the other.
DiscsSolution fit_moving_pair(const SplitTask& task) {
  const Vector<2> along = task.ellipse.along, across(-along.y(), along.x());
  const double length = task.ellipse.half_length, width = task.ellipse.half_width;
  const double radius = std::max(0.7, std::min(std::sqrt(task.window.half_area / (2 * std::numbers::pi)), length / 2));
  const auto fitted = [&](const Vector<2>& apart, const Vector<2>& path) {
    return fit_discs(moving_pair(task, apart, path, radius), task.window, task.value, task.stiffness);
  };
  DiscsSolution best = fitted(length * along, std::max(0.3, width - radius) * across);
  for (const DiscsSolution& other :
       std::array{fitted(length * along, 0.25 * length * along), fitted(width * across, std::max(0.3, length - radius) * along)}) {
    if (other.normal.squares < best.normal.squares) best = other;
  }
  return best;
}

}  // namespace

MarkerSplit split_markers(const MarkerWindow& window, const MarkerBlob& blob, const MarkerSurroundings& around,
                          std::size_t expected, bool moving) {
  if (window.count < 20) return {};
  const SplitTask task = task_of(window, blob, around);
  const DiscsSolution rival = fit_discs(swept_disc(task.ellipse, window, task.blur), window, task.value, task.stiffness);
  const double fraction = expected >= 2 ? kDistinctlyExpected : kDistinctly;
  const double certainly = (expected >= 2 ? kCertainlyExpected : kCertainly) * task.noise * task.noise;
  double to_beat = rival.normal.squares;
  MarkerSplit best;
  for (int k = 2; k <= kMaxDiscs; ++k) {
    const DiscsSolution solution = fit_several(task, k);
    const double left = solution.normal.squares;
    const bool clear = left < fraction * to_beat || (left < task.floor && to_beat - left > certainly);
    if (!distinct(solution.model) || !clear || !within_window(solution.model, window)) {
      if (k == 2) continue;  // three in a corner may fit where two do not
      break;
    }
    best.discs = shapes(solution, window, task.stiffness);
    to_beat = left;
    if (left < task.floor || best.discs.front().misfit < 0.04) break;
  }
  const double maximum = std::max(kWellReported, 3 * task.noise);
  const MarkerShape swept = shapes(rival, window, task.stiffness).front();
  const double reported = best.discs.empty() ? swept.misfit : best.discs.front().misfit;
  const bool may_move = moving && window.count >= kMinMoving && window.count <= kMaxMoving;
  if (may_move && (reported > std::max(kGrain, 2 * task.noise) || best.discs.size() > 2)) {
    const DiscsSolution pair = fit_moving_pair(task);
    const double limit = (best.discs.size() > 2 ? kSimpler : kMovingDistinctly) * to_beat;
    if (distinct(pair.model, kMovingApart) && pair.normal.squares < limit) best.discs = shapes(pair, window, task.stiffness);
  }
  if (!best.discs.empty() && best.discs.front().misfit > maximum) best.discs.clear();
  if (best.discs.empty() && swept.misfit <= maximum) best.swept = swept;
  return best;
}

}  // namespace marey::detect::markers
