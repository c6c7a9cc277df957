// A person's keypoints in space as OpenCap's marker augmenter takes them: 18 points of both sides at 60 Hz, over the parts of a
// recording in which all of them are known.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/recording.h"

namespace marey::pipeline::keypoints {

/// Of each side; arms come last.
inline constexpr std::array<std::string_view, 9> kAugmenterPoints = {"shoulder",  "hip",     "knee",  "ankle", "heel",
                                                                     "small_toe", "big_toe", "elbow", "wrist"};
inline constexpr std::size_t kLegPoints = 7;     ///< that many of them are not of arms, by definition
inline constexpr double kAugmenterRate_hz = 60;  ///< physical: of the recordings that its networks learned from

/// What the point of a side is at one step: index 2 · point + side, the right side first.
struct AugmenterStep {
  std::array<Vector<3>, 2 * kAugmenterPoints.size()> position;    ///< m, z up
  std::array<Matrix<3>, 2 * kAugmenterPoints.size()> covariance;  ///< m²; 0 where the recording has none
};

/// Instants one after the other at which all points are known, and the same at even steps.
struct AugmenterRun {
  std::size_t first = 0, last = 0;  ///< of the recording's instants
  double begin_s = 0;               ///< the recording's time of the first step
  std::vector<AugmenterStep> steps;
  std::vector<Vector<3>> hips;  ///< their middle at each instant
};

struct AugmenterInput {
  std::vector<AugmenterRun> runs;
  bool arms = true;                  ///< elbows and wrists are among the points
  bool covariances = true;           ///< of all points
  bool small_toes = true;            ///< recorded; otherwise placed on the foot, as OpenPose's lie to heel and big toe
  std::size_t instants = 0;          ///< in all runs
  std::vector<std::string> missing;  ///< points without which nothing can be made: never seen
};

/// The middle of the hips.
Vector<3> hips_of(const AugmenterStep& step);

/// Where a recording has the hips.
enum class HipPoints { as_networks, joint_centres };

/// `person`: what stands before the labels of the one of several people ("P2:"). Labels are known as any program calls the points.
/// BlazePose's hips are put where the others' are, and joints' centres where OpenPose has hips. Runs of fewer than `min_steps`
/// steps are omitted.
AugmenterInput augmenter_input(const Recording& recording, const std::string& person, HipPoints hips, std::size_t min_steps);

/// The people who have the points of legs, by what stands before their labels.
std::vector<std::string> people_to_augment(const std::vector<TrackName>& tracks);

}  // namespace marey::pipeline::keypoints
