// Names for the markers of a whole recording, whatever its tracks are called: only where points are counts.
//
// 1. Tracks are cut into tracklets where they have gaps or jump, and tied to chains where motion leaves no doubt (tracklets.h).
// 2. At some instants with many markers, spread over the recording, names are found from distances alone (initialise_labels.h); the
//    answer that fits best is the seed.
// 3. Every chain is asked how well each name fits it over its whole life: by its distances to the markers that are named already,
//    of which the tightest count. At each instant names are then shared out so that each is given once; instants vote, and a chain
//    has the name that most gave it, as long as no other there at the same time has it. The result refines which
//    distances are expected, and the round begins again. A tracklet that fits another name much better than its chain's is cut off.
// 4. What fits badly, or barely better than another name that was free, stays without a name, and its two best names are reported.
// A set that does not fit is of another person. It is then scaled, first by the stature, then by the segments, and names are sought
// from nothing with distances as wide as another body makes them, and by what moves against what, which two people have in common
// (distance_model.h). Searches at other instants, by what was taught and scaled alone, must give the same names, or the set is left
// as it was, and does not fit; a name on which they barely agree is given to nothing.
// Cost: points × names × neighbours a round.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/learned_markers.h"
#include "marey/core/recording.h"
#include "marey/solve/labels/distance_model.h"
#include "marey/solve/labels/initialise_labels.h"
#include "marey/solve/labels/tracklets.h"

namespace marey::solve::labels {

/// How a set is scaled to another person than the one who taught it.
struct ScalingOptions {
  int passes = 2;                         ///< the second with the segments' sizes
  int instants = 40;                      ///< at which a distance is seen, or more, that a size is measured by
  double distance = 0.05;                 ///< m, or more, the same
  double rigid = 0.006;                   ///< m: deviation of a learned distance, below which it is of one segment
  double prior = 2;                       ///< distances, that a segment is as large as the whole
  double min_segment = 0.8;               ///< of the whole
  double max_segment = 1.25;              ///< of the whole
  double min_found_again = 0.955;         ///< of the names, by searches at other instants; with fewer the set does not fit
  double min_found_again_of_name = 0.75;  ///< of the searches, of one name
  double few_found = 0.7;                 ///< of the set's markers: with fewer the set may be another person's
};

struct LabelOptions {
  TrackletOptions tracklets;
  DistanceOptions distances;
  LabelInitOptions initialise;
  int initialises = 6;  ///< instants at which names are searched for from nothing
  int rounds = 4;
  std::size_t neighbours = 8;  ///< that say how well a name fits
  double min_fit = 4;          ///< log-likelihood ratio, mean over a tracklet's life, below which the name is not given
  double min_margin = 3;       ///< that the name must be better than the next one
  ScalingOptions scaling;
  bool scale_to_person = true;  ///< where a set that one person taught does not fit
};

/// How one marker of the set came off.
struct MarkerHealth {
  std::string label;
  std::int64_t detected = 0;  ///< instants with the name
  std::int64_t gaps = 0;      ///< within
  std::int64_t renamed = 0;   ///< instants at which the track had another name of the set
  std::int64_t outliers = 0;  ///< instants at which its distances to its steadiest neighbours are off by more than four deviations
};

/// A piece of a track that stays without a name.
struct Unnamed {
  TrackId track{};                   ///< in the recording that comes out
  std::int32_t first = 0, last = 0;  ///< instants
  std::string best, next;            ///< names it could have; empty if none fits at all
  double fit = 0, margin = 0;
};

struct Labelled {
  Recording recording;  ///< a track for each name, by the set's order, then what has none
  std::vector<MarkerHealth> health;
  std::vector<Unnamed> unnamed;
  double scale = 1;          ///< of the subject against the learned set
  std::int64_t renamed = 0;  ///< segments of tracks that had another name of the set before
  /// By name of the set: not 0 if the final check found an exchange with another name that fits as well. No track has such a name.
  std::vector<char> undecided;
  double misfit = 0;    ///< how far rigid distances are off, against those expected of the subject that taught: about 1
  double misfit_m = 0;  ///< the same as a median, m
  /// If the set is another person's and was scaled to this one: the share of the names that searches at other instants gave too.
  std::optional<double> found_again;
};

/// Throws Error if the recording is not one of space, or too few of the set's markers can be reported to begin with.
Labelled label_recording(const Recording& recording, const LearnedMarkers& learned, const LabelOptions& options = {},
                         const Hooks& hooks = {});

}  // namespace marey::solve::labels
