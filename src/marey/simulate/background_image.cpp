// The lawn is a sum of value noise (random values at the corners of a grid on the ground, smoothly mixed between them) at four
// sizes, each faded where it is too small for a pixel, mowing stripes and a few lines. Every pixel is asked once, at four places
// within it.
#include "marey/simulate/background_image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "marey/simulate/value_noise.h"

namespace marey::simulate {
namespace {

struct Patch {
  double size, strength;  // m, share of the brightness
};
constexpr std::array<Patch, 4> kPatches{{{6, 0.06}, {1.3, 0.05}, {0.3, 0.06}, {0.08, 0.08}}};
constexpr double kStripe = 5.5;     // m, of mowing
constexpr double kLineWide = 0.12;  // m
constexpr double kLineEvery = 11;   // m

people::Rgb lawn_at(const Vector<2>& at, double px_per_m, std::uint64_t seed) {
  double bright = 1;
  for (std::size_t i = 0; i < kPatches.size(); ++i) {
    const double detected = std::clamp(kPatches[i].size * px_per_m / 2 - 0.5, 0.0, 1.0);
    if (detected > 0) bright += detected * kPatches[i].strength * value_noise(at / kPatches[i].size, seed + i);
  }
  bright *= static_cast<std::int64_t>(std::floor(at.x() / kStripe)) % 2 == 0 ? 1.05 : 0.95;
  const double dry = 0.5 + 0.5 * value_noise(at / 9, seed + 17);
  const auto near_line = [](double value) { return std::abs(value - kLineEvery * std::round(value / kLineEvery)) < kLineWide / 2; };
  if (near_line(at.x() + 3) || near_line(at.y() + 4)) return {215 * bright, 222 * bright, 212 * bright};
  return {(72 + 26 * dry) * bright, (118 + 6 * dry) * bright, 52 * bright};
}

}  // namespace

std::optional<people::Sighting> LevelCamera::operator()(const Vector<3>& point) const {
  const double c = std::cos(pitch), s = std::sin(pitch);
  const double ahead = distance + c * point.y() - s * point.z();
  if (ahead < 0.1) return std::nullopt;
  const double down = -s * point.y() - c * point.z();
  const double scale = focal / ahead;
  return people::Sighting{{(size.width - 1) / 2.0 + scale * point.x(), (size.height - 1) / 2.0 + scale * down}, scale, ahead};
}

std::optional<Vector<2>> LevelCamera::on_ground(const Vector<2>& location) const {
  const double c = std::cos(pitch), s = std::sin(pitch);
  const double right = (location.x() - (size.width - 1) / 2.0) / focal;
  const double down = (location.y() - (size.height - 1) / 2.0) / focal;
  const double fall = s + c * down;  // of a ray, per unit ahead
  if (fall < 1e-6) return std::nullopt;
  const double ahead = distance * s / fall;
  return Vector<2>(right * ahead, (ahead - distance) * c - down * ahead * s);
}

Image draw_lawn(const LevelCamera& camera, std::uint64_t seed) {
  cv::Mat bgr(camera.size, CV_8UC3);
  const std::array<double, 2> offsets{-0.25, 0.25};
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      people::Rgb sum{};
      for (const double dy : offsets) {
        for (const double dx : offsets) {
          const auto at = camera.on_ground({x + dx, y + dy});
          const people::Rgb colour = at ? lawn_at(*at, camera.focal / camera.distance, seed) : people::Rgb{120, 130, 140};
          for (std::size_t i = 0; i < 3; ++i) sum[i] += colour[i] / 4;
        }
      }
      auto& pixel = bgr.at<cv::Vec3b>(y, x);
      for (int i = 0; i < 3; ++i) pixel[i] = cv::saturate_cast<std::uint8_t>(sum[static_cast<std::size_t>(2 - i)]);
    }
  }
  return Image::from_bgr(bgr);
}

}  // namespace marey::simulate
