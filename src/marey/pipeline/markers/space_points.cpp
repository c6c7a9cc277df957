#include "marey/pipeline/markers/space_points.h"

#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace marey::pipeline::markers {

SpacePoints::SpacePoints(const Rig& rig, const reconstruct::CorrespondOptions& options, std::optional<double> noise_px)
    : options_(options), noise_(noise_px) {
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const std::string& name = names_.emplace_back(rig.cameras[i].name);
    if (const auto camera = rig.cameras[i].camera()) {
      ids_.push_back(CameraId{static_cast<int>(i)});
      cameras.push_back(*camera);
    } else {
      warnings_.push_back(fmt::format("camera \"{}\" has no calibration and is omitted", name));
    }
  }
  watch_.emplace(cameras, ids_);
  corresponder_.emplace(std::move(cameras), options_for(ids_.size()), ids_);
}

reconstruct::CorrespondOptions SpacePoints::options_for(std::size_t cameras) const {
  reconstruct::CorrespondOptions options = options_;
  options.noise_px = noise_.px();
  if (cameras == 2) options.min_rays = 2;
  return options;
}

std::optional<std::vector<std::optional<Camera>>> SpacePoints::apply_moves() {
  if (!moved_) return std::nullopt;
  moved_.reset();
  corresponder_.emplace(watch_->cameras(), options_for(ids_.size()), ids_);
  std::vector<std::optional<Camera>> cameras(names_.size());
  for (std::size_t i = 0; i < ids_.size(); ++i) cameras[static_cast<std::size_t>(number(ids_[i]))] = watch_->cameras()[i];
  return cameras;
}

const reconstruct::Correspondences& SpacePoints::find(Timestamp now, std::span<const Observation<2>> blobs,
                                                      std::span<const Track<3>> expected) {
  const reconstruct::Correspondences* found = &corresponder_->match(blobs, expected);
  if (noise_.learn(*found)) {
    corresponder_->set_noise(noise_.px());
    if (counts_.instants == 0) found = &corresponder_->match(blobs, expected);
  }
  moved_ = watch_->observe_frame(now, blobs, *found, noise_.px());
  if (moved_) warn_of(*moved_);
  count(blobs, *found);
  return *found;
}

void SpacePoints::count(std::span<const Observation<2>> blobs, const reconstruct::Correspondences& found) {
  ++counts_.instants;
  counts_.observations += std::ssize(blobs);
  counts_.unexplained += found.unexplained;
  counts_.by_two_rays += std::ssize(found.by_two_rays);
  for (const auto& reason : found.missed) {
    if (reason) ++counts_.missed[*reason];
  }
}

void SpacePoints::warn_of(const reconstruct::MovedCamera& moved) {
  warnings_.push_back(fmt::format(
      "camera \"{}\" was moved at {:.2f} s, by {:.2f}° and {:.0f} mm; its new place was found ({} blobs within {:.2f} px) and "
      "counts from then on: calibrate the rig again",
      names_[static_cast<std::size_t>(number(moved.camera))], seconds(moved.since), moved.angle * 180 / std::numbers::pi,
      1000 * moved.distance, moved.pairs, moved.rms_px));
}

void SpacePoints::report(corridor::Summary& summary) const {
  corridor::SpacePointFigures& figures = summary.points.emplace();
  figures.noise_px = noise_.px();
  figures.observations = counts_.observations, figures.unexplained = counts_.unexplained;
  figures.two_ray_points = counts_.by_two_rays;
  for (const auto& [reason, count] : counts_.missed) figures.not_located[reason] = count;
}

}  // namespace marey::pipeline::markers
