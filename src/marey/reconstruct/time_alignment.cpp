#include "marey/reconstruct/time_alignment.h"

#include <utility>

namespace marey::reconstruct {

OwnTime::OwnTime(std::vector<std::optional<Camera>> cameras, const OwnTimeOptions& options)
    : options_(options), cameras_(std::move(cameras)), last_(cameras_.size()) {}

/// How much the marker that is expected nearest moves from then to now.
std::optional<Vector<2>> OwnTime::by_expected(const Vector<2>& blob) const {
  const Moving* best = nullptr;
  double minimum = options_.near_px * options_.near_px;
  for (const Moving& each : moving_) {
    const double distance = (each.then - blob).squaredNorm();
    if (distance < minimum) minimum = distance, best = &each;
  }
  if (best == nullptr) return std::nullopt;
  return best->now - best->then;
}

std::optional<Vector<2>> OwnTime::by_last(const Vector<2>& blob, const Last& last, double elapsed, double ahead) const {
  const Vector<2>* partner = nullptr;
  for (const Vector<2>& each : last.blobs) {
    if ((each - blob).squaredNorm() > options_.farthest_px * options_.farthest_px) continue;
    if (partner != nullptr) return std::nullopt;  // it may be either
    partner = &each;
  }
  if (partner == nullptr) return std::nullopt;
  return (blob - *partner) * (ahead / elapsed);
}

void OwnTime::bring(CameraId camera, Timestamp detected, Timestamp now, std::span<Observation<2>> blobs,
                    std::span<const Track<3>> expected) {
  const auto index = static_cast<std::size_t>(number(camera));
  if (!cameras_[index]) return;
  Last& last = last_[index];
  before_.clear();
  for (const Observation<2>& blob : blobs) before_.push_back(blob.value);
  const double ahead = seconds(now - detected), elapsed = seconds(detected - last.time);
  if (ahead != 0) {
    moving_.clear();
    for (const Track<3>& track : expected) {
      const auto then = cameras_[index]->project(track.position - ahead * track.velocity);
      const auto at_moment = cameras_[index]->project(track.position);
      if (then && at_moment) moving_.push_back({*then, *at_moment});
    }
    for (Observation<2>& blob : blobs) {
      auto moved = by_expected(blob.value);
      if (!moved && elapsed > 0) moved = by_last(blob.value, last, elapsed, ahead);
      if (moved) blob.value += *moved;
    }
  }
  last.time = detected;
  std::swap(last.blobs, before_);
}

}  // namespace marey::reconstruct
