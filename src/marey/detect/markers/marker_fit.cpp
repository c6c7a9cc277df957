// The sub-pixel centre. The model is a disc of one brightness on a flat background with an edge blurred by a Gaussian:
// background + contrast · Φ((radius − d) / blur). All six parameters are fitted by Levenberg-Marquardt to the pixels out to 2.5 px
// beyond the blob. A pixel's own width widens the edge, which `blur` absorbs (+1/12 px²), and bends the distance (d² + 1/12). Where
// the true shape is another one (an ellipse, a streak, a saturated or shaded ball) the centre stays unbiased as long as the shape
// is the same from both sides, because only the odd part of the residual moves it; the covariance is scaled by what the model
// leaves. A weak prior on the blur and the radius holds what very small spots cannot distinguish: it does not touch the centre.
// Cost: 3–4 linearisations of about 2 ns a pixel. docs/decisions says what else was tried.
#include "marey/detect/markers/marker_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

namespace marey::detect::markers {
namespace {

constexpr double kMargin = 2.5;           // px beyond the blob
constexpr int kMaxFitSteps = 12;          // numerical: it ends earlier where it settles
constexpr double kFitSettled = 1e-3;      // px, numerical: the next step would be a hundredth of it
constexpr double kWorstMisfit = 0.2;      // of the contrast
constexpr double kFloorDeviation = 3e-3;  // px; pixels are not quite alike

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
enum { kX, kY, kRadius, kBlur, kContrast, kBackground };

struct Linearised {
  Matrix6 information;
  Vector6 gradient;
  double squares;
};

Linearised linearise(const MarkerWindow& window, const Vector6& p, const MarkerKernels& kernels) {
  float parameters[kDiscParameters];
  for (int i = 0; i < kDiscParameters; ++i) parameters[i] = static_cast<float>(p[i]);
  const DiscSums sums = kernels.linearise_disc(window.samples(), parameters);
  Linearised result;
  int k = 0;
  for (int a = 0; a < kDiscParameters; ++a) {
    for (int b = a; b < kDiscParameters; ++b) result.information(a, b) = result.information(b, a) = sums.sum[k++];
    result.gradient[a] = sums.sum[21 + a];
  }
  result.squares = sums.sum[27];
  return result;
}

/// Prior knowledge as further observations: `weight` is the pixels' noise variance over the prior's.
struct Prior {
  Vector6 mean;
  Vector6 weight;
};

struct Fit {
  Vector6 parameters;
  Linearised last;
  bool settled = false;
};

bool sensible(const Vector6& p, double reach) {
  return p[kRadius] > 0.15 && p[kRadius] < reach && p[kBlur] > 0.2 && p[kBlur] < 0.5 * reach + 1 && p[kContrast] > 0.05 &&
         p[kContrast] < 20 && std::hypot(p[kX], p[kY]) < reach;
}

double cost(const Linearised& at, const Vector6& p, const Prior& prior) {
  return at.squares + (prior.weight.array() * (p - prior.mean).array().square()).sum();
}

Fit minimise(const MarkerWindow& window, const Vector6& start, const Prior& prior, const MarkerKernels& kernels) {
  Fit fit{start, linearise(window, start, kernels)};
  double damping = 1e-4;
  double best = cost(fit.last, fit.parameters, prior);
  for (int step = 0; step < kMaxFitSteps; ++step) {
    Matrix6 information = fit.last.information;
    information.diagonal() += prior.weight + damping * fit.last.information.diagonal();
    const Vector6 gradient = fit.last.gradient - prior.weight.cwiseProduct(fit.parameters - prior.mean);
    const Vector6 change = information.llt().solve(gradient);
    if (!change.allFinite()) break;
    const Vector6 moved = fit.parameters + change;
    const double shift = std::max(std::abs(change[kX]), std::abs(change[kY]));
    const bool there_already = damping < 0.1 && shift < kFitSettled;
    if (sensible(moved, window.reach)) {
      if (there_already) {  // this step still counts; the next would be a hundredth of it
        fit.parameters = moved;
        fit.last.squares -= change.dot(gradient);
        fit.settled = true;
        break;
      }
      const Linearised there = linearise(window, moved, kernels);
      const double squares = cost(there, moved, prior);
      if (squares <= best) {
        fit.parameters = moved;
        fit.last = there;
        best = squares;
        damping *= 0.1;
        continue;
      }
    }
    damping = std::max(damping * 10, 1e-2);
  }
  return fit;
}

}  // namespace

MarkerShape fit_disc(const MarkerWindow& window, const MarkerBlob& blob, const MarkerSurroundings& around,
                     const MarkerKernels& kernels) {
  MarkerShape shape;
  shape.centre = window.origin + window.centroid;
  shape.covariance = window.centroid_covariance;
  shape.radius = std::sqrt(std::max(window.half_area, 1.0) / std::numbers::pi);
  shape.contrast = window.scale;
  shape.misfit = 1;
  if (window.count < 12) return shape;

  const double noise = around.noise / window.scale;
  const double blur = around.blur.value_or(kDefaultBlur);
  Prior prior{Vector6::Zero(), Vector6::Zero()};
  prior.mean[kBlur] = blur;
  prior.weight[kBlur] = noise * noise / std::pow(0.5 * blur, 2);
  prior.mean[kRadius] = shape.radius;
  prior.weight[kRadius] = noise * noise / std::pow(0.5 * shape.radius + 0.25, 2);
  Vector6 start;
  start << window.centroid.x(), window.centroid.y(), shape.radius, blur, 1.0, 0.0;
  const Fit fit = minimise(window, start, prior, kernels);
  shape.misfit = std::sqrt(std::max(0.0, fit.last.squares) / window.count) / fit.parameters[kContrast];
  const Vector<2> centre = fit.parameters.head<2>();
  const double far = 0.35 * std::sqrt(static_cast<double>(blob.area) / std::numbers::pi) + 0.5;
  const bool good = fit.settled && shape.misfit < kWorstMisfit && (centre - window.centroid).norm() < far;
  if (!good) return shape;

  Matrix6 information = fit.last.information;
  information.diagonal() += prior.weight;
  const double left = std::max(0.0, fit.last.squares) / std::max(1, window.count - kDiscParameters);
  const Eigen::Matrix<double, 6, 2> spread =
      information.llt().solve(Eigen::Matrix<double, 6, 2>::Identity()) * std::max(left, 1.0 / 12 / (window.scale * window.scale));
  shape.fitted = true;
  shape.centre = window.origin + centre;
  shape.covariance = spread.topRows<2>() + Matrix<2>::Identity() * (kFloorDeviation * kFloorDeviation);
  shape.radius = fit.parameters[kRadius];
  shape.blur = fit.parameters[kBlur];
  shape.contrast = fit.parameters[kContrast] * window.scale;
  return shape;
}

namespace {

/// The blob's pixels and one more on each side: contrast, centroid and area at half height.
template <typename Pixel>
void measure(const cv::Mat& image, const MarkerBlob& blob, const MarkerSurroundings& around, MarkerWindow& window) {
  const cv::Rect box =
      cv::Rect(blob.box.x - 1, blob.box.y - 1, blob.box.width + 2, blob.box.height + 2) & cv::Rect({}, image.size());
  const float sign = around.dark ? -1.0f : 1.0f;
  const auto level = static_cast<float>(around.background);
  float peak = 1;
  for (int y = box.y; y < box.br().y; ++y) {
    const auto* row = image.ptr<Pixel>(y);
    for (int x = box.x; x < box.br().x; ++x) peak = std::max(peak, sign * (row[x] - level));
  }
  double sum = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_yy = 0;
  int above_half = 0;
  const float floor = 0.1f * peak;
  for (int y = box.y; y < box.br().y; ++y) {
    const auto* row = image.ptr<Pixel>(y);
    float row_sum = 0, row_x = 0, row_xx = 0;
    for (int x = box.x; x < box.br().x; ++x) {
      const float height = sign * (row[x] - level);
      const float weight = height > floor ? height : 0;
      const auto dx = static_cast<float>(x - blob.box.x);
      row_sum += weight;
      row_x += weight * dx;
      row_xx += dx * dx;
      above_half += height > 0.5f * peak ? 1 : 0;
    }
    const double dy = y - blob.box.y;
    sum += row_sum;
    sum_x += row_x;
    sum_y += row_sum * dy;
    sum_xx += row_xx;
    sum_yy += box.width * dy * dy;
  }
  window.scale = peak;
  window.background = around.background;
  window.half_area = above_half;
  const Vector<2> first(blob.box.x, blob.box.y);
  // Nothing stands out where the background was taken for another than it is; then the blob's own mean serves.
  const bool dim = !(sum > 0);
  const Vector<2> mean = dim ? Vector<2>(blob.mean_x - blob.box.x, blob.mean_y - blob.box.y) : Vector<2>(sum_x / sum, sum_y / sum);
  if (dim) sum = 1;
  window.origin = first + mean.array().round().matrix();
  window.centroid = first + mean - window.origin;
  // Var = σ² Σ (x − c)² / (Σ w)², plus what cutting at the floor does to a disc's rim.
  const double n = box.area();
  const double cut = 0.02;
  const double factor = around.noise * around.noise / (sum * sum);
  window.centroid_covariance << factor * (sum_xx + n * mean.x() * mean.x()) + cut * cut, 0, 0,
      factor * (sum_yy + n * mean.y() * mean.y()) + cut * cut;
}

/// Whether a neighbour's light comes as far as a row.
bool reaches_row(double y, std::span<const MarkerNeighbour> neighbours) {
  return std::any_of(neighbours.begin(), neighbours.end(), [&](const MarkerNeighbour& other) {
    const double dy = y - other.centre.y(), reach = other.radius + kMargin;
    return dy * dy < reach * reach;
  });
}

bool belongs_elsewhere(double x, double y, double own_radius, std::span<const MarkerNeighbour> neighbours) {
  return std::any_of(neighbours.begin(), neighbours.end(), [&](const MarkerNeighbour& other) {
    const double dx = x - other.centre.x(), dy = y - other.centre.y();
    const double away = dx * dx + dy * dy;
    const double reach = other.radius + kMargin;
    return away < reach * reach && away - other.radius * other.radius < x * x + y * y - own_radius * own_radius;
  });
}

template <typename Pixel>
void gather(const cv::Mat& image, const MarkerBlob& blob, const MarkerSurroundings& around,
            std::span<const MarkerNeighbour> neighbours, MarkerWindow& window) {
  const double own_radius = std::sqrt(static_cast<double>(blob.area) / std::numbers::pi);
  const int reach = static_cast<int>(window.reach);
  const int cx = static_cast<int>(window.origin.x()), cy = static_cast<int>(window.origin.y());
  const float scale = (around.dark ? -1.0f : 1.0f) / static_cast<float>(window.scale);
  const auto level = static_cast<float>(around.background);
  const std::size_t room = static_cast<std::size_t>(2 * reach + 1) * (2 * reach + 1) + 8;
  for (auto* column : {&window.x, &window.y, &window.value, &window.weight}) column->resize(room);
  int n = 0;
  for (int dy = std::max(-reach, -cy); dy <= std::min(reach, image.rows - 1 - cy); ++dy) {
    const auto* row = image.ptr<Pixel>(cy + dy) + cx;
    const int half = static_cast<int>(std::sqrt(window.reach * window.reach - dy * dy));
    const int first = std::max(-half, -cx), last = std::min(half, image.cols - 1 - cx);
    const bool shared = reaches_row(dy, neighbours);
    for (int dx = first; dx <= last; ++dx) {
      if (shared && belongs_elsewhere(dx, dy, own_radius, neighbours)) continue;
      window.x[n] = static_cast<float>(dx);
      window.y[n] = static_cast<float>(dy);
      window.value[n] = (row[dx] - level) * scale;
      window.weight[n++] = 1;
    }
  }
  window.count = n;
  const int padded = (n + 7) / 8 * 8;
  for (int i = n; i < padded; ++i) window.x[i] = window.y[i] = window.value[i] = window.weight[i] = 0;
  for (auto* column : {&window.x, &window.y, &window.value, &window.weight}) column->resize(padded);
}

}  // namespace

void collect_window(const cv::Mat& image, const MarkerBlob& blob, const MarkerSurroundings& around,
                    std::vector<MarkerNeighbour>& neighbours, MarkerWindow& window) {
  const bool bytes = image.depth() == CV_8U;
  bytes ? measure<std::uint8_t>(image, blob, around, window) : measure<std::uint16_t>(image, blob, around, window);
  const double extent = std::max(blob.box.width, blob.box.height) / 2.0;
  window.reach = extent + kMargin;
  for (MarkerNeighbour& neighbour : neighbours) neighbour.centre -= window.origin;
  std::erase_if(neighbours, [&](const MarkerNeighbour& other) {  // whose light ends before the window begins
    return other.centre.norm() > other.radius + kMargin + window.reach + 1e-6;
  });
  bytes ? gather<std::uint8_t>(image, blob, around, neighbours, window)
        : gather<std::uint16_t>(image, blob, around, neighbours, window);
}

}  // namespace marey::detect::markers
