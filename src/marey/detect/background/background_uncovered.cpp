#include "marey/detect/background/background_uncovered.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "marey/detect/background/difference_sums.h"
#include "marey/geometry/median.h"

namespace marey::detect::background {
namespace {

constexpr double kUnlikeLuma = 10, kUnlikeChroma = 7;  // levels: what differs by less is noise or shade
constexpr double kNoiseSigmas = 5;                     // deviations of the noise; likewise
constexpr double kOfGaussian = 1.4826;  // by definition: standard deviations in a median distance from the median, of a Gaussian
constexpr double kMinArea = 0.15, kMaxArea = 2;       // of the body's box; with its shadow it is larger than the body
constexpr double kMinHeight = 0.5;                    // of the body's
constexpr double kGap = 1.0 / 15;                     // of the body's height: what is nearer together is one thing
constexpr double kSharper = 1.3, kSharperLevels = 2;  // how much sharper the border is in the scene, and by how many levels more
constexpr double kSameLevels = 8;                     // mean difference of what is the same
constexpr int kBlurReach = 2;                         // px about a region that its blur reaches

std::vector<float> values_of(const cv::Mat& plane, const cv::Mat& mask) {
  std::vector<float> values;
  for (int y = 0; y < plane.rows; ++y) {
    for (int x = 0; x < plane.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) != 0) values.push_back(plane.at<float>(y, x));
    }
  }
  return values;
}

/// Luma, in levels of 8 bit, and for colour chroma at full size. Luma of 16 bit becomes CV_32F; all else is CV_8U.
std::vector<cv::Mat> levels_of(const Image& image) {
  std::vector<cv::Mat> planes{image.luma()};
  if (image.luma().depth() == CV_16U) image.luma().convertTo(planes[0], CV_32F, 1.0 / 257.0);
  if (!image.is_colour()) return planes;
  for (const cv::Mat* chroma : {&image.cb(), &image.cr()}) {
    cv::resize(*chroma, planes.emplace_back(), image.size(), 0, 0, cv::INTER_LINEAR);
  }
  return planes;
}

cv::Mat as_float(const cv::Mat& plane) {
  cv::Mat result;
  plane.convertTo(result, CV_32F);
  return result;
}

cv::Rect pixels_of(const Box& box, cv::Size size) {
  const cv::Rect rect(cv::Point(static_cast<int>(std::floor(box.left)), static_cast<int>(std::floor(box.top))),
                      cv::Point(static_cast<int>(std::ceil(box.right())), static_cast<int>(std::ceil(box.bottom()))));
  return rect & cv::Rect({}, size);
}

cv::Mat round_element(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

/// Marks where a plane differs by more than `unlike` levels and more than its noise outside `body` does, once both are in one
/// light.
void mark_differing(const cv::Mat& scene, const cv::Mat& now, const cv::Rect& body, double unlike, cv::Mat& mask) {
  if (scene.depth() == CV_8U && now.depth() == CV_8U) {
    const DifferenceSums sums(scene, now);
    const DifferenceSums::Noise noise = sums.noise_outside(body);
    sums.mark(noise.shade, std::max(unlike, kNoiseSigmas * kOfGaussian * noise.deviation), mask);
    return;
  }
  cv::Mat outside(scene.size(), CV_8UC1, cv::Scalar(255));
  outside(body) = 0;
  cv::Mat difference = as_float(now) - as_float(scene);
  cv::blur(difference, difference, {3, 3});
  std::vector<float> values = values_of(difference, outside);
  const double shade = geometry::median_or(values, 0);
  for (float& value : values) value = static_cast<float>(std::abs(value - shade));
  mask |= cv::abs(difference - shade) > std::max(unlike, kNoiseSigmas * kOfGaussian * geometry::median_or(values, 0));
}

/// How sharp the images are along a band, levels: of each pixel its sharpest plane.
double sharpness(const std::vector<cv::Mat>& planes, const cv::Mat& band) {
  const cv::Rect within = cv::boundingRect(band);
  // A gradient needs the smooth levels beside it, and these need the levels beside them.
  const cv::Rect needed = cv::Rect(within.x - 2, within.y - 2, within.width + 4, within.height + 4) & cv::Rect({}, band.size());
  cv::Mat sharpest = cv::Mat::zeros(within.size(), CV_32F);
  for (const cv::Mat& plane : planes) {
    cv::Mat smooth, gradient;
    cv::blur(as_float(plane(needed)), smooth, {3, 3});
    cv::morphologyEx(smooth, gradient, cv::MORPH_GRADIENT, round_element(1));
    sharpest = cv::max(sharpest, gradient({within.tl() - needed.tl(), within.size()}));
  }
  return cv::mean(sharpest, band(within))[0];
}

/// Without specks, and with what is nearer together than twice `gap` joined. All of it is within the image's rectangle returned,
/// which is empty if nothing comes near the body, or what there is cannot be of its height.
cv::Rect tidy(cv::Mat& mask, int gap, const Box& body) {
  const Box near{body.left - gap, body.top - gap, body.width + 2.0 * gap, body.height + 2.0 * gap};
  if (const cv::Rect there = pixels_of(near, mask.size()); there.empty() || cv::countNonZero(mask(there)) == 0) return {};
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, round_element(1));
  cv::Rect within = cv::boundingRect(mask);
  if (within.empty() || within.height + 2 * gap < kMinHeight * body.height) return {};
  // Wide enough that nothing touches the sides; its corner is even, for there labels go by pairs of rows and columns.
  const int round = 2 * gap + 2;
  within = cv::Rect(cv::Point((within.x - round) & ~1, (within.y - round) & ~1), within.br() + cv::Point(round, round)) &
           cv::Rect({}, mask.size());
  cv::Mat part = mask(within);
  cv::morphologyEx(part, part, cv::MORPH_CLOSE, round_element(gap));
  return within;
}

/// Of the connected regions, all `within` that rectangle, the one that has most pixels in the body's box; nothing if it is no
/// body.
std::optional<cv::Mat> region_at(const cv::Mat& mask, const cv::Rect& within, const Box& body) {
  if (within.empty() || cv::countNonZero(mask(within)) < kMinArea * body.area()) return std::nullopt;
  cv::Mat labels, stats, centres;
  const int count = cv::connectedComponentsWithStats(mask(within), labels, stats, centres, 8);
  std::vector<int> inside(static_cast<std::size_t>(count), 0);
  const cv::Rect box = (pixels_of(body, mask.size()) & within) - within.tl();
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) ++inside[static_cast<std::size_t>(labels.at<int>(y, x))];
  }
  inside[0] = 0;
  const int best = static_cast<int>(std::max_element(inside.begin(), inside.end()) - inside.begin());
  if (inside[static_cast<std::size_t>(best)] == 0) return std::nullopt;
  const int area = stats.at<int>(best, cv::CC_STAT_AREA), height = stats.at<int>(best, cv::CC_STAT_HEIGHT);
  if (area < kMinArea * body.area() || area > kMaxArea * body.area() || height < kMinHeight * body.height) return std::nullopt;
  cv::Mat region = cv::Mat::zeros(mask.size(), CV_8UC1);
  cv::compare(labels, best, region(within), cv::CMP_EQ);
  return region;
}

void lay(const cv::Mat& patch, const cv::Mat& mask, cv::Mat plane) {
  cv::Mat there, put;
  plane.convertTo(there, CV_32F);
  patch.convertTo(put, CV_32F);
  std::vector<float> shades = values_of(there - put, mask == 0);
  put += cv::Scalar(geometry::median_or(shades, 0));
  put.convertTo(put, plane.type());
  put.copyTo(plane, mask);
}

}  // namespace

std::optional<cv::Mat> uncovered(const Image& scene, const Image& now, const Box& body) {
  if (scene.size() != now.size() || scene.is_colour() != now.is_colour() || scene.empty()) return std::nullopt;
  const std::vector<cv::Mat> before = levels_of(scene), after = levels_of(now);
  cv::Mat mask = cv::Mat::zeros(scene.size(), CV_8UC1);
  for (std::size_t i = 0; i < before.size(); ++i)
    mark_differing(before[i], after[i], pixels_of(body, scene.size()), i == 0 ? kUnlikeLuma : kUnlikeChroma, mask);
  const int gap = std::max(1, static_cast<int>(std::lround(kGap * body.height / 2)));
  auto region = region_at(mask, tidy(mask, gap, body), body);
  if (!region) return std::nullopt;
  cv::Mat outer, inner;
  cv::dilate(*region, outer, round_element(1));
  cv::erode(*region, inner, round_element(1));
  const cv::Mat band = outer & ~inner;
  if (sharpness(before, band) < kSharper * sharpness(after, band) + kSharperLevels) return std::nullopt;
  cv::dilate(*region, *region, round_element(kBlurReach));
  return region;
}

bool same_within(const Image& a, const Image& b, const cv::Mat& mask) {
  if (a.size() != b.size() || a.empty()) return false;
  cv::Mat difference = as_float(levels_of(a).front()) - as_float(levels_of(b).front());
  std::vector<float> outside = values_of(difference, mask == 0);
  difference -= cv::Scalar(geometry::median_or(outside, 0));
  return cv::mean(cv::abs(difference), mask)[0] < kSameLevels;
}

Image patched(const Image& image, const Image& patch, const cv::Mat& mask, cv::Point corner) {
  const cv::Rect location(corner, mask.size());
  cv::Mat luma = image.luma().clone();
  lay(patch.luma(), mask, luma(location));
  if (!image.is_colour()) return Image(luma);
  cv::Mat half_mask;
  cv::dilate(mask, half_mask, round_element(1));
  const cv::Rect half(location.x / 2, location.y / 2, patch.cb().cols, patch.cb().rows);
  cv::resize(half_mask, half_mask, half.size(), 0, 0, cv::INTER_NEAREST);
  cv::Mat cb = image.cb().clone(), cr = image.cr().clone();
  lay(patch.cb(), half_mask, cb(half));
  lay(patch.cr(), half_mask, cr(half));
  return {luma, cb, cr, image.range()};
}

}  // namespace marey::detect::background
