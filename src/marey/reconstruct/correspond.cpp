#include "marey/reconstruct/correspond.h"

#include "marey/core/error.h"
#include "marey/files/limits.h"
#include "marey/reconstruct/frame_rays.h"
#include "marey/reconstruct/ray_groups.h"
#include "marey/reconstruct/ray_intersections.h"
#include "marey/reconstruct/track_matches.h"

namespace marey::reconstruct {

class Corresponder::Impl {
 public:
  Impl(std::vector<Camera> cameras, const CorrespondOptions& options, std::span<const CameraId> ids)
      : options_(options),
        triangulator_(options.triangulate),
        frame_(std::move(cameras), ids),
        track_matches_(options.sigmas, triangulator_),
        intersections_(frame_.all_cameras(), options.sigmas, triangulator_) {}

  const Correspondences& match(std::span<const Observation<2>> detected, std::span<const Track<3>> expected) {
    const std::size_t maximum = options_.max_observations.value_or(Limits::in_force().observations);
    if (detected.size() > maximum) {
      throw Error(
          "the cameras see {} blobs at one instant; at most {} are matched (the limit observations): is the threshold too low?",
          detected.size(), maximum);
    }
    frame_.build(detected, options_.noise_px);
    groups_.clear(frame_);
    track_matches_.match(frame_, expected, groups_, result_.missed);
    intersections_.find(frame_, groups_);
    const auto sure = groups_.groups().size();
    intersections_.find_pairs(frame_, groups_);
    report(detected.size(), options_.min_rays > 2 ? sure : groups_.groups().size());
    return result_;
  }

  void set_noise(double px) { options_.noise_px = px; }

 private:
  /// Groups from `sure` on are reported apart.
  void report(std::size_t observations, std::size_t sure) {
    detected_.clear();
    result_.points.clear();
    result_.by_two_rays.clear();
    for (const RayGroups::Group& group : groups_.groups()) {
      for (const int ray : groups_.members(group)) detected_.push_back(frame_.observation(ray));
    }
    std::size_t begin = 0, index = 0;
    for (const RayGroups::Group& group : groups_.groups()) {
      const std::span<const int> detected = std::span(detected_).subspan(begin, static_cast<std::size_t>(group.count));
      begin += detected.size();
      (index++ < sure ? result_.points : result_.by_two_rays).push_back({group.point, detected, group.expected});
    }
    result_.unexplained = static_cast<int>(observations - detected_.size());
  }

  CorrespondOptions options_;
  Triangulator triangulator_;
  FrameRays frame_;
  TrackMatches track_matches_;
  RayIntersections intersections_;
  RayGroups groups_;
  std::vector<int> detected_;
  Correspondences result_;
};

Corresponder::Corresponder(std::vector<Camera> cameras, const CorrespondOptions& options, std::vector<CameraId> ids) {
  if (cameras.size() < 2 || cameras.size() > 64) {
    throw Error("{} calibrated {} given; a place in space takes 2 to 64", cameras.size(),
                cameras.size() == 1 ? "camera is" : "cameras are");
  }
  for (int i = 0; ids.size() < cameras.size(); ++i) ids.push_back(CameraId{i});
  impl_ = std::make_unique<Impl>(std::move(cameras), options, ids);
}
Corresponder::~Corresponder() = default;
Corresponder::Corresponder(Corresponder&&) noexcept = default;
Corresponder& Corresponder::operator=(Corresponder&&) noexcept = default;

void Corresponder::set_noise(double px) {
  impl_->set_noise(px);
}

const Correspondences& Corresponder::match(std::span<const Observation<2>> detected, std::span<const Track<3>> expected) {
  return impl_->match(detected, expected);
}

}  // namespace marey::reconstruct
