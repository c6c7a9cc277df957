// Whether a camera was moved while it records, and where it stands since.
//
// A camera that is pushed still sees its markers, but where the others' rays meet it has no blob any more: its share in the points
// falls from nearly all to nearly none within a frame, while it has as many blobs as before. A camera that is covered has none; a
// marker that is hidden costs one point. From some frames after the fall the motion is found: every blob proposes, with every point
// near it, a shift of the whole image; the shift that most agree on pairs points and blobs; the pose that explains the pairs best
// (Gauss and Newton's method, Huber's weights) pairs them again, ever more narrowly. It is trusted where it explains as large a
// share of the points as the camera had before.
// Assumes that the lens stayed as it is, and that one camera is moved at a time. Cost: points × cameras a frame; the search is
// points × blobs × frames, once.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/reconstruct/correspond.h"

namespace marey::reconstruct {

/// A camera stands elsewhere than before.
struct MovedCamera {
  CameraId camera{};
  Timestamp since{};         ///< when its blobs ceased to fit
  Rigid3 camera_from_world;  ///< from then on, m
  double angle = 0;          ///< that it was turned by, rad
  double distance = 0;       ///< and moved by, m
  double rms_px = 0;         ///< 2-D distance of blobs and points that the new pose rests on, root mean square
  int pairs = 0;             ///< of these
};

class CameraWatch {
 public:
  /// `ids[i]` is the CameraId of cameras[i].
  CameraWatch(std::vector<Camera> cameras, std::vector<CameraId> ids);

  /// Takes in one instant's observations and the points found in it; `noise_px` as the corresponder has it. Says that a
  /// camera was moved as soon as its new place is known; from then on cameras() has it there.
  std::optional<MovedCamera> observe_frame(Timestamp now, std::span<const Observation<2>> detected, const Correspondences& found,
                                           double noise_px);

  const std::vector<Camera>& cameras() const { return cameras_; }

 private:
  /// Of one camera at one instant: points by the other cameras, m, and its own blobs, px.
  struct View {
    std::vector<Vector<3>> points;
    std::vector<Vector<2>> blobs;
  };
  struct Watched {
    CameraId id{};
    double typical = 0;       // share of the points in its image that it has a ray in
    int frames = 0;           // that `usual` is a mean of
    Timestamp since{};        // when that fell
    std::vector<View> views;  // since then
  };
  struct Pair {
    Vector<3> point;
    Vector<2> blob;
  };

  double fraction_of(std::size_t camera, const Correspondences& found, View& view) const;
  std::optional<MovedCamera> find(std::size_t camera, double noise_px);
  std::optional<Vector<2>> common_shift(std::size_t camera) const;
  static std::vector<Pair> pairs_of(const Watched& watched, const Camera& camera, const Vector<2>& shift, double within);

  std::vector<Camera> cameras_;
  std::vector<Watched> watched_;
  View view_;
  std::vector<CameraMask> observed_by_;  // by point
};

}  // namespace marey::reconstruct
