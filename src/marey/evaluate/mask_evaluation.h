#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/run_mask.h"
#include "marey/evaluate/evaluation.h"
#include "marey/files/limits.h"

namespace marey::evaluate {

/// Scores of masks: those of boxes (evaluation.h) with the IoU of masks, and two of MOTS (Voigtlaender et al., CVPR 2019).
struct MaskEvaluation {
  Evaluation scores;
  std::optional<double> smotsa;  ///< (sum of the IoU of matches − FP − IDSW) / true masks; none without truth
  std::optional<double> motsp;   ///< mean IoU of the matches; none without matches
};

/// Removes the tracks' masks that match no true mask at `min_iou` and are more than half in a region that is not evaluated, as
/// TrackEval does for MOTS. All are ordered by frame; masks of a file do not overlap.
void remove_ignored(std::span<const LabelledMask> truth, std::span<const LabelledMask> ignored, double min_iou,
                    std::vector<LabelledMask>& tracks);

/// Evaluates masks against the truth, both ordered by frame, an id once per frame, all masks of a frame of one size. `min_iou`, in
/// (0, 1], is the IoU from which CLEAR and identity scores accept a match. Throws Error if a frame exceeds `limits`.
MaskEvaluation evaluate_masks(std::span<const LabelledMask> truth, std::span<const LabelledMask> tracks, double min_iou = 0.5,
                              const Limits& limits = Limits::in_force());

}  // namespace marey::evaluate
