#include "marey/pipeline/people/ground/mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace marey::pipeline::people::ground {
namespace {

constexpr int kKept = 7;              // values of a cell; numerical: memory alone
constexpr double kMaxDistance = 110;  // m: what rises above the ground is taken to be this far away
constexpr double kFinest = 1.2;       // of the angle of a pixel at the longest focal length: between cells; numerical: memory alone
constexpr int kLookupGrid = 8;        // px between rays that are computed; numerical
constexpr double kPole = 1.2;         // rad: directions so steep are not kept; numerical

/// Evenly mixed bits.
std::uint32_t mixed(std::uint32_t value) {
  value = (value ^ 61U) ^ (value >> 16U);
  value *= 9U;
  value ^= value >> 4U;
  value *= 0x27d4eb2dU;
  return value ^ (value >> 15U);
}

}  // namespace

Mosaic::Mosaic(const PtzCamera& camera, cv::Size size, std::size_t cells) : tripod_(camera.tripod), size_(size) {
  Vector<2> low = Vector<2>::Constant(9), high = Vector<2>::Constant(-9);
  double longest = 0;
  for (const PtzCamera::Turn& turn : camera.rotations) {
    if (!turn.heading) continue;
    const double focal = std::exp(turn.heading->log_focal), half = std::atan(1.15 / focal),
                 upright = std::atan(1.15 * size.height / size.width / focal);
    const Vector<2> aim(turn.heading->pan, turn.heading->tilt),
        reach(half / std::max(0.4, std::cos(turn.heading->tilt)), upright + 0.02);
    low = low.cwiseMin(aim - reach), high = high.cwiseMax(aim + reach);
    longest = std::max(longest, focal);
  }
  low.y() = std::max(low.y(), -kPole), high.y() = std::min(high.y(), kPole);
  const Vector<2> extent = (high - low).cwiseMax(0.01);
  cell_ = std::max(kFinest / (longest * size.width / 2), std::sqrt(extent.x() * extent.y() / static_cast<double>(cells)));
  pan_ = low.x(), tilt_ = low.y();
  columns_ = static_cast<int>(extent.x() / cell_) + 1, rows_ = static_cast<int>(extent.y() / cell_) + 1;
  const auto all = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  kept_.assign(kKept * all, 0);
  count_.assign(all, 0);
}

/// What a direction from the tripod shows: the ground, or something far away.
Vector<3> Mosaic::shown(double pan, double tilt) const {
  const Vector<3> ray(std::sin(pan) * std::cos(tilt), std::cos(pan) * std::cos(tilt), -std::sin(tilt));
  const double ground = ray.z() < -1e-6 ? -tripod_.location.z() / ray.z() : kMaxDistance;
  return tripod_.location + std::min(kMaxDistance, ground) * ray;
}

void Mosaic::add(const cv::Mat& luma, const geometry::Heading& heading) {
  const auto numbers = tripod_.as_numbers();
  const Vector<3> rotated = heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
  cv::Mat smooth;
  cv::GaussianBlur(luma, smooth, {3, 3}, 0.8);
  const std::uint32_t number = added_++;
  const double reach = std::atan(1.3 / frame.focal);
  const int top = std::max(0, static_cast<int>((heading.tilt - reach - tilt_) / cell_)),
            bottom = std::min(rows_, static_cast<int>((heading.tilt + reach - tilt_) / cell_) + 1);
  cv::parallel_for_(cv::Range(top, std::max(top, bottom)), [&](const cv::Range& range) {
    for (int row = range.start; row < range.end; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const double pan = pan_ + cell_ * column;
        if (std::abs(pan - heading.pan) > 1.6 * reach) continue;
        const Vector<3> location = shown(pan, tilt_ + cell_ * row);
        if (frame.depth(location) < 1) continue;
        const Vector<2> pixel = geometry::to_pixel(frame.detected(location), size_);
        if (pixel.x() < 1 || pixel.y() < 1 || pixel.x() > size_.width - 2 || pixel.y() > size_.height - 2) continue;
        const std::size_t cell =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
        std::uint8_t& count = count_[cell];
        std::size_t at = count;
        if (count >= kKept) at = mixed(static_cast<std::uint32_t>(cell) * 31U + number) % (count + 1U);
        if (count < 255) ++count;
        if (at >= kKept) continue;
        kept_[kKept * cell + at] = smooth.at<std::uint8_t>(cvRound(pixel.y()), cvRound(pixel.x()));
      }
    }
  });
}

void Mosaic::finish() {
  median_.create(rows_, columns_, CV_8UC1);
  cv::parallel_for_(cv::Range(0, rows_), [&](const cv::Range& range) {
    for (int row = range.start; row < range.end; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const std::size_t cell =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
        const int count = std::min<int>(kKept, count_[cell]);
        std::uint8_t* values = &kept_[kKept * cell];
        std::nth_element(values, values + count / 2, values + count);
        median_.at<std::uint8_t>(row, column) = count == 0 ? 0 : std::max<std::uint8_t>(1, values[count / 2]);
      }
    }
  });
  kept_ = {};
}

cv::Mat Mosaic::scene(const geometry::Heading& heading) const {
  const Camera camera = geometry::camera_of(tripod_, heading, size_);
  const int columns = size_.width / kLookupGrid + 2, rows = size_.height / kLookupGrid + 2;
  cv::Mat coarse(rows, columns, CV_32FC2), whole, lookup, result;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      cv::Vec2f& to = coarse.at<cv::Vec2f>(row, column);
      to = {-1e4F, -1e4F};
      const auto ray = camera.ray({(column + 0.5) * kLookupGrid - 0.5, (row + 0.5) * kLookupGrid - 0.5});
      if (!ray) continue;
      const double ground = ray->direction.z() < -1e-6 ? -ray->origin.z() / ray->direction.z() : kMaxDistance;
      const Vector<3> off = ray->origin + std::min(kMaxDistance, ground) * ray->direction - tripod_.location;
      const double pan = std::atan2(off.x(), off.y()), tilt = std::atan2(-off.z(), off.head<2>().norm());
      to = {static_cast<float>((pan - pan_) / cell_), static_cast<float>((tilt - tilt_) / cell_)};
    }
  }
  cv::resize(coarse, whole, {columns * kLookupGrid, rows * kLookupGrid}, 0, 0, cv::INTER_LINEAR);
  cv::remap(median_, result, whole(cv::Rect({}, size_)), {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
  return result;
}

}  // namespace marey::pipeline::people::ground
