#include "marey/pipeline/corridor/marker_tuning.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"

namespace marey::pipeline::corridor {

detect::markers::MarkerOptions markers_of(const RigCamera& camera, detect::markers::MarkerOptions options) {
  if (!options.threshold) options.threshold = camera.threshold;
  options.masked.insert(options.masked.end(), camera.masks.begin(), camera.masks.end());
  return options;
}

void exclude_masked(std::vector<Detection>& detections, std::span<const Mask> masks) {
  std::erase_if(detections, [&](const Detection& detection) {
    return std::any_of(masks.begin(), masks.end(), [&](const Mask& mask) { return mask.contains(detection.centre); });
  });
}

MarkerTuning::Values MarkerTuning::values() const {
  const std::lock_guard lock(mutex_);
  return values_;
}

template <typename Change>
void MarkerTuning::change(const Change& change) {
  const std::lock_guard lock(mutex_);
  change(values_);
  ++version_;
}

void MarkerTuning::set_threshold(std::optional<double> threshold) {
  change([&](Values& values) { values.threshold = threshold; });
}

void MarkerTuning::mask(const Mask& part) {
  change([&](Values& values) {
    if (values.masks.size() >= kMaxMasks) throw Error("it has {} masks already; take some away first", kMaxMasks);
    values.masks.push_back(part);
  });
}

void MarkerTuning::unmask(const Mask& part) {
  change([&](Values& values) { std::erase(values.masks, part); });
}

void MarkerTuning::set_masks(std::vector<Mask> masks) {
  change([&](Values& values) { values.masks = std::move(masks); });
}

void MarkerTuning::mask_lit() {
  change([](Values& values) { values.learning = true; });
}

void MarkerTuning::learned(std::span<const cv::Rect> parts) {
  change([&](Values& values) {
    const std::size_t room = kMaxMasks - std::min(kMaxMasks, values.masks.size());
    values.masks.insert(values.masks.end(), parts.begin(),
                        parts.begin() + static_cast<std::ptrdiff_t>(std::min(room, parts.size())));
    values.learning = false;
  });
}

TunedMarkers::TunedMarkers(const detect::markers::MarkerOptions& options, std::shared_ptr<MarkerTuning> tuning)
    : options_(options), tuning_(std::move(tuning)), version_(tuning_ != nullptr ? -1 : 0), detector_(options) {}

void TunedMarkers::retune() {
  version_ = tuning_->version();  // before the values: a change in the meantime is received next time
  MarkerTuning::Values values = tuning_->values();
  detect::markers::MarkerOptions options = options_;
  options.threshold = values.threshold;
  options.masked = std::move(values.masks);
  learning_ = values.learning;
  if (learning_) options.auto_mask_s = MarkerTuning::kLitSeconds;
  detector_.change(options);
}

detect::Detections TunedMarkers::detect(const Frame& frame, std::span<const Expected> expected) {
  if (tuning_ != nullptr && version_ != tuning_->version()) retune();
  detect::Detections found = detector_.detect(frame, expected);
  if (!learning_) return found;
  if (const auto parts = detector_.learned_parts()) tuning_->learned(*parts);
  return found;
}

}  // namespace marey::pipeline::corridor
