#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "marey/core/labelled_box.h"
#include "marey/files/limits.h"

namespace marey::evaluate {

/// CLEAR-MOT (Bernardin & Stiefelhagen 2008), as py-motmetrics counts. Each frame keeps the last match of an object while it
/// still overlaps enough, and matches the rest for the most pairs and the least total distance 1 − IoU.
struct ClearScores {
  std::int64_t matches = 0;          ///< true boxes found, switches among them
  std::int64_t false_positives = 0;  ///< FP: reported boxes on nothing
  std::int64_t misses = 0;           ///< FN: true boxes not found
  std::int64_t switches = 0;         ///< IDSW: an object's match is another track than its last one
  std::int64_t fragmentations = 0;   ///< FRAG: a followed object is lost and found again
  std::int64_t mostly_tracked = 0;   ///< objects found in at least 80 % of their frames
  std::int64_t partially_tracked = 0;
  std::int64_t mostly_lost = 0;     ///< objects found in less than 20 % of their frames
  std::optional<double> mota;       ///< 1 − (FP + FN + IDSW) / true boxes; none without truth
  std::optional<double> motp;       ///< mean distance 1 − IoU of the matches; none without matches
  std::optional<double> recall;     ///< matches / true boxes
  std::optional<double> precision;  ///< matches / reported boxes
};

/// Ristani et al. 2016, as py-motmetrics counts: each object is given one track permanently, so that most boxes agree.
struct IdentityScores {
  std::int64_t true_positives = 0;
  std::int64_t false_positives = 0;
  std::int64_t false_negatives = 0;
  std::optional<double> f1, precision, recall;  ///< none where they divide by nothing
};

/// Luiten et al. 2021, as trackeval counts: means over the overlaps 0.05, 0.10, ..., 0.95 that a match must have.
struct HotaScores {
  double hota = 0;
  double detection = 0;                                      ///< DetA
  double association = 0;                                    ///< AssA
  double detection_recall = 0, detection_precision = 0;      ///< DetRe, DetPr
  double association_recall = 0, association_precision = 0;  ///< AssRe, AssPr
  double localisation = 1;                                   ///< LocA; 1 where nothing matches, as trackeval has it
};

/// Everything `marey evaluate` reports.
struct Evaluation {
  std::int64_t frames = 0;  ///< in which there is truth or track
  std::int64_t common_frames = 0;
  std::int64_t true_boxes = 0, track_boxes = 0;
  std::int64_t objects = 0, tracks = 0;  ///< different ids
  ClearScores clear;
  IdentityScores identity;
  HotaScores hota;
};

/// Evaluates tracks against the truth. Both are ordered by frame, and an id stands once a frame; `least_overlap`, in (0, 1], is the
/// IoU from which CLEAR and identity scores let a box count as found. Two passes over the boxes, frame by frame; memory grows with
/// the pairs of ids that ever overlap, not with the frames. Cost: truth × tracks of each frame, and an assignment where boxes
/// crowd. Throws Error if a frame is crowded beyond `limits`.
Evaluation evaluate(std::span<const LabelledBox> truth, std::span<const LabelledBox> tracks, double least_overlap = 0.5,
                    const Limits& limits = Limits::in_force());

}  // namespace marey::evaluate
