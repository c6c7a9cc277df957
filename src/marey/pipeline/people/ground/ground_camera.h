// One camera of several that face one ground: where people are expected in its image, who is found there, where they stand.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/ground_views.h"
#include "marey/core/ptz_camera.h"
#include "marey/detect/detectors.h"
#include "marey/detect/people/people_size.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/corridor/parallel_tasks.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/people/ground/ball_in_view.h"
#include "marey/pipeline/people/standing_people.h"
#include "marey/pipeline/people/view_ambiguities.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::pipeline::people::ground {

struct GroundCameraOptions {
  detect::DetectorOptions detector = detect::people::PeopleDetectorOptions{};
  bool prime = true;        ///< process images of the beginning first, to learn the empty scene; a live camera cannot
  bool stabilised = false;  ///< its images were brought to its rest
  std::shared_ptr<const PtzCamera> ptz = {};                   ///< how it turns; nothing if it stands
  std::shared_ptr<const StandingPeople> without = {};          ///< who is not to be taken for a part of the scene
  std::optional<detect::ball::BallDetectorOptions> ball = {};  ///< the ball is searched for, where the camera has images and stands
};

/// How a camera sees the ground at the beginning. Throws Error, with the camera's name, where that is not known.
GroundView ground_view_of(const RigCamera& camera, const geometry::GroundSurface& ground);

class GroundCamera {
 public:
  /// `views`: of all cameras of the rig, this one's among them. Of the feed's images only the part is inspected in which people
  /// may be who count. A PTZ camera's people are found by a network, or before the
  /// mosaic of its empty scene; throws Error if neither is possible.
  GroundCamera(const corridor::Feed& feed, std::shared_ptr<const GroundViews> views, const reconstruct::GroundArea& area,
               const GroundCameraOptions& options);
  ~GroundCamera();
  GroundCamera(GroundCamera&&) noexcept;

  /// How it sees the ground at this time, by the rig's clock.
  const GroundView& view_at(Timestamp time) const { return views_->view_at(id_, time); }

  /// Finds people where `expected` are (m, world), or takes what another program found, and places them. Valid until the next call.
  track::ground::CameraObservations observe(const CameraFrame& given, std::span<const Track<2>> expected);

  /// What of the last frame may be the ball; nothing if it is not searched for.
  std::optional<track::ball::BallView> ball() const { return ball_ ? ball_->candidates() : std::nullopt; }

  /// The box of a person at `ground` (m, world) in the camera's image, px; nothing if that is not known.
  std::optional<Box> box_at(const Vector<2>& ground, Timestamp time) const;

  /// Who was taken for a part of the scene and has left it; nothing if there is no model of it.
  const std::shared_ptr<StandingPeople>& standing() const { return standing_; }

  /// What the frames since the last call showed of a camera that ought to stand, one sentence each.
  std::vector<std::string> news();
  /// Puts in what was inspected, found and omitted.
  void report(corridor::Summary& summary) const;
  std::int64_t frames() const { return frames_; }

 private:
  cv::Point corner() const { return part_ ? part_->tl() : cv::Point(); }
  Image observed_part(const Image& image) const { return part_ ? image.part(*part_) : image; }
  detect::Detections detect(const Frame& frame, std::span<const Track<2>> expected, corridor::ParallelTasks& parallel);
  void learn_sizes(const std::vector<Detection>& detections, const cv::Size& size);
  void location(const Frame& frame, detect::Detections& found);

  RigCamera camera_;
  CameraId id_;
  reconstruct::GroundArea area_;
  std::shared_ptr<const GroundViews> views_;
  std::shared_ptr<const PtzCamera> ptz_;                    // nothing if it stands
  std::optional<cv::Rect> part_;                            // px, that is inspected; nothing: the whole image
  std::unique_ptr<detect::Detector> detector_;              // none where another program's detections come
  std::optional<detect::people::PersonSizeModel> learned_;  // where neither a camera nor a detector knows how tall people are
  std::optional<BallInView> ball_;
  std::shared_ptr<StandingPeople> standing_;
  std::vector<Track<2>> in_image_;  // who is expected, in the part that is inspected
  std::vector<Expected> expected_;
  std::vector<Observation<2>> detected_;
  std::int64_t frames_ = 0, detections_ = 0, outside_ = 0;
  std::optional<ViewAmbiguities> view_;  // of a camera with images that ought to stand
};

}  // namespace marey::pipeline::people::ground
