// How a scene is learned from images of the beginning: each is brought to one of them, by corners, or by all pixels where those
// report too few; their median, in which no person walks, is the scene.
#include <algorithm>
#include <array>

#include "marey/geometry/median.h"
#include "marey/source/stabilise/reference_scene.h"

namespace marey::source::stabilise {
namespace {

constexpr int kInMedian = 15;
constexpr double kMaxSamples = 0.8;  // of the samples: with fewer by corners, all pixels are asked
constexpr std::size_t kTooFewOf = 8;
constexpr double kUnambiguouslyInSamples = 0.03;  // a few that are wrong do not matter to their median
constexpr int kInspectRounds = 3;                 // of bringing samples to their median

/// Pixel by pixel.
cv::Mat median_image(const std::vector<cv::Mat>& images) {
  cv::Mat median(images.front().size(), CV_8UC1);
  std::vector<std::uint8_t> levels(images.size());
  for (int y = 0; y < median.rows; ++y) {
    for (int x = 0; x < median.cols; ++x) {
      for (std::size_t i = 0; i < images.size(); ++i) levels[i] = images[i].at<std::uint8_t>(y, x);
      median.at<std::uint8_t>(y, x) = geometry::median(levels);
    }
  }
  return median;
}

}  // namespace

/// How many of the samples show what one of them does: those then have places and motions against it.
std::size_t ReferenceScene::begin_with(std::vector<Sampled>& samples, std::size_t anchor) {
  corners_.clear();
  if (!take_corners(samples[anchor].shrunk)) return 0;
  last_ = {};
  std::size_t found = 0;
  for (Sampled& sample : samples) {
    const auto pyramid = pyramid_of(sample.shrunk, false);
    auto fit = find_from(corners_.front(), pyramid, last_, &sample.locations);
    if (!fit) fit = find_anywhere(sample.shrunk, pyramid);
    sample.motion = fit ? std::optional(fit->motion) : std::nullopt;
    if (!fit) continue;
    last_ = fit->motion;
    ++found;
  }
  return found;
}

/// The same by all pixels: against one sample first, then against the median of those that were found, in which less moves.
std::size_t ReferenceScene::begin_with_all_pixels(std::vector<Sampled>& samples, std::size_t anchor) {
  std::vector<SceneAppearance> appearances;
  for (const Sampled& sample : samples) appearances.emplace_back(sample.shrunk);
  SceneAppearance scene = appearances[anchor];
  std::size_t found = 0;
  for (int round = 0; round < kInspectRounds && scene.can_be_found(); ++round) {
    found = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto at = scene.find(appearances[i], view_, options_.farthest * size_.width, kUnambiguouslyInSamples);
      samples[i].locations.clear();
      samples[i].motion = at ? std::optional(at->motion) : std::nullopt;
      found += at ? 1 : 0;
      if (i >= kTooFewOf && found * kTooFewOf < i) return 0;  // another scene: no need to ask all of them
    }
    if (3 * found < samples.size() + 2) return found;
    scene = SceneAppearance(laid_over(samples, {}));
  }
  return found;
}

/// The median of samples as the camera at `rest` would have taken them.
cv::Mat ReferenceScene::laid_over(const std::vector<Sampled>& samples, const SceneMotion& rest) const {
  std::vector<cv::Mat> back;
  std::vector<const Sampled*> found;
  for (const Sampled& sample : samples) {
    if (sample.motion) found.push_back(&sample);
  }
  const std::size_t step = (found.size() + kInMedian - 1) / kInMedian;
  for (std::size_t i = 0; i < found.size(); i += step) back.push_back(at_rest(found[i]->shrunk, against(*found[i]->motion, rest)));
  return median_image(back);
}

/// By corners; if those report too few samples, by all pixels if they report more. Whether a third is reported of.
bool ReferenceScene::begin(std::vector<Sampled>& samples) {
  if (samples.empty()) return false;
  std::vector<Sampled> best;
  std::size_t maximum = 0;
  const auto enough = [&] { return static_cast<double>(maximum) >= kMaxSamples * static_cast<double>(samples.size()); };
  for (const bool all_pixels : {false, true}) {
    for (std::size_t quarter = 0; quarter < 4 && !enough(); ++quarter) {
      const std::size_t anchor = quarter * (samples.size() - 1) / 3;
      const std::size_t found = all_pixels ? begin_with_all_pixels(samples, anchor) : begin_with(samples, anchor);
      if (found <= maximum) continue;
      maximum = found;
      best = samples;
    }
  }
  if (3 * maximum < samples.size() + 2) return false;  // one shows itself
  samples = std::move(best);
  return true;
}

bool ReferenceScene::learn(std::span<const Image> images) {
  std::vector<Sampled> samples;
  for (const Image& image : images) {
    if (image.size() == image_) samples.push_back({shrunk(image), {}, {}});
  }
  if (!begin(samples)) {
    corners_.clear();
    return false;
  }
  std::erase_if(samples, [](const Sampled& sample) { return !sample.motion; });
  std::vector<std::vector<TrackedPosition>> telling;
  for (const Sampled& sample : samples) {
    if (!sample.locations.empty() && sample.motion->turn.head<2>().norm() * view_.focal >= options_.reports_focal)
      telling.push_back(sample.locations);
  }
  if (!focal_known_ && !telling.empty()) settle_focal(telling);
  if (telling.size() >= 5) focal_known_ = true;
  SceneMotion rest;
  std::array<std::vector<double>, 3> rotations;
  for (Sampled& sample : samples) {
    if (const auto again = fit_motion(sample.locations, view_, options_.agree)) sample.motion = again->motion;
    for (int axis = 0; axis < 3; ++axis) rotations[static_cast<std::size_t>(axis)].push_back(sample.motion->turn[axis]);
  }
  for (int axis = 0; axis < 3; ++axis) rest.turn[axis] = geometry::median(rotations[static_cast<std::size_t>(axis)]);
  const cv::Mat median = laid_over(samples, rest);
  corners_.clear();
  last_ = {};
  appearances_ = SceneAppearance(median);
  learned_from_several_ = true;
  return take_corners(median) || appearances_.can_be_found();
}

}  // namespace marey::source::stabilise
