#include "marey/pipeline/markers/space_blobs.h"

#include <cmath>
#include <utility>

namespace marey::pipeline::markers {
namespace {

constexpr double kMaxBlobSigma = 1;     // px; a blob whose centre is less certain would widen every gate
constexpr double kSynchronised = 0.02;  // of a frame: within it no marker moves by more than noise

std::vector<std::optional<Camera>> cameras_of(const Rig& rig) {
  std::vector<std::optional<Camera>> cameras;
  for (const RigCamera& camera : rig.cameras) cameras.push_back(camera.camera());
  return cameras;
}

}  // namespace

SpaceBlobs::SpaceBlobs(const Rig& rig, double rate_hz, bool align) : alignment_(cameras_of(rig)), rate_hz_(rate_hz), align_(align) {
  for (const RigCamera& camera : rig.cameras) calibrated_.push_back(camera.camera().has_value());
}

void SpaceBlobs::set_cameras(std::vector<std::optional<Camera>> cameras) {
  alignment_ = reconstruct::OwnTime(std::move(cameras));
}

void SpaceBlobs::collect(const FrameSet& frames, std::span<const Track<3>> expected) {
  blobs_.clear();
  sigmas_.clear();
  for (std::size_t c = 0; c < frames.cameras.size(); ++c) {
    if (!frames.cameras[c] || !calibrated_[c]) continue;
    const CameraId id{static_cast<int>(c)};
    const std::size_t first = blobs_.size();
    for (const Detection& detection : *frames.cameras[c]->detections) {
      const std::optional<double> sigma = detection.sigma();
      if (sigma && *sigma > kMaxBlobSigma) continue;
      blobs_.push_back(observation_of(detection));
      blobs_.back().camera = id;
      sigmas_.push_back(sigma);
    }
    if (!align_) continue;
    const Timestamp own = frames.cameras[c]->frame.time;
    const bool synchronised = std::abs(seconds(own - frames.time)) <= kSynchronised / rate_hz_;
    alignment_.bring(id, synchronised ? frames.time : own, frames.time, std::span(blobs_).subspan(first), expected);
  }
}

std::vector<ImageObservation> SpaceBlobs::recorded() const {
  std::vector<ImageObservation> points;
  for (std::size_t i = 0; i < blobs_.size(); ++i) {
    const Observation<2>& blob = blobs_[i];
    ImageObservation& point = points.emplace_back();
    point.camera = blob.camera;
    point.pixel = blob.value;
    point.sigma = sigmas_[i];
    if (blob.box && blob.box->area() > 0) point.area = blob.box->area();
  }
  return points;
}

}  // namespace marey::pipeline::markers
