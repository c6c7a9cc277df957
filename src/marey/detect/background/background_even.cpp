// A scene is learned from what samples of a recording have in common, pixel by pixel. Where clouds pass, a lamp is switched or the
// camera shakes they have little in common, and the middle of them is a patchwork of several lights that no frame ever shows. So
// the sample of middle brightness is taken for the measure: the others are moved to its places (background_sway.h) and divided by
// the gain of their light over its own (background_light.h, background_patches.h). The one who stands in it is nowhere else, and
// the gain of the cells that he covers comes from those round them. What was evened is not trusted for its own sake: as many pixels
// as show the same thing in most samples must become more. Cost: where nothing changes, a few thousand reads a sample and one in 64
// of all pixels.
#include "marey/detect/background/background_even.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "marey/detect/background/background_light.h"
#include "marey/detect/background/background_patches.h"
#include "marey/detect/background/background_sway.h"
#include "marey/geometry/median.h"

namespace marey::detect::background {
namespace {

constexpr std::size_t kMinEvened = 6;
constexpr int kSameSample = 10;    // levels; samples this near their median show the same thing
constexpr double kBetter = 0.8;    // of the pixels that show something else: evened samples have fewer
constexpr int kComparedEvery = 8;  // px

std::size_t middle_sample(std::span<const FramePlanes> samples) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < samples.size(); ++i) order.emplace_back(cv::mean(samples[i].luma)[0], i);
  return geometry::median(order).second;
}

/// Over a sparse grid, the share of the samples' pixels that are not as the median of the samples is there.
double disagreement(std::span<const FramePlanes> samples) {
  std::vector<int> levels(samples.size());
  double other = 0, all = 0;
  const cv::Size size = samples.front().luma.size();
  for (int y = kComparedEvery / 2; y < size.height; y += kComparedEvery) {
    for (int x = kComparedEvery / 2; x < size.width; x += kComparedEvery) {
      for (std::size_t i = 0; i < samples.size(); ++i) levels[i] = samples[i].luma.at<std::uint8_t>(y, x);
      const int median = geometry::median(levels);
      other += static_cast<double>(
          std::count_if(levels.begin(), levels.end(), [&](int level) { return std::abs(level - median) > kSameSample; }));
      all += static_cast<double>(levels.size());
    }
  }
  return all > 0 ? other / all : 0;
}

/// `plane` divided by the gains of a grid's cells, levels counted from `origin`.
cv::Mat divided(const cv::Mat& plane, const cv::Mat& gains, int origin) {
  ScenePlane lit(1, 1);
  lit.begin(plane);
  lit.relight(1 / gains, origin);
  return lit.image();
}

class Measure {
 public:
  Measure(const FramePlanes& planes, int black) : black_(black) {
    luma_.begin(planes.luma);
    if (planes.cb.empty()) return;
    cb_.begin(planes.cb);
    cr_.begin(planes.cr);
  }

  FramePlanes brought_to(const FramePlanes& sample) {
    FramePlanes result = sample;
    const cv::Point shift = sway_.measure(sample.luma, luma_);
    if (shift != cv::Point()) result = brought_back(sample, shift, luma_, cb_, cr_);
    if (const std::optional<LightChange> change = meter_.measure(result.luma, luma_, black_); change && change->explained) {
      relight(result, change->gains);
    }
    if (const std::optional<cv::Mat> gains = patches_.measure(result.luma, luma_, black_)) relight(result, *gains);
    return result;
  }

 private:
  void relight(FramePlanes& planes, const cv::Mat& gains) const {
    planes.luma = divided(planes.luma, gains, black_);
    if (planes.cb.empty()) return;
    planes.cb = divided(planes.cb, gains, 128);
    planes.cr = divided(planes.cr, gains, 128);
  }

  int black_;
  ScenePlane luma_{1, 1}, cb_{1, 1}, cr_{1, 1};
  SwayMeter sway_;
  LightMeter meter_;
  LightPatches patches_;
};

}  // namespace

std::optional<std::vector<FramePlanes>> evened_out(std::span<const FramePlanes> samples, int black) {
  if (samples.size() < kMinEvened) return std::nullopt;
  Measure measure(samples[middle_sample(samples)], black);
  std::vector<FramePlanes> result;
  for (const FramePlanes& sample : samples) result.push_back(measure.brought_to(sample));
  if (disagreement(result) > kBetter * disagreement(samples)) return std::nullopt;
  return result;
}

}  // namespace marey::detect::background
