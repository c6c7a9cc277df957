// Where a track may have gone over from one person to another. What is cut is only offered to be joined otherwise (ground_join.h):
// where nothing fits better, the pieces join again.
//
// Clothes: a tracker that follows by motion may come out of an encounter with the wrong person. When the two wear different
// colours, the track shows it: the colour is one thing before and another after. A tracklet's colours, half a second at a time (the
// median, so that one who runs through the image does not count), are cut in two where that explains them best, as long as that
// explains them much better (binary segmentation: Scott & Knott, "A cluster analysis method for grouping means in the analysis of
// variance", Biometrics 30, 1974). A piece at either end may be of a single half second: a track that begins on the one of two who
// run side by side and continues on the other. Motion: what no person can have done (filter/human_motion.h) is taken out, and the
// track cut there, where one person cannot have gone over it: a box has slid from one to the other. Ends: where a track ends or
// begins beside another one, the other may have taken its observations. Overlaps: where cameras disagree, one person's next track
// begins in another camera an instant or two before the last one ends; no person can be joined to who was there before, so the last
// one ends earlier. Cost: linear in the samples, and in the pairs of tracklets.
#pragma once

#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground::offline {

struct GroundCutOptions {
  double shortest = 1;    ///< s; a piece whose colour is trusted lasts at least this long
  double minimum = 12;    ///< by how much the colours of two pieces differ, as perceived
  double certainly = 40;  ///< and how much better two colours explain the observations than one: twice a logarithm of likelihoods
  double deviation = 6;   ///< of one person's colour from one half second to another
  double near = 4;        ///< m, besides what is uncertain: a person nearer than this to a track's end may have taken it over
  double overlap = 0.25;  ///< s; for this long two tracks may show one person while one goes over into the other,
  double together = 1;    ///< m, besides what is uncertain: so near to each other
};

/// The same tracklets, those in which the colour changes cut there. Order is kept.
std::vector<GroundTracklet> cut_at_appearance_changes(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times,
                                                      const GroundCutOptions& options = {});

/// The same tracklets without samples in which a person does what no person can; cut there where those before and after are two
/// people.
std::vector<GroundTracklet> cut_where_impossible(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times);

/// The same tracklets; one beginning while another ends, near it and never seen by one camera with it, is there alone from then on.
std::vector<GroundTracklet> end_before_successors(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times,
                                                  const GroundCutOptions& options = {});

/// The same tracklets, cut where one of the others ends or begins nearby, but for the recording's own first and last second.
std::vector<GroundTracklet> cut_where_others_end(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times,
                                                 const GroundCutOptions& options = {});

}  // namespace marey::track::ground::offline
