#include "marey/reconstruct/place_people.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

namespace marey::reconstruct {
namespace {

constexpr double at_border = 1.5;     // px: a box that comes this near to the image's border is cut by it
constexpr double inconsistent = 9;    // squared standard deviations by which foot and head contradict each other
constexpr double group_across = 0.3;  // of its width: where in a shared region one of its people stands, standard deviation
constexpr int kStepsToGround = 4;     // each leaves a few hundredths of the error in height that it began with
constexpr double group_along = 0.15;  // of its height

struct Placement {
  Vector<2> location = Vector<2>::Zero();
  Matrix<2> covariance = Matrix<2>::Identity();
};

/// Which edges of a box the image's border cuts.
struct Cut {
  bool side = false, top = false, bottom = false;
};

class GroundLocaliser {
 public:
  GroundLocaliser(std::span<const Detection> detections, const GroundView& view, const LocalisePeopleOptions& options)
      : detections_(detections), view_(view), options_(options) {}

  std::optional<Placement> location(std::size_t index) const {
    const Detection& one = detections_[index];
    if (one.box.empty()) return std::nullopt;
    const Cut cut = cut_of(one.box);
    auto foot = by_foot(index, cut);
    const Camera* camera = view_.camera();
    if (camera == nullptr || cut.top || one.group) return foot;
    if (cut.bottom) {
      const auto head = by_head(*camera, index, cut);
      return head ? head : foot;
    }
    if (!foot) return std::nullopt;
    return joined(*camera, *foot, index, cut);
  }

 private:
  Cut cut_of(const Box& box) const {
    const cv::Size size = view_.size();
    return {.side = box.left < at_border - 0.5 || box.right() > size.width + 0.5 - at_border,
            .top = box.top<at_border - 0.5, .bottom = box.bottom()> size.height + 0.5 - at_border};
  }

  double edge_variance(const Box& box) const {
    return options_.pixel_noise * options_.pixel_noise + std::pow(options_.edge_noise * box.height, 2);
  }

  /// Of a box's middle: two edges give it, unless the border or other people hide one.
  double across_variance(const Detection& one, const Cut& cut) const {
    const double edge = edge_variance(one.box);
    if (one.group) return edge + std::pow(group_across * one.box.width, 2);
    return cut.side ? edge + std::pow(one.box.width / 2, 2) : edge / 2;
  }

  std::optional<Placement> by_foot(std::size_t index, const Cut& cut) const {
    const Detection& one = detections_[index];
    const auto location = view_.location(one.box.foot());
    if (!location) return std::nullopt;
    double along = edge_variance(one.box);
    if (one.group) along += std::pow(group_along * one.box.height, 2);
    if (cut.bottom) along += std::pow(one.box.height / 2, 2);
    const Vector<2> away = -location->by_pixel.col(1).normalized();
    return Placement{location->ground + options_.toe * away, on_ground(location->by_pixel, across_variance(one, cut), along)};
  }

  Matrix<2> on_ground(const Matrix<2>& by_pixel, double across, double along) const {
    return by_pixel * Vector<2>(across, along).asDiagonal() * by_pixel.transpose() +
           options_.stride * options_.stride * Matrix<2>::Identity();
  }

  Vector<2> head_of(std::size_t index) const {
    const Box& box = detections_[index].box;
    return {box.left + (box.width - 1) / 2, box.top - 0.5};
  }

  /// A camera below the ground is one whose world has z down (GroundView).
  static double up(const Camera& camera) { return camera.centre().z() < 0 ? -1 : 1; }
  /// m, of the top of who stands there, in the world.
  double head_height(const Camera& camera, const Vector<2>& location) const {
    return view_.surface().height(location) + up(camera) * options_.height;
  }

  std::optional<Placement> by_head(const Camera& camera, std::size_t index, const Cut& cut) const {
    const auto ray = camera.ray(head_of(index));
    if (!ray) return std::nullopt;
    double crown = up(camera) * options_.height;
    Vector<2> location = Vector<2>::Zero();
    for (int step = 0; step < kStepsToGround; ++step) {  // one is enough where the ground is level
      const double length = (crown - ray->origin.z()) / ray->direction.z();
      if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
      location = ray->origin.head<2>() + length * ray->direction.head<2>();
      if (crown == head_height(camera, location)) break;
      crown = head_height(camera, location);
    }
    const auto detected = camera.project_with_jacobian({location.x(), location.y(), crown});
    if (!detected) return std::nullopt;
    const Matrix<2> by_ground = detected->by_world.leftCols<2>();
    if (!(std::abs(by_ground.determinant()) > 1e-12)) return std::nullopt;
    const Vector<2> by_height = ray->direction.head<2>() / std::abs(ray->direction.z()) * options_.height_spread;
    const Matrix<2> by_pixel = by_ground.inverse();
    return Placement{location,
                     on_ground(by_pixel, across_variance(detections_[index], cut), edge_variance(detections_[index].box)) +
                         by_height * by_height.transpose()};
  }

  /// The foot's place corrected by the row in which the head is seen.
  std::optional<Placement> joined(const Camera& camera, const Placement& foot, std::size_t index, const Cut& cut) const {
    const double row = head_of(index).y();
    Placement both = foot;
    for (int i = 0; i < 2; ++i) {
      const auto head = camera.project_with_jacobian({both.location.x(), both.location.y(), head_height(camera, both.location)});
      if (!head) return foot;
      const Vector<2> slope = head->by_world.row(1).head<2>();
      const double spread = head->by_world(1, 2) * options_.height_spread;
      const double residual = row - head->pixel.y() - slope.dot(foot.location - both.location);
      const double S = slope.dot(foot.covariance * slope) + edge_variance(detections_[index].box) + spread * spread;
      if (residual * residual > inconsistent * S) {
        if (residual < 0 || !legs_hidden(index)) return foot;
        return by_head(camera, index, cut);
      }
      const Vector<2> K = foot.covariance * slope / S;
      both.location = foot.location + K * residual;
      both.covariance = foot.covariance - K * S * K.transpose();
    }
    return both;
  }

  /// Another's box, whose foot is nearer, covers what lies below this one.
  bool legs_hidden(std::size_t index) const {
    const Box& box = detections_[index].box;
    const Box below{box.left, box.bottom(), box.width, std::max(1.0, box.height / 4)};
    return std::any_of(detections_.begin(), detections_.end(), [&](const Detection& other) {
      return &other != &detections_[index] && other.box.bottom() > box.bottom() &&
             intersection(below, other.box).area() > below.area() / 2;
    });
  }

  std::span<const Detection> detections_;
  const GroundView& view_;
  const LocalisePeopleOptions& options_;
};

}  // namespace

LocatedPeople localise_people(std::span<const Detection> detections, const GroundView& view, CameraId camera,
                              const LocalisePeopleOptions& options) {
  const GroundLocaliser placer(detections, view, options);
  LocatedPeople located;
  located.detected.reserve(detections.size());
  located.detection.reserve(detections.size());
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const auto at = placer.location(i);
    if (!at) continue;
    auto& one = located.detected.emplace_back();
    one.value = at->location;
    one.covariance = at->covariance;
    one.camera = camera;
    one.score = detections[i].score;
    one.box = detections[i].box;
    one.shared = detections[i].group.has_value();
    located.detection.push_back(static_cast<int>(i));
  }
  return located;
}

}  // namespace marey::reconstruct
