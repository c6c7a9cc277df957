#include "marey/source/stabilise/reference_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace marey::source::stabilise {
namespace {

constexpr int kWindow = 15, kLevels = 3;
constexpr double kContrast = 40, kMinContrast = 10;  // grey levels: standard deviation of a shrunk image; of a flat one
constexpr int kGridAcross = 14, kGridDown = 9;       // corners are taken from everywhere
constexpr int kBorder = 6;                           // px, in which no corner is followed
constexpr double kDefaultFocal = 1.5;                // in widths of the image
constexpr std::array<double, 13> kFocals{0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 1.8, 2.2, 2.7, 3.5, 5.0, 10.0, 30.0};  // in widths
constexpr std::size_t kFirstFocalImages = 10, kFocalImages = 40;
constexpr int kMeanEvery = 5, kMinMean = 10;  // images
constexpr double kMeanFraction = 0.08;
constexpr std::size_t kMaxKinds = 6;
constexpr int kSearchAgain = 5;  // images: one that is lost for longer is searched for everywhere this often
constexpr int kCoarse = 2;
constexpr double kStillThere = 0.6;    // of an image's corners: with fewer, the next ones are reported against a newer image
constexpr int kBeforeMinimum = 10;     // images located only by the one before, after which new corners are taken
constexpr int kAllPixelsAtFirst = 25;  // images lost in turn, after which all pixels are asked as rarely as everything else

/// The best few corners of each cell of a grid.
std::vector<cv::Point2f> corners_of(const cv::Mat& image, int maximum, double minimum) {
  cv::Mat as_float, quality, best;
  image.convertTo(as_float, CV_32F);
  cv::cornerMinEigenVal(as_float, quality, 7, 3);
  cv::dilate(quality, best, cv::Mat::ones(9, 9, CV_8U));
  const int each = std::max(1, maximum / (kGridAcross * kGridDown)) + 1;
  struct Corner {
    float quality;
    cv::Point2f at;
  };
  std::vector<Corner> all;
  for (int cell = 0; cell < kGridAcross * kGridDown; ++cell) {
    const int column = cell % kGridAcross, row = cell / kGridAcross;
    const int left = std::max(kBorder, column * image.cols / kGridAcross), top = std::max(kBorder, row * image.rows / kGridDown);
    const int right = std::min(image.cols - kBorder, (column + 1) * image.cols / kGridAcross);
    const int bottom = std::min(image.rows - kBorder, (row + 1) * image.rows / kGridDown);
    std::vector<Corner> here;
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        const float value = quality.at<float>(y, x);
        if (value >= minimum && value == best.at<float>(y, x))
          here.push_back({value, {static_cast<float>(x), static_cast<float>(y)}});
      }
    }
    const auto better = [](const Corner& a, const Corner& b) { return a.quality > b.quality; };
    std::stable_sort(here.begin(), here.end(), better);
    if (std::ssize(here) > each) here.resize(static_cast<std::size_t>(each));
    all.insert(all.end(), here.begin(), here.end());
  }
  std::stable_sort(all.begin(), all.end(), [](const Corner& a, const Corner& b) { return a.quality > b.quality; });
  std::vector<cv::Point2f> corners;
  for (const Corner& corner : all) {
    if (std::ssize(corners) < maximum) corners.push_back(corner.at);
  }
  return corners;
}

}  // namespace

ReferenceScene::ReferenceScene(cv::Size image, const std::optional<PinholeView>& known, const ReferenceSceneOptions& options)
    : options_(options), image_(image), focal_known_(known.has_value()) {
  shrink_ = std::max(1, (image.width + options.max_across - 1) / options.max_across);
  size_ = {std::max(1, image.width / shrink_), std::max(1, image.height / shrink_)};
  if (known) {
    view_.focal = known->focal / shrink_;
    view_.principal = (known->principal + Vector<2>(0.5, 0.5)) / shrink_ - Vector<2>(0.5, 0.5);
  } else {
    view_.focal = kDefaultFocal * size_.width;
    view_.principal = {(size_.width - 1) / 2.0, (size_.height - 1) / 2.0};
  }
}

std::vector<cv::Mat> ReferenceScene::pyramid_of(const cv::Mat& image, bool gradients) {
  std::vector<cv::Mat> pyramid;
  cv::buildOpticalFlowPyramid(image, pyramid, {kWindow, kWindow}, kLevels, gradients);
  return pyramid;
}

PinholeView ReferenceScene::view() const {
  return {view_.focal * shrink_, (view_.principal + Vector<2>(0.5, 0.5)) * shrink_ - Vector<2>(0.5, 0.5)};
}

/// Levels are brought to one mean and contrast, so that a cloud changes little.
cv::Mat ReferenceScene::shrunk(const Image& image) const {
  const cv::Mat luma = image.luma()({0, 0, size_.width * shrink_, size_.height * shrink_});
  cv::Mat small = luma, result;
  if (shrink_ > 1) cv::resize(luma, small, size_, 0, 0, cv::INTER_AREA);
  cv::Scalar mean, deviation;
  cv::meanStdDev(small, mean, deviation);
  const double of_8_bits = small.depth() == CV_16U ? 1.0 / 256 : 1.0;
  const double gain = kContrast / std::max(deviation[0], kMinContrast / of_8_bits);
  small.convertTo(result, CV_8U, gain, 128 - gain * mean[0]);
  return result;
}

bool ReferenceScene::take_corners(const cv::Mat& from) {
  Corners corners;
  corners.at = corners_of(from, options_.corners, options_.min_corner);
  if (std::ssize(corners.at) < options_.min_corners) return false;
  corners.pyramid = pyramid_of(from, true);
  if (corners_.size() == kMaxKinds) corners_.erase(corners_.begin() + 1);  // those of the beginning lie where the rest does
  corners_.push_back(std::move(corners));
  used_ = corners_.size() - 1;
  return true;
}

/// Where the corners that can be followed are seen; `within` is how many would be in the image.
std::vector<TrackedPosition> ReferenceScene::track_corners(const Corners& corners, const std::vector<cv::Mat>& pyramid,
                                                           const SceneMotion& start, int& within) const {
  const Matrix<3> to_picture = moved_from_rest(start, view_);
  const auto inside = [this](const cv::Point2f& at) {
    return at.x >= kBorder && at.y >= kBorder && at.x < size_.width - kBorder && at.y < size_.height - kBorder;
  };
  std::vector<cv::Point2f> from, to;
  for (const cv::Point2f& corner : corners.at) {
    const Vector<3> ahead = to_picture * Vector<3>(corner.x, corner.y, 1);
    const cv::Point2f at(static_cast<float>(ahead.x() / ahead.z()), static_cast<float>(ahead.y() / ahead.z()));
    if (!inside(at)) continue;
    from.push_back(corner);
    to.push_back(at);
  }
  within = static_cast<int>(from.size());
  std::vector<TrackedPosition> locations;
  if (from.empty()) return locations;
  std::vector<unsigned char> found;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(corners.pyramid, pyramid, from, to, found, error, {kWindow, kWindow}, kLevels,
                           {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 15, 0.02}, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-3);
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (found[i] != 0 && inside(to[i])) locations.push_back({{from[i].x, from[i].y}, {to[i].x, to[i].y}});
  }
  return locations;
}

std::optional<SceneFit> ReferenceScene::fit(const std::vector<TrackedPosition>& locations, int within, std::size_t all) const {
  const auto found = fit_motion(locations, view_, options_.agree);
  if (!found || found->agreeing < options_.min_corners || found->agreeing < options_.fraction * within) return std::nullopt;
  if (found->agreeing < options_.fraction_of_all * static_cast<double>(all)) return std::nullopt;
  if (found->motion.turn.head<2>().norm() * view_.focal > options_.farthest * size_.width) return std::nullopt;
  if (found->spread < options_.min_spread * size_.height) return std::nullopt;
  return found;
}

std::optional<SceneFit> ReferenceScene::find_from(const Corners& corners, const std::vector<cv::Mat>& pyramid,
                                                  const SceneMotion& start, std::vector<TrackedPosition>* kept) const {
  int within = 0;
  std::vector<TrackedPosition> locations = track_corners(corners, pyramid, start, within);
  auto found = fit(locations, within, corners.at.size());
  if (kept != nullptr) *kept = std::move(locations);
  return found;
}

cv::Mat ReferenceScene::coarse(const cv::Mat& image) const {
  cv::Mat small, result;
  cv::resize(image, small, {}, 1.0 / kCoarse, 1.0 / kCoarse, cv::INTER_AREA);
  small.convertTo(result, CV_32F);
  return result;
}

/// With all corners that are known, from wherever the whole image seems to have gone.
std::optional<SceneFit> ReferenceScene::find_anywhere(const cv::Mat& now, const std::vector<cv::Mat>& pyramid) {
  const cv::Mat small = coarse(now);
  cv::Mat window;
  cv::createHanningWindow(window, small.size(), CV_32F);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const std::size_t kind = (used_ + i) % corners_.size();
    const cv::Point2d by = kCoarse * cv::phaseCorrelate(coarse(corners_[kind].pyramid[0]), small, window);
    SceneMotion start;
    start.turn = {-by.y / view_.focal, by.x / view_.focal, 0};
    const auto found = find_from(corners_[kind], pyramid, start);
    if (!found) continue;
    used_ = kind;
    return found;
  }
  return std::nullopt;
}

/// The focal length with which the images' places lie best.
void ReferenceScene::settle_focal(const std::vector<std::vector<TrackedPosition>>& images) {
  double minimum = 0;
  std::optional<double> best;
  for (const double focal : kFocals) {
    PinholeView view = view_;
    view.focal = focal * size_.width;
    double cost = 0;
    for (const auto& locations : images) {
      if (const auto found = fit_motion(locations, view, options_.agree)) cost += found->cost;
    }
    if (best && cost >= minimum) continue;
    minimum = cost;
    best = view.focal;
  }
  if (best) view_.focal = *best;
}

/// While images come one by one: as soon as there are enough to determine it. Whether it has changed.
bool ReferenceScene::learn_focal(const std::vector<TrackedPosition>& locations, const SceneMotion& motion) {
  if (focal_known_ || motion.turn.head<2>().norm() * view_.focal < options_.reports_focal) return false;
  for_focal_.push_back(locations);
  if (for_focal_.size() != kFirstFocalImages && for_focal_.size() != kFocalImages) return false;
  settle_focal(for_focal_);
  focal_known_ = for_focal_.size() == kFocalImages;
  if (focal_known_) for_focal_.clear();
  return true;
}

cv::Mat ReferenceScene::at_rest(const cv::Mat& now, const SceneMotion& motion) const {
  const Matrix<3> h = moved_from_rest(motion, view_);
  const cv::Matx33d by(h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1), h(2, 2));
  cv::Mat result;
  cv::warpPerspective(now, result, by, now.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return result;
}

/// Into the mean of recent images; whether it has changed.
bool ReferenceScene::remember(const cv::Mat& now, const SceneMotion& motion) {
  if (++since_mean_ < kMeanEvery) return false;
  since_mean_ = 0;
  if (mean_.empty()) mean_ = cv::Mat::zeros(size_, CV_32F);
  ++in_mean_;
  cv::accumulateWeighted(at_rest(now, motion), mean_, std::max(kMeanFraction, 1.0 / in_mean_));
  if (!learned_from_several_ && in_mean_ == kMinMean) {
    cv::Mat levels;
    mean_.convertTo(levels, CV_8U);
    appearances_ = SceneAppearance(levels);  // in which those who walk are fainter than in the first image
  }
  return true;
}

/// New corners out of the mean of recent images where too few of the old ones are found again.
void ReferenceScene::keep_up(const cv::Mat& now, const SceneFit& fit) {
  Corners& corners = corners_[used_];
  const double fraction = static_cast<double>(fit.agreeing) / static_cast<double>(corners.at.size());
  agreed_ = agreed_ == 0 ? fraction : agreed_ + 0.05 * (fraction - agreed_);
  corners.agreed = std::max(corners.agreed, agreed_);
  if (!remember(now, fit.motion)) return;
  if (in_mean_ < kMinMean || agreed_ > options_.renew * corners.agreed) return;
  cv::Mat levels;
  mean_.convertTo(levels, CV_8U);
  in_mean_ = 0;
  if (take_corners(levels)) agreed_ = 0;
}

/// By the last image whose motion is known: where a person hides what the scene was known by, or has uncovered it, one image
/// still shows what the next one does. From time to time the scene's corners are taken again then.
std::optional<SceneMotion> ReferenceScene::find_from_before(const cv::Mat& now, const std::vector<cv::Mat>& pyramid) {
  if (before_image_.empty()) return std::nullopt;
  if (before_.pyramid.empty()) {
    before_.at = corners_of(before_image_, options_.corners, options_.min_corner);
    before_.pyramid = pyramid_of(before_image_, true);
  }
  if (std::ssize(before_.at) < options_.min_corners) return std::nullopt;
  auto found = find_from(before_, pyramid, {});
  if (!found) return std::nullopt;
  const bool changed = found->agreeing < kStillThere * static_cast<double>(before_.at.size());
  found->motion = after(found->motion, before_motion_);
  if (found->motion.turn.head<2>().norm() * view_.focal > options_.farthest * size_.width) return std::nullopt;
  if (changed) {
    before_ = {};
    before_image_ = now;
    before_motion_ = found->motion;
  }
  if (++by_before_ < kBeforeMinimum) return found->motion;
  by_before_ = 0;
  take_corners(at_rest(now, found->motion));
  return found->motion;
}

/// Against the scene with all pixels.
std::optional<SceneMotion> ReferenceScene::find_by_all_pixels(const cv::Mat& now) {
  if (lost_run_ >= kAllPixelsAtFirst && lost_run_ % kSearchAgain != 0) return std::nullopt;
  const auto found = appearances_.find(SceneAppearance(now), view_, options_.farthest * size_.width);
  if (!found) return std::nullopt;
  remember(now, found->motion);
  return found->motion;
}

/// By corners, from where the camera was last or from anywhere.
std::optional<SceneFit> ReferenceScene::find_by_corners(const cv::Mat& now, const std::vector<cv::Mat>& pyramid) {
  if (corners_.empty()) return std::nullopt;
  std::vector<TrackedPosition> locations;
  auto found = find_from(corners_[used_], pyramid, last_, &locations);
  if (!found) return lost_run_ % kSearchAgain == 0 ? find_anywhere(now, pyramid) : std::nullopt;
  return learn_focal(locations, found->motion) ? fit_motion(locations, view_, options_.agree) : found;
}

std::optional<SceneMotion> ReferenceScene::find(const Image& image) {
  if (image.size() != image_) return std::nullopt;
  const cv::Mat now = shrunk(image);
  if (corners_.empty() && appearances_.empty()) {
    SceneAppearance first(now);
    if (!take_corners(now) && !first.can_be_found()) return std::nullopt;
    appearances_ = std::move(first);
    return SceneMotion{};
  }
  const auto pyramid = pyramid_of(now, false);
  const auto found = find_by_corners(now, pyramid);
  std::optional<SceneMotion> motion = found ? std::optional(found->motion) : find_by_all_pixels(now);
  const bool by_scene = motion.has_value();
  if (!motion) motion = find_from_before(now, pyramid);
  lost_run_ = motion ? 0 : lost_run_ + 1;
  if (!motion) return std::nullopt;
  last_ = *motion;
  if (!by_scene) return last_;
  by_before_ = 0;
  before_ = {};
  before_image_ = now;
  before_motion_ = last_;
  if (found) keep_up(now, *found);
  return last_;
}

}  // namespace marey::source::stabilise
