#include "marey/calibrate/ptz/line_markings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace marey::calibrate::ptz {
namespace {

constexpr double kReading = 0.5;          // px between readings across a line
constexpr double kOptics = 1.6;           // px: how much optics and compression widen paint
constexpr double kMinGroundDistance = 3;  // m before the camera
constexpr int kMaxReadings = 256;

struct Crossing {
  Vector<2> pixel, normal;
  double width;             // px, of the paint
  double pixels_per_metre;  // across
};

double level_at(const cv::Mat& luma, double x, double y) {
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const double u = x - column, v = y - row;
  const auto* above = luma.ptr<std::uint8_t>(row) + column;
  const auto* below = luma.ptr<std::uint8_t>(row + 1) + column;
  return (1 - v) * ((1 - u) * above[0] + u * above[1]) + v * ((1 - u) * below[0] + u * below[1]);
}

/// Levels across a line, summed from its beginning, so that a mean over any piece is one difference.
class Profile {
 public:
  Profile(const cv::Mat& luma, const Crossing& crossing, double reach) : half_(reach) {
    count_ = std::min(kMaxReadings - 1, static_cast<int>(2 * reach / kReading) + 1);
    sums_[0] = 0;
    for (int i = 0; i < count_; ++i) {
      const Vector<2> at = crossing.pixel + (i * kReading - half_) * crossing.normal;
      sums_[i + 1] = sums_[i] + level_at(luma, at.x(), at.y());
    }
  }
  int count() const { return count_; }
  double offset(double index) const { return index * kReading - half_; }
  /// Mean of the readings from `first` on.
  double mean(int first, int readings) const { return (sums_[first + readings] - sums_[first]) / readings; }

 private:
  double half_;
  int count_ = 0;
  std::array<double, kMaxReadings> sums_{};
};

struct Ridge {
  double offset = 0, contrast = 0;
};

/// The ridge that stands out most, the nearer the better.
std::optional<Ridge> ridge_of(const cv::Mat& luma, const Crossing& crossing, const PaintOptions& options) {
  const double wide = std::hypot(crossing.width, kOptics);
  const int inner = std::max(2, static_cast<int>(std::lround(0.8 * wide / kReading)));
  const int gap = std::max(1, static_cast<int>(std::lround(0.45 * wide / kReading)));
  const int side = std::max(2, static_cast<int>(std::lround(0.6 * wide / kReading)));
  const double margin = (inner / 2.0 + gap + side) * kReading;
  const Profile profile(luma, crossing, options.reach + margin);
  const int all = inner + 2 * (gap + side);
  std::array<double, kMaxReadings> score{};
  const int locations = profile.count() - all;
  for (int i = 0; i <= locations; ++i) {
    const double left = profile.mean(i, side), middle = profile.mean(i + side + gap, inner),
                 right = profile.mean(i + side + 2 * gap + inner, side);
    score[i] = middle - std::max(left, right);
  }
  std::optional<Ridge> best;
  double best_rank = 0;
  for (int i = 1; i < locations; ++i) {
    if (score[i] < options.contrast || score[i] < score[i - 1] || score[i] <= score[i + 1]) continue;
    const double bend = score[i - 1] - 2 * score[i] + score[i + 1];
    const double part = bend < 0 ? (score[i - 1] - score[i + 1]) / (2 * bend) : 0;
    const double offset = profile.offset(i + part + (all - 1) / 2.0);
    const double rank = score[i] * std::exp(-0.5 * std::pow(offset / options.reach, 2));
    if (rank > best_rank) best_rank = rank, best = Ridge{offset, score[i]};
  }
  return best;
}

class Sampler {
 public:
  Sampler(const geometry::Tripod& tripod, const geometry::Heading& heading, cv::Size size, double margin)
      : size_(size), margin_(margin), frame_(tripod.as_numbers().data(), heading.as_vector().data()) {}

  std::optional<Crossing> at(const Vector<2>& ground, const Vector<2>& tangent) const {
    const auto here = pixel(ground);
    if (!here) return std::nullopt;
    if (here->x() < margin_ || here->y() < margin_ || here->x() > size_.width - 2 - margin_ ||
        here->y() > size_.height - 2 - margin_)
      return std::nullopt;
    constexpr double kStep = 0.05;  // m
    const Vector<2> aside(-tangent.y(), tangent.x());
    const auto on = pixel(ground + kStep * tangent), aside_pixel = pixel(ground + kStep * aside);
    if (!on || !aside_pixel) return std::nullopt;
    const Vector<2> along = (*on - *here).normalized(), normal(-along.y(), along.x());
    const double scale = std::abs(normal.dot(*aside_pixel - *here)) / kStep;
    return Crossing{*here, normal, scale * geometry::kPitchLineWidth, scale};
  }

 private:
  std::optional<Vector<2>> pixel(const Vector<2>& ground) const {
    const Vector<3> location(ground.x(), ground.y(), 0);
    if (frame_.depth(location) < kMinGroundDistance) return std::nullopt;
    const Vector<2> detected = frame_.detected(location);
    if (std::abs(detected.x()) > 3 || std::abs(detected.y()) > 3) return std::nullopt;
    return geometry::to_pixel(detected, size_);
  }

  cv::Size size_;
  double margin_;
  geometry::TripodFrame<double> frame_;
};

}  // namespace

Paint find_paint(const cv::Mat& luma, const geometry::Tripod& tripod, const geometry::Heading& heading,
                 std::span<const geometry::PitchLine> lines, const PaintOptions& options) {
  Paint paint;
  paint.expected_of.assign(lines.size(), 0);
  const Sampler inside(tripod, heading, luma.size(), 2);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    Vector<2> last = Vector<2>::Constant(-1e6);
    for (std::size_t i = 0; i < lines[line].points.size(); ++i) {
      const auto crossing = inside.at(lines[line].points[i], lines[line].tangents[i]);
      if (!crossing || crossing->width > 40) continue;
      if ((crossing->pixel - last).norm() < options.apart) continue;
      last = crossing->pixel;
      // The samples read to both sides have to lie within the image.
      const double read = options.reach + 2.2 * std::hypot(crossing->width, kOptics) + 2;
      const Vector<2> swing = read * crossing->normal.cwiseAbs();
      if (crossing->pixel.x() < swing.x() || crossing->pixel.y() < swing.y() || crossing->pixel.x() > luma.cols - 2 - swing.x() ||
          crossing->pixel.y() > luma.rows - 2 - swing.y())
        continue;
      ++paint.expected, ++paint.expected_of[line];
      const auto ridge = ridge_of(luma, *crossing, options);
      if (!ridge) continue;
      const Vector<2> pixel = crossing->pixel + ridge->offset * crossing->normal;
      const double sigma = std::hypot(options.sigma_px, options.sigma_metres * crossing->pixels_per_metre);
      paint.detected.push_back({lines[line].points[i].cast<float>(), pixel.cast<float>(), crossing->normal.cast<float>(),
                                static_cast<float>(sigma), static_cast<std::int16_t>(line)});
    }
  }
  return paint;
}

}  // namespace marey::calibrate::ptz
