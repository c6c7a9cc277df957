#include "marey/calibrate/pitch/element_start.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

namespace marey::calibrate::pitch {
namespace {

constexpr double kMaxFelt = 0.1;                       // half image widths: a point farther off says nothing
constexpr double kMaxWidth = 1.2, kMinWidth = 60;      // focal lengths, half image widths
constexpr double kMaxRoll = 0.2;                       // rad
constexpr double kMaxCrossing = 1.6;                   // half image widths from the middle, where elements' lines are prolonged to
constexpr double kSameAngle = 0.25, kSameFocal = 0.1;  // of the image's half width, of ln f: nearer starts are one

struct Crossing {
  Vector<3> location;
  Vector<2> pixel;
};

/// Where two straight elements' lines meet in space.
std::optional<Vector<3>> intersection(const geometry::StraightElement& a, const geometry::StraightElement& b) {
  const Vector<3> u = a.to - a.from, v = b.to - b.from, normal = u.cross(v), between = b.from - a.from;
  if (normal.norm() < 1e-9 || std::abs(between.dot(normal)) > 1e-6 * normal.norm()) return std::nullopt;
  return Vector<3>(a.from + u * (between.cross(v).dot(normal) / normal.squaredNorm()));
}

std::optional<Vector<2>> intersection(const ElementSight& a, const ElementSight& b) {
  const Vector<3> meets =
      a.first.homogeneous().cross(a.last.homogeneous()).cross(b.first.homogeneous().cross(b.last.homogeneous()));
  const double sine =
      std::abs((a.last - a.first).normalized().dot(Vector<2>(b.first.y() - b.last.y(), b.last.x() - b.first.x()).normalized()));
  if (!(sine > 0.05)) return std::nullopt;
  const Vector<2> pixel = meets.hnormalized();
  if (!(pixel.norm() < kMaxCrossing)) return std::nullopt;
  return pixel;
}

std::vector<Crossing> crossings_of(std::span<const ElementSight> sights) {
  std::vector<Crossing> result;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    for (std::size_t k = i + 1; k < sights.size(); ++k) {
      const auto* a = std::get_if<geometry::StraightElement>(&sights[i].model.shape);
      const auto* b = std::get_if<geometry::StraightElement>(&sights[k].model.shape);
      if (a == nullptr || b == nullptr) continue;
      const auto location = intersection(*a, *b);
      const auto pixel = intersection(sights[i], sights[k]);
      if (location && pixel) result.push_back({*location, *pixel});
    }
  }
  return result;
}

double angle_between(const Vector<3>& a, const Vector<3>& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The focal length at which two pixels are seen under this angle, by halving ln f.
std::optional<double> focal_for(const Vector<2>& a, const Vector<2>& b, double angle) {
  const auto detected = [&](double focal) {
    return angle_between({a.x() / focal, a.y() / focal, 1}, {b.x() / focal, b.y() / focal, 1});
  };
  double low = kMaxWidth, high = kMinWidth;
  if (!(detected(low) > angle && detected(high) < angle)) return std::nullopt;
  for (int i = 0; i < 16; ++i) {
    const double middle = std::sqrt(low * high);
    (detected(middle) > angle ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

/// Columns: the direction of `a`, that towards `b` across it, and their normal.
Matrix<3> axes_of(const Vector<3>& a, const Vector<3>& b) {
  const Vector<3> first = a.normalized(), normal = a.cross(b).normalized();
  Matrix<3> axes;
  axes << first, normal.cross(first), normal;
  return axes;
}

std::optional<ElementView> two_point_view(const Crossing& one, const Crossing& other, const Vector<3>& location) {
  const Vector<3> a = one.location - location, b = other.location - location;
  if ((one.pixel - other.pixel).norm() < 0.05) return std::nullopt;
  const auto focal = focal_for(one.pixel, other.pixel, angle_between(a, b));
  if (!focal) return std::nullopt;
  const Vector<3> p(one.pixel.x() / *focal, one.pixel.y() / *focal, 1), q(other.pixel.x() / *focal, other.pixel.y() / *focal, 1);
  const Matrix<3> world_from_camera = axes_of(a, b) * axes_of(p, q).transpose();
  const Vector<3> ahead = world_from_camera.col(2), right = world_from_camera.col(0);
  const double pan = std::atan2(ahead.x(), ahead.y()), tilt = -std::asin(std::clamp(ahead.z(), -1.0, 1.0));
  const Vector<3> level_right(std::cos(pan), -std::sin(pan), 0);
  const double roll = std::atan2(right.dot(ahead.cross(level_right)), right.dot(level_right));
  if (std::abs(roll) > kMaxRoll) return std::nullopt;
  return ElementView{{pan, tilt, roll, std::log(*focal), location.x(), location.y(), location.z(), 0}};
}

struct RatedStart {
  ElementView view;
  double cost = 0;
};

void add_grid(std::span<const ElementSight> sights, const Vector<3>& location, std::vector<RatedStart>& starts) {
  Vector<3> middle = Vector<3>::Zero();
  for (const ElementSight& sight : sights) {
    const std::vector<Vector<3>> points = geometry::sampled(sight.model, 1e9);
    for (const Vector<3>& point : points) middle += point / static_cast<double>(points.size() * sights.size());
  }
  const Vector<3> off = middle - location;
  const double pan0 = std::atan2(off.x(), off.y());
  for (double log_focal = std::log(1.5); log_focal < std::log(30.0); log_focal += 0.3) {
    const double step = 0.35 / std::exp(log_focal);
    for (double pan = pan0 - 0.5; pan <= pan0 + 0.5; pan += step) {
      for (double tilt = 0; tilt < 0.6; tilt += step) {
        const ElementView view{{pan, tilt, 0, log_focal, location.x(), location.y(), location.z(), 0}};
        starts.push_back({view, cut_off_cost(view, sights, 3 * kMaxFelt)});
      }
    }
  }
}

bool alike(const ElementView& a, const ElementView& b) {
  const double focal = std::exp(a.p[ElementView::log_focal]);
  return std::abs(a.p[ElementView::pan] - b.p[ElementView::pan]) * focal < kSameAngle &&
         std::abs(a.p[ElementView::tilt] - b.p[ElementView::tilt]) * focal < kSameAngle &&
         std::abs(a.p[ElementView::log_focal] - b.p[ElementView::log_focal]) < kSameFocal;
}

}  // namespace

std::vector<ElementSight> sights_of(std::span<const geometry::LabelledElement> labels, const geometry::PitchSize& pitch,
                                    cv::Size size) {
  const auto models = geometry::pitch_elements(pitch);
  const Vector<2> middle((size.width - 1) / 2.0, (size.height - 1) / 2.0);
  std::vector<ElementSight> sights;
  for (const geometry::LabelledElement& label : labels) {
    if (label.points.empty()) continue;
    ElementSight& sight = sights.emplace_back();
    sight.element = label.element;
    sight.model = models[static_cast<std::size_t>(label.element)];
    for (const Vector<2>& point : label.points) sight.points.emplace_back((point - middle) / (size.width / 2.0));
    sight.first = sight.last = sight.points[0];
    for (std::size_t i = 0; i < sight.points.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if ((sight.points[i] - sight.points[k]).norm() <= (sight.first - sight.last).norm()) continue;
        sight.first = sight.points[i], sight.last = sight.points[k];
      }
    }
  }
  return sights;
}

double cut_off_cost(const ElementView& view, std::span<const ElementSight> sights, double reach) {
  const ElementFrame<double> frame(view.p.data());
  double cost = 0;
  for (const ElementSight& sight : sights) {
    double sum = 0;
    for (const Vector<2>& point : sight.points) {
      const Vector<2> at = straightened(point, view.p[ElementView::bend]);
      sum += std::min(off(sight.model, frame, at).squaredNorm(), reach * reach);
    }
    cost += sum / static_cast<double>(sight.points.size());
  }
  return cost / static_cast<double>(sights.size());
}

std::vector<ElementView> element_starts(std::span<const ElementSight> sights, std::span<const Vector<3>> locations,
                                        std::size_t count) {
  const std::vector<Crossing> crossings = crossings_of(sights);
  std::vector<RatedStart> starts;
  for (const Vector<3>& location : locations) {
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (const auto view = two_point_view(crossings[i], crossings[k], location))
          starts.push_back({*view, cut_off_cost(*view, sights, kMaxFelt)});
      }
    }
  }
  if (starts.empty()) {
    for (const Vector<3>& location : locations) add_grid(sights, location, starts);
  }
  std::stable_sort(starts.begin(), starts.end(), [](const RatedStart& a, const RatedStart& b) { return a.cost < b.cost; });
  std::vector<ElementView> best;
  for (const RatedStart& start : starts) {
    if (best.size() == count) break;
    if (std::none_of(best.begin(), best.end(), [&](const ElementView& view) { return alike(view, start.view); }))
      best.push_back(start.view);
  }
  return best;
}

}  // namespace marey::calibrate::pitch
