// Names for the points of one instant, out of nothing but how far each two are from each other, and on which side.
//
// Names are given in an order in which each is as well tied to those before it as may be. A beam search keeps the best partial
// answers: each is continued by every point that is still free, and by none; what that adds is the sum over the names that are
// given already of how well the two points' distance fits (distance_model.h), and a penalty where a point lies on the wrong side of
// three that are rigid with it: distances alone do not specify a body from its mirror image, nor two markers of one wrist.
// Distances are not those of the instant alone but of all instants at which both points are there, so that what is rigid is known
// to be. At the end single names are exchanged as long as that gains. Cost: names × points × answers × names.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/learned_markers.h"
#include "marey/solve/labels/distance_model.h"

namespace marey::solve::labels {

struct LabelInitOptions {
  int answers = 400;        ///< that are kept
  double wrong_side = 12;   ///< log-likelihood that a point on the wrong side costs
  double direction = 0.35;  ///< of the distance: by how much the vector from a neighbour differs between two like postures
  double height = 0.012;    ///< m: of a marker above three others: less has no side
  // What it costs in the final check (check_names.h) that a point lies elsewhere about its neighbours than in the learned posture:
  std::size_t posture_neighbours = 8;  ///< that the posture is laid onto
  double posture = 0.2;                ///< of the distance from them: how much another posture moves a marker
  double posture_max = 6;              ///< nats that one marker costs at most
  double posture_weight = 3;           ///< times
};

/// The known data of the points of one instant.
struct InitialiseScene {
  std::vector<Vector<3>> locations;        ///< m
  std::vector<DistanceObserved> detected;  ///< of each two, as LearnedMarkers has its distances
  const DistanceObserved& between(std::size_t i, std::size_t j) const { return detected[LearnedMarkers::index_of(i, j)]; }
};

struct LabelHypothesis {
  std::vector<int> point_of;  ///< by name: the point, or assign::kNoIndex
  double score = 0;
};

/// What it costs that points lie on the wrong side of each other, for any answer to one scene. `learned`, `model` and `options`
/// must outlive it.
class SideCosts {
 public:
  SideCosts(InitialiseScene scene, const LearnedMarkers& learned, const DistanceModel& model, const LabelInitOptions& options);
  ~SideCosts();
  SideCosts(SideCosts&&) noexcept;

  /// Of the sides that a name has a part in; 0 if it has no point. `point_of`: by name, or assign::kNoIndex.
  double of(const std::vector<int>& point_of, std::size_t name) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// With `learned_from_scene`, where the subject's posture is about the one it was learned in: the turn from one's axes to the
/// other's. Then it counts too in which direction markers lie from their neighbours.
LabelHypothesis initialise_labels(const InitialiseScene& scene, const LearnedMarkers& learned, const DistanceModel& model,
                                  const LabelInitOptions& options = {}, const std::optional<Matrix<3>>& learned_from_scene = {});

}  // namespace marey::solve::labels
