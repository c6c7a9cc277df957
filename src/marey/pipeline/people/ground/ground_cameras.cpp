#include "marey/pipeline/people/ground/ground_cameras.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/pipeline/people/ground/ptz_views.h"

namespace marey::pipeline::people::ground {

std::shared_ptr<GroundViews> views_of(const Rig& fed, const PtzCameras& ptz) {
  const auto id_of = [](std::size_t i) { return CameraId{static_cast<int>(i)}; };
  std::vector<GroundView> first;
  for (std::size_t i = 0; i < fed.cameras.size(); ++i) {
    const auto own = ptz_of(ptz, id_of(i));
    first.push_back(own ? first_view(fed.cameras[i], *own, fed.ground) : ground_view_of(fed.cameras[i], fed.ground));
  }
  auto views = ground_views(std::move(first));
  for (std::size_t i = 0; i < fed.cameras.size(); ++i) {
    if (const auto own = ptz_of(ptz, id_of(i))) enter_ptz(*views, id_of(i), fed.cameras[i], *own, fed.ground);
  }
  return views;
}

GroundCameras::GroundCameras(const std::vector<corridor::Feed>& feeds, const std::shared_ptr<GroundViews>& views,
                             const reconstruct::GroundArea& area, const PeopleOnGroundOptions& options)
    : all_(feeds.size()) {
  std::vector<std::optional<GroundCamera>> opened(feeds.size());
  tbb::parallel_for(std::size_t{0}, feeds.size(), [&](std::size_t i) {
    const GroundCameraOptions how{.detector = options.detector,
                                  .prime = !options.live,
                                  .stabilised = options.stabilise,
                                  .ptz = ptz_of(options.ptz, feeds[i].id()),
                                  .without = i < options.without.size() ? options.without[i] : nullptr,
                                  .ball = options.ball ? std::optional(options.ball->detector) : std::nullopt};
    opened[i].emplace(feeds[i], views, area, how);
  });
  for (auto& camera : opened) cameras_.push_back(std::move(*camera));
}

std::span<const track::ground::CameraObservations> GroundCameras::observe(const FrameSet& frames,
                                                                          std::span<const Track<2>> expected) {
  tbb::parallel_for(std::size_t{0}, cameras_.size(), [&](std::size_t i) {
    if (frames.cameras[i]) all_[i] = cameras_[i].observe(*frames.cameras[i], expected);
  });
  observed_.clear();
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (frames.cameras[i]) observed_.push_back(all_[i]);
  }
  return observed_;
}

track::ball::BallObservations GroundCameras::ball_candidates(const FrameSet& frames) const {
  track::ball::BallObservations candidates;
  candidates.index = frames.index;
  candidates.time = frames.time;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (!frames.cameras[i]) continue;
    if (auto view = cameras_[i].ball()) candidates.views.push_back(std::move(*view));
  }
  return candidates;
}

bool GroundCameras::search_ball() const {
  return std::any_of(cameras_.begin(), cameras_.end(), [](const GroundCamera& camera) { return camera.ball().has_value(); });
}

std::vector<std::shared_ptr<StandingPeople>> GroundCameras::standing() const {
  std::vector<std::shared_ptr<StandingPeople>> all;
  for (const GroundCamera& camera : cameras_) all.push_back(camera.standing());
  return all;
}

std::vector<std::string> GroundCameras::news() {
  std::vector<std::string> all;
  for (GroundCamera& camera : cameras_) {
    for (std::string& message_text : camera.news()) all.push_back(std::move(message_text));
  }
  return all;
}

void GroundCameras::report(corridor::Summary& summary) const {
  for (const GroundCamera& camera : cameras_) camera.report(summary);
}

}  // namespace marey::pipeline::people::ground
