#include "marey/reconstruct/keypoints/person_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace marey::reconstruct::keypoints {
namespace {

constexpr double kMostSquare = 25;

class PathFinder {
 public:
  PathFinder(PersonTrack& track, const KeypointSet& set, std::span<const std::optional<Camera>> cameras, const FindKeypoints& find,
             double step_s, const PersonPathOptions& options)
      : track_(track), set_(set), cameras_(cameras), find_(find), step_s_(step_s), options_(options), limbs_(limbs_of(set)) {}

  PersonPath find() {
    PersonPath path;
    path.points.resize(set_.points.size());
    for (std::size_t i = 0; i < set_.points.size(); ++i) path.points[i] = smooth(i);
    if (exchange(path)) {
      for (std::size_t i = 0; i < set_.points.size(); ++i) {
        if (limbs_[i]) path.points[i] = smooth(i);
      }
    }
    for (std::size_t i = 0; i < set_.points.size(); ++i) append_squares(lines_of(i), path.points[i], path.squares);
    return path;
  }

 private:
  std::optional<SightLine> line_at(std::size_t instant, int camera, std::size_t point, bool other_side) const {
    const PlacedPerson& placed = track_.instants[instant];
    const int index = placed.views.empty() ? -1 : placed.views[static_cast<std::size_t>(camera)];
    const Keypoints<2>* seen = index < 0 ? nullptr : find_(track_.first + instant, camera, index);
    if (seen == nullptr) return std::nullopt;
    const auto& keypoint = seen->points[other_side ? static_cast<std::size_t>(set_.mirrored[point]) : point];
    if (!keypoint) return std::nullopt;
    return line_of(*cameras_[static_cast<std::size_t>(camera)], camera, *keypoint, options_.noise);
  }

  PointLines lines_of(std::size_t point) const {
    PointLines lines;
    for (std::size_t t = 0; t < track_.instants.size(); ++t) {
      for (int camera = 0; camera < std::ssize(track_.instants[t].views); ++camera) {
        const bool swapped = track_.instants[t].mirrored[static_cast<std::size_t>(camera)].of(limbs_[point]);
        if (const auto line = line_at(t, camera, point, swapped)) lines.add(*line);
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

  /// How much better a view's limb fits with its names exchanged, by limb, in squared deviations.
  std::array<double, 2> gain_of(const PersonPath& path, std::size_t t, int camera) const {
    std::array<double, 2> gain{0, 0};
    for (std::size_t i = 0; i < set_.points.size(); ++i) {
      const auto other = static_cast<std::size_t>(set_.mirrored[i]);
      if (!limbs_[i] || path.points[i].empty() || path.points[other].empty()) continue;
      const auto line = line_at(t, camera, i, false);
      if (!line) continue;
      const auto square = [&](const Vector<3>& at) {
        return line->depth(at) > 0.1 ? std::min(kMostSquare, line->error(at).squaredNorm() / (line->sigma * line->sigma))
                                     : kMostSquare;
      };
      gain[static_cast<std::size_t>(*limbs_[i])] += square(path.points[i][t].position) - square(path.points[other][t].position);
    }
    return gain;
  }

  /// Whether any view is read otherwise than before.
  bool exchange(const PersonPath& path) {
    bool changed = false;
    const double least = options_.swap_gain * options_.swap_gain;
    for (std::size_t t = 0; t < track_.instants.size(); ++t) {
      std::vector<Mirrored>& mirrored = track_.instants[t].mirrored;
      std::vector<Mirrored> now(mirrored.size());
      int arms = 0, legs = 0, views = 0;
      for (int camera = 0; camera < std::ssize(mirrored); ++camera) {
        if (track_.instants[t].views[static_cast<std::size_t>(camera)] < 0) continue;
        const auto gain = gain_of(path, t, camera);
        now[static_cast<std::size_t>(camera)] = {.arms = gain[0] > least, .legs = gain[1] > least};
        arms += gain[0] > least ? 1 : 0;
        legs += gain[1] > least ? 1 : 0;
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
};

}  // namespace

PersonPath path_of(PersonTrack& track, const KeypointSet& set, std::span<const std::optional<Camera>> cameras,
                   const FindKeypoints& find, double step_s, const PersonPathOptions& options) {
  return PathFinder(track, set, cameras, find, step_s, options).find();
}

}  // namespace marey::reconstruct::keypoints
