// When cameras over one ground were started, from the people that they see.
//
// Each camera follows people by itself; the paths of one person, seen by two cameras, agree when the clocks do. Two seconds of a
// path from one camera are compared with every path from the other, its time shifted: as one person's (both apart by something
// systematic, half a metre that barely changes, and by noise) against as two people's (anywhere, moving anyhow). The logarithms of
// the ratios, those against cut off, add up to a score for the shift. A shift moves who runs straight along like the systematic
// part, so turns, starts and stops carry the answer, and people who run in different directions.
//   coarse  the score at every tenth of a second,
//   fine    from its best peaks, least squares over the pairs that agree: the shift, what is systematic of all and of each pair,
//   chain   cameras are joined to one clock, those first that see most in common; pairs that are joined already only help to put
//           all offsets right together.
// Assumes people's paths to be right for a second or two (numbers may change in between), and cameras to place them within a metre.
// Cost: shifts × paths × people at once, some ten nanoseconds each: less than 0.3 s for six cameras, 25 people and half a minute.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::calibrate::pitch {

/// Where one camera saw one person, in the order of time.
struct GroundPath {
  struct Sample {
    double time_s = 0;  ///< by the camera's own clock
    Vector<2> location = Vector<2>::Zero();
    Matrix<2> covariance = Matrix<2>::Identity();  ///< m²
  };
  std::vector<Sample> samples;
};

struct GroundOffsetOptions {
  double max_offset_s = 60;       ///< how far cameras are unsynchronised
  double systematic_m = 0.5;      ///< standard deviation of what stays different between two cameras' places of one person
  double min_common_s = 3;        ///< that two recordings must have in common, in seconds
  double min_score = 8;           ///< nats by which a shift must be better than all that are not beside it
  double max_deviation_s = 0.15;  ///< a shift less sure than this is not taken for found
};

enum class OffsetVerdict { found, no_overlap, no_motion, ambiguous };

/// "found", "no overlap", "no person moves", "ambiguous".
std::string_view offset_verdict_name(OffsetVerdict verdict);

struct GroundOffset {
  OffsetVerdict verdict = OffsetVerdict::no_overlap;
  double offset_s = 0;     ///< added to the camera's times gives the first camera's; only where found
  double deviation_s = 0;  ///< standard deviation
  double gain = 0;         ///< nats by which it explains the paths better than the offset that was assumed
};

/// Whether the result speaks against an offset: by several deviations, more than a hundredth of a second or two, and by how
/// well people's paths are explained.
bool contradicts(const GroundOffset& found, double assumed_s, const GroundOffsetOptions& options = {});

/// The offset of every camera to the first, whose own is 0 and found. `assumed`: the offsets that `gain` compares with, s. Cameras
/// need not all overlap with the first: any chain will do.
std::vector<GroundOffset> find_ground_offsets(std::span<const std::vector<GroundPath>> cameras, std::span<const double> assumed,
                                              const GroundOffsetOptions& options = {});

}  // namespace marey::calibrate::pitch
