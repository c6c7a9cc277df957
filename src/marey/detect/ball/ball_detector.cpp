// The scene is an image of its own here, of grey levels, which follows by a level now and then: the background models for people
// omit what is as small as a ball far away. What is brighter than it falls into regions; a region is evaluated by its light, the
// sum of what it adds, which motion smears but does not change: a ball's is that of a white disc of the radius that it has there.
// The score is the logarithm of the ratio of two densities of the radius, a ball's (a normal one of the logarithm) and that of
// anything else (even in the logarithm), less for what is ragged. A ball is alone on the grass; a sock, a shirt or a head has the
// rest of a person beside it, brighter or darker than the scene, whether or not that was found to be a person: its company.
// Cost: some passes over the image.
#include "marey/detect/ball/ball_detector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "marey/geometry/median.h"

namespace marey::detect::ball {

void BallDetector::prime(std::span<const Frame> samples) {
  std::vector<cv::Mat> images;
  for (const Frame& frame : samples) {
    if (!frame.image.empty() && frame.image.luma().type() == CV_8UC1) images.push_back(frame.image.luma());
  }
  if (images.size() < 3) return;
  scene_.create(images.front().size(), CV_8UC1);
  std::vector<std::uint8_t> levels(images.size());
  for (int y = 0; y < scene_.rows; ++y) {
    for (int x = 0; x < scene_.cols; ++x) {
      for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = images[i].at<std::uint8_t>(y, x);
      scene_.at<std::uint8_t>(y, x) = geometry::median(levels);
    }
  }
}

/// One level nearer to the frame, this often a second as the options say.
void BallDetector::adapt_scene(const cv::Mat& luma, Timestamp time) {
  if (!tracked_) tracked_ = time;
  if (seconds(time - *tracked_) * options_.track_hz < 1) return;
  tracked_ = time;
  cv::Mat up, down;
  cv::compare(luma, scene_, up, cv::CMP_GT);
  cv::compare(luma, scene_, down, cv::CMP_LT);
  cv::add(scene_, cv::Scalar(1), scene_, up);
  cv::subtract(scene_, cv::Scalar(1), scene_, down);
}

std::vector<BallCandidate> BallDetector::detect(const Frame& frame) {
  cv::Mat luma = frame.image.luma();
  if (luma.type() == CV_16UC1) luma.convertTo(luma, CV_8U, 1 / 257.0);
  if (scene_.size() != luma.size()) scene_ = luma.clone();
  cv::subtract(luma, scene_, added_);
  cv::Mat bright, blobs, figures, centres, other;
  cv::absdiff(luma, scene_, other);
  cv::threshold(other, other, options_.contrast, 1, cv::THRESH_BINARY);
  cv::integral(other, other_, CV_32S);
  adapt_scene(luma, frame.time);
  cv::threshold(added_, bright, options_.contrast, 255, cv::THRESH_BINARY);
  const int count = cv::connectedComponentsWithStats(bright, blobs, figures, centres, 8, CV_32S);
  std::vector<BallCandidate> found;
  for (int blob = 1; blob < count; ++blob) {
    const int* figure = figures.ptr<int>(blob);
    const cv::Rect box(figure[cv::CC_STAT_LEFT], figure[cv::CC_STAT_TOP], figure[cv::CC_STAT_WIDTH], figure[cv::CC_STAT_HEIGHT]);
    if (figure[cv::CC_STAT_AREA] < 2 || box.width > 80 || box.height > 80) continue;
    if (const auto candidate = assess(blobs, blob, box)) found.push_back(*candidate);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  if (std::ssize(found) > options_.maximum) found.resize(static_cast<std::size_t>(options_.maximum));
  return found;
}

/// Of the square round a box up to five radii away, without the box and what motion or a video's compression smears round it.
double BallDetector::local_clutter(const cv::Rect& box, double radius) const {
  const auto grown = [&](int by) {
    return cv::Rect(box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by) & cv::Rect({}, scene_.size());
  };
  const auto sum = [&](const cv::Rect& part) {
    return other_.at<int>(part.br()) - other_.at<int>(part.y, part.br().x) - other_.at<int>(part.br().y, part.x) +
           other_.at<int>(part.tl());
  };
  const cv::Rect inner = grown(2), outer = grown(static_cast<int>(std::lround(5 * radius)) + 2);
  const int area = outer.area() - inner.area();
  return area <= 0 ? 0 : static_cast<double>(sum(outer) - sum(inner)) / area;
}

std::optional<BallCandidate> BallDetector::assess(const cv::Mat& blobs, int blob, const cv::Rect& box) const {
  double light = 0, scene = 0, xx = 0, yy = 0, xy = 0;
  int area = 0;
  Vector<2> sum = Vector<2>::Zero();
  const cv::Point from(std::max(0, box.x - 1), std::max(0, box.y - 1));  // its faint rim too
  const cv::Point to(std::min(blobs.cols, box.br().x + 1), std::min(blobs.rows, box.br().y + 1));
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      const int label = blobs.at<int>(y, x);
      if (label != blob && label != 0) continue;
      const double more = added_.at<std::uint8_t>(y, x);
      light += more;
      sum += more * Vector<2>(x, y);
      xx += more * x * x, yy += more * y * y, xy += more * x * y;
      scene += scene_.at<std::uint8_t>(y, x);
      ++area;
    }
  }
  BallCandidate candidate;
  candidate.centre = sum / light;
  const auto expected = size_(candidate.centre);
  if (!expected) return std::nullopt;
  const double contrast = std::max(20.0, options_.white - scene / area);
  const double disc = std::numbers::pi * *expected * *expected * contrast;
  if (light < options_.min_light * disc || light > options_.max_light * disc) return std::nullopt;
  candidate.radius = std::sqrt(light / (std::numbers::pi * contrast));
  // The narrower side of the light's spread: motion draws out one side alone.
  const double vx = xx / light - candidate.centre.x() * candidate.centre.x(),
               vy = yy / light - candidate.centre.y() * candidate.centre.y();
  const double cross = xy / light - candidate.centre.x() * candidate.centre.y();
  const double root = std::sqrt((vx - vy) * (vx - vy) / 4 + cross * cross);
  const double narrow = std::sqrt(std::max(0.0, (vx + vy) / 2 - root)), wide = std::sqrt((vx + vy) / 2 + root);
  const double off = std::log(candidate.radius / *expected);
  const double spread = off < 0 ? options_.size_spread : options_.flown_spread;
  constexpr double kRange = 3;  // of the logarithm of radii that anything else has
  candidate.score = -off * off / (2 * spread * spread) +
                    std::log(2 * kRange / (std::sqrt(2 * std::numbers::pi) * (options_.size_spread + options_.flown_spread)));
  const double round = std::hypot(0.5 * candidate.radius, 0.6);  // what a disc spreads, blurred by the lens
  candidate.score -= 0.5 * std::pow(std::max(0.0, narrow / round - 1.2) / 0.25, 2);
  candidate.score -= 0.5 * std::pow(std::max(0.0, wide / round - 2) / 0.8, 2);
  candidate.sigma = 0.4 + 0.1 * wide;
  if (candidate.score < -12) return std::nullopt;
  candidate.local_clutter = local_clutter(box, *expected);
  return candidate;
}

}  // namespace marey::detect::ball
