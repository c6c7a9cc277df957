// Which blobs are the same marker, and where it is.
//
// (1) Claim: the predictions of a tracker come first. Each is projected into every camera and takes the blob that fits best within
// its own uncertainty, one to one; a wrong ray shows in the triangulation and is omitted; cameras that gave nothing are then asked
// again about the place itself, which is known far better than the prediction.
// (2) Meet: the rest is matched by rays, camera pair by camera pair, the pairs that give depth best first. Two rays that lie in
// one epipolar plane propose a point, and every other camera is asked for a blob there. Groups of four rays and more that fit are
// taken at once, the largest first, so that later pairs have little left to do; groups of three wait until all pairs have been
// seen, because three rays also meet by chance, and then the best fit wins.
// (3) Two rays meet by chance so often that they are trusted only where each is the other's only partner among the rest;
// they are reported apart.
//
// Assumes that blobs are accurate to a fraction of the distance between them. Cost: near linear in blobs while most have one
// partner; camera pairs add one pass over what is unexplained. References: Maas, "Complexity analysis for the establishment of
// image correspondences of dense spatial target fields", 1992 (rays of three cameras and more); Hartley & Zisserman, 2004.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/observation.h"
#include "marey/core/track.h"
#include "marey/reconstruct/triangulate.h"

namespace marey::reconstruct {

struct CorrespondOptions {
  double noise_px = 0.1;  ///< standard deviation of calibration and of what blobs do not specify of themselves, along each axis
  double sigmas = 4;      ///< how far from each other, in standard deviations, rays may pass that are taken for partners
  int min_rays = 3;       ///< of a new point; 2: every pair of rays without another choice counts as one
  TriangulateOptions triangulate = {};
  std::optional<std::size_t> max_observations = {};  ///< of all cameras at one instant; nothing: the limit in force
};

/// A marker's place at one instant.
struct Located {
  SpacePoint point;               ///< `used` counts the rays in `seen`
  std::span<const int> detected;  ///< indices of the observations behind it, by camera; all of them count
  std::optional<int> expected;    ///< index of the prediction that it matched; nothing: it was found by rays alone

  bool by_two_rays() const { return point.rays == 2; }
};

/// Valid until the next call.
struct Correspondences {
  std::vector<Located> points;                 ///< matched ones in the order of predictions, then new ones of three rays and more
  std::vector<Located> by_two_rays;            ///< new ones of two rays, each the other's only choice
  std::vector<std::optional<NoPoint>> missed;  ///< by prediction: why it has no point, where it has none
  int unexplained = 0;                         ///< observations that are part of no point: ghosts, and markers that one camera sees
};

class Corresponder {
 public:
  /// `ids[i]` is the CameraId of cameras[i], so that a rig may have others whose calibration is not known; empty: i. Observations
  /// of other cameras are omitted. Throws Error if there are fewer than two or more than 64.
  explicit Corresponder(std::vector<Camera> cameras, const CorrespondOptions& options = {}, std::vector<CameraId> ids = {});
  ~Corresponder();
  Corresponder(Corresponder&&) noexcept;
  Corresponder& operator=(Corresponder&&) noexcept;

  /// Points from what all cameras saw at one instant (px; `camera` and `covariance` count) and where a tracker expects its targets
  /// then (m). Observations that are not finite are omitted. Deterministic; allocates only where a frame is larger than all
  /// before. Throws Error if there are more than `max_observations`.
  const Correspondences& match(std::span<const Observation<2>> detected, std::span<const Track<3>> expected = {});

  /// From the next call on.
  void set_noise(double px);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::reconstruct
