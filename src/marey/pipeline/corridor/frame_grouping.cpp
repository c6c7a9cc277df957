#include "marey/pipeline/corridor/frame_grouping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace marey::pipeline::corridor {
namespace {

constexpr double kMaxDistance = 60;  // px that a detection may move in a frame and still be found again

std::optional<std::size_t> closest(const Vector<2>& location, const std::vector<Detection>& among) {
  std::optional<std::size_t> best;
  double minimum = kMaxDistance * kMaxDistance;
  for (std::size_t i = 0; i < among.size(); ++i) {
    const double distance = (among[i].centre - location).squaredNorm();
    if (distance < minimum) minimum = distance, best = i;
  }
  return best;
}

}  // namespace

std::vector<Detection> moved_to(Timestamp now, const CameraFrame& nearest, const CameraFrame& other) {
  std::vector<std::optional<std::size_t>> partner;
  for (const Detection& detection : *other.detections) partner.push_back(closest(detection.centre, *nearest.detections));
  const double fraction = seconds(now - nearest.frame.time) / seconds(other.frame.time - nearest.frame.time);
  std::vector<Detection> moved;
  for (std::size_t i = 0; i < nearest.detections->size(); ++i) {
    const Detection& detection = (*nearest.detections)[i];
    const auto found = closest(detection.centre, *other.detections);
    if (!found || partner[*found] != i) continue;
    moved.push_back(detection);
    moved.back().centre += fraction * ((*other.detections)[*found].centre - detection.centre);
  }
  return moved;
}

FrameGrouping::FrameGrouping(std::vector<Feed>&& feeds, const ClockOptions& options, double rate_hz)
    : options_(options), feeds_(std::move(feeds)), lanes_(feeds_.size()), rate_hz_(rate_hz) {}

std::optional<CameraFrame> FrameGrouping::take(std::size_t camera, Timestamp now) {
  Lane& lane = lanes_[camera];
  auto& frames = lane.waiting;
  // One frame before the instant is kept, to estimate motion from.
  while (frames.size() > 2 && frames[1].frame.time <= now) frames.pop_front();
  const auto found = nearest(lane, now);
  if (!found) {
    ++lane.missed;
    return std::nullopt;
  }
  CameraFrame frame = frames[*found];
  lane.used = frame.frame.time;
  if (options_.interpolate) {
    move_to(now, camera, *found, frame);
  } else {
    frames.erase(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(*found) + 1);
  }
  return frame;
}

std::optional<std::size_t> FrameGrouping::nearest(const Lane& lane, Timestamp now) const {
  std::optional<std::size_t> nearest;
  double minimum = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < lane.waiting.size(); ++i) {
    const Timestamp time = lane.waiting[i].frame.time;
    if (!options_.interpolate && lane.used && time <= *lane.used) continue;  // given already
    const double off = std::abs(seconds(time - now));
    if (off < minimum) minimum = off, nearest = i;
  }
  if (minimum > kHalf / rate_hz_) return std::nullopt;
  return nearest;
}

/// Along the line to the frame on the instant's other side, else to the one on this side.
void FrameGrouping::move_to(Timestamp now, std::size_t camera, std::size_t nearest, CameraFrame& frame) const {
  const auto& frames = lanes_[camera].waiting;
  const double period = 1 / (feeds_[camera].rate_hz() > 0 ? feeds_[camera].rate_hz() : rate_hz_);
  if (std::abs(seconds(frame.frame.time - now)) <= kInStep * period) return;
  const bool early = frame.frame.time < now;
  for (const bool beyond : {early, !early}) {
    if (beyond ? nearest + 1 >= frames.size() : nearest == 0) continue;
    const CameraFrame& other = frames[beyond ? nearest + 1 : nearest - 1];
    if (std::abs(seconds(other.frame.time - frame.frame.time)) > 1.5 * period) continue;
    frame.detections = moved_to(now, frame, other);
    return;
  }
  frame.detections->clear();
}

}  // namespace marey::pipeline::corridor
