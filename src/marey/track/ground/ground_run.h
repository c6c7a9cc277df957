// Following people over a whole recording: the models learned from its beginning serve all of it.
//
// How cameras disagree (camera_bias.h) and how people move (motion_statistics.h) differ from rig to rig and from square to pitch.
// Until there is enough to learn from, or the recording ends, instants are kept and a quick tracker goes ahead, for who asks where
// people are expected; then the stored instants are tracked again by the requested tracker, corrected by the learned models, and
// so on to the end. Memory: 200 bytes per stored observation; later what the tracker has not decided yet, and 48 bytes a
// person and instant.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "marey/track/ground/camera_bias.h"
#include "marey/track/ground/ground_contradictions.h"
#include "marey/track/ground/ground_instant.h"
#include "marey/track/ground/ground_tracker.h"
#include "marey/track/ground/offline/ground_recorder.h"

namespace marey::track::ground {

struct GroundLearnOptions {
  bool agreement = true;  ///< of cameras
  bool walk = true;       ///< how people move: else the tracker's filter and the join's motion stay as they are
  bool teams = true;      ///< what two teams wear, where people wear two shirts
  /// Whether people are distinguished by gnn where that is enough: cameras agree, and instants follow each other closely. Else the
  /// association that was asked for is taken.
  bool association = false;
  std::size_t max_observations = 400'000;  ///< that are kept to learn from
};

class GroundRun {
 public:
  /// Called once an instant, in order, with its observations and their tracks.
  using OnDecided = std::function<void(const GroundInstant&, std::span<const ObservationMatch>)>;

  GroundRun(const GroundTrackerOptions& tracker, const offline::GroundJoinOptions& join, const GroundLearnOptions& learn,
            std::shared_ptr<const GroundViews> views, OnDecided on_decided);

  /// As Tracker::expected.
  std::span<const Track<2>> expected(Timestamp now) { return tracker_->expected(now); }
  /// The next instant; frames grow.
  void step(std::int32_t frame, Timestamp now, std::span<const CameraObservations> views);
  /// Every person, once all was seen. Nothing may follow.
  offline::GroundRecorder::Joined finish(const offline::InSight& in_sight);
  /// Cameras that could be compared, once there was enough to learn from them; none where agreement is not learned.
  const std::vector<ComparedCameras>& compared() const { return compared_; }

 private:
  bool learning() const { return !learned_; }
  void learn();
  void learn_motion();
  bool is_plain() const;
  void run_tracker(const GroundInstant& instant);
  void record(std::span<const GroundDecision> decisions);
  void correct(GroundInstant& instant) const;

  GroundTrackerOptions options_;
  offline::GroundJoinOptions join_;
  GroundLearnOptions learn_;
  std::shared_ptr<const GroundViews> views_;
  OnDecided on_decided_;
  std::unique_ptr<GroundTracker> tracker_;
  CameraBias agreement_;
  std::vector<ComparedCameras> compared_;
  bool learned_ = false;
  std::size_t kept_observations_ = 0;
  std::deque<GroundInstant> kept_;  // to learn from; later those that are not decided yet
  offline::GroundRecorder recorder_;
};

}  // namespace marey::track::ground
