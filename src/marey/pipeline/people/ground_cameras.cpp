#include "marey/pipeline/people/ground_cameras.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/pipeline/people/turned_views.h"

namespace marey::pipeline::people {
namespace {

constexpr std::size_t kMaxCameras = 64;

Rig rig_as_fed(const Rig& rig, const std::vector<corridor::Feed>& feeds) {
  Rig fed = rig;
  for (std::size_t i = 0; i < feeds.size(); ++i) fed.cameras[i] = feeds[i].camera();
  return fed;
}

std::shared_ptr<GroundViews> views_of(const std::vector<corridor::Feed>& feeds, const Rig& rig, const TurningCameras& all) {
  std::vector<GroundView> first;
  for (std::size_t i = 0; i < feeds.size(); ++i) {
    const auto turning = turning_of(all, feeds[i].id());
    first.push_back(turning ? first_view(rig.cameras[i], *turning, rig.ground) : ground_view_of(rig.cameras[i], rig.ground));
  }
  auto views = ground_views(std::move(first));
  for (std::size_t i = 0; i < feeds.size(); ++i) {
    if (const auto turning = turning_of(all, feeds[i].id()))
      enter_turns(*views, feeds[i].id(), rig.cameras[i], *turning, rig.ground);
  }
  return views;
}

}  // namespace

GroundCameras::GroundCameras(const std::vector<corridor::Feed>& feeds, const Rig& rig, const reconstruct::GroundArea& area,
                             const PeopleOnGroundOptions& options)
    : rig_(rig_as_fed(rig, feeds)), all_(feeds.size()) {
  if (feeds.empty()) throw Error("{}", "the rig has no camera");
  if (feeds.size() > kMaxCameras) throw Error("the rig has {} cameras; {} is the most", feeds.size(), kMaxCameras);
  views_ = views_of(feeds, rig_, options.turning);
  std::vector<std::optional<GroundCamera>> opened(feeds.size());
  tbb::parallel_for(std::size_t{0}, feeds.size(), [&](std::size_t i) {
    const GroundCameraOptions how{.detector = options.detector,
                                  .prime = !options.live,
                                  .steadied = options.steady,
                                  .turning = turning_of(options.turning, feeds[i].id()),
                                  .without = i < options.without.size() ? options.without[i] : nullptr,
                                  .ball = options.ball ? std::optional(options.ball->detector) : std::nullopt};
    opened[i].emplace(feeds[i], views_, area, how);
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

track::ball::BallMoment GroundCameras::ball_candidates(const FrameSet& frames) const {
  track::ball::BallMoment candidates;
  candidates.index = frames.index;
  candidates.time = frames.time;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (frames.cameras[i] && cameras_[i].ball()) candidates.views.push_back(*cameras_[i].ball());
  }
  return candidates;
}

bool GroundCameras::search_ball() const {
  return std::any_of(cameras_.begin(), cameras_.end(), [](const GroundCamera& camera) { return camera.ball().has_value(); });
}

bool GroundCameras::in_view(const Vector<2>& position, Timestamp time, const reconstruct::GroundArea& area) const {
  if (!area.holds(position)) return false;
  return std::any_of(cameras_.begin(), cameras_.end(), [&](const GroundCamera& camera) {
    const GroundView& view = camera.view_at(time);
    const auto pixel = view.pixel(position);
    return pixel && cv::Rect2d({-0.5, -0.5}, cv::Size2d(view.size())).contains({pixel->x(), pixel->y()});
  });
}

std::vector<std::shared_ptr<StandingPeople>> GroundCameras::standing() const {
  std::vector<std::shared_ptr<StandingPeople>> all;
  for (const GroundCamera& camera : cameras_) all.push_back(camera.standing());
  return all;
}

std::vector<std::string> GroundCameras::news() {
  std::vector<std::string> all;
  for (GroundCamera& camera : cameras_) {
    for (std::string& sentence : camera.news()) all.push_back(std::move(sentence));
  }
  return all;
}

void GroundCameras::report(corridor::Summary& summary) const {
  for (const GroundCamera& camera : cameras_) camera.report(summary);
}

}  // namespace marey::pipeline::people
