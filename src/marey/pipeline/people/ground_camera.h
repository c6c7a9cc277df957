// One camera of several that look at one ground: where people are expected in its picture, who is found there, where they stand.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/ground_views.h"
#include "marey/core/turning_camera.h"
#include "marey/detect/detectors.h"
#include "marey/detect/people/people_size.h"
#include "marey/pipeline/corridor/beside.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/people/ball_in_view.h"
#include "marey/pipeline/people/standing_people.h"
#include "marey/pipeline/people/view_doubts.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::pipeline::people {

struct GroundCameraOptions {
  detect::DetectorOptions detector = detect::people::PeopleDetectorOptions{};
  bool prime = true;      ///< look at pictures of the beginning first, to learn the empty scene; a live camera cannot
  bool steadied = false;  ///< its pictures were brought to its rest
  std::shared_ptr<const TurningCamera> turning = {};           ///< how it turns; nothing where it stands
  std::shared_ptr<const StandingPeople> without = {};          ///< who is not to be taken for a part of the scene
  std::optional<detect::ball::BallDetectorOptions> ball = {};  ///< the ball is looked for, where the camera has pictures and stands
};

/// How a camera sees the ground at the beginning. Throws Error, with the camera's name, where that is not known.
GroundView ground_view_of(const RigCamera& camera, const geometry::GroundSurface& ground);

class GroundCamera {
 public:
  /// `views`: of all cameras of the rig, this one's among them. Of the feed's pictures only the part is looked at in which people
  /// may be who count. Throws Error where a camera that turns has pictures and its detector needs one that stands.
  GroundCamera(const corridor::Feed& feed, std::shared_ptr<const GroundViews> views, const reconstruct::GroundArea& area,
               const GroundCameraOptions& options);
  ~GroundCamera();
  GroundCamera(GroundCamera&&) noexcept;

  /// How it sees the ground at this time, by the rig's clock.
  const GroundView& view_at(Timestamp time) const { return views_->view_at(id_, time); }

  /// Finds people where `expected` are (m, world), or takes what another program found, and places them. Valid until the next call.
  track::ground::CameraObservations observe(const CameraFrame& given, std::span<const Track<2>> expected);

  /// What of the last frame may be the ball; nothing where it is not looked for.
  std::optional<track::ball::BallView> ball() const { return ball_ ? ball_->candidates() : std::nullopt; }

  /// The box of a person at `ground` (m, world) in the camera's picture, px; nothing where that is not known.
  std::optional<Box> box_at(const Vector<2>& ground, Timestamp time) const;

  /// Who was taken for a part of the scene and has left it; nothing where there is no model of it.
  const std::shared_ptr<StandingPeople>& standing() const { return standing_; }

  /// What the frames since the last call showed of a camera that ought to stand, one sentence each.
  std::vector<std::string> news();
  /// Puts in what was looked at, found and left out.
  void report(corridor::Summary& summary) const;
  std::int64_t frames() const { return frames_; }

 private:
  cv::Point corner() const { return part_ ? part_->tl() : cv::Point(); }
  Picture looked_at(const Picture& picture) const { return part_ ? picture.part(*part_) : picture; }
  detect::Detections detect(const Frame& frame, std::span<const Track<2>> expected, corridor::Beside& beside);
  void learn_sizes(const std::vector<Detection>& detections, const cv::Size& size);
  void place(const Frame& frame, detect::Detections& found);

  RigCamera camera_;
  CameraId id_;
  reconstruct::GroundArea area_;
  std::shared_ptr<const GroundViews> views_;
  std::shared_ptr<const TurningCamera> turning_;            // nothing where it stands
  std::optional<cv::Rect> part_;                            // px, that is looked at; nothing: the whole picture
  std::unique_ptr<detect::Detector> detector_;              // none where another program's detections come
  std::optional<detect::people::PersonSizeModel> learned_;  // where neither a camera nor a detector knows how tall people are
  std::optional<BallInView> ball_;
  std::shared_ptr<StandingPeople> standing_;
  std::vector<Track<2>> in_picture_;  // who is expected, in the part that is looked at
  std::vector<Expected> expected_;
  std::vector<Observation<2>> seen_;
  std::int64_t frames_ = 0, detections_ = 0, outside_ = 0;
  std::optional<ViewDoubts> view_;  // of a camera with pictures that ought to stand
};

}  // namespace marey::pipeline::people
