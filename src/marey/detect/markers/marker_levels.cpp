// The automatic threshold. Each tile of 64 × 64 pixels is sampled at 64 places on a grid. Its background is their median, smoothed
// by the median of the 3 × 3 tiles around, so that a marker that fills a tile does not become its background. The noise is found
// twice: over the image, from differences of pixels two apart, which a gradient barely touches; and in the tile, from how far the
// samples fall short of their median, on the side on which no marker is: texture and gradients count there. A pixel passes that
// stands out by the largest of 6 standard deviations, 3 % of white (compression and shadows), and a fifth of what the markers so
// far stood out by. Assumes that markers cover less than half of most neighbourhoods of 192 × 192 pixels. Cost: 64 samples for a
// 32nd of the tiles each frame, about 0.4 % of the pixels' number in operations.
#include "marey/detect/markers/marker_levels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "marey/geometry/median.h"

namespace marey::detect::markers {
namespace {

constexpr int kTile = MarkerThresholds::kTile;
constexpr int kGrid = 8;                 // samples per tile, in each direction
constexpr int kFraction = 32;            // frames in which every tile is measured once
constexpr double kSigmas = 6;            // a million pixels of pure noise: one false pixel in a thousand frames
constexpr double kMinCompressed = 0.03;  // of white; of what was compressed or rounded to 8 bits
constexpr double kMinRaw = 0.01;         // of an image of more bits
constexpr double kOfContrast = 0.3;      // of the bright ones': a dim edge of something else is no marker
constexpr double kForget = 0.97;         // of the contrast is left after a frame without a marker
constexpr double kUneven = 0.5;          // of what a marker must stand out by: a step in the ground that matters
constexpr double kUnevenNoise = 5;       // noises: of noise alone seven tenths lie within 2.1
constexpr double kOfTop = 0.6;           // of their own level: one before something bright stands out by less
constexpr int kMaxChange = 1023;         // format: of a histogram, in levels of 8 bits or quarters of them

double value_at(const cv::Mat& image, int x, int y) {
  return image.depth() == CV_8U ? image.ptr<std::uint8_t>(y)[x] : image.ptr<std::uint16_t>(y)[x];
}

}  // namespace

void MarkerLevels::begin(const cv::Mat& image) {
  size_ = image.size();
  depth_ = image.depth();
  tiles_ = {(size_.width + kTile - 1) / kTile, (size_.height + kTile - 1) / kTile};
  raw_.assign(tiles_.area(), {});
  level_.assign(tiles_.area(), 0);
  thresholds_ = {std::vector<std::uint16_t>(tiles_.area(), 0), dark_};
  white_ = 255;
  if (depth_ == CV_16U) {
    double maximum = 0;
    cv::minMaxLoc(image, nullptr, &maximum);
    while (white_ < maximum) white_ = 2 * white_ + 1;
  }
}

void MarkerLevels::learn(const cv::Mat& image, bool afresh) {
  const bool first = image.size() != size_ || image.depth() != depth_;
  if (first) begin(image);
  const int count = tiles_.area();
  const int fraction = first || afresh ? count : (count + kFraction - 1) / kFraction;
  if (first || afresh) changes_.assign(kMaxChange + 1, 0);
  for (int i = 0; i < fraction; ++i) sample(image, (next_ + i) % count);
  if (first || afresh || next_ + fraction >= count) {
    learn_noise();
    for (auto& detected : changes_) detected /= 2;  // older frames fade
  }
  for (int i = 0; i < fraction; ++i) set_threshold((next_ + i) % count);
  next_ = (next_ + fraction) % count;
}

void MarkerLevels::sample(const cv::Mat& image, int tile) {
  const cv::Rect area = cv::Rect(tile % tiles_.width * kTile, tile / tiles_.width * kTile, kTile, kTile) & cv::Rect({}, size_);
  std::array<int, kGrid * kGrid> heights;
  const int jump = std::min(2, size_.width - 1);
  const double unit = white_ / 255;
  int n = 0;
  for (int j = 0; j < kGrid; ++j) {
    const int y = area.y + (2 * j + 1) * area.height / (2 * kGrid);
    for (int i = 0; i < kGrid; ++i) {
      const int x = area.x + (2 * i + j % 2) * area.width / (2 * kGrid);
      const double value = value_at(image, x, y);
      const double other = value_at(image, x + jump < size_.width ? x + jump : x - jump, y);
      heights[n++] = static_cast<int>(dark_ ? white_ - value : value);
      ++changes_[std::min<int>(kMaxChange, static_cast<int>(std::abs(value - other) * (depth_ == CV_8U ? 1 : 4 / unit)))];
    }
  }
  std::sort(heights.begin(), heights.begin() + n);
  // Of a normal distribution these are the same; where two levels meet in the tile one of them lies within a level.
  const int middle = heights[n / 2];
  const double spread = std::min((middle - heights[n / 10]) / 1.2816, (middle - heights[n / 4]) / 0.6745);
  const auto step = static_cast<float>(heights[n - 1 - n / 7] - heights[n / 7]);
  const auto held = [](int height) { return static_cast<std::uint16_t>(std::clamp(height, 0, 65535)); };
  raw_[tile] = {held(middle), held(heights[n - 1 - n / 7]), step, static_cast<float>(spread)};
}

/// From the histogram of |difference|: the 68.3 % point of noise of deviation σ√2. Bins are spread evenly over their width.
void MarkerLevels::learn_noise() {
  double total = 0;
  for (const auto count : changes_) total += count;
  const double bin = depth_ == CV_8U ? 1 : white_ / 255 / 4;
  double below = 0;
  std::size_t k = 0;
  while (k + 1 < changes_.size() && below + changes_[k] < 0.6827 * total) below += changes_[k++];
  const double within = changes_[k] > 0 ? (0.6827 * total - below) / changes_[k] : 0;
  // Bin 0 of an 8-bit image holds differences up to ½ on either side, bin k those from k − ½ to k + ½.
  const double width = k == 0 ? within * 0.5 : static_cast<double>(k) - 0.5 + within;
  noise_ = std::max(width * bin / std::sqrt(2.0), std::sqrt(1.0 / 12));
}

double MarkerLevels::smooth_median(int tile) const {
  std::array<std::uint16_t, 9> around{};
  int n = 0;
  const int column = tile % tiles_.width, row = tile / tiles_.width;
  for (int j = std::max(0, row - 1); j <= std::min(tiles_.height - 1, row + 1); ++j) {
    for (int i = std::max(0, column - 1); i <= std::min(tiles_.width - 1, column + 1); ++i) {
      around[n++] = raw_[static_cast<std::size_t>(j) * tiles_.width + i].median;
    }
  }
  return geometry::nth_value(std::span(around).first(static_cast<std::size_t>(n)), static_cast<std::size_t>((n - 1) / 2));
}

double MarkerLevels::brighter_level(int tile) const {
  const double height = raw_[static_cast<std::size_t>(tile)].high;
  return dark_ ? white_ - height : height;
}

/// What compression, rounding and shadows leave, grey levels.
double MarkerLevels::minimum() const {
  return (depth_ == CV_8U ? kMinCompressed : kMinRaw) * white_;
}

double MarkerLevels::noise_demand(int tile) const {
  const double sigma = std::max<double>(noise_, raw_[static_cast<std::size_t>(tile)].spread);
  return std::max(kSigmas * sigma, minimum());
}

double MarkerLevels::demand(double ground) const {
  const double height = dark_ ? white_ - ground : ground;
  return std::min(kOfContrast * typical_.contrast, kOfTop * typical_.top - height);
}

double MarkerLevels::needed(int tile) const {
  const double height = level_[static_cast<std::size_t>(tile)];
  return std::max(noise_demand(tile), demand(dark_ ? white_ - height : height));
}

/// The tile's own spread does not count: it is the step.
bool MarkerLevels::is_uneven(int tile) const {
  const double ground = raw_[static_cast<std::size_t>(tile)].median;
  const double apart = std::abs(ground - level_[static_cast<std::size_t>(tile)]);
  const double required = std::max({kSigmas * noise_, minimum(), demand(dark_ ? white_ - ground : ground)});
  return std::max<double>(raw_[static_cast<std::size_t>(tile)].step, apart) > std::max(kUneven * required, kUnevenNoise * noise_);
}

void MarkerLevels::set_threshold(int tile) {
  level_[tile] = smoothed_ ? smooth_median(tile) : raw_[tile].median;
  const double top = depth_ == CV_8U ? 255 : 65535;
  const double height = level_[tile] + needed(tile);
  const double threshold = fixed_ ? *fixed_ : dark_ ? white_ - height : height;
  thresholds_.of_tile[tile] =
      static_cast<std::uint16_t>(std::clamp(dark_ ? std::ceil(threshold) : std::floor(threshold), 0.0, top));
}

/// Where nothing stands out any more markers may have become darker: less and less is asked of them.
void MarkerLevels::learn_contrast(const std::optional<TypicalMarker>& typical) {
  if (!typical) {
    typical_.contrast *= kForget;
    return;
  }
  const double fraction = typical_.contrast > 0 ? 1.0 / kFraction : 1;
  typical_.contrast += (typical->contrast - typical_.contrast) * fraction;
  typical_.top += (typical->top - typical_.top) * fraction;
}

void MarkerLevels::set_contrast(const TypicalMarker& typical) {
  typical_ = typical;
  for (int tile = 0; tile < tiles_.area(); ++tile) set_threshold(tile);
}

double MarkerLevels::background(int x, int y) const {
  const double height = level_[static_cast<std::size_t>(y / kTile) * tiles_.width + x / kTile];
  return dark_ ? white_ - height : height;
}

double MarkerLevels::typical_min_contrast() const {
  std::vector<double> all;
  for (std::size_t i = 0; i < level_.size(); ++i) {
    const double height = dark_ ? white_ - thresholds_.of_tile[i] : thresholds_.of_tile[i];
    all.push_back(std::abs(height - level_[i]));
  }
  if (all.empty()) return 0;
  return geometry::median(all);
}

double MarkerLevels::min_contrast(int x, int y) const {
  const std::size_t tile = static_cast<std::size_t>(y / kTile) * tiles_.width + x / kTile;
  return std::max(1.0, std::abs(thresholds_.of_tile[tile] - background(x, y)));
}

}  // namespace marey::detect::markers
