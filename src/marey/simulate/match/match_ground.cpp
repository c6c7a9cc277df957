// Every pixel faces along its rays to what they meet: the ground, or a wall round it that stands for boards and trees, or the sky.
// Grass is mowing stripes and value noise at several sizes, each faded where it is too small for a pixel; a pixel near a line is
// asked at many places, so that lines narrower than a pixel, as those across the pitch are, keep their share of it. Rays are
// undistorted at every sixteenth pixel and interpolated, which is exact to some hundredths of a pixel.
#include "marey/simulate/match/match_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/core/utility.hpp>

#include "marey/simulate/people/people_renderer.h"
#include "marey/simulate/value_noise.h"

namespace marey::simulate::match {
namespace {

constexpr int kGrid = 16;             // px between rays that are undistorted
constexpr int kPlain = 2, kFine = 6;  // places asked in a pixel, in each direction: anywhere, near a line
constexpr double kStripe = 5.25;      // m, of mowing
constexpr double kMown = 4;           // m beyond the lines
constexpr double kWall = 24;          // m beyond the lines
constexpr double kBoards = 1.1;       // m high
constexpr people::Rgb kLight{94, 106, 74}, kDark{70, 94, 74}, kBeyond{76, 96, 68}, kPaint{208, 213, 206}, kSky{196, 206, 226},
    kTrees{38, 58, 34}, kBoard{58, 76, 84};

struct Patch {
  double size, strength;  // m, share of the brightness
};
constexpr std::array<Patch, 5> kPatches{{{14, 0.05}, {5, 0.05}, {1.3, 0.05}, {0.35, 0.06}, {0.1, 0.12}}};

people::Rgb mix(const people::Rgb& a, const people::Rgb& b, double fraction) {
  people::Rgb result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] + fraction * (b[i] - a[i]);
  return result;
}
people::Rgb times(const people::Rgb& a, double factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}

class Painter {
 public:
  Painter(const GroundView& view, const Matrix<3>& pitch_from_world, const geometry::PitchSize& pitch, std::uint64_t seed)
      : surface_(view.surface()), camera_(*view.camera()), pitch_from_world_(pitch_from_world), pitch_(pitch), seed_(seed) {
    const Camera& camera = camera_;
    columns_ = camera.size().width / kGrid + 2;
    const int rows = camera.size().height / kGrid + 2;
    const Matrix<3> to_world = camera.camera_from_world().rotation.transpose();
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const auto bearing = camera.bearing({static_cast<double>(column * kGrid), static_cast<double>(row * kGrid)});
        rays_.push_back(bearing ? Vector<3>(to_world * *bearing) : Vector<3>(Vector<3>::UnitZ()));
      }
    }
  }

  void paint(cv::Mat& bgr, int y) const {
    for (int x = 0; x < bgr.cols; ++x) {
      const people::Rgb colour = pixel(x, y);
      auto& out = bgr.at<cv::Vec3b>(y, x);
      for (int i = 0; i < 3; ++i) out[i] = cv::saturate_cast<std::uint8_t>(colour[static_cast<std::size_t>(2 - i)]);
    }
  }

 private:
  /// The direction that is seen at a place of the image, in the world; its length is about 1.
  Vector<3> ray(double x, double y) const {
    const double u = std::max(0.0, x / kGrid), v = std::max(0.0, y / kGrid);
    const auto column = static_cast<int>(u), row = static_cast<int>(v);
    const auto at = [&](int r, int c) -> const Vector<3>& { return rays_[static_cast<std::size_t>(r * columns_ + c)]; };
    const double a = u - column, b = v - row;
    return (1 - b) * ((1 - a) * at(row, column) + a * at(row, column + 1)) +
           b * ((1 - a) * at(row + 1, column) + a * at(row + 1, column + 1));
  }

  /// Where a ray meets the ground, on the pitch's own; nothing beyond the wall.
  std::optional<Vector<2>> on_ground(const Vector<3>& ray) const {
    if (ray.z() > -1e-5) return std::nullopt;
    const double far = -camera_.centre().z() / ray.z();
    std::optional<Vector<2>> world = camera_.centre().head<2>() + far * ray.head<2>();
    if (!surface_.flat()) world = geometry::ground_met({camera_.centre(), ray}, surface_);
    if (!world) return std::nullopt;
    const Vector<2> at = (pitch_from_world_ * world->homogeneous()).head<2>();
    return outside(at) > kWall ? std::nullopt : std::optional(at);
  }

  /// m from the pitch's lines; 0 within them.
  double outside(const Vector<2>& at) const {
    return std::max({-at.x(), at.x() - pitch_.length, -at.y(), at.y() - pitch_.width, 0.0});
  }

  people::Rgb pixel(int x, int y) const {
    const auto middle = on_ground(ray(x, y));
    const auto right = on_ground(ray(x + 0.5, y)), below = on_ground(ray(x, y + 0.5));
    bool line = false;
    double foot = 1e3;  // m across a pixel, the mean of both directions
    if (middle && right && below) {
      const double wide = 2 * (*right - *middle).norm(), deep = 2 * (*below - *middle).norm();
      foot = std::sqrt(wide * deep);
      line = geometry::distance_to_line(pitch_, *middle) < geometry::kPitchLineWidth / 2 + 0.75 * std::max(wide, deep);
    }
    const int count = line ? kFine : kPlain;
    people::Rgb sum{};
    for (int row = 0; row < count; ++row) {
      for (int column = 0; column < count; ++column) {
        const Vector<3> along = ray(x + (column + 0.5) / count - 0.5, y + (row + 0.5) / count - 0.5);
        const auto at = on_ground(along);
        const people::Rgb colour = at ? grass(*at, foot, line) : beyond(along);
        for (std::size_t i = 0; i < 3; ++i) sum[i] += colour[i] / (count * count);
      }
    }
    return sum;
  }

  people::Rgb grass(const Vector<2>& at, double foot, bool line) const {
    double bright = 1;
    for (std::size_t i = 0; i < kPatches.size(); ++i) {
      const double detected = std::clamp(kPatches[i].size / foot / 2 - 0.5, 0.0, 1.0);
      if (detected > 0) bright += detected * kPatches[i].strength * value_noise(at / kPatches[i].size, seed_ + i);
    }
    if (line && distance_to_line(pitch_, at) < geometry::kPitchLineWidth / 2) return times(kPaint, 0.5 + 0.5 * bright);
    if (outside(at) > kMown) return times(kBeyond, bright);
    const bool even = static_cast<std::int64_t>(std::floor(at.x() / kStripe)) % 2 == 0;
    return times(mix(even ? kLight : kDark, kBeyond, 0.25 + 0.25 * value_noise(at / 7, seed_ + 9)), bright);
  }

  /// Boards, trees and the sky.
  people::Rgb beyond(const Vector<3>& ray) const {
    const double across = ray.head<2>().norm();
    const double rise = ray.z() / std::max(1e-9, across);
    const double round = std::atan2(ray.y(), ray.x());
    const double high = camera_.centre().z() + rise * 95;  // m, at about where the wall is
    if (high < kBoards) return times(kBoard, 1 + 0.15 * value_noise({round * 60, 0}, seed_ + 20));
    const double tops = 9.5 + 1.6 * value_noise({round * 25, 1}, seed_ + 21) + 0.7 * value_noise({round * 120, 2}, seed_ + 22);
    const Vector<2> leaves(round * 200, high * 2);
    if (high < tops)
      return times(kTrees, 1 + 0.35 * value_noise(leaves, seed_ + 23) + 0.25 * value_noise(3.1 * leaves, seed_ + 24));
    const double cloud = 0.5 + 0.5 * value_noise({round * 6, rise * 18}, seed_ + 25);
    return mix(kSky, {236, 239, 244}, cloud);
  }

  const geometry::GroundSurface& surface_;
  const Camera& camera_;
  Matrix<3> pitch_from_world_;
  geometry::PitchSize pitch_;
  std::uint64_t seed_;
  int columns_ = 0;
  std::vector<Vector<3>> rays_;
};

}  // namespace

Image draw_match_ground(const GroundView& view, const Matrix<3>& pitch_from_world, const geometry::PitchSize& pitch,
                        std::uint64_t seed) {
  const Painter painter(view, pitch_from_world, pitch, seed);
  cv::Mat bgr(view.size(), CV_8UC3);
  cv::parallel_for_(cv::Range(0, bgr.rows), [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) painter.paint(bgr, y);
  });
  return Image::from_bgr(bgr);
}

}  // namespace marey::simulate::match
