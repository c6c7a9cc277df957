// A silhouette runs on the halo of sharpening and on smeared colour: its edge is put where its body ends (body_share.h), and where
// colour cannot tell, at the edge of intensity. A target's motion begins anew where its silhouette lies far from where it was
// predicted.
#include "marey/track/contour/lone_silhouette.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "marey/track/contour/body_share.h"
#include "marey/track/contour/shared_outlines.h"
#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

constexpr double kMostUnlike = 1.35;        // factor of a silhouette's size over the usual, from which on it is not believed
constexpr double kLeft = 0.5;               // heights from where the centre is predicted: the motion begins anew
constexpr int kRounds = 3;                  // of the fit, in every frame
constexpr double kBeside = 0.2;             // heights about a silhouette that are looked at
constexpr double kLeastOfSilhouette = 0.5;  // of its area that is body; less, and colour cannot tell
constexpr double kLearn = 0.1;              // what a frame alone counts in how a target looks
constexpr int kLearnEvery = 3;              // frames: its colours change little

Box bounds(std::span<const Vector<2>> polygon) {
  Vector<2> least = polygon[0], most = polygon[0];
  for (const Vector<2>& corner : polygon) {
    least = least.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  return {least.x(), least.y(), most.x() - least.x(), most.y() - least.y()};
}

}  // namespace

void LoneSilhouettes::look_at(const Picture& picture, const cv::Mat& mask, const SceneImage* scene) {
  picture_ = picture;
  scene_ = scene;
  mask_ = mask;
}

bool LoneSilhouettes::has_colours() const {
  return picture_.luma().type() == CV_8UC1 && picture_.size() == mask_.size() && !mask_.empty();
}

std::optional<geometry::ClosedSpline> LoneSilhouettes::fitted(const Detection& seen, const geometry::SplineFitOptions& options) {
  share_.release();
  if (!has_colours() || seen.outline.size() < 4) return fit_silhouette(seen, picture_.luma(), options);
  const double height = seen.box.height;
  patch_ = cut_patch(picture_, mask_, grown(bounds(seen.outline), 2 + kBeside * height), cell_step(height), scene_);
  if (patch_.colour.empty()) return fit_silhouette(seen, picture_.luma(), options);
  share_ = body_share(patch_, cells_within(seen.outline, patch_), height);
  const std::vector<Vector<2>> edge = half_level_curve(share_, patch_);
  if (geometry::polygon_area(edge) < kLeastOfSilhouette * geometry::polygon_area(seen.outline)) {
    share_.release();
    return fit_silhouette(seen, picture_.luma(), options);
  }
  auto spline = fit_curve(edge, options);
  if (!spline || geometry::intersection(spline->box(), seen.box).area() < 0.5 * seen.box.area()) return std::nullopt;
  return spline;
}

bool LoneSilhouettes::take(FollowedTarget& target, const Detection& seen, const Track<2>& track) {
  const int count = target.shape.spline().count();
  geometry::SplineFitOptions options = fit_;  // never fewer than it had: a shape that is seen anew keeps its detail
  options.least = count;
  options.most = std::max(count, options.most);
  options.rounds = kRounds;
  const auto spline = fitted(seen, options);
  if (!spline || spline->count() < count) return false;
  const double growth = std::sqrt(spline->area() / target.usual_area);
  const bool known = target.state == Outline::State::seen || target.learned > 0;
  if (known && target.held < kHeldTooLong && (growth < 1 / kMostUnlike || growth > kMostUnlike)) return false;
  const Vector<2> centre = spline->centroid();
  if ((centre - target.motion.centre()).norm() > kLeft * target.height) {
    target.motion = MotionFilter(centre, target.motion.velocity(), 0, kSilhouetteNoise, target.height, kGrowthDoubt);
  }
  target.shape = ShapeFilter(*spline, kSilhouetteNoise);
  target.state = Outline::State::seen;
  target.knotted = false;
  target.measured = {centre, Vector<2>::Constant(kSilhouetteNoise) + target.height * Vector<2>(kGaitAcross, kGaitDown)};
  target.usual_area += kShareMemory * (spline->area() - target.usual_area);
  if (track.box) target.tracked_height += kShareMemory * (track.box->height - target.tracked_height);
  learn(target, centre, track);
  return true;
}

/// How the target looks, from what was just seen of it alone.
void LoneSilhouettes::learn(FollowedTarget& target, const Vector<2>& centre, const Track<2>& track) {
  if (track.box) {
    const Vector<2> off = (centre - track.box->centre()) / target.height;
    target.centre_in_box += (target.learned == 0 ? 1 : kLearn) * (off - target.centre_in_box);
  }
  if (share_.empty()) return;
  const double rate = std::max(kLearn, 1.0 / (target.learned + 1));
  if (target.learned % kLearnEvery == 0) target.body.learn_colours(patch_, share_, centre, target.height, rate);
  target.body.learn_coverage(patch_, share_, centre, target.height, rate);
  ++target.learned;
}

}  // namespace marey::track::contour
