#include "marey/evaluate/mask_evaluation.h"

#include <algorithm>

#include "marey/evaluate/evaluate_tracks.h"

namespace marey::evaluate {

void remove_ignored(std::span<const LabelledMask> truth, std::span<const LabelledMask> ignored, double min_iou,
                    std::vector<LabelledMask>& tracks) {
  const auto of_frame = [](std::span<const LabelledMask> masks, std::int32_t frame) {
    return std::ranges::equal_range(masks, frame, {}, &LabelledMask::frame);
  };
  std::erase_if(tracks, [&](const LabelledMask& track) {
    const auto regions = of_frame(ignored, track.frame);
    const bool within = std::ranges::any_of(
        regions, [&](const LabelledMask& region) { return 2 * shared_area(track.mask, region.mask) > track.mask.area(); });
    if (!within) return false;
    return std::ranges::none_of(of_frame(truth, track.frame),
                                [&](const LabelledMask& object) { return iou(object.mask, track.mask) >= min_iou; });
  });
}

MaskEvaluation evaluate_masks(std::span<const LabelledMask> truth, std::span<const LabelledMask> tracks, double min_iou,
                              const Limits& limits) {
  const auto closeness = [](const LabelledMask& a, const LabelledMask& b) {
    const double overlap = iou(a.mask, b.mask);
    return Closeness{1 - overlap, overlap};
  };
  MaskEvaluation result;
  result.scores = assess(truth, tracks, 1 - min_iou, closeness, [](const auto&, const ClearCounter&) {}, limits).scores;
  const ClearScores& clear = result.scores.clear;
  double overlaps = 0;
  if (clear.motp) {
    result.motsp = 1 - *clear.motp;
    overlaps = static_cast<double>(clear.matches) * *result.motsp;
  }
  if (result.scores.true_boxes > 0) {
    result.smotsa =
        (overlaps - static_cast<double>(clear.false_positives + clear.switches)) / static_cast<double>(result.scores.true_boxes);
  }
  return result;
}

}  // namespace marey::evaluate
