#include "marey/pipeline/people/ground/ground_boxes.h"

#include "marey/pipeline/people/ground/ball_on_ground.h"

namespace marey::pipeline::people::ground {

void GroundBoxes::add_frames(const FrameSet& frames) {
  if (!enabled_) return;
  for (std::size_t i = 0; i < logs_.size(); ++i) {
    if (frames.cameras[i])
      logs_[i].add_frame(static_cast<std::int32_t>(frames.index), static_cast<std::int32_t>(frames.cameras[i]->frame.index));
  }
}

void GroundBoxes::add(const track::ground::GroundInstant& instant, std::span<const track::ground::ObservationMatch> matches) {
  if (!enabled_) return;
  for (const track::ground::ObservationMatch& match : matches) {
    const track::ground::CameraObservations& camera = instant.cameras[static_cast<std::size_t>(match.view)];
    const Observation<2>& observation = camera.detected[static_cast<std::size_t>(match.observation)];
    if (!observation.box || observation.shared) continue;
    logs_[static_cast<std::size_t>(number(camera.camera))].add_box(instant.frame, match.track, *observation.box);
  }
}

void GroundBoxes::rename(const std::function<std::optional<TrackId>(TrackId, std::int32_t)>& track_of) {
  for (track::image::ViewLog& log : logs_) log.name(track_of);
}

std::optional<Box> GroundBoxes::box_of(const Sample& sample, std::int64_t instant, Timestamp time, CameraId camera,
                                       const GroundScene& scene, const Vector<2>& position) const {
  if (const auto observed = logs_[static_cast<std::size_t>(number(camera))].box(instant, sample.track)) return observed;
  const auto whole = scene.box_at(camera, position, time);
  if (!whole) return std::nullopt;
  const cv::Size size = scene.views->view_at(camera, time).size();
  const Box visible = geometry::intersection(*whole, {0, 0, static_cast<double>(size.width), static_cast<double>(size.height)});
  if (visible.empty()) return std::nullopt;
  return visible;
}

void GroundBoxes::add_to(Instant& instant, Timestamp time, const GroundScene& scene, std::optional<TrackId> ball) const {
  for (std::size_t i = 0; i < logs_.size(); ++i) {
    const auto frame = logs_[i].frame_at(instant.index);
    if (!frame) continue;
    const CameraId camera{static_cast<int>(i)};
    const GroundView& view = scene.views->view_at(camera, time);
    for (const Sample& sample : instant.samples) {
      const Vector<2> position = scene.area.world(sample.position.head<2>());
      const bool is_ball = sample.track == ball;
      const std::optional<Box> box =
          is_ball ? ball_box(view, position, sample.position.z()) : box_of(sample, instant.index, time, camera, scene, position);
      if (!box) continue;
      instant.boxes.push_back({.camera = camera,
                               .frame = *frame,
                               .track = sample.track,
                               .box = *box,
                               .foot = is_ball ? box->centre() : view.pixel(position),
                               .detected = (sample.cameras & mask_of(camera)) != 0});
    }
  }
}

}  // namespace marey::pipeline::people::ground
