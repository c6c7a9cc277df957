#include "marey/evaluate/evaluation.h"

#include <algorithm>
#include <cassert>

#include "marey/evaluate/evaluate_tracks.h"

namespace marey::evaluate {
namespace {

[[maybe_unused]] bool boxes_by_frame(const LabelledBox& a, const LabelledBox& b) {
  return a.frame < b.frame;
}

/// Intersection over union to the last bit as the reference implementations have it: areas from corners, which differ from
/// width × height by a rounding, and a draw with the threshold is decided by it.
double overlap(const Box& a, const Box& b) {
  const double width = std::min(a.right(), b.right()) - std::max(a.left, b.left);
  const double height = std::min(a.bottom(), b.bottom()) - std::max(a.top, b.top);
  if (!(width > 0 && height > 0)) return 0;
  const double shared = width * height;
  const double area_a = (a.right() - a.left) * (a.bottom() - a.top);
  const double area_b = (b.right() - b.left) * (b.bottom() - b.top);
  return shared / (area_a + area_b - shared);
}

Closeness closeness(const LabelledBox& a, const LabelledBox& b) {
  const double iou = overlap(a.box, b.box);
  return {1 - iou, iou};
}

}  // namespace

Evaluation evaluate(std::span<const LabelledBox> truth, std::span<const LabelledBox> tracks, double least_overlap,
                    const Limits& limits) {
  assert(std::is_sorted(truth.begin(), truth.end(), boxes_by_frame) && "truth is ordered by frame");
  assert(std::is_sorted(tracks.begin(), tracks.end(), boxes_by_frame) && "tracks are ordered by frame");
  assert(least_overlap > 0 && least_overlap <= 1 && "an overlap from which a box counts as found");
  // The threshold is written as the reference has it: its rounding decides draws.
  return assess(truth, tracks, 1 - least_overlap, closeness, [](const auto&, const ClearCounter&) {}, limits).scores;
}

}  // namespace marey::evaluate
