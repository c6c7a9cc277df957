#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/outline.h"
#include "marey/core/time.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/body_model.h"
#include "marey/track/contour/line_search.h"
#include "marey/track/contour/motion_filter.h"
#include "marey/track/contour/shape_filter.h"

namespace marey::track::contour {

// Noise, in heights of the target (px where it says so).
inline constexpr double kSilhouetteNoise = 0.5;  // px, of a control point from a silhouette
inline constexpr double kGaitAcross = 0.012, kGaitDown = 0.008,
                        kHiddenCentre = 4;  // how the centre swings with the steps; the last: factor where a part is hidden

inline constexpr double kStrideWidth = 0.4;  // heights: physical, a body in a stride is as wide, whatever its box

inline constexpr double kMaxMissingPart = 0.12;  // heights by which an outline may be lower than its target's box

inline constexpr double kTypicalWeight = 0.35;  // of the typical coverage in a prior, the rest being the predicted outline's
inline constexpr double kAstray = 0.5;          // heights off the predicted centre, from which on the prediction is wrong

inline constexpr double kFractionMemory = 0.05;  // what a frame counts in what is typical of a target

// Doubts of a target that begins, or begins again.
inline constexpr double kBend = 0.12;            // heights each √second, of a control point against all others
inline constexpr double kGrowthAmbiguity = 0.5;  // 1/s
inline constexpr double kGrowthNoise = 2;        // 1/s, of the growth read off two outlines
inline constexpr int kHeldTooLong = 5;           // frames after which a shape that was held says little

/// px, standard deviation of a control point whose edge is not seen, of a target of that height.
inline double prior_deviation(double height) {
  return 0.05 * height;
}

/// px, standard deviation axis by axis.
struct MeasuredCentre {
  Vector<2> centre, deviation;
};

/// One target whose outline is followed.
struct ContourTarget {
  TrackId id;
  ShapeFilter shape;
  MotionFilter motion;
  double height;                                          ///< px
  double typical_area;                                    ///< px²
  double tracked_height;                                  ///< px; of the tracker's box while `typical_area` was seen
  geometry::ClosedSpline predicted;                       ///< of this frame, before anything was seen of it
  std::optional<geometry::ClosedSpline> body_shape = {};  ///< the last that filled the tracker's box; in heights, from its foot
  colour::BodyModel body = {};                            ///
  int learned = 0;                                        ///< frames that `body` was learned from
  int held = 0;                                           ///< frames since it was seen, or a part of it
  Vector<2> centre_in_box = {0, 0};                       ///< heights, from the middle of the tracker's box to the outline's centre
  double typical_fraction = 1;                            ///< of the pixels within the outline that are foreground
  double fraction = 1;
  Box box = {};
  Outline::State state = Outline::State::detected;
  colour::Footprint footprint = {};
  std::vector<MeasurementLine> lines = {};
  std::array<std::shared_ptr<Outline>, 3> slots = {};  ///< a reader may still hold one
  std::vector<TrackId> behind = {};                    ///< targets that hide a part of it in this frame
  std::vector<int> hidden = {};                        ///< control points whose edge is not seen
  bool crowded = false;                                ///< its box meets another's
  bool knotted = false;                                ///< what the lines made of it was no outline
  std::optional<MeasuredCentre> measured = {};         ///< in this frame, for the motion filter
};

}  // namespace marey::track::contour
