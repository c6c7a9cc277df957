// The automatic threshold, as seen from above. The first pass lets through whatever stands out of a tile's ground by more than its
// noise: markers, but texture, specks, the pixels of a bar too. Each blob is then measured against what lies round it. Of those
// that stand out, the bright and large ones say what a marker's contrast is; three tenths of that is asked of all, and more where
// the dim ones are so many that the brightest of them would pass. What is too large or too long for a marker, and noise on
// something wide, says where the ground is not plain: there the image less what is wide is searched. After each such finding the
// image is searched again, at most four times in all; in a video that is the first image, and one where something comes into view.
#include "marey/detect/markers/marker_search.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/geometry/median.h"

namespace marey::detect::markers {
namespace {

constexpr std::size_t kMaxRuns = 1 << 18;
constexpr std::size_t kEnoughSamples = 5;  // for an automatic mask
constexpr int kMaxPasses = 4;              // at one image
constexpr int kClutterKept = 64;           // frames, before it is asked again whether it is still there
constexpr double kOfDemand = 0.85;         // a blob over what is round it, in the contrast that its pixels had to have
constexpr double kNewContrast = 1.5;       // times the known contrast: markers are brighter than was thought
constexpr double kLong = 0.15;             // less round than that is no marker, however it moves
constexpr int kLongSide = 16;              // px, of what may be called long
constexpr double kManyAreas = 8;           // of typical blobs: something wide, where it is not round or is cut by the border
constexpr double kRound = 0.7;
constexpr double kModeratelyRound = 0.4;  // of blobs that say what markers are like
constexpr int kNoisy = 3;                 // faint blobs in a tile: its ground is another than it was taken for
constexpr double kHalo = 0.08;            // of its height, 3 px outside a blob over 12 px: a lamp's
constexpr double kMinLight = 0.05;        // contrast times area, of the typical one's: less is a speck
constexpr double kEnoughLight = 60;       // px² of that one's area that count
constexpr double kAsBright = 0.7;         // of the typical one's own level
constexpr double kDefaultMaxWidth = 41;   // px; of markers on something wide, before one is known

bool at_border(const MarkerBlob& blob, cv::Size size) {
  return blob.box.x == 0 || blob.box.y == 0 || blob.box.br().x == size.width || blob.box.br().y == size.height;
}

}  // namespace

MarkerSearch::MarkerSearch(const MarkerOptions& options)
    : options_(options),
      levels_(options.dark && !options.colour, options.threshold),
      clutter_(options.dark),
      finder_(kMaxRuns),
      auto_mask_(options.auto_mask_s) {
  if (!options_.mask.empty()) CV_Assert(options_.mask.type() == CV_8UC1);
}

void MarkerSearch::prime(std::span<const Frame> samples) {
  if (options_.auto_mask_s <= 0) return;
  for (const Frame& frame : samples) {
    if (seconds(frame.time - samples.front().time) > options_.auto_mask_s || frame.image.empty()) continue;
    find(frame, std::nullopt);
  }
  if (samples.size() < kEnoughSamples || !auto_mask_.learning()) return;
  learned_ = auto_mask_.finish();
  mask_more(learned_);
}

std::span<const MarkerBlob> MarkerSearch::find(const Frame& frame, std::optional<double> widest) {
  const cv::Mat& luma = frame.image.luma();
  widest_ = options_.widest > 0 ? options_.widest : widest.value_or(kDefaultMaxWidth);
  prepare(frame.image);
  if (++frames_ % kClutterKept == 0) clutter_.forget();
  standing_.clear();
  for (int pass = 1;; ++pass) {
    inspect(frame.image);
    if (!options_.automatic()) break;
    assess(luma);
    if (pass == kMaxPasses || !(learned_contrast() || found_clutter())) break;
  }
  if (options_.automatic()) levels_.learn_contrast(typical_);
  if (options_.auto_mask_s <= 0 || !auto_mask_.learning()) return blobs_;
  if (const auto learned = auto_mask_.add(frame.time, size_, finder_.runs())) {
    learned_ = *learned;
    mask_more(*learned);
    inspect(frame.image);
    if (options_.automatic()) assess(luma);
  }
  return blobs_;
}

/// Learns the levels of the image, and begins again where it has another size.
void MarkerSearch::prepare(const Image& image) {
  const cv::Mat& luma = image.luma();
  if (!options_.mask.empty() && options_.mask.size() != luma.size()) {
    throw Error("the mask is {}×{} px but the image is {}×{}; give a mask of the image's size", options_.mask.cols,
                options_.mask.rows, luma.cols, luma.rows);
  }
  levels_.learn(luma);
  if (options_.colour) colour_heights(image, *options_.colour, colours_);
  const cv::Size size = options_.colour ? colours_.size() : luma.size();
  if (size != size_) begin(size);
}

namespace {

void exclude(cv::Mat& excluded, const Mask& part) {
  if (part.corners().empty()) {
    excluded(part.box() & cv::Rect({}, excluded.size())).setTo(255);
  } else {
    cv::fillPoly(excluded, std::vector<std::vector<cv::Point>>{part.corners()}, cv::Scalar(255));
  }
}

}  // namespace

void MarkerSearch::begin(cv::Size size) {
  size_ = size;
  const int tiles = (size.width + 63) / 64 * ((size.height + 63) / 64);
  colour_thresholds_ = {std::vector<std::uint16_t>(static_cast<std::size_t>(tiles), 63), false};
  clutter_.begin(size, options_.widest > 0 && options_.automatic());
  mask_ = MarkerMask();
  if (options_.mask.empty() && options_.masked.empty()) return;
  const cv::Size full = options_.colour ? cv::Size(2 * size.width, 2 * size.height) : size;
  cv::Mat excluded = options_.mask.empty() ? cv::Mat(cv::Mat::zeros(full, CV_8UC1)) : cv::Mat(options_.mask != 0);
  for (const Mask& part : options_.masked) exclude(excluded, part);
  if (options_.colour) {  // a chroma pixel is omitted where any of its four is
    cv::dilate(excluded, excluded, cv::Mat::ones(3, 3, CV_8U));
    cv::resize(excluded, excluded, size, 0, 0, cv::INTER_NEAREST);
  }
  mask_more(MarkerMask(excluded));
}

std::optional<std::vector<cv::Rect>> MarkerSearch::learned_parts() const {
  if (options_.auto_mask_s <= 0 || auto_mask_.learning()) return std::nullopt;
  cv::Mat learned(learned_.size(), CV_8UC1), labels, stats, centres;
  for (int y = 0; y < learned.rows; ++y) {
    for (int x = 0; x < learned.cols; ++x) learned.at<std::uint8_t>(y, x) = learned_.at(x, y) ? 255 : 0;
  }
  std::vector<cv::Rect> parts;
  const int count = learned.empty() ? 0 : cv::connectedComponentsWithStats(learned, labels, stats, centres);
  const int factor = options_.colour ? 2 : 1;
  for (int i = 1; i < count; ++i) {
    const int* of = stats.ptr<int>(i);
    parts.emplace_back(factor * of[cv::CC_STAT_LEFT], factor * of[cv::CC_STAT_TOP], factor * of[cv::CC_STAT_WIDTH],
                       factor * of[cv::CC_STAT_HEIGHT]);
  }
  return parts;
}

void MarkerSearch::mask_more(const MarkerMask& learned) {
  mask_.add(learned);
  std::int64_t excluded = 0;
  for (int y = 0; y < mask_.size().height; ++y) {
    for (int x = 0; x < mask_.size().width; ++x) excluded += mask_.at(x, y) ? 1 : 0;
  }
  if (!mask_.empty()) masked_fraction_ = static_cast<double>(excluded) / mask_.size().area();
}

/// One pass: the blobs of what is searched.
void MarkerSearch::inspect(const Image& image) {
  if (!options_.colour) {
    const bool cluttered = clutter_.any();
    const cv::Mat& plane = cluttered ? clutter_.plane(image.luma(), widest_) : image.luma();
    blobs_ = finder_.find(plane, cluttered ? clutter_.thresholds(levels_) : levels_.thresholds(), mask_);
    if (!finder_.cut_at()) return;
    levels_.learn(image.luma(), true);  // the light may have changed at once
    if (cluttered) clutter_.relearn();
    blobs_ = finder_.find(plane, cluttered ? clutter_.thresholds(levels_) : levels_.thresholds(), mask_);
    return;
  }
  full_size_.clear();
  for (MarkerBlob blob : finder_.find(colours_, colour_thresholds_, mask_)) {
    blob.box = {2 * blob.box.x, 2 * blob.box.y, 2 * blob.box.width, 2 * blob.box.height};
    blob.area *= 4;
    blob.mean_x = 2 * blob.mean_x + 0.5;
    blob.mean_y = 2 * blob.mean_y + 0.5;
    blob.var_x *= 4;
    blob.var_y *= 4;
    blob.cov_xy *= 4;
    full_size_.push_back(blob);
  }
  blobs_ = full_size_;
}

double MarkerSearch::demand(const MarkerBlob& blob, double around) {
  const int tile = MarkerClutter::tile_of(static_cast<int>(blob.mean_x), static_cast<int>(blob.mean_y), size_);
  const double noise = (clutter_.at(tile) ? clutter_.levels() : levels_).noise_demand(tile);
  return std::max(noise, levels_.demand(around));
}

double MarkerSearch::around(const cv::Mat& luma, std::size_t blob) const {
  const MarkerBlob& one = blobs_[blob];
  const int x = std::min(static_cast<int>(one.mean_x), luma.cols - 1), y = std::min(static_cast<int>(one.mean_y), luma.rows - 1);
  const double ground = levels_.background(x, y);
  if (!options_.automatic()) return contrast_of(luma, one, options_.dark && !options_.colour, ground).around;
  // The tile's ground is of many pixels and known better, where it is the ground.
  const double close_by = contrasts_[blob].around;
  return options_.widest > 0 || std::abs(close_by - ground) > 3 * levels_.noise() + 1 ? close_by : ground;
}

bool MarkerSearch::has_halo(std::size_t blob) const {
  return !contrasts_.empty() && contrasts_[blob].halo > kHalo;
}

/// Measures each blob against what is round it, and finds what is typical of those that stand out.
void MarkerSearch::assess(const cv::Mat& luma) {
  contrasts_.assign(blobs_.size(), {});
  standing_.assign(blobs_.size(), Standing::unobserved);
  heights_.clear();
  std::vector<geometry::WeightedValue> contrasts, tops, areas;
  for (std::size_t i = 0; i < blobs_.size(); ++i) {
    const MarkerBlob& blob = blobs_[i];
    const auto area = static_cast<double>(blob.area);
    if (area < options_.min_area) continue;
    contrasts_[i] =
        contrast_of(luma, blob, options_.dark, levels_.background(static_cast<int>(blob.mean_x), static_cast<int>(blob.mean_y)));
    const auto& [around, height, halo] = contrasts_[i];
    standing_[i] = height < kOfDemand * demand(blob, around) ? Standing::faint : Standing::out;
    if (standing_[i] == Standing::faint || area > options_.max_area || has_halo(i) || at_border(blob, luma.size())) continue;
    const double round = roundness_of(blob), announce = report_of(height, area);
    if (round < kModeratelyRound) continue;
    heights_.push_back(height);
    contrasts.push_back({height, announce});
    tops.push_back({(options_.dark ? levels_.white() - around : around) + height, announce});
    if (round >= kRound) areas.push_back({area, announce});
  }
  const auto contrast = geometry::weighted_median(contrasts), top = geometry::weighted_median(tops);
  typical_ = contrast ? std::optional(TypicalMarker{*contrast, *top}) : std::nullopt;
  typical_area_ = geometry::weighted_median(areas);
  if (typical_) leave_clutter();
}

/// What this many others stand out by that the brightest of them would pass for markers, and what gives too little light.
void MarkerSearch::leave_clutter() {
  const double minimum = above_clutter(heights_, typical_->contrast);
  const double light = kMinLight * std::min(typical_area_.value_or(0), kEnoughLight) * typical_->contrast;
  for (std::size_t i = 0; i < blobs_.size(); ++i) {
    const auto& [around, height, halo] = contrasts_[i];
    const double top = (options_.dark ? levels_.white() - around : around) + height;
    const bool dim = height < minimum && top < kAsBright * typical_->top;  // and not before something bright
    const bool speck = height * static_cast<double>(blobs_[i].area) < light;
    if (standing_[i] == Standing::out && (dim || speck)) standing_[i] = Standing::clutter;
  }
}

/// Whether markers are brighter than was known, so that more can be asked of a pixel.
bool MarkerSearch::learned_contrast() {
  if (!typical_ || typical_->contrast < kNewContrast * levels_.contrast()) return false;
  levels_.set_contrast(*typical_);
  clutter_.forget();  // what stands out by less than is asked now does no harm
  return true;
}

bool MarkerSearch::is_structure(const MarkerBlob& blob) const {
  const auto area = static_cast<double>(blob.area);
  if (area > options_.max_area) return true;
  const double round = roundness_of(blob);
  if (round < kLong && std::max(blob.box.width, blob.box.height) >= kLongSide) return true;
  return typical_area_ && area > kManyAreas * *typical_area_ && (round < kRound || at_border(blob, size_));
}

/// Whether a tile that was taken for plain holds something wide, or noise on it.
bool MarkerSearch::found_clutter() {
  structure_.assign(blobs_.size(), 0);
  bool any = false, fresh = false;
  std::vector<int> faint;
  for (std::size_t i = 0; i < blobs_.size(); ++i) {
    const MarkerBlob& blob = blobs_[i];
    if (static_cast<double>(blob.area) < options_.min_area) continue;
    if (is_structure(blob)) {
      structure_[i] = 1;
      any = true;
    } else if (standing_[i] == Standing::faint) {
      fresh |=
          clutter_.mark_noise(MarkerClutter::tile_of(static_cast<int>(blob.mean_x), static_cast<int>(blob.mean_y), size_), kNoisy);
    }
  }
  clutter_.clear_noise();
  for (int tile = 0; tile < levels_.tile_count(); ++tile) {
    if (levels_.is_uneven(tile)) fresh |= clutter_.mark(tile);
  }
  if (any) fresh |= clutter_.mark(finder_.runs(), structure_);
  return fresh;
}

}  // namespace marey::detect::markers
