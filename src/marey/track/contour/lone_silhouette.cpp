// A silhouette runs on the halo of sharpening and on smeared colour: its edge is put where its body ends (body_fraction.h), and
// where colour cannot decide, at the edge of intensity. A target's motion begins again where its silhouette lies far from where it
// was predicted.
#include "marey/track/contour/lone_silhouette.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "marey/track/contour/colour/body_share.h"
#include "marey/track/contour/colour/edge_matting.h"
#include "marey/track/contour/colour/shared_region.h"
#include "marey/track/contour/colour/visible_edge.h"
#include "marey/track/contour/shared_outlines.h"
#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

constexpr double kMaxUnlike = 1.35;       // factor of a silhouette's size over the typical, from which on it is not trusted
constexpr int kRounds = 3;                // of the fit, in every frame
constexpr double kHalo = 5;               // px: physical, sharpening's halo at both ends of a silhouette
constexpr double kSurround = 0.2;         // heights about a silhouette that are inspected
constexpr double kMinOfSilhouette = 0.5;  // of its area that is body; less, and colour cannot decide
constexpr double kMaxGrowth = 1.5;        // of an outline's box, in a frame; unswept
constexpr double kSmeared = 0.015;        // heights; at crf 18, 35 and recorded, 60 px: 0.006, 0.025, 0.035; 120 px: 0.016
constexpr double kMinSmear = 1.3;         // px; sharp edges of thin limbs measure up to 1.1 in chroma of half the resolution
constexpr int kKnown = 10;                // frames that a target's colours were learned from, from which on they decide; unswept
constexpr double kSame = 0.5;             // of a box that the outline's must share; unswept
constexpr double kLearn = 0.1;            // weight of one frame in a target's appearance
constexpr int kLearnEvery = 3;            // frames: its colours change little

Box bounds(std::span<const Vector<2>> polygon) {
  Vector<2> minimum = polygon[0], maximum = polygon[0];
  for (const Vector<2>& corner : polygon) {
    minimum = minimum.cwiseMin(corner);
    maximum = maximum.cwiseMax(corner);
  }
  return {minimum.x(), minimum.y(), maximum.x() - minimum.x(), maximum.y() - minimum.y()};
}

/// A body does not grow by half from one frame to the next: a shadow, or a neighbour, came with it.
bool is_of_size(const Box& box, const ContourTarget& target) {
  const Box before = target.predicted.box();
  return box.height < kMaxGrowth * before.height && box.width < kMaxGrowth * std::max(before.width, kStrideWidth * target.height);
}

}  // namespace

bool is_whole(const std::optional<geometry::ClosedSpline>& outline, const Box& silhouette) {
  if (!outline) return false;
  const double part = kMaxMissingPart * silhouette.height;
  const Box own = outline->box(), most = colour::grown(silhouette, part);
  return own.height > silhouette.height - std::max(part, kHalo) && own.left >= most.left && own.right() <= most.right() &&
         own.top >= most.top && own.bottom() <= most.bottom();
}

void LoneSilhouettes::inspect_at(const Image& image, const cv::Mat& mask, const colour::SceneImage* scene) {
  image_ = image;
  scene_ = scene;
  mask_ = mask;
}

bool LoneSilhouettes::has_colours() const {
  return image_.luma().type() == CV_8UC1 && image_.size() == mask_.size() && !mask_.empty();
}

LoneSilhouettes::Inspected LoneSilhouettes::inspected(const Detection& detected, const geometry::SplineFitOptions& options,
                                                      const ContourTarget* target, const colour::BodyMask* mask) const {
  if (!has_colours() || detected.outline.size() < 4) return {fit_silhouette(detected, image_.luma(), options)};
  const double height = detected.box.height;
  const bool known =
      target != nullptr && target->learned >= kKnown && target->held < kHeldTooLong && (is_smeared(height) || mask != nullptr);
  Box about = bounds(detected.outline);
  if (known) about = geometry::hull(about, target->predicted.box());
  colour::ColourPatch patch =
      colour::cut_patch(image_, mask_, colour::grown(about, 2 + kSurround * height), colour::cell_step(height), scene_);
  if (patch.colour.empty()) return {fit_silhouette(detected, image_.luma(), options)};
  cv::Mat fraction = known ? known_fraction(patch, *target, detected, mask)
                           : colour::body_fraction(patch, colour::cells_within(detected.outline, patch), height);
  const std::vector<Vector<2>> edge = colour::half_level_curve(fraction, patch);
  const double typical = known ? target->typical_area : geometry::polygon_area(detected.outline);
  if (geometry::polygon_area(edge) < kMinOfSilhouette * typical) return {fit_silhouette(detected, image_.luma(), options)};
  auto spline = fit_curve(edge, options);
  const Box same = known ? target->predicted.box() : detected.box;
  if (!spline || geometry::intersection(spline->box(), same).area() < kSame * same.area()) return {};
  return {std::move(spline), std::move(patch), std::move(fraction)};
}

/// Whether colours run over limbs, so that a cell's own colour says little of what it shows.
bool LoneSilhouettes::is_smeared(double height) const {
  return scene_ != nullptr && scene_->smear() > std::max(kMinSmear, kSmeared * height);
}

cv::Mat LoneSilhouettes::known_fraction(const colour::ColourPatch& patch, const ContourTarget& target, const Detection& detected,
                                        const colour::BodyMask* mask) {
  colour::RegionMember member;
  member.body = &target.body;
  member.polygon = target.predicted.polygon(4);
  member.centre = target.predicted.centroid();
  member.height = target.height;
  member.foot = detected.box.bottom();
  member.shifts = {Vector<2>::Zero()};
  member.typical = kTypicalWeight;
  if (mask != nullptr) member.network = colour::chances_in(*mask, patch);
  const cv::Mat ground = colour::divide_region(patch, {&member, 1});
  return colour::matted_edge(patch, member.whole, {}, ground, target.height);
}

bool LoneSilhouettes::take(ContourTarget& target, const Detection& detected, const Track<2>& track,
                           const colour::BodyMask* mask) const {
  const int count = target.shape.spline().count();
  geometry::SplineFitOptions options = fit_;  // never fewer than it had: a shape that is seen again keeps its detail
  options.minimum = count;
  options.maximum = std::max(count, options.maximum);
  options.rounds = kRounds;
  Inspected found = inspected(detected, options, &target, mask);
  // Where the learned colours explain too little of a silhouette, or too much, it says more of the body than they do.
  if (!is_whole(found.spline, detected.box)) {
    Inspected without = inspected(detected, options, nullptr, nullptr);
    if (!found.spline || is_whole(without.spline, detected.box)) found = std::move(without);
  }
  const std::optional<geometry::ClosedSpline>& spline = found.spline;
  if (!spline || spline->count() < count) return false;
  const double growth = std::sqrt(spline->area() / target.typical_area);
  const bool known = target.state == Outline::State::detected || target.learned > 0;
  if (known && target.held < kHeldTooLong && (growth < 1 / kMaxUnlike || growth > kMaxUnlike)) return false;
  if (known && !is_of_size(spline->box(), target)) return false;
  const Vector<2> centre = spline->centroid();
  if ((centre - target.motion.centre()).norm() > kAstray * target.height) {
    target.motion = MotionFilter(centre, target.motion.velocity(), 0, kSilhouetteNoise, target.height, kGrowthAmbiguity);
  }
  set_shape(target, found);
  target.state = Outline::State::detected;
  target.knotted = false;
  target.measured = {centre, Vector<2>::Constant(kSilhouetteNoise) + target.height * Vector<2>(kGaitAcross, kGaitDown)};
  target.typical_area += kFractionMemory * (spline->area() - target.typical_area);
  if (track.box) target.tracked_height += kFractionMemory * (track.box->height - target.tracked_height);
  learn(target, found, centre, track);
  return true;
}

/// The shape that was found, as well as its edge is seen.
void LoneSilhouettes::set_shape(ContourTarget& target, const Inspected& found) const {
  const geometry::ClosedSpline& spline = *found.spline;
  if (found.fraction.empty()) {
    target.shape = ShapeFilter(spline, kSilhouetteNoise);
    target.hidden = image_.empty() ? std::vector<int>{} : colour::at_border(spline, image_.size());
    return;
  }
  colour::VisibleEdge edge = colour::visible_edge(spline, found.patch, {}, image_.size(), prior_deviation(target.height));
  target.shape = ShapeFilter(spline, edge.deviations);
  target.hidden = std::move(edge.hidden);
}

/// The target's appearance, from the last observation of it alone.
void LoneSilhouettes::learn(ContourTarget& target, const Inspected& found, const Vector<2>& centre, const Track<2>& track) {
  if (track.box) {
    const Vector<2> off = (centre - track.box->centre()) / target.height;
    target.centre_in_box += (target.learned == 0 ? 1 : kLearn) * (off - target.centre_in_box);
  }
  if (found.fraction.empty()) return;
  const double rate = std::max(kLearn, 1.0 / (target.learned + 1));
  if (target.learned % kLearnEvery == 0) target.body.learn_colours(found.patch, found.fraction, centre, target.height, rate);
  target.body.learn_coverage(found.patch, found.fraction, centre, target.height, rate);
  ++target.learned;
}

}  // namespace marey::track::contour
