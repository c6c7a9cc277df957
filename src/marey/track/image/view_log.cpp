#include "marey/track/image/view_log.h"

#include <algorithm>
#include <utility>

namespace marey::track::image {

void ViewLog::add_box(std::int32_t instant, TrackId track, const Box& box) {
  rows_.push_back({instant, number(track), static_cast<float>(box.left), static_cast<float>(box.top), static_cast<float>(box.width),
                   static_cast<float>(box.height)});
}

std::optional<std::int32_t> ViewLog::frame_at(std::int64_t instant) const {
  const auto at = std::lower_bound(frames_.begin(), frames_.end(), instant,
                                   [](const FramePair& frame, std::int64_t required) { return frame.instant < required; });
  if (at == frames_.end() || at->instant != instant) return std::nullopt;
  return at->own;
}

void ViewLog::name(const std::function<std::optional<TrackId>(TrackId, std::int32_t)>& track_of) {
  std::erase_if(rows_, [&](Row& row) {
    const auto track = track_of(TrackId{row.track}, row.instant);
    if (track) row.track = number(*track);
    return !track;
  });
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const Row& a, const Row& b) { return std::pair(a.instant, a.track) < std::pair(b.instant, b.track); });
}

std::optional<Box> ViewLog::box(std::int64_t instant, TrackId track) const {
  const auto at = std::lower_bound(
      rows_.begin(), rows_.end(), std::pair(instant, number(track)),
      [](const Row& row, const auto& required) { return std::pair<std::int64_t, int>(row.instant, row.track) < required; });
  if (at == rows_.end() || at->instant != instant || at->track != number(track)) return std::nullopt;
  return Box{at->left, at->top, at->width, at->height};
}

}  // namespace marey::track::image
