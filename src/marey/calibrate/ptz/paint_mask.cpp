#include "marey/calibrate/ptz/paint_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <opencv2/imgproc.hpp>

namespace marey::calibrate::ptz {
namespace {

constexpr double kFar = 12;              // shrunk px: beyond, a line is not there
constexpr std::size_t kPositions = 400;  // pieces of paint that a heading has to explain; numerical: cost alone

/// The threshold over which a ridge stands out: as low as the grass allows.
double ridge_threshold(const cv::Mat& ridges, const cv::Mat& ground, const PaintMaskOptions& options) {
  constexpr std::array<float, 2> kLevels{0, 64};  // numerical
  const float* levels = kLevels.data();
  const int channel = 0, bins = 64;
  cv::Mat counts;
  cv::calcHist(&ridges, 1, &channel, ground, counts, 1, &bins, &levels);
  const double all = cv::sum(counts)[0];
  double above = all;
  for (int level = 0; level < bins; ++level) {
    above -= counts.at<float>(level);
    if (level >= options.min_ridge && above < options.paint_fraction * all) return std::min<double>(level, options.max_ridge);
  }
  return options.max_ridge;
}

/// Leaves the pieces that are as long as this or longer, in one direction or the other.
void drop_specks(cv::Mat& paint, int piece) {
  cv::Mat labels, boxes, middles;
  const int count = cv::connectedComponentsWithStats(paint, labels, boxes, middles, 8, CV_32S);
  std::vector<std::uint8_t> kept(static_cast<std::size_t>(count), 0);
  for (int i = 1; i < count; ++i)
    kept[static_cast<std::size_t>(i)] =
        std::max(boxes.at<int>(i, cv::CC_STAT_WIDTH), boxes.at<int>(i, cv::CC_STAT_HEIGHT)) >= piece ? 255 : 0;
  for (int y = 0; y < paint.rows; ++y) {
    for (int x = 0; x < paint.cols; ++x) paint.at<std::uint8_t>(y, x) = kept[static_cast<std::size_t>(labels.at<int>(y, x))];
  }
}

/// A straight line of the image: the direction of its normal, and how far it is from the middle.
struct ImageLine {
  double angle = 0, offset = 0;
};

}  // namespace

PaintMask paint_mask(const Image& image, const PaintMaskOptions& options) {
  const double factor = static_cast<double>(kMaskWidth) / image.size().width;
  const cv::Size size(kMaskWidth, cvRound(image.size().height * factor));
  const cv::Mat& luma = image.luma();
  const int wide = std::max(9, image.size().width / 64) | 1;
  cv::Mat open, ridges, mask, shrunk, smooth;
  cv::GaussianBlur(luma, smooth, {3, 3}, 0.7);
  cv::morphologyEx(smooth, open, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, {wide, wide}));
  ridges = smooth - open;
  cv::Mat ground(luma.size(), CV_8UC1, cv::Scalar(255));
  if (!image.cb().empty()) {
    // Paint has the ground's green about it: the middle colour of a wide window.
    cv::Mat cb, cr, green;
    cv::resize(image.cb(), cb, size, 0, 0, cv::INTER_AREA);
    cv::resize(image.cr(), cr, size, 0, 0, cv::INTER_AREA);
    cv::blur(cb, cb, {9, 9}), cv::blur(cr, cr, {9, 9});
    green = (cb < 127) & (cr < 127);
    cv::erode(green, green, cv::Mat::ones(5, 5, CV_8U));
    cv::resize(green, ground, luma.size(), 0, 0, cv::INTER_NEAREST);
  }
  cv::threshold(ridges, mask, ridge_threshold(ridges, ground, options), 255, cv::THRESH_BINARY);
  mask &= ground;
  cv::resize(mask, shrunk, size, 0, 0, cv::INTER_AREA);
  PaintMask result;
  result.ground = cv::mean(ground)[0] / 255;
  result.paint = shrunk >= 40;
  if (options.piece > 0) drop_specks(result.paint, options.piece);
  const cv::Mat bare = ~result.paint;  // 0 where there is paint
  cv::Mat far;
  cv::distanceTransform(bare, far, cv::DIST_L2, 3);
  result.near = 1 - far / kFar;
  cv::max(result.near, 0, result.near);
  result.about = 1 - far / (2 * kFar);
  cv::max(result.about, 0, result.about);
  std::vector<cv::Point> painted;
  cv::findNonZero(result.paint, painted);
  const std::size_t step = std::max<std::size_t>(1, painted.size() / kPositions);
  for (std::size_t i = 0; i < painted.size(); i += step) result.positions.emplace_back(painted[i].x, painted[i].y);
  return result;
}

int distinct_lines(const PaintMask& mask) {
  constexpr double kSameAngle = 0.05,
                   kSameOffset =
                       9;  // rad, shrunk px; numerical: how finely lines are distinguished, of which only the number counts
  std::vector<cv::Vec4i> pieces;
  cv::HoughLinesP(mask.paint, pieces, 1, CV_PI / 180, 35, kMaskWidth / 10.0, 6);
  const Vector<2> middle(mask.paint.cols / 2.0, mask.paint.rows / 2.0);
  std::vector<ImageLine> lines;
  for (const cv::Vec4i& piece : pieces) {
    const Vector<2> from(piece[0], piece[1]), to(piece[2], piece[3]), along = (to - from).normalized(),
                                                                      normal(-along.y(), along.x());
    const ImageLine here{std::atan2(normal.y(), normal.x()), normal.dot((from + to) / 2 - middle)};
    const bool known = std::any_of(lines.begin(), lines.end(), [&](const ImageLine& other) {
      const double turned = std::remainder(here.angle - other.angle, 2 * M_PI);
      const bool opposite = std::abs(turned) > M_PI / 2;
      return std::abs(std::remainder(turned, M_PI)) < kSameAngle &&
             std::abs(here.offset - (opposite ? -other.offset : other.offset)) < kSameOffset;
    });
    if (!known) lines.push_back(here);
  }
  return static_cast<int>(lines.size());
}

}  // namespace marey::calibrate::ptz
