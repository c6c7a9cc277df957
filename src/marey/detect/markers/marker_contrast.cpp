#include "marey/detect/markers/marker_contrast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "marey/geometry/median.h"

namespace marey::detect::markers {
namespace {

constexpr int kRim = 3;             // px outside the blob's box
constexpr int kRimPositions = 48;   // at most
constexpr double kAllRound = 0.9;   // of the directions in which a blob must fall off
constexpr int kLampArea = 50;       // px², from which on a halo is searched for
constexpr int kFurther = 12;        // px outside the box, where a halo is fainter
constexpr double kEnoughArea = 50;  // px² beyond which a blob is no better a marker
constexpr int kMinClutter = 10;     // blobs from which a tail is reported
constexpr double kFalsePerImage = 0.05;
constexpr double kMaxFactorOfTypical = 0.5;

/// Places round a blob's box, evenly spread over a frame this many px outside it: `visit(x, y, inwards_x, inwards_y)` for those
/// within the image.
template <typename Look>
void walk_round(const cv::Rect& box, int margin, cv::Size size, Look&& visit) {
  const cv::Rect frame(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin);
  const int length = 2 * (frame.width + frame.height) - 4, step = (length + kRimPositions - 1) / kRimPositions;
  for (int i = 0; i < length; i += step) {  // clockwise
    int x = frame.x, y = frame.y;
    if (i < frame.width) {
      x += i;
    } else if (i < frame.width + frame.height - 1) {
      x += frame.width - 1, y += i - frame.width + 1;
    } else if (i < 2 * frame.width + frame.height - 2) {
      x += 2 * frame.width + frame.height - 3 - i, y += frame.height - 1;
    } else {
      y += length - i;
    }
    if (x < 0 || y < 0 || x >= size.width || y >= size.height) continue;
    const int across = x < box.x ? 1 : x >= box.br().x ? -1 : 0, down = y < box.y ? 1 : y >= box.br().y ? -1 : 0;
    visit(x, y, across, down);
  }
}

template <typename Pixel>
int peak_of(const cv::Mat& luma, const cv::Rect& box, int sign) {
  const int skip = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(box.area()) / 400)));
  int peak = sign * luma.ptr<Pixel>(box.y)[box.x];
  for (int y = box.y; y < box.br().y; y += skip) {
    const auto* row = luma.ptr<Pixel>(y);
    for (int x = box.x; x < box.br().x; x += skip) peak = std::max(peak, sign * row[x]);
  }
  return peak;
}

/// The middle of the values on a frame; nothing if all of it lies outside the image.
template <typename Pixel>
std::optional<double> middle_round(const cv::Mat& luma, const cv::Rect& box, int margin) {
  std::array<int, kRimPositions> rim;
  std::size_t n = 0;
  walk_round(box, margin, luma.size(), [&](int x, int y, int, int) { rim[n++] = luma.ptr<Pixel>(y)[x]; });
  if (n == 0) return std::nullopt;
  return geometry::median(std::span(rim).first(n));
}

template <typename Pixel>
MarkerContrast measured(const cv::Mat& luma, const MarkerBlob& blob, bool dark, double otherwise) {
  const int sign = dark ? -1 : 1;
  const int peak = peak_of<Pixel>(luma, blob.box, sign);
  std::array<int, kRimPositions> rim, valleys;
  std::size_t n = 0;
  walk_round(blob.box, kRim, luma.size(), [&](int x, int y, int across, int down) {
    rim[n] = valleys[n] = sign * luma.ptr<Pixel>(y)[x];
    for (int step = 1; step < kRim; ++step) {  // past a blob of one row or column, and so perhaps out of the image
      const int row = std::clamp(y + step * down, 0, luma.rows - 1), column = std::clamp(x + step * across, 0, luma.cols - 1);
      valleys[n] = std::min<int>(valleys[n], sign * luma.ptr<Pixel>(row)[column]);
    }
    ++n;
  });
  if (n == 0) return {otherwise, peak - sign * otherwise, 0};
  const auto middle = geometry::median(std::span(rim).first(n));
  const auto sill = geometry::quantile(std::span(valleys).first(n), kAllRound);
  MarkerContrast result{static_cast<double>(sign * middle), static_cast<double>(peak - sill), 0};
  if (blob.area < kLampArea) return result;
  const auto further = middle_round<Pixel>(luma, blob.box, kFurther);
  if (further && peak > middle) result.halo = (middle - sign * *further) / (peak - middle);
  return result;
}

}  // namespace

MarkerContrast contrast_of(const cv::Mat& luma, const MarkerBlob& blob, bool dark, double otherwise) {
  return luma.depth() == CV_8U ? measured<std::uint8_t>(luma, blob, dark, otherwise)
                               : measured<std::uint16_t>(luma, blob, dark, otherwise);
}

double roundness_of(const MarkerBlob& blob) {
  const double mean = (blob.var_x + blob.var_y) / 2;
  const double largest = mean + std::hypot((blob.var_x - blob.var_y) / 2, blob.cov_xy);
  return static_cast<double>(blob.area) / (4 * std::numbers::pi * largest);
}

double report_of(double contrast, double area) {
  return std::max(0.0, contrast) * std::min(area, kEnoughArea);
}

double above_clutter(std::span<const double> contrasts, double typical) {
  std::vector<double> excess;  // over the least of them
  for (const double contrast : contrasts) {
    if (contrast < kMaxFactorOfTypical * typical) excess.push_back(contrast);
  }
  if (std::ssize(excess) < kMinClutter) return 0;
  const double minimum = *std::min_element(excess.begin(), excess.end());
  for (double& contrast : excess) contrast -= minimum;
  const double mean = std::max(0.0, geometry::median(excess)) / std::numbers::ln2;
  return std::min(kMaxFactorOfTypical * typical, minimum + mean * std::log(static_cast<double>(excess.size()) / kFalsePerImage));
}

}  // namespace marey::detect::markers
