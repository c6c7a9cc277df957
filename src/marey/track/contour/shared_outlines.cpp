// The targets of one region are divided (shared_region.h); then each takes the outline of what is its own and of what is hidden of
// it, fitted again. What is hidden keeps the predicted shape, moved to where the seen part says that the body is.
#include "marey/track/contour/shared_outlines.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include "marey/track/contour/colour/body_share.h"
#include "marey/track/contour/colour/colour_patch.h"
#include "marey/track/contour/colour/edge_matting.h"
#include "marey/track/contour/colour/shared_region.h"
#include "marey/track/contour/colour/visible_edge.h"
#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

constexpr double kMargin = 0.15;                          // heights about all members
constexpr double kMinVisible = 0.18;                      // share of a body, below which its shape is held
constexpr double kWhollyVisible = 0.92;                   // from which on it is seen as if alone
constexpr double kMinOfTypical = 0.4, kMaxOfTypical = 2;  // area of an outline, of the typical, that is trusted
constexpr double kTypicalWeightHeld = 0.6;                // of the typical coverage, where the shape is old or unknown
constexpr float kUnlikeGround = 22;                       // levels from the ground, of a body whose colours are not known yet
constexpr double kLearnInRegion = 0.15;                   // what a frame counts in a body that was never seen alone
constexpr double kFine = 80;                              // px of height, up to which cells are pixels
constexpr int kFewFrames = 6;                             // alone, up to which the silhouettes may have held pixels of others

bool barely_known(const ContourTarget& target) {
  return target.learned < kFewFrames;
}

/// Its typical area, as large as the tracker has it now.
double expected_area(const ContourTarget& target, const Box& box) {
  const double growth = target.tracked_height > 0 ? box.height / target.tracked_height : 1;
  return target.typical_area * growth * growth;
}

colour::ColourPatch patch_about(const Image& image, const cv::Mat& mask, const colour::SceneImage* scene,
                                std::span<const SharedTarget> targets) {
  Box all;
  double height = 0;
  for (const SharedTarget& one : targets) {
    const Box own = geometry::hull(one.box, one.target->predicted.box());
    all = all.empty() ? own : geometry::hull(all, own);
    height = std::max(height, one.target->height);
  }
  const int step = height <= kFine ? 1 : colour::cell_step(std::max(height, 120.0));
  return colour::cut_patch(image, mask, colour::grown(all, kMargin * height), step, scene);
}

colour::RegionMember member_of(const SharedTarget& shared) {
  const ContourTarget& target = *shared.target;
  colour::RegionMember member;
  member.body = &target.body;
  member.polygon = target.predicted.polygon(4);
  member.centre = target.predicted.centroid();
  member.height = target.height;
  member.foot = shared.box.bottom();
  const Vector<2> tracked = shared.box.centre() + target.height * target.centre_in_box - member.centre;
  const bool old = target.held >= kHeldTooLong;
  const Vector<2> none = Vector<2>::Zero();
  if (tracked.norm() > kAstray * target.height) {
    member.shifts = {tracked};
  } else if (old && shared.observed) {
    member.shifts = {tracked, none};
  } else {
    member.shifts = {none, tracked};
  }
  member.typical = old || barely_known(target) ? kTypicalWeightHeld : kTypicalWeight;
  return member;
}

/// Colours of a target that was never alone: the pixels where it is expected and no other is.
void guess_colours(const colour::ColourPatch& patch, std::span<const colour::RegionMember> members, std::size_t own,
                   colour::BodyModel& body) {
  cv::Mat alone = colour::cells_within(members[own].polygon, patch).mul(patch.mask);
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (k != own) alone = alone.mul(1 - colour::cells_within(members[k].polygon, patch));
  }
  const cv::Mat ground = colour::ground_next_to(patch, patch.mask, members[own].height);
  for (int y = 0; y < alone.rows; ++y) {
    for (int x = 0; x < alone.cols; ++x) {
      const cv::Vec3f away = patch.colour.at<cv::Vec3f>(y, x) - ground.at<cv::Vec3f>(y, x);
      if (away.dot(away) < kUnlikeGround * kUnlikeGround) alone.at<float>(y, x) = 0;
    }
  }
  if (cv::sum(alone)[0] < 12) return;
  body.learn_colours(patch, alone, members[own].centre + members[own].shifts.front(), members[own].height, 1);
}

void hold(ContourTarget& target, const Vector<2>& shift) {
  std::vector<Vector<2>> points(std::as_const(target.predicted).control_points());
  for (Vector<2>& point : points) point += shift;
  target.shape = ShapeFilter(geometry::ClosedSpline(target.predicted.order(), std::move(points)),
                             std::sqrt(1.0 + target.held) * prior_deviation(target.height));
  target.state = Outline::State::held;
}

void note_behind(ContourTarget& target, const colour::RegionMember& own, std::span<const SharedTarget> targets) {
  for (const int j : own.behind) target.behind.push_back(targets[static_cast<std::size_t>(j)].target->id);
  std::sort(target.behind.begin(), target.behind.end());
}

/// What takes the cells that are not a member's.
cv::Mat taken_by_others(std::span<const colour::RegionMember> members, const colour::RegionMember& own) {
  cv::Mat taken = own.whole - own.detected;
  for (const colour::RegionMember& other : members) {
    if (&other != &own) cv::max(taken, other.detected, taken);
  }
  return taken;
}

void take_part(ContourTarget& target, const Box& box, const colour::RegionMember& member, const colour::ColourPatch& patch,
               const cv::Mat& blocked, cv::Size image) {
  const Vector<2> gait_noise = target.height * Vector<2>(kGaitAcross, kGaitDown);
  hold(target, member.shift);
  target.measured.reset();
  if (member.visible < kMinVisible) return;
  const int count = target.predicted.count();
  const auto curve = colour::half_level_curve(member.whole, patch);
  const auto spline = fit_curve(curve, {.order = target.predicted.order(), .minimum = count, .maximum = count});
  const double part = spline ? spline->area() / expected_area(target, box) : 0;
  const double doubt_of_area = barely_known(target) ? 0.6 : 1;  // its typical area is a guess then
  const double hidden_factor = 1 + (kHiddenCentre - 1) * std::min(1.0, 2 * (1 - member.visible));
  if (!spline || spline->count() != count || part < kMinOfTypical * doubt_of_area || part > kMaxOfTypical / doubt_of_area) {
    // No outline results from it, but a place does.
    target.measured = {target.shape.spline().centroid(), 2 * hidden_factor * gait_noise + Vector<2>::Constant(1)};
    return;
  }
  colour::VisibleEdge edge = colour::visible_edge(*spline, patch, blocked, image, prior_deviation(target.height));
  target.shape = ShapeFilter(*spline, edge.deviations);
  target.hidden = std::move(edge.hidden);
  target.state = member.visible > kWhollyVisible ? Outline::State::detected : Outline::State::partly;
  target.measured = {spline->centroid(), hidden_factor * gait_noise + Vector<2>::Constant(kSilhouetteNoise)};
  target.knotted = false;
}

/// Where a member borders on ground, its edge is where its colours end.
void refine_edges(const colour::ColourPatch& patch, const cv::Mat& ground, std::span<colour::RegionMember> members) {
  tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t k) {
    cv::Mat blocked = taken_by_others(members, members[k]);
    cv::dilate(blocked, blocked, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
    members[k].whole = colour::matted_edge(patch, members[k].whole, blocked, ground, members[k].height);
  });
}

}  // namespace

void outline_shared_region(const Image& image, const cv::Mat& mask, const colour::SceneImage* scene,
                           std::span<SharedTarget> targets) {
  const colour::ColourPatch patch = patch_about(image, mask, scene, targets);
  if (patch.colour.empty()) return;
  std::vector<colour::RegionMember> members;
  for (const SharedTarget& one : targets) members.push_back(member_of(one));
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (targets[k].mask != nullptr) members[k].network = colour::chances_in(*targets[k].mask, patch);
    if (!targets[k].target->body.knows_colours()) guess_colours(patch, members, k, targets[k].target->body);
  }
  const cv::Mat ground = colour::divide_region(patch, members);
  std::vector<cv::Mat> taken;
  for (const colour::RegionMember& member : members) taken.push_back(taken_by_others(members, member));
  refine_edges(patch, ground, members);
  tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t k) {
    ContourTarget& target = *targets[k].target;
    target.lines.clear();
    take_part(target, targets[k].box, members[k], patch, taken[k], image.size());
    if (barely_known(target) && target.state != Outline::State::held && members[k].visible > 0.5) {
      const Vector<2> centre = members[k].centre + members[k].shift;
      target.body.learn_colours(patch, members[k].detected, centre, target.height, kLearnInRegion);
      target.typical_area += kLearnInRegion * (target.shape.spline().area() - target.typical_area);
      target.tracked_height += kLearnInRegion * (targets[k].box.height - target.tracked_height);
    }
    note_behind(target, members[k], targets);
  });
}

}  // namespace marey::track::contour
