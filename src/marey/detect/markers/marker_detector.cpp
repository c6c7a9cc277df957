// Markers in one frame: learn the levels, find the components, sort out what no marker is, and fit each of the rest. The steps are
// in files of their own: marker_levels, marker_runs, marker_fit, marker_split, marker_colour, marker_auto_mask. The number of runs,
// of blobs fitted and the size of each are bounded, so that glare or a white frame costs bounded time and memory.
#include "marey/detect/markers/marker_detector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/detect/markers/marker_auto_mask.h"
#include "marey/detect/markers/marker_fit.h"
#include "marey/detect/markers/marker_levels.h"
#include "marey/detect/markers/marker_neighbours.h"
#include "marey/detect/markers/marker_split.h"

namespace marey::detect::markers {
namespace {

constexpr std::size_t kMostRuns = 1 << 18;
constexpr int kMostSplitPixels = 40000;    // a frame: about 200 pairs
constexpr double kShapeMisfit = 0.06;      // of the contrast: what a lone round marker leaves at most
constexpr double kOfRoundness = 0.6;       // a blob this much less round is not even split: it bounds a window by its blob's area
constexpr std::size_t kEnoughSamples = 5;  // for an automatic mask
constexpr double kColourDeviation = 0.5;   // px; where chroma lies within its four pixels is not known for certain
constexpr double kLeastLumaContrast = 8;   // noises, for the centre of a coloured marker
constexpr double kUnlikeArea = 6;          // times the area of a typical disc

/// Area over that of the circle with the same largest second moment (a disc of radius R has R²/4).
double roundness(const MarkerBlob& blob) {
  const double mean = (blob.var_x + blob.var_y) / 2;
  const double largest = mean + std::hypot((blob.var_x - blob.var_y) / 2, blob.cov_xy);
  return static_cast<double>(blob.area) / (4 * std::numbers::pi * largest);
}

/// The middle of the pixels along the border of `frame`; `otherwise` where all of it lies outside the picture.
double rim_level(const cv::Mat& luma, const cv::Rect& frame, double otherwise) {
  std::vector<int> rim;
  const cv::Rect within({}, luma.size());
  const auto look = [&](int x, int y) {
    if (within.contains({x, y})) rim.push_back(luma.depth() == CV_8U ? luma.at<std::uint8_t>(y, x) : luma.at<std::uint16_t>(y, x));
  };
  for (int x = frame.x; x < frame.br().x; ++x) look(x, frame.y), look(x, frame.br().y - 1);
  for (int y = frame.y; y < frame.br().y; ++y) look(frame.x, y), look(frame.br().x - 1, y);
  if (rim.empty()) return otherwise;
  const auto middle = rim.begin() + static_cast<std::ptrdiff_t>(rim.size() / 2);
  std::nth_element(rim.begin(), middle, rim.end());
  return *middle;
}

/// How far each pixel stands out from what is wider than a marker: the picture less its morphological opening (a dark one: its
/// closing less the picture). What is wider than `widest` px leaves nothing, edges neither (Serra 1982: the top-hat).
void spot_heights(const cv::Mat& luma, double widest, bool dark, cv::Mat& heights) {
  const int side = 2 * static_cast<int>(std::ceil(widest / 2)) + 1;
  cv::morphologyEx(luma, heights, dark ? cv::MORPH_BLACKHAT : cv::MORPH_TOPHAT, cv::Mat::ones(side, side, CV_8U));
}

bool inside(const Box& box, double x, double y) {
  return x >= box.left - 0.5 && y >= box.top - 0.5 && x < box.right() - 0.5 && y < box.bottom() - 0.5;
}

}  // namespace

class MarkerDetector::Impl {
 public:
  explicit Impl(MarkerOptions options)
      : options_(std::move(options)),
        levels_(options_.dark && !options_.colour, options_.threshold),
        spot_levels_(false, std::nullopt),
        finder_(kMostRuns),
        auto_mask_(options_.auto_mask_s) {
    if (!options_.mask.empty()) CV_Assert(options_.mask.type() == CV_8UC1);
  }

  void prime(std::span<const Frame> samples);
  Detections detect(const Frame& frame, std::span<const Expected> expected);

  MarkerCounts counts_;
  MarkerLevels& levels() { return levels_; }

 private:
  const cv::Mat& prepare(const Picture& picture);
  std::span<const MarkerBlob> find(const cv::Mat& searched);
  void mask_more(const MarkerMask& learned);
  void choose(std::span<const MarkerBlob> blobs, std::span<const Expected> expected);
  MarkerSurroundings surroundings(const cv::Mat& luma, const MarkerBlob& blob) const;
  void measure(const cv::Mat& luma, std::span<const MarkerBlob> blobs, std::size_t index, std::span<const Expected> expected,
               std::vector<Detection>& found);
  Detection report(const MarkerShape& shape, const MarkerBlob& blob);
  void drop_unlike(std::vector<Detection>& found);
  void learn_from(std::vector<double>& contrasts);

  MarkerOptions options_;
  bool looks_close_by() const { return options_.widest > 0 && !options_.colour && !options_.threshold; }

  MarkerLevels levels_;
  MarkerLevels spot_levels_;  // of the picture less what is wider than a marker
  MarkerRunFinder finder_;
  MarkerAutoMask auto_mask_;
  MarkerMask mask_;
  cv::Size searched_size_;
  cv::Mat heights_;
  MarkerThresholds colour_thresholds_;
  std::vector<std::size_t> chosen_;
  MarkerNeighbours neighbours_;
  MarkerWindow window_;
  std::vector<MarkerBlob> full_size_;
  std::vector<double> contrasts_, blurs_, disc_areas_;
  std::vector<char> is_disc_;  // for each detection of the frame
  std::optional<double> blur_;
  std::optional<double> disc_area_;  // px², typical
  int split_pixels_left_ = 0;
};

void MarkerDetector::Impl::prime(std::span<const Frame> samples) {
  if (options_.auto_mask_s <= 0) return;
  for (const Frame& frame : samples) {
    if (seconds(frame.time - samples.front().time) > options_.auto_mask_s || frame.picture.empty()) continue;
    const cv::Mat& searched = prepare(frame.picture);
    find(searched);
    auto_mask_.add(frame.time, searched.size(), finder_.runs());
  }
  if (samples.size() >= kEnoughSamples) mask_more(auto_mask_.finish());
}

/// The plane that is searched: luma, or how much of the colour there is, at the size of the chroma planes.
const cv::Mat& MarkerDetector::Impl::prepare(const Picture& picture) {
  const cv::Mat& luma = picture.luma();
  if (!options_.mask.empty() && options_.mask.size() != luma.size()) {
    throw Error("the mask is {}×{} px but the picture is {}×{}; give a mask of the picture's size", options_.mask.cols,
                options_.mask.rows, luma.cols, luma.rows);
  }
  levels_.learn(luma);
  if (options_.colour) colour_heights(picture, *options_.colour, heights_);
  if (looks_close_by()) {
    spot_heights(luma, options_.widest, options_.dark, heights_);
    spot_levels_.learn(heights_);
  }
  const cv::Mat& searched = options_.colour || looks_close_by() ? heights_ : luma;
  if (searched.size() == searched_size_) return searched;
  searched_size_ = searched.size();
  const int tiles = (searched.cols + 63) / 64 * ((searched.rows + 63) / 64);
  colour_thresholds_ = {std::vector<std::uint16_t>(tiles, 63), false};
  mask_ = MarkerMask();
  if (options_.mask.empty()) return searched;
  cv::Mat excluded = options_.mask != 0;
  if (options_.colour) {  // a chroma pixel is left out where any of its four is
    cv::dilate(excluded, excluded, cv::Mat::ones(3, 3, CV_8U));
    cv::resize(excluded, excluded, searched.size(), 0, 0, cv::INTER_NEAREST);
  }
  mask_more(MarkerMask(excluded));
  return searched;
}

/// Blobs in pixels of the full picture, whatever they were found in.
std::span<const MarkerBlob> MarkerDetector::Impl::find(const cv::Mat& searched) {
  if (!options_.colour) {
    MarkerLevels& levels = looks_close_by() ? spot_levels_ : levels_;
    const auto blobs = finder_.find(searched, levels.thresholds(), mask_);
    if (!finder_.cut_at()) return blobs;
    levels.learn(searched, true);  // the light may have changed at once
    return finder_.find(searched, levels.thresholds(), mask_);
  }
  full_size_.clear();
  for (MarkerBlob blob : finder_.find(searched, colour_thresholds_, mask_)) {
    blob.box = {2 * blob.box.x, 2 * blob.box.y, 2 * blob.box.width, 2 * blob.box.height};
    blob.area *= 4;
    blob.mean_x = 2 * blob.mean_x + 0.5;
    blob.mean_y = 2 * blob.mean_y + 0.5;
    blob.var_x *= 4;
    blob.var_y *= 4;
    blob.cov_xy *= 4;
    full_size_.push_back(blob);
  }
  return full_size_;
}

Detections MarkerDetector::Impl::detect(const Frame& frame, std::span<const Expected> expected) {
  Detections result;
  ++counts_.frames;
  if (frame.picture.empty()) return result;
  const cv::Mat& luma = frame.picture.luma();
  const cv::Mat& searched = prepare(frame.picture);
  auto blobs = find(searched);
  if (finder_.cut_at()) ++counts_.frames_cut;
  if (options_.auto_mask_s > 0 && auto_mask_.learning()) {
    if (auto learned = auto_mask_.add(frame.time, searched.size(), finder_.runs())) {
      mask_more(*learned);
      blobs = find(searched);
    }
  }
  choose(blobs, expected);
  neighbours_.file(blobs, chosen_, luma.size());
  contrasts_.clear();
  blurs_.clear();
  disc_areas_.clear();
  is_disc_.clear();
  split_pixels_left_ = kMostSplitPixels;
  result.detections.reserve(chosen_.size());
  for (const std::size_t index : chosen_) measure(luma, blobs, index, expected, result.detections);
  drop_unlike(result.detections);
  counts_.markers += static_cast<std::int64_t>(result.detections.size());
  learn_from(contrasts_);
  return result;
}

void MarkerDetector::Impl::mask_more(const MarkerMask& learned) {
  mask_.add(learned);
  std::int64_t excluded = 0;
  for (int y = 0; y < mask_.size().height; ++y) {
    for (int x = 0; x < mask_.size().width; ++x) excluded += mask_.at(x, y) ? 1 : 0;
  }
  if (!mask_.empty()) counts_.masked_share = static_cast<double>(excluded) / mask_.size().area();
}

void MarkerDetector::Impl::choose(std::span<const MarkerBlob> blobs, std::span<const Expected> expected) {
  chosen_.clear();
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    const auto area = static_cast<double>(blobs[i].area);
    if (area < options_.min_area) {
      ++counts_.too_small;
    } else if (area > options_.max_area) {
      ++counts_.too_large;
    } else if (roundness(blobs[i]) < kOfRoundness * options_.min_roundness) {
      ++counts_.not_round;
    } else {
      chosen_.push_back(i);
    }
  }
  const auto most = static_cast<std::size_t>(options_.most_markers);
  if (chosen_.size() <= most) return;
  counts_.over_limit += static_cast<std::int64_t>(chosen_.size() - most);
  const auto wanted = [&](std::size_t i) {
    return std::any_of(expected.begin(), expected.end(),
                       [&](const Expected& e) { return inside(e.box, blobs[i].mean_x, blobs[i].mean_y); });
  };
  std::vector<std::tuple<bool, std::int64_t, std::size_t>> order;  // what sorts first stays
  order.reserve(chosen_.size());
  for (const std::size_t i : chosen_) order.emplace_back(!wanted(i), -blobs[i].area, i);
  std::sort(order.begin(), order.end());
  std::transform(order.begin(), order.end(), chosen_.begin(), [](const auto& entry) { return std::get<2>(entry); });
  chosen_.resize(most);
  std::sort(chosen_.begin(), chosen_.end());
}

MarkerSurroundings MarkerDetector::Impl::surroundings(const cv::Mat& luma, const MarkerBlob& blob) const {
  MarkerSurroundings around;
  const int x = std::min(static_cast<int>(blob.mean_x), luma.cols - 1), y = std::min(static_cast<int>(blob.mean_y), luma.rows - 1);
  around.background = levels_.background(x, y);
  around.noise = levels_.noise();
  around.white = levels_.white();
  around.dark = options_.dark;
  around.blur = blur_;
  if (!options_.colour && !options_.threshold && !looks_close_by()) return around;
  // A coloured marker may be brighter or darker than what is around it, and beside a fixed threshold a tile may be mostly of
  // something else than what lies round the marker.
  const cv::Rect within({}, luma.size());
  around.background = rim_level(luma, {blob.box.x - 3, blob.box.y - 3, blob.box.width + 6, blob.box.height + 6}, around.background);
  if (options_.colour) around.dark = cv::mean(luma(blob.box & within))[0] < around.background;
  return around;
}

void MarkerDetector::Impl::measure(const cv::Mat& luma, std::span<const MarkerBlob> blobs, std::size_t index,
                                   std::span<const Expected> expected, std::vector<Detection>& found) {
  const MarkerBlob& blob = blobs[index];
  const MarkerSurroundings around = surroundings(luma, blob);
  collect_window(luma, blob, around, neighbours_.of(blobs, index), window_);
  MarkerShape lone = fit_disc(window_, blob, around);
  if (options_.colour &&
      (!lone.fitted || lone.contrast < kLeastLumaContrast * around.noise)) {  // luma does not show it: chroma does
    lone.fitted = false;
    lone.centre = {blob.mean_x, blob.mean_y};
    lone.covariance = Matrix<2>::Identity() * (kColourDeviation * kColourDeviation);
  }
  const double grain = 3 * around.noise / window_.scale;
  if (lone.misfit > std::max(kShapeMisfit, grain) && blob.area >= 8 && window_.count <= split_pixels_left_) {
    split_pixels_left_ -= window_.count;
    const auto several = static_cast<std::size_t>(std::count_if(expected.begin(), expected.end(), [&](const Expected& e) {
      return blob.box.contains(
          {static_cast<int>(std::lround(e.box.centre().x())), static_cast<int>(std::lround(e.box.centre().y()))});
    }));
    const auto parts = split_markers(window_, blob, around, several);
    if (!parts.empty()) {
      ++counts_.split;
      for (const MarkerShape& part : parts) {
        found.push_back(report(part, blob));
        is_disc_.push_back(1);
      }
      return;
    }
  }
  if (roundness(blob) < options_.min_roundness) {
    ++counts_.not_round;
    return;
  }
  if (!lone.fitted) ++counts_.not_fitted;
  const bool is_disc = lone.fitted && lone.misfit < std::max(kShapeMisfit, grain);
  if (is_disc) {
    blurs_.push_back(lone.blur);
    disc_areas_.push_back(static_cast<double>(blob.area));
  }
  contrasts_.push_back(window_.scale);
  Detection detection = report(lone, blob);
  detection.box = {static_cast<double>(blob.box.x), static_cast<double>(blob.box.y), static_cast<double>(blob.box.width),
                   static_cast<double>(blob.box.height)};
  is_disc_.push_back(is_disc ? 1 : 0);
  found.push_back(std::move(detection));
}

Detection MarkerDetector::Impl::report(const MarkerShape& shape, const MarkerBlob& blob) {
  Detection detection;
  detection.centre = shape.centre;
  detection.covariance = shape.covariance;
  detection.area = shape.fitted ? std::numbers::pi * shape.radius * shape.radius : static_cast<double>(blob.area);
  detection.box = Box::from_centre(shape.centre, 2 * shape.radius + 1, 2 * shape.radius + 1);
  if (options_.colour || options_.threshold) return detection;
  const double least =
      (looks_close_by() ? spot_levels_ : levels_).least_contrast(static_cast<int>(blob.mean_x), static_cast<int>(blob.mean_y));
  detection.score = std::clamp(shape.contrast / (2 * least), 0.1, 1.0);
  return detection;
}

/// Markers of one recording are of one kind. What no disc fits and is many times as large as the discs is something else that is
/// bright: the edge of a barrier, a window. Where no disc is seen at all, nothing is dropped.
void MarkerDetector::Impl::drop_unlike(std::vector<Detection>& found) {
  if (!disc_areas_.empty()) {
    const auto middle = disc_areas_.begin() + static_cast<std::ptrdiff_t>(disc_areas_.size() / 2);
    std::nth_element(disc_areas_.begin(), middle, disc_areas_.end());
    disc_area_ = disc_area_ ? *disc_area_ + (*middle - *disc_area_) / 8 : *middle;
  }
  if (!disc_area_) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!is_disc_[i] && found[i].box.area() > kUnlikeArea * *disc_area_) {
      ++counts_.unlike;
      continue;
    }
    if (kept != i) found[kept] = std::move(found[i]);
    ++kept;
  }
  found.resize(kept);
}

void MarkerDetector::Impl::learn_from(std::vector<double>& contrasts) {
  double cubes = 0, squares = 0;  // the mean, weighted by its square: the bright ones decide
  for (const double contrast : contrasts) {
    cubes += contrast * contrast * contrast;
    squares += contrast * contrast;
  }
  for (MarkerLevels* levels : {&levels_, &spot_levels_}) {
    levels->learn_contrast(squares > 0 ? std::optional(cubes / squares) : std::nullopt);
  }
  if (blurs_.empty()) return;
  const auto middle = blurs_.begin() + static_cast<std::ptrdiff_t>(blurs_.size() / 2);
  std::nth_element(blurs_.begin(), middle, blurs_.end());
  blur_ = blur_ ? *blur_ + (*middle - *blur_) / 8 : *middle;
}

MarkerDetector::MarkerDetector(MarkerOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
MarkerDetector::~MarkerDetector() = default;

void MarkerDetector::prime(std::span<const Frame> samples) {
  impl_->prime(samples);
}

Detections MarkerDetector::detect(const Frame& frame, std::span<const Expected> expected) {
  return impl_->detect(frame, expected);
}

DetectionCounts MarkerDetector::detection_counts() const {
  const MarkerCounts& all = counts();
  return {all.too_small, all.too_large + all.not_round + all.unlike};
}

const MarkerCounts& MarkerDetector::counts() const {
  return impl_->counts_;
}

double MarkerDetector::typical_threshold() const {
  return impl_->levels().typical_least_contrast();
}

double MarkerDetector::noise() const {
  return impl_->levels().noise();
}

std::vector<std::string> warnings(const MarkerCounts& counts) {
  std::vector<std::string> result;
  if (counts.over_limit > 0) {
    result.push_back(
        fmt::format("{} blobs beyond the most markers allowed a frame were left out: is there glare? A mask or a higher "
                    "threshold helps",
                    counts.over_limit));
  }
  if (counts.frames_cut > 0) {
    result.push_back(
        fmt::format("{} of {} frames had too much above the threshold to be searched to the bottom; a higher threshold helps",
                    counts.frames_cut, counts.frames));
  }
  if (counts.frames > 0 && counts.markers == 0) result.push_back("no marker was seen in any frame");
  return result;
}

}  // namespace marey::detect::markers
