// For each target and frame: the shape filter is predicted by the motion filter (the paper's equation), the outline is searched
// along lines normal to it, the lines correct the shape filter, and the centre and the growth of the corrected outline correct the
// motion filter. Beyond the paper: lines carry variances and must agree with the filter's own; targets nearer to the camera own
// their pixels, so that lines on a neighbour say nothing; one of which too little is seen keeps its shape and coasts on its motion
// filter; one of which a part is hidden by the scene is held stiff. Cost a target: lines × (length of a line + (2M)²) + (2M)².
// References: Arnaut & Costa, TECCEN 2(1), 2009; MacCormick & Blake, IJCV 39(1), 2000; Blake & Isard, "Active Contours", 1998.
#include "marey/track/contour/line_correction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "marey/track/contour/colour/colour_patch.h"
#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

using Finding = MeasurementLine::Finding;

// Noise, in heights of the target (px where it says so); each √second where it is a motion.
constexpr double kTogether = 0.3, kStiff = 0.1;  // the last: of bend and together, while a part may be hidden
constexpr double kAcceleration = 0.4, kGrowthDrift = 0.15;
constexpr double kGate = 3.5;                               // standard deviations
constexpr double kMinReachPx = 4, kMaxReachHeights = 0.25;  // of a line: px; heights
constexpr double kObserved = 0.6, kPartly = 0.25;           // shares of the lines found
constexpr double kMaxGrowthRate = 0.5;                      // 1/s: physical, one who runs at the camera from ten metres grows so
constexpr double kRelevant = 0.25;        // weight of a line at a control point, from which on it says something of it; unswept
constexpr double kHiddenFraction = 0.75;  // of the foreground typical within the outline: below, the scene hides some of it

}  // namespace

void LineCorrection::predict(ContourTarget& target, double dt) {
  const bool held = target.state == Outline::State::held;
  const double stiff = target.state == Outline::State::detected && !target.crowded ? 1 : kStiff;
  const double step = std::sqrt(dt) * target.height;
  const double growth = held ? 0 : std::clamp(target.motion.growth(), -kMaxGrowthRate, kMaxGrowthRate) * dt;
  const ShapeNoise noise{.bend = held ? 0 : kBend * stiff * step,
                         .together = held ? 0 : kTogether * stiff * step,
                         .shift = dt * target.motion.velocity_deviation().mean(),
                         .growth = held ? 0 : dt * target.motion.growth_deviation()};
  target.shape.predict(dt * target.motion.velocity(), growth, target.shape.spline().centroid(), noise);
  target.predicted = target.shape.spline();
  target.behind.clear();
  target.hidden.clear();
  target.motion.predict(dt, {.acceleration = kAcceleration * target.height, .growth = kGrowthDrift});
  target.box = target.shape.spline().box();
  polygon_ = target.shape.spline().polygon(4);
  target.footprint.fill(polygon_);
}

void LineCorrection::correct(ContourTarget& target, std::span<const ContourTarget> all, const cv::Mat& mask, double dt) {
  others_.clear();
  target.crowded = false;
  const Box wide = colour::grown(target.box, 2 + kMaxReachHeights * target.height);
  for (const ContourTarget& other : all) {
    if (&other == &target || geometry::intersection(other.box, wide).area() <= 0) continue;
    others_.push_back(&other.footprint);
    target.crowded = target.crowded || geometry::intersection(other.box, target.box).area() > 0;
  }
  target.fraction = foreground_fraction(target, mask);
  position_lines(target);
  const LineScene scene{mask, others_};
  int found = 0, askable = 0;
  for (std::size_t i = 0; i < target.lines.size(); ++i) {
    MeasurementLine& line = target.lines[i];
    search_line(line, scene, deviations_[i]);
    found += line.finding == Finding::found ? 1 : 0;
    askable += line.finding != Finding::outside ? 1 : 0;
  }
  correct_shape(target, found, askable, dt);
}

/// Of the pixels that the target covers and no other does.
double LineCorrection::foreground_fraction(const ContourTarget& target, const cv::Mat& mask) const {
  const colour::Footprint& own = target.footprint;
  const int left = std::max(0, own.left()), right = std::min(mask.cols, own.left() + own.width());
  int covered = 0, filled = 0;
  for (int y = std::max(0, own.top()); y < std::min(mask.rows, own.top() + own.height()); ++y) {
    const std::uint8_t* pixels = mask.ptr<std::uint8_t>(y);
    const std::uint8_t* inside = own.row(y).data();
    for (int x = left; x < right; ++x) {
      const int one = inside[x - own.left()];
      covered += one;
      filled += one & (pixels[x] >> 7);
    }
  }
  return covered > 0 ? static_cast<double>(filled) / covered : 0;
}

void LineCorrection::position_lines(ContourTarget& target) {
  const geometry::ClosedSpline& spline = target.shape.spline();
  spline.evenly_spaced(locations_);
  target.lines.clear();
  weights_.clear();
  deviations_.clear();
  for (const double location : locations_) {
    const geometry::SplineWeights weights = geometry::spline_weights(spline.order(), spline.count(), location);
    Vector<2> at = Vector<2>::Zero(), slope = Vector<2>::Zero();
    for (int j = 0; j < spline.order(); ++j) {
      const Vector<2>& point = spline.control_points()[(weights.first + j) % spline.count()];
      at += weights.value[j] * point;
      slope += weights.derivative[j] * point;
    }
    const double length = slope.norm();
    if (!(length > 1e-6)) continue;
    const Vector<2> normal(slope.y() / length, -slope.x() / length);
    const double deviation = std::sqrt(std::max(0.0, target.shape.variance(weights, normal)));
    const double maximum = std::max(kMinReachPx, kMaxReachHeights * target.height);
    target.lines.push_back({.foot = at, .normal = normal, .reach = std::clamp(3 * deviation, kMinReachPx, maximum)});
    weights_.push_back(weights);
    deviations_.push_back(deviation);
  }
}

/// How many lines the shape filter trusted. Where they tie a loop they are trusted as to where the target is, not as to its
/// shape.
int LineCorrection::trust_lines(ContourTarget& target) {
  const ShapeFilter predicted = target.shape;
  int trusted = 0;
  for (std::size_t i = 0; i < target.lines.size(); ++i) {
    MeasurementLine& line = target.lines[i];
    if (line.finding != Finding::found) continue;
    const double position = line.normal.dot(line.foot) + line.offset;
    if (target.shape.correct(weights_[i], line.normal, position, line.variance, kGate)) {
      ++trusted;
    } else {
      line.finding = Finding::outlier;
    }
  }
  target.knotted = is_knotted(target.shape.spline());
  if (target.knotted) {
    const Vector<2> shift = target.shape.spline().centroid() - predicted.spline().centroid();
    target.shape = predicted;
    target.shape.predict(shift, 0, target.shape.spline().centroid(), {});
  }
  return trusted;
}

/// Control points next to which no line found the edge.
void LineCorrection::note_hidden(ContourTarget& target) {
  const int count = target.shape.spline().count();
  requested_.assign(static_cast<std::size_t>(count), 0);
  answered_.assign(static_cast<std::size_t>(count), 0);
  for (std::size_t i = 0; i < target.lines.size(); ++i) {
    for (int j = 0; j < target.shape.spline().order(); ++j) {
      if (weights_[i].value[j] < kRelevant) continue;
      const auto point = static_cast<std::size_t>((weights_[i].first + j) % count);
      ++requested_[point];
      answered_[point] += target.lines[i].finding == Finding::found ? 1 : 0;
    }
  }
  for (int point = 0; point < count; ++point) {
    if (requested_[static_cast<std::size_t>(point)] > 0 && answered_[static_cast<std::size_t>(point)] == 0)
      target.hidden.push_back(point);
  }
}

void LineCorrection::correct_shape(ContourTarget& target, int found, int askable, double dt) {
  const bool hidden = target.fraction < kHiddenFraction * target.typical_fraction;
  const double part = askable > 0 ? static_cast<double>(found) / askable : 0;
  if (part < kPartly || target.fraction < 0.4 * target.typical_fraction) {
    target.state = Outline::State::held;
    return;
  }
  const double predicted_area = target.shape.spline().area();
  const int trusted = trust_lines(target);
  note_hidden(target);
  target.state = trusted >= kObserved * askable && !hidden && !target.knotted ? Outline::State::detected
                 : trusted >= kPartly * askable                               ? Outline::State::partly
                                                                              : Outline::State::held;
  if (target.state == Outline::State::held) return;
  const bool clear = target.state == Outline::State::detected;
  const Matrix<2> P = target.shape.centroid_covariance();
  const Vector<2> gait = (clear ? 1 : kHiddenCentre) * target.height * Vector<2>(kGaitAcross, kGaitDown);
  const Vector<2> deviation = (P.diagonal() + gait.cwiseAbs2()).cwiseSqrt();
  const Vector<2> centre = target.shape.spline().centroid();
  target.measured = {centre, deviation};
  const double area = target.shape.spline().area();
  if (clear && dt > 0 && area > 0 && predicted_area > 0) {
    const double measured = target.motion.growth() + (std::sqrt(area / predicted_area) - 1) / dt;
    target.motion.correct_growth(measured, kGrowthNoise);
    target.typical_fraction += kFractionMemory * (target.fraction - target.typical_fraction);
    target.height += kFractionMemory * (target.shape.spline().box().height - target.height);
  }
}

}  // namespace marey::track::contour
