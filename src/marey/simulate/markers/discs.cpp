#include "marey/simulate/markers/discs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Dense>

namespace marey::simulate::markers {
namespace {

constexpr double kReach = 6;  // blurs from the edge beyond which the share is 0 or 1 to 1e-9

/// A disc's share of the pixel (x, y).
double coverage(const Disc& disc, int x, int y, int points) {
  const double distance = std::hypot(x - disc.centre.x(), y - disc.centre.y());
  const double reach = kReach * disc.blur + std::numbers::sqrt2 / 2;
  if (distance > disc.radius + reach) return 0;
  if (distance < disc.radius - reach) return 1;
  const double scale = 1 / (std::numbers::sqrt2 * disc.blur);
  double sum = 0;
  for (int j = 0; j < points; ++j) {
    const double dy = y + (j + 0.5) / points - 0.5 - disc.centre.y();
    for (int i = 0; i < points; ++i) {
      const double dx = x + (i + 0.5) / points - 0.5 - disc.centre.x();
      sum += std::erfc((std::sqrt(dx * dx + dy * dy) - disc.radius) * scale);
    }
  }
  return sum / (2.0 * points * points);
}

/// The first and one past the last pixel between two places, held within an image.
cv::Range pixels(double low, double high, int size) {
  const auto held = [size](double value) { return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size))); };
  return {held(std::ceil(low)), held(std::floor(high) + 1)};
}

/// How much of the pixel at `place` lies within [low, high).
double overlap(int location, double low, double high) {
  return std::max(0.0, std::min(location + 0.5, high) - std::max(location - 0.5, low));
}

/// The standard normal's quantiles at (i + ½) / 65536, found by Newton's method outwards from the median.
std::vector<float> normal_quantiles() {
  constexpr int kHalf = 1 << 15;
  std::vector<float> table(2 * kHalf);
  double z = 0;
  for (int i = 0; i < kHalf; ++i) {
    const double above = 0.5 - (i + 0.5) / (2 * kHalf);
    for (int step = 0; step < 6; ++step) {
      z += (std::erfc(z / std::numbers::sqrt2) / 2 - above) * std::sqrt(2 * std::numbers::pi) * std::exp(z * z / 2);
    }
    table[kHalf + i] = static_cast<float>(z);
    table[kHalf - 1 - i] = static_cast<float>(-z);
  }
  return table;
}

/// Each sample is the mean of two table entries times √2: normal up to 6 standard deviations, and ten times as fast as exact ones.
void add_noise(cv::Mat& image, float noise, std::uint64_t seed) {
  static const std::vector<float> table = normal_quantiles();
  std::mt19937_64 engine(seed);
  const float scale = noise / std::numbers::sqrt2_v<float>;
  for (int y = 0; y < image.rows; ++y) {
    float* row = image.ptr<float>(y);
    for (int x = 0; x < image.cols; x += 2) {
      const std::uint64_t bits = engine();
      row[x] += scale * (table[bits & 0xFFFF] + table[bits >> 16 & 0xFFFF]);
      if (x + 1 < image.cols) row[x + 1] += scale * (table[bits >> 32 & 0xFFFF] + table[bits >> 48]);
    }
  }
}

using Shape = std::array<double, 6>;  // x, y, radius, blur, contrast, background

cv::Mat drawn(const Shape& shape, int side) {
  cv::Mat image(side, side, CV_32FC1, cv::Scalar(shape[5]));
  const Disc disc{{shape[0], shape[1]}, shape[2], shape[4] + shape[5], shape[3]};
  draw_discs(image, std::span(&disc, 1));
  return image;
}

}  // namespace

cv::Rect reach_of(const Disc& disc) {
  const double reach = disc.radius + kReach * disc.blur + 1;
  const auto low = [&](double centre) { return static_cast<int>(std::ceil(centre - reach)); };
  const auto high = [&](double centre) { return static_cast<int>(std::floor(centre + reach)) + 1; };
  return {cv::Point(low(disc.centre.x()), low(disc.centre.y())), cv::Point(high(disc.centre.x()), high(disc.centre.y()))};
}

void draw_discs(cv::Mat& image, std::span<const Disc> discs, int points) {
  CV_Assert(image.type() == CV_32FC1 && points > 0);
  for (const Disc& disc : discs) {
    const cv::Rect touched = reach_of(disc) & cv::Rect({}, image.size());
    for (int y = touched.y; y < touched.br().y; ++y) {
      float* row = image.ptr<float>(y);
      for (int x = touched.x; x < touched.br().x; ++x) {
        const double fraction = coverage(disc, x, y, points);
        row[x] = static_cast<float>((1 - fraction) * row[x] + fraction * disc.level);
      }
    }
  }
}

void draw_barrier(cv::Mat& image, const Box& box, double level) {
  CV_Assert(image.type() == CV_32FC1);
  const cv::Range columns = pixels(box.left - 1, box.right(), image.cols);
  const cv::Range rows = pixels(box.top - 1, box.bottom(), image.rows);
  for (int y = rows.start; y < rows.end; ++y) {
    float* row = image.ptr<float>(y);
    const double down = overlap(y, box.top - 0.5, box.bottom() - 0.5);
    for (int x = columns.start; x < columns.end; ++x) {
      const double fraction = down * overlap(x, box.left - 0.5, box.right() - 0.5);
      row[x] = static_cast<float>((1 - fraction) * row[x] + fraction * level);
    }
  }
}

cv::Mat expose(const cv::Mat& image, double noise, std::uint64_t seed, int depth) {
  CV_Assert(image.type() == CV_32FC1 && (depth == CV_8U || depth == CV_16U));
  cv::Mat detected = image.clone();
  if (noise > 0) add_noise(detected, static_cast<float>(noise), seed);
  cv::Mat result;
  detected.convertTo(result, depth);
  return result;
}

double disc_centre_bound(const Disc& disc, double background, double noise) {
  constexpr int kPhases = 5;
  constexpr double kStep = 1e-2;
  const int side = 2 * static_cast<int>(std::ceil(disc.radius + kReach * disc.blur)) + 3;
  const int middle = side / 2;
  double variance = 0;
  for (int phase = 0; phase < kPhases * kPhases; ++phase) {
    const double px = middle + (phase % kPhases + 0.5) / kPhases - 0.5;
    const double py = middle + (phase / kPhases + 0.5) / kPhases - 0.5;
    const Shape shape{px, py, disc.radius, disc.blur, disc.level - background, background};
    std::array<cv::Mat, 6> slope;
    for (std::size_t i = 0; i < slope.size(); ++i) {
      Shape more = shape, less = shape;
      more[i] += kStep;
      less[i] -= kStep;
      slope[i] = (drawn(more, side) - drawn(less, side)) / (2 * kStep);
    }
    Eigen::Matrix<double, 6, 6> information;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) information(i, j) = slope[i].dot(slope[j]);
    }
    const Eigen::Matrix<double, 6, 6> bound = information.inverse();
    variance += (bound(0, 0) + bound(1, 1)) / 2;
  }
  return std::sqrt(variance / (kPhases * kPhases) * (noise * noise + 1.0 / 12));
}

}  // namespace marey::simulate::markers
