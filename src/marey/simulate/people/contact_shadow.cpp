// A shoe hides half of the sky from the ground that touches it, and less and less of it farther away: here a Gaussian of the
// distance from the shoe on the ground, wider and weaker the higher the shoe is lifted; two shoes side by side darken what is
// between them twice. The ground near a shoe is taken for flat in the image. Cost: the pixels within a few decimetres.
#include "marey/simulate/people/contact_shadow.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace marey::simulate::people {
namespace {

constexpr double kReach = 0.07;    // m, standard deviation beside a shoe on the ground
constexpr double kByHeight = 0.6;  // of the height of a shoe that is lifted, more
constexpr double kFades = 0.12;    // m of height over which it becomes a half
constexpr double kCut = 2.5;       // standard deviations

/// A shoe on the ground.
struct Sole {
  Vector<2> heel, toe;
  double radius = 0, height = 0;

  double distance(const Vector<2>& at) const {
    const Vector<2> along = toe - heel;
    const double fraction = std::clamp((at - heel).dot(along) / std::max(along.squaredNorm(), 1e-9), 0.0, 1.0);
    return std::max(0.0, (at - heel - fraction * along).norm() - radius);
  }
};

void scale_to(cv::Mat& plane, int x, int y, double zero, double factor) {
  auto& level = plane.at<std::uint8_t>(y, x);
  level = cv::saturate_cast<std::uint8_t>(zero + factor * (level - zero));
}

void darken(const Sole& sole, const Projection& projection, double strength, const Vector<2>& shift, cv::Mat& luma, cv::Mat& cb,
            cv::Mat& cr) {
  constexpr double kStep = 0.1;  // m
  const Vector<2> middle = (sole.heel + sole.toe) / 2;
  const auto detected = projection({middle.x(), middle.y(), 0}), aside = projection({middle.x() + kStep, middle.y(), 0}),
             behind = projection({middle.x(), middle.y() + kStep, 0});
  if (!detected || !aside || !behind) return;
  Matrix<2> by_ground;
  by_ground << (aside->at - detected->at) / kStep, (behind->at - detected->at) / kStep;
  if (!(std::abs(by_ground.determinant()) > 1e-9)) return;
  const Matrix<2> by_pixel = by_ground.inverse();
  const double deviation = kReach + kByHeight * sole.height;
  const double dark = strength / (1 + sole.height / kFades);
  const double reach = (sole.toe - sole.heel).norm() / 2 + sole.radius + kCut * deviation;
  const double across = reach * by_ground.row(0).norm(), down = reach * by_ground.row(1).norm();
  const Vector<2> at = detected->at + shift;
  const cv::Rect area = cv::Rect(cv::Point(static_cast<int>(at.x() - across), static_cast<int>(at.y() - down)),
                                 cv::Point(static_cast<int>(at.x() + across) + 1, static_cast<int>(at.y() + down) + 1)) &
                        cv::Rect({0, 0}, luma.size());
  for (int y = area.y; y < area.br().y; ++y) {
    for (int x = area.x; x < area.br().x; ++x) {
      const Vector<2> ground = middle + by_pixel * (Vector<2>(x, y) - at);
      const double away = sole.distance(ground) / deviation;
      const double left = 1 - dark * std::exp(-away * away / 2);
      scale_to(luma, x, y, 16, left);
      if (x % 2 != 0 || y % 2 != 0) continue;
      scale_to(cb, x / 2, y / 2, 128, left);
      scale_to(cr, x / 2, y / 2, 128, left);
    }
  }
}

}  // namespace

void darken_contact(std::span<const Limb> limbs, const Projection& projection, double strength, const Vector<2>& shift,
                    cv::Mat& luma, cv::Mat& cb, cv::Mat& cr) {
  for (const Limb& limb : limbs) {
    if (limb.part != FigurePart::shoes) continue;
    const double radius = (limb.from_radius + limb.to_radius) / 2;
    const double height = std::max(0.0, std::min(limb.from.z() - limb.from_radius, limb.to.z() - limb.to_radius));
    darken({limb.from.head<2>(), limb.to.head<2>(), radius, height}, projection, strength, shift, luma, cb, cr);
  }
}

}  // namespace marey::simulate::people
