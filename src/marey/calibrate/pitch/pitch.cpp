#include "marey/calibrate/pitch/pitch.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "marey/calibrate/pitch/pitch_sightings.h"
#include "marey/core/error.h"
#include "marey/core/geometry.h"
#include "marey/geometry/ground_view.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::pitch {
namespace {

// The search narrows as the camera gets better (units of `find_lines`, for an image of 3,072 px; more or less for others).
constexpr double kReaches[] = {14, 12, 10, 10, 8};
constexpr double kLastReaches[] = {8, 6};  // when lens and ground are known together
constexpr double kReferenceWidth = 3072;
constexpr double kSampleStep = 0.25;  // m
constexpr double kMaxClick = 50;      // px: what is clicked further off its line is not a click on it

/// Frames with their origin in the middle of the pitch have negative coordinates within half a pitch.
Vector<2> corner_of(const std::vector<PitchView>& views, const geometry::PitchSize& size) {
  Vector<2> low = Vector<2>::Zero(), high = Vector<2>::Zero();
  for (const PitchView& view : views) {
    for (const PitchPoint& point : view.points) low = low.cwiseMin(point.ground), high = high.cwiseMax(point.ground);
  }
  const Vector<2> half(size.length / 2, size.width / 2);
  const bool centred =
      (low.array() < -1).any() && (low.array() > -half.array() - 1).all() && (high.array() < half.array() + 1).all();
  return centred ? Vector<2>(-half) : Vector<2>::Zero();
}

/// The model's lines, in the world.
std::vector<geometry::PitchLine> lines_in_world(const geometry::PitchSize& size, const Vector<2>& corner,
                                                const Matrix<3>& world_from_ground) {
  std::vector<geometry::PitchLine> lines = geometry::pitch_lines(size, kSampleStep);
  for (geometry::PitchLine& line : lines) {
    for (Vector<2>& point : line.points) point = (world_from_ground * (point + corner).homogeneous()).hnormalized();
    for (Vector<2>& tangent : line.tangents) tangent = world_from_ground.topLeftCorner<2, 2>() * tangent;
  }
  return lines;
}

void measure_lines(const geometry::GroundSurface& ground, PitchViewResult& result) {
  const GroundView view(result.camera, ground);
  std::vector<double> pixels, metres;
  for (const LineSighting& detected : result.lines) {
    const auto expected = view.pixel(detected.ground);
    if (!expected) continue;
    const double off = detected.normal.dot(detected.pixel - *expected);
    pixels.push_back(std::abs(off));
    metres.push_back(std::abs(off) / detected.pixels_per_metre);
  }
  result.line_median_px = geometry::quantile(pixels, 0.5);
  result.line_95_px = geometry::quantile(pixels, 0.95);
  result.line_median_m = geometry::quantile(metres, 0.5);
  result.line_95_m = geometry::quantile(metres, 0.95);
}

/// Clicks against the camera; an outlier is given the other name on the pitch that would suit it.
void measure_points(const std::vector<PitchPoint>& points, const GroundView& view, const Matrix<3>& ground_from_world,
                    PitchViewResult& result) {
  result.error_px.clear();
  for (const PitchPoint& point : points) {
    const auto pixel = view.pixel(point.ground);
    const auto location = view.location(point.pixel);
    result.error_px.push_back(pixel ? (*pixel - point.pixel).norm()
                                    : std::hypot(result.camera.size().width, result.camera.size().height));
    result.error_m.push_back(location ? std::optional((location->ground - point.ground).norm()) : std::nullopt);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto& better = result.better_name.emplace_back();
    if (result.inlier[i]) continue;
    double nearest = result.error_px[i] / 3;
    // Its neighbours' coordinates, exchanged one by one: the one who names a point wrong takes one number of the next.
    for (const PitchPoint& x_of : points) {
      for (const PitchPoint& y_of : points) {
        const Vector<2> location(x_of.ground.x(), y_of.ground.y());
        const auto pixel = view.pixel(location);
        if (!pixel || (*pixel - points[i].pixel).norm() >= nearest) continue;
        nearest = (*pixel - points[i].pixel).norm();
        better = (ground_from_world * location.homogeneous()).hnormalized();
      }
    }
  }
}

constexpr double kClickSigma = 3;  // px

/// Clicks along a line, each against the piece of the line that it is nearest to.
std::vector<LineSighting> sightings_of(const std::vector<PitchClickedLine>& clicked, const Matrix<3>& world_from_ground,
                                       const GroundView& view) {
  constexpr int pieces = 400;
  std::vector<LineSighting> result;
  for (const PitchClickedLine& line : clicked) {
    const Vector<2> from = (world_from_ground * line.from.homogeneous()).hnormalized();
    const Vector<2> to = (world_from_ground * line.to.homogeneous()).hnormalized();
    for (const Vector<2>& pixel : line.pixels) {
      double nearest = kMaxClick;
      std::optional<LineSighting> best;
      for (int i = 0; i <= pieces; ++i) {
        const Vector<2> location = from + (to - from) * i / pieces;
        const auto here = view.camera()->project_with_jacobian({location.x(), location.y(), view.surface().height(location)});
        if (!here || (here->pixel - pixel).norm() >= nearest) continue;
        nearest = (here->pixel - pixel).norm();
        const Vector<2> along = here->by_world.leftCols<2>() * (to - from).normalized();
        const Vector<2> normal = Vector<2>(-along.y(), along.x()).normalized();
        const Vector<2> aside = here->by_world.leftCols<2>() * Vector<2>(from.y() - to.y(), to.x() - from.x()).normalized();
        best = LineSighting{location, pixel, normal, std::abs(normal.dot(aside)), kClickSigma, -1};
      }
      if (best) result.push_back(*best);
    }
  }
  return result;
}

PitchViewResult calibrate_view(const PitchView& view, const std::vector<PitchPoint>& points, const Matrix<3>& world_from_ground,
                               const std::vector<geometry::PitchLine>& lines) {
  const PitchCamera start = camera_from_points(view.name, points, view.size);
  PitchViewResult result{start.camera, start.inlier, start.error_px, {}, {}, {}, 0, 0, 0, 0};
  const auto refine_on = [&](const std::vector<LineSighting>& painted) {
    std::vector<LineSighting> all = sightings_of(view.lines, world_from_ground, GroundView(result.camera));
    all.insert(all.end(), painted.begin(), painted.end());
    if (!all.empty()) result.camera = refine(result.camera, points, result.inlier, all, !painted.empty());
  };
  refine_on({});
  if (view.empty_ground.empty()) return result;
  for (const double reach : kReaches) {
    result.lines = find_lines(view.empty_ground, GroundView(result.camera), lines, reach * view.size.width / kReferenceWidth);
    if (result.lines.empty()) return result;
    refine_on(result.lines);
  }
  return result;
}

/// The points of a view, in the world.
std::vector<PitchPoint> points_in_world(const PitchView& view, const Matrix<3>& world_from_ground) {
  std::vector<PitchPoint> points = view.points;
  for (PitchPoint& point : points) point.ground = (world_from_ground * point.ground.homogeneous()).hnormalized();
  return points;
}

constexpr double kClickOutlier = 4;     // of a click's error
constexpr double kMinClickOutlier = 6;  // px: no user clicks better than this always

std::vector<char> clicks_that_fit(const std::vector<PitchPoint>& points, const GroundView& view, double scale) {
  std::vector<char> fits;
  for (const PitchPoint& point : points) {
    const auto pixel = view.pixel(point.ground);
    fits.push_back(click_error(view, point) < kClickOutlier * std::max(1.0, scale) ||
                   (pixel && (*pixel - point.pixel).norm() < kMinClickOutlier));
  }
  return fits;
}

/// All views over one ground; the paint is sought again where they then expect it.
void fit_together(const std::vector<PitchView>& views, const PitchCalibrationOptions& options, const Matrix<3>& world_from_ground,
                  const std::vector<geometry::PitchLine>& lines, PitchCalibration& result) {
  geometry::GroundSurface ground;
  ground.half = Vector<2>(options.size.length, options.size.width) / 2;
  ground.middle = (world_from_ground * (result.corner + ground.half).homogeneous()).hnormalized();
  if (options.known == GroundKnown::wholly && !options.ground.flat()) ground = options.ground;
  const auto round = [&] {
    std::vector<PitchEvidence> evidence;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const PitchViewResult& initial = result.views[i];
      evidence.push_back({initial.camera, points_in_world(views[i], world_from_ground), initial.lines,
                          sightings_of(views[i].lines, world_from_ground, GroundView(initial.camera, ground))});
    }
    result.fit = fit_pitch(evidence, ground, options.known);
    ground = result.fit.ground;
    for (std::size_t i = 0; i < views.size(); ++i) result.views[i].camera = result.fit.cameras[i];
  };
  round();
  for (const double reach : kLastReaches) {
    bool any = false;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (views[i].empty_ground.empty() || result.views[i].lines.empty()) continue;
      result.views[i].lines = find_lines(views[i].empty_ground, GroundView(result.views[i].camera, ground), lines,
                                         reach * views[i].size.width / kReferenceWidth);
      any = true;
    }
    if (any) round();
  }
}

}  // namespace

PitchCalibration calibrate_pitch(const std::vector<PitchView>& views, const PitchCalibrationOptions& options) {
  if (views.empty()) throw Error("no camera's points on the pitch are given");
  PitchCalibration result;
  result.corner = corner_of(views, options.size);
  const bool reflected = is_left_handed(views.front().name, views.front().points, views.front().size);
  for (const PitchView& view : views) {
    if (is_left_handed(view.name, view.points, view.size) != reflected)
      throw Error(
          "cameras \"{}\" and \"{}\" contradict each other: by the points of one the pitch is mirrored; are left and right, or "
          "near and far, "
          "exchanged in one of them?",
          views.front().name, view.name);
  }
  if (reflected) result.ground_from_world(1, 1) = -1;
  const Matrix<3> world_from_ground = result.ground_from_world.inverse();
  const auto lines = lines_in_world(options.size, result.corner, world_from_ground);
  for (const PitchView& view : views) {
    result.views.push_back(calibrate_view(view, points_in_world(view, world_from_ground), world_from_ground, lines));
  }
  fit_together(views, options, world_from_ground, lines, result);
  for (std::size_t i = 0; i < views.size(); ++i) {
    PitchViewResult& one = result.views[i];
    const GroundView view(one.camera, result.fit.ground);
    const std::vector<PitchPoint> points = points_in_world(views[i], world_from_ground);
    one.inlier = clicks_that_fit(points, view, result.fit.click_scale);
    measure_lines(result.fit.ground, one);
    measure_points(points, view, result.ground_from_world, one);
  }
  return result;
}

}  // namespace marey::calibrate::pitch
