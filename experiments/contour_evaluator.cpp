// The measures of `marey experiment contours`, all from true silhouettes on a lattice of 4 × 4 points per pixel. The bias is the
// difference of the areas of contour and silhouette over the silhouette's perimeter, which is how much its area grows per pixel
// of dilation. Second differences are taken of what each method itself reports, of a person alone, over three frames in a row.
#include "experiments/contour_evaluator.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <opencv2/imgproc.hpp>

#include "marey/core/geometry.h"
#include "marey/evaluate/outline_overlap.h"
#include "marey/geometry/bspline.h"

namespace marey::experiments {
namespace {

using simulate::people::Silhouette;
using simulate::people::TrueFigure;

constexpr double kHalfVisible = 0.5;  // of a person, from which on they count
constexpr double kNotVisible = 0.02;  // of a person, up to which they are hidden
constexpr double kFoundIou = 0.5;
constexpr double kMinShared = 0.2, kMaxShared = 0.7;  // of the smaller of two who overlap
constexpr double kMaxOversize = 1.5;
constexpr double kMinWidth = 0.4;  // heights: a person this wide at least, for the size that a contour may have
constexpr int kMinHiddenFrames = 3;
constexpr int kNameFrames = 25;  // after an occlusion, in which the name must be the one before

evaluate::SilhouetteMask mask_of(const Silhouette& silhouette) {
  return {silhouette.mask, silhouette.lattice.tl(), silhouette.samples};
}

bool is_within(const Silhouette& silhouette, const cv::Size& image) {
  return (silhouette.pixels() & cv::Rect({0, 0}, image)) == silhouette.pixels();
}

/// How much of the smaller of two silhouettes the other shares, hidden parts included.
double shared_fraction(const Silhouette& a, const Silhouette& b) {
  const cv::Rect both = a.lattice & b.lattice;
  if (both.empty()) return 0;
  cv::Mat shared;
  cv::bitwise_and(a.mask(both - a.lattice.tl()) != 0, b.mask(both - b.lattice.tl()) != 0, shared);
  return cv::countNonZero(shared) / (std::min(a.area(), b.area()) * a.samples * a.samples);
}

/// px: the growth of the area per pixel of dilation.
double perimeter_of(const Silhouette& silhouette) {
  cv::Mat wide, narrow;
  const int border = silhouette.samples;
  cv::copyMakeBorder(silhouette.mask != 0, wide, border, border, border, border, cv::BORDER_CONSTANT, 0);
  const cv::Mat disc = cv::getStructuringElement(cv::MORPH_ELLIPSE, {silhouette.samples + 1, silhouette.samples + 1});
  cv::erode(wide, narrow, disc);
  cv::dilate(wide, wide, disc);
  return (cv::countNonZero(wide) - cv::countNonZero(narrow)) / static_cast<double>(silhouette.samples * silhouette.samples);
}

double visible_iou(const TrackedShape& shape, std::span<const TrackedShape> all, const TrueFigure& person, const cv::Size& image) {
  std::vector<std::vector<Vector<2>>> hiding;
  for (const TrackedShape& other : all) {
    if (std::find(shape.behind.begin(), shape.behind.end(), other.name) != shape.behind.end()) hiding.push_back(other.polygon);
  }
  return evaluate::visible_overlap(shape.polygon, hiding, mask_of(person.visible), image).iou();
}

std::pair<Vector<2>, Vector<2>> bounds_of(std::span<const Vector<2>> polygon) {
  Vector<2> low = polygon[0], high = polygon[0];
  for (const Vector<2>& corner : polygon) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return {low, high};
}

bool crosses_itself(const std::vector<Vector<2>>& polygon) {
  const auto side = [](const Vector<2>& a, const Vector<2>& b, const Vector<2>& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  const std::size_t count = polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector<2>&a = polygon[i], &b = polygon[(i + 1) % count];
    for (std::size_t j = i + 2; j < count; ++j) {
      const Vector<2>&c = polygon[j], &d = polygon[(j + 1) % count];
      if ((j + 1) % count == i) continue;
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
    }
  }
  return false;
}

}  // namespace

void ContourTally::add(const ContourTally& other) {
  for (Mean ContourTally::* const mean :
       {&ContourTally::whole, &ContourTally::alone, &ContourTally::front, &ContourTally::behind, &ContourTally::found,
        &ContourTally::bias, &ContourTally::back, &ContourTally::hidden, &ContourTally::swapped, &ContourTally::taken_over,
        &ContourTally::step_s, &ContourTally::processor_s}) {
    (this->*mean).add(other.*mean);
  }
  for (std::size_t i = 0; i < bends.size(); ++i) bends[i].add(other.bends[i]);
  curves += other.curves;
  crossed += other.crossed;
  oversized += other.oversized;
}

void ContourEvaluator::match(std::span<const TrueFigure> truth, std::span<const TrackedShape> shapes) {
  struct Pair {
    double iou;
    std::size_t person, shape;
  };
  std::vector<Pair> pairs;
  for (std::size_t p = 0; p < truth.size(); ++p) {
    if (truth[p].visible_fraction < kNotVisible) continue;
    const Box box = truth[p].visible.box();
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      const auto [low, high] = bounds_of(shapes[s].polygon);
      if (high.x() < box.left || low.x() > box.right() || high.y() < box.top || low.y() > box.bottom()) continue;
      pairs.push_back({visible_iou(shapes[s], shapes, truth[p], image_), p, s});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.iou > b.iou; });
  matched_.assign(truth.size(), -1);
  visible_iou_.assign(truth.size(), 0);
  std::vector<bool> used(shapes.size(), false);
  for (const Pair& pair : pairs) {
    if (pair.iou <= 0 || matched_[pair.person] >= 0 || used[pair.shape]) continue;
    matched_[pair.person] = static_cast<int>(pair.shape);
    visible_iou_[pair.person] = pair.iou;
    used[pair.shape] = true;
  }
}

void ContourEvaluator::observe(int frame, std::span<const TrueFigure> truth, std::span<const TrackedShape> shapes) {
  match(truth, shapes);
  for (const TrackedShape& shape : shapes) {
    if (!shape.is_curve) continue;
    ++tally_.curves;
    tally_.crossed += crosses_itself(shape.polygon) ? 1 : 0;
  }
  for (std::size_t p = 0; p < truth.size(); ++p) {
    const TrackedShape* const shape = matched_[p] >= 0 ? &shapes[static_cast<std::size_t>(matched_[p])] : nullptr;
    // A person counts from the first frame with a contour on.
    if (shape == nullptr && !people_.contains(truth[p].id)) continue;
    update_occlusion(frame, truth[p], shape, visible_iou_[p]);
    if (truth[p].visible_fraction >= kHalfVisible) score(truth, p, shape);
    const bool touched = std::any_of(truth.begin(), truth.end(), [&](const TrueFigure& other) {
      return other.id != truth[p].id && shared_fraction(truth[p].whole, other.whole) > 0;
    });
    if (truth[p].visible_fraction < 1 || touched || !is_within(truth[p].whole, image_)) continue;
    update_motion(frame, truth[p], shape);
  }
}

void ContourEvaluator::score(std::span<const TrueFigure> truth, std::size_t index, const TrackedShape* shape) {
  const TrueFigure& person = truth[index];
  const evaluate::OutlineOverlap with_whole =
      shape != nullptr ? evaluate::overlap(shape->polygon, mask_of(person.whole), &image_) : evaluate::OutlineOverlap{};
  tally_.whole.add(with_whole.iou());
  if (shape != nullptr && shape->is_curve) {
    const auto [low, high] = bounds_of(shape->polygon);
    const Box box = person.whole.box();
    const double width = std::max(box.width, kMinWidth * box.height);
    const bool large = high.x() - low.x() > kMaxOversize * width || high.y() - low.y() > kMaxOversize * box.height;
    tally_.oversized += large ? 1 : 0;
  }
  if (!is_within(person.whole, image_)) return;
  double maximum = 0;
  bool nearer = false;
  for (const TrueFigure& other : truth) {
    if (other.id == person.id) continue;
    const double part = shared_fraction(person.whole, other.whole);
    if (part <= maximum) continue;
    maximum = part;
    nearer = person.foot.y() > other.foot.y();
  }
  if (maximum > 0 && (maximum < kMinShared || maximum > kMaxShared)) return;
  if (maximum <= 0 && person.visible_fraction < 1) return;
  Mean& kind = maximum <= 0 ? tally_.alone : nearer ? tally_.front : tally_.behind;
  kind.add(visible_iou_[index]);
  tally_.found.add(visible_iou_[index] >= kFoundIou ? 1 : 0);
  if (maximum > 0 || shape == nullptr || visible_iou_[index] < 0.3) return;
  tally_.bias.add((with_whole.outline - with_whole.silhouette) / perimeter_of(person.whole));
}

void ContourEvaluator::update_occlusion(int frame, const TrueFigure& person, const TrackedShape* shape, double iou) {
  Person& known = people_[person.id];
  if (person.visible_fraction <= kNotVisible) {
    if (++known.hidden == kMinHiddenFrames) known.before = known.name;
    return;
  }
  const std::string name = shape != nullptr ? shape->name : "";
  if (person.visible_fraction >= kHalfVisible && known.hidden >= kMinHiddenFrames && !known.before.empty()) {
    tally_.back.add(iou);
    tally_.hidden.add(known.hidden);
    known.watched_until = frame + kNameFrames;
    known.hidden = 0;
  }
  if (frame == known.watched_until) {
    tally_.swapped.add(name == known.before ? 0 : 1);
    const bool taken = name != known.before && !name.empty() && std::any_of(people_.begin(), people_.end(), [&](const auto& other) {
                         return other.first != person.id && other.second.before == name;
                       });
    tally_.taken_over.add(taken ? 1 : 0);
  }
  if (person.visible_fraction >= kHalfVisible && known.hidden < kMinHiddenFrames) {
    known.hidden = 0;
    if (!name.empty()) known.name = name;
  }
}

void ContourEvaluator::update_motion(int frame, const TrueFigure& person, const TrackedShape* shape) {
  if (shape == nullptr) return;
  Person& known = people_[person.id];
  const auto [low, high] = bounds_of(shape->polygon);
  const std::array<double, 4> now{shape->centre.x(), shape->centre.y(), std::sqrt(std::abs(geometry::polygon_area(shape->polygon))),
                                  high.x() - low.x()};
  if (frame == known.last + 1 && known.run >= 2) {
    const auto bend = [&](std::size_t i) { return now[i] - 2 * known.path[1][i] + known.path[0][i]; };
    tally_.bends[0].add(bend(0) * bend(0) + bend(1) * bend(1));
    tally_.bends[1].add(bend(2) * bend(2));
    tally_.bends[2].add(bend(3) * bend(3));
  }
  known.run = frame == known.last + 1 ? known.run + 1 : 1;
  known.last = frame;
  known.path = {known.path[1], now};
}

}  // namespace marey::experiments
