// One body, one track: tracklets that show the same person at the same time are made one, over the whole recording.
//
// Cameras that disagree about where a person stands, or a box that comes a metre beside where it was expected, let a second track
// begin beside the first; from then on each is fed now and then, by one camera or the other. While it happens that looks like two
// who run close together (ground_duplicates.h merges what can be reported at once); from the whole of it it is distinguished by
// what two people cannot do: be beside each other from the first to the last instant that both tracks are there, one of them
// beginning there and one ending, without any camera ever seeing both in one frame, though it sees the one or the other again and
// again. Two people who hide each other are seen apart by a person before or after, or are of other colours. How far two may be
// apart is reported by the observations, not by a filter's output: errors of one camera persist, and do not average out. Cost:
// for each pair of tracklets that overlap the samples of the overlap, where they are near at its ends.
#pragma once

#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground::offline {

struct GroundDoubleOptions {
  double farthest = 2;        ///< m; what lies farther apart is never one person
  double disagreement = 0.5;  ///< m, by which cameras disagree about a place permanently: standard deviation per axis
  double near = 0.6;          ///< share of the overlap in which both may be at one place
  double both = 0.05;         ///< share of observations of either in which one camera may see both: a body that was split in two
  double shortest = 0.2;      ///< s; a shorter overlap is the end of one track beside the beginning of another (ground_cut.h)
  int appearances = 5;        ///< at either of them, within the overlap, at least
  double colours = 20;        ///< as perceived, by which the clothes of one person may differ from camera to camera
};

/// `tracklets` of which those that show one body are one: with all that was seen of it, at each instant the mean by covariances.
/// `times` by instant. Order is kept; a tracklet that is merged is where the earlier of the list was.
std::vector<GroundTracklet> merge_doubles(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times,
                                          const GroundDoubleOptions& options = {});

}  // namespace marey::track::ground::offline
