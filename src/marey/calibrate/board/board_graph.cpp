#include "marey/calibrate/board/board_graph.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/geometry/decompositions.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::board {
namespace {

constexpr int kMinCommon = 3;
constexpr double kMinFraction = 0.3;    // of the most views that any offset brings together
constexpr double kMaxGap = 2.5;         // frames between two views that are still interpolated between
constexpr double kLimitOfSpread = 0.2;  // a pair whose views disagree more decides nothing

/// Median time between neighbours, s.
double period_of(std::span<const PosedView> views) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < views.size(); ++i) steps.push_back(views[i].time_s - views[i - 1].time_s);
  return steps.empty() ? 0 : geometry::median(std::move(steps));
}

/// The pose at a time between two views; nothing outside, or within a gap.
std::optional<Rigid3> pose_at(std::span<const PosedView> views, double time_s, double longest_gap_s) {
  const auto after = std::ranges::lower_bound(views, time_s, {}, &PosedView::time_s);
  if (after == views.end()) return std::nullopt;
  if (after->time_s - time_s < 1e-9) return after->camera_from_board;
  if (after == views.begin()) return std::nullopt;
  const auto before = after - 1;
  const double gap = after->time_s - before->time_s;
  if (gap > longest_gap_s) return std::nullopt;
  const double fraction = (time_s - before->time_s) / gap;
  const Eigen::Quaterniond from(before->camera_from_board.rotation), to(after->camera_from_board.rotation);
  return Rigid3{from.slerp(fraction, to).toRotationMatrix(),
                (1 - fraction) * before->camera_from_board.translation + fraction * after->camera_from_board.translation};
}

double angle_between(const Matrix<3>& a, const Matrix<3>& b) {
  return std::acos(std::clamp(((a.transpose() * b).trace() - 1) / 2, -1.0, 1.0));
}

/// The pose that most of `poses` are near: means over the half that agree best, begun at the one nearest to all the others.
Rigid3 common_pose(const std::vector<Rigid3>& poses, double depth, double& spread) {
  const auto apart = [&](const Rigid3& a, const Rigid3& b) {
    return std::hypot(angle_between(a.rotation, b.rotation), (a.translation - b.translation).norm() / depth);
  };
  Rigid3 centre = poses[0];
  spread = 1e9;
  const std::size_t stride = std::max<std::size_t>(1, poses.size() / 15);
  for (std::size_t i = 0; i < poses.size(); i += stride) {
    std::vector<double> distances;
    for (const Rigid3& other : poses) distances.push_back(apart(poses[i], other));
    const double here = geometry::median(std::move(distances));
    if (here < spread) spread = here, centre = poses[i];
  }
  for (int round = 0; round < 3; ++round) {
    Matrix<3> rotations = Matrix<3>::Zero();
    Vector<3> translations = Vector<3>::Zero();
    std::vector<double> distances;
    int count = 0;
    for (const Rigid3& pose : poses) {
      distances.push_back(apart(pose, centre));
      if (distances.back() > 1.5 * spread + 1e-12) continue;
      rotations += pose.rotation;
      translations += pose.translation;
      ++count;
    }
    if (count == 0) break;
    const geometry::SingularValues3 svd = geometry::singular_values(rotations);
    const double sign = (svd.U * svd.V.transpose()).determinant();
    centre = {svd.U * Vector<3>(1, 1, sign).asDiagonal() * svd.V.transpose(), translations / count};
    spread = geometry::median(std::move(distances));
  }
  return centre;
}

std::optional<BoardPair> compare_at(std::span<const PosedView> first, std::span<const PosedView> second, double offset_s,
                                    double longest_gap_s) {
  std::vector<Rigid3> poses;
  std::vector<double> depths;
  for (const PosedView& detected : second) {
    const auto other = pose_at(first, detected.time_s + offset_s, longest_gap_s);
    if (!other) continue;
    poses.push_back(detected.camera_from_board * other->inverse());
    depths.push_back(0.5 * (detected.camera_from_board.translation.norm() + other->translation.norm()));
  }
  if (static_cast<int>(poses.size()) < kMinCommon) return std::nullopt;
  BoardPair pair;
  pair.offset_s = offset_s;
  pair.common = static_cast<int>(poses.size());
  pair.second_from_first = common_pose(poses, geometry::median(std::move(depths)), pair.spread);
  return pair;
}

}  // namespace

std::optional<BoardPair> compare_views(std::span<const PosedView> first, std::span<const PosedView> second, double offset_s,
                                       double max_offset_s) {
  const double period = std::max(period_of(first), period_of(second));
  const double gap = kMaxGap * period;
  if (!(max_offset_s > 0) || !(period > 0)) return compare_at(first, second, offset_s, max_offset_s > 0 ? gap : 0.6 * period);
  const double step = period / 2;
  const int steps = static_cast<int>(max_offset_s / step);
  std::map<int, BoardPair> tried;
  int maximum = 0;
  for (int i = -steps; i <= steps; ++i) {
    const auto pair = compare_at(first, second, offset_s + i * step, gap);
    if (!pair) continue;
    tried.emplace(i, *pair);
    maximum = std::max(maximum, pair->common);
  }
  const BoardPair* best = nullptr;
  for (const auto& [i, pair] : tried) {
    if (pair.common < std::max<double>(kMinCommon, kMinFraction * maximum)) continue;
    if (!best || pair.spread < best->spread) best = &pair;
  }
  return best ? std::optional(*best) : std::nullopt;
}

std::vector<BoardPlacement> position_cameras(const std::vector<std::vector<PosedView>>& views,
                                             std::span<const BoardRigCamera> cameras, const BoardRigOptions& options) {
  const std::size_t count = views.size();
  const double search = options.timing == BoardRigOptions::Timing::videos ? options.max_offset_s : 0;
  std::map<std::pair<std::size_t, std::size_t>, BoardPair> pairs;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      const auto pair = compare_views(views[a], views[b], cameras[b].offset_s - cameras[a].offset_s, search);
      if (pair && pair->spread < kLimitOfSpread) pairs.emplace(std::pair{a, b}, *pair);
    }
  }
  std::vector<std::optional<BoardPlacement>> located(count);
  located[0] = BoardPlacement{};
  while (true) {  // Prim's tree: the edge whose views agree best, for their number, is taken first
    const BoardPair* best = nullptr;
    std::size_t from = 0, to = 0;
    for (const auto& [ends, pair] : pairs) {
      const auto [a, b] = ends;
      if (located[a].has_value() == located[b].has_value()) continue;
      if (best && pair.spread / std::sqrt(pair.common) >= best->spread / std::sqrt(best->common)) continue;
      best = &pair;
      from = located[a] ? a : b;
      to = located[a] ? b : a;
    }
    if (!best) break;
    const Rigid3 to_from = from < to ? best->second_from_first : best->second_from_first.inverse();
    const double offset = from < to ? best->offset_s : -best->offset_s;
    located[to] = BoardPlacement{to_from * located[from]->camera_from_world, located[from]->offset_s + offset};
  }
  std::vector<std::string> lost;
  for (std::size_t i = 0; i < count; ++i) {
    if (!located[i]) lost.push_back(fmt::format("\"{}\"", cameras[i].name));
  }
  if (!lost.empty())
    throw Error(
        "camera {} never sees the board together with camera \"{}\" or any camera tied to it, in {} images at least that agree; "
        "carry the board "
        "through what they see in common",
        fmt::join(lost, ", "), cameras[0].name, kMinCommon);
  std::vector<BoardPlacement> result;
  for (const auto& placement : located) result.push_back(*placement);
  return result;
}

}  // namespace marey::calibrate::board
