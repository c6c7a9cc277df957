#include "marey/reconstruct/keypoints/person_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "marey/geometry/median.h"

namespace marey::reconstruct::keypoints {
namespace {

constexpr double kMaxSquare = 25;
constexpr double kWide = 1.5;  // times the noise, of the first paths
constexpr double kMinNoise = 0.1;
constexpr double kMedianSquare = 1.386;  // of two standard normal variables' squares
constexpr double kLastingBound = 3;      // standard deviations at which an error has a quarter of its weight
constexpr double kFewErrors = 5;         // instants by which a mean error is drawn to none

class PathFinder {
 public:
  PathFinder(PersonTrack& track, const KeypointSet& set, std::span<const std::optional<Camera>> cameras, const FindKeypoints& find,
             double step_s, const PersonPathOptions& options)
      : track_(track), set_(set), cameras_(cameras), find_(find), step_s_(step_s), options_(options), limbs_(limbs_of(set)) {}

  PersonPath find() {
    noise_ = kWide * std::max(1.0, options_.noise);
    PersonPath path;
    path.points.resize(set_.points.size());
    smooth_all(path);
    if (swap_sides(path)) smooth_all(path);
    if (options_.lasting_s > 0) take_lasting(path);
    learn_noise(path);
    smooth_all(path);
    if (swap_sides(path)) {
      learn_noise(path);
      smooth_all(path);
    }
    path.noise = noise_;
    return path;
  }

 private:
  std::optional<SightLine> line_at(std::size_t instant, int camera, std::size_t point, bool other_side) const {
    const LocatedPerson& located = track_.instants[instant];
    const int index = located.views.empty() ? -1 : located.views[static_cast<std::size_t>(camera)];
    const Keypoints<2>* detected = index < 0 ? nullptr : find_(track_.first + instant, camera, index);
    if (detected == nullptr) return std::nullopt;
    const auto& keypoint = detected->points[other_side ? static_cast<std::size_t>(set_.mirrored[point]) : point];
    if (!keypoint) return std::nullopt;
    const Camera& eye = *cameras_[static_cast<std::size_t>(camera)];
    if (lasting_.empty()) return line_of(eye, camera, *keypoint, noise_);
    Keypoint<2> moved = *keypoint;
    moved.position += lasting_[static_cast<std::size_t>(camera) * set_.points.size() + point][instant];
    return line_of(eye, camera, moved, noise_);
  }

  PointLines lines_of(std::size_t point) const {
    PointLines lines;
    for (std::size_t t = 0; t < track_.instants.size(); ++t) {
      for (int camera = 0; camera < std::ssize(track_.instants[t].views); ++camera) {
        if (const auto line = located_line(t, camera, point)) lines.add(*line);
      }
      lines.end_instant();
    }
    return lines;
  }

  std::vector<TrajectoryPoint> smooth(std::size_t point) const {
    std::vector<std::optional<Vector<3>>> start(track_.instants.size());
    for (std::size_t t = 0; t < start.size(); ++t) {
      const auto& points = track_.instants[t].points;
      if (!points.empty() && points[point]) start[t] = points[point]->position;
    }
    return smooth_trajectory(lines_of(point), start, step_s_, options_.trajectory);
  }

  void smooth_all(PersonPath& path) const {
    for (std::size_t i = 0; i < set_.points.size(); ++i) path.points[i] = smooth(i);
  }

  /// The deviation that the errors of all views show.
  void learn_noise(const PersonPath& path) {
    std::vector<double> squares;
    for (std::size_t i = 0; i < set_.points.size(); ++i) append_squares(lines_of(i), path.points[i], squares);
    if (squares.empty()) return;
    noise_ = std::max(kMinNoise, noise_ * std::sqrt(geometry::median(squares) / kMedianSquare));
  }

  /// Of each camera and point the mean error over a while, px: errors are averaged across the view at the point's distance, those
  /// far off with little weight.
  void take_lasting(const PersonPath& path) {
    const std::size_t count = track_.instants.size();
    std::vector<std::vector<Vector<2>>> lasting(cameras_.size() * set_.points.size());
    const auto half = static_cast<std::size_t>(std::max(1.0, options_.lasting_s / step_s_ / 2));
    for (std::size_t i = 0; i < set_.points.size(); ++i) {
      for (std::size_t c = 0; c < cameras_.size(); ++c) {
        std::vector<Vector<2>>& of = lasting[c * set_.points.size() + i];
        of.assign(count, Vector<2>::Zero());
        if (path.points[i].empty()) continue;
        std::vector<Vector<3>> sums(count + 1, Vector<3>::Zero());  // of weighted errors and of weights, up to each instant
        std::vector<double> scales(count, 0);                       // px/m
        for (std::size_t t = 0; t < count; ++t) {
          sums[t + 1] = sums[t];
          const auto line = located_line(t, static_cast<int>(c), i);
          if (!line) continue;
          const double depth = line->depth(path.points[i][t].position);
          if (!(depth > 0.1)) continue;
          scales[t] = line->scale() / depth;
          const Vector<2> error = line->error(path.points[i][t].position);
          const double fraction =
              kLastingBound * kLastingBound / (kLastingBound * kLastingBound + error.squaredNorm() / (line->sigma * line->sigma));
          sums[t + 1] += fraction * fraction * Vector<3>(error.x() / scales[t], error.y() / scales[t], 1);
        }
        for (std::size_t t = 0; t < count; ++t) {
          const Vector<3> sum = sums[std::min(count, t + half + 1)] - sums[t > half ? t - half : 0];
          of[t] = scales[t] / (sum.z() + kFewErrors) * sum.head<2>();
        }
      }
    }
    lasting_ = std::move(lasting);
  }

  /// The line by the names that the view is read with.
  std::optional<SightLine> located_line(std::size_t t, int camera, std::size_t point) const {
    if (track_.instants[t].views.empty()) return std::nullopt;
    return line_at(t, camera, point, track_.instants[t].mirrored[static_cast<std::size_t>(camera)].of(limbs_[point]));
  }

  /// How much better a view's limb fits with its names exchanged, by limb, in squared deviations.
  std::array<double, 2> gain_of(const PersonPath& path, std::size_t t, int camera) const {
    std::array<double, 2> gain{0, 0};
    for (std::size_t i = 0; i < set_.points.size(); ++i) {
      const auto other = static_cast<std::size_t>(set_.mirrored[i]);
      if (!limbs_[i] || path.points[i].empty() || path.points[other].empty()) continue;
      const auto line = line_at(t, camera, i, false);
      if (!line) continue;
      const auto square = [&](const Vector<3>& at) {
        return line->depth(at) > 0.1 ? std::min(kMaxSquare, line->error(at).squaredNorm() / (line->sigma * line->sigma))
                                     : kMaxSquare;
      };
      gain[static_cast<std::size_t>(*limbs_[i])] += square(path.points[i][t].position) - square(path.points[other][t].position);
    }
    return gain;
  }

  /// Whether any view is read otherwise than before.
  bool swap_sides(const PersonPath& path) {
    bool changed = false;
    const double minimum = options_.swap_gain * options_.swap_gain;
    for (std::size_t t = 0; t < track_.instants.size(); ++t) {
      std::vector<Mirrored>& mirrored = track_.instants[t].mirrored;
      std::vector<Mirrored> now(mirrored.size());
      int arms = 0, legs = 0, views = 0;
      for (int camera = 0; camera < std::ssize(mirrored); ++camera) {
        if (track_.instants[t].views[static_cast<std::size_t>(camera)] < 0) continue;
        const auto gain = gain_of(path, t, camera);
        now[static_cast<std::size_t>(camera)] = {.arms = gain[0] > minimum, .legs = gain[1] > minimum};
        arms += gain[0] > minimum ? 1 : 0;
        legs += gain[1] > minimum ? 1 : 0;
        ++views;
      }
      for (Mirrored& of : now) {
        of.arms &= 2 * arms <= views;
        of.legs &= 2 * legs <= views;
      }
      changed |= now != mirrored;
      mirrored = std::move(now);
    }
    return changed;
  }

  PersonTrack& track_;
  const KeypointSet& set_;
  std::span<const std::optional<Camera>> cameras_;
  const FindKeypoints& find_;
  double step_s_;
  PersonPathOptions options_;
  std::vector<std::optional<Limb>> limbs_;
  double noise_ = 1;
  std::vector<std::vector<Vector<2>>> lasting_;  // px, by camera and point, then instant
};

}  // namespace

PersonPath path_of(PersonTrack& track, const KeypointSet& set, std::span<const std::optional<Camera>> cameras,
                   const FindKeypoints& find, double step_s, const PersonPathOptions& options) {
  return PathFinder(track, set, cameras, find, step_s, options).find();
}

}  // namespace marey::reconstruct::keypoints
