#include "marey/solve/skeleton/gaps.h"

#include <algorithm>

namespace marey::solve::skeleton {
namespace {

/// Of each marker: whether it is missed in a frame, that is hidden between two frames that are at most `hidden` apart.
std::vector<std::vector<bool>> missed_markers(std::size_t markers, std::span<const ObservedMarkers> frames, std::size_t hidden) {
  std::vector<std::vector<bool>> missed(markers, std::vector<bool>(frames.size(), false));
  for (std::size_t j = 0; j < markers; ++j) {
    std::optional<std::size_t> last;
    for (std::size_t f = 0; f < frames.size(); ++f) {
      if (!frames[f][j]) continue;
      if (last && f - *last <= hidden) {
        for (std::size_t t = *last + 1; t < f; ++t) missed[j][t] = true;
      }
      last = f;
    }
  }
  return missed;
}

}  // namespace

std::vector<std::vector<WholeFrames>> whole_frames(const Skeleton& skeleton, std::span<const ObservedMarkers> frames,
                                                   std::size_t hidden) {
  const auto missed = missed_markers(skeleton.markers.size(), frames, hidden);
  std::vector<std::vector<WholeFrames>> all(skeleton.segments.size(), std::vector<WholeFrames>(frames.size()));
  for (std::size_t s = 0; s < skeleton.segments.size(); ++s) {
    std::vector<bool> whole(frames.size(), true);
    for (std::size_t j = 0; j < skeleton.markers.size(); ++j) {
      const auto on = static_cast<std::size_t>(skeleton.markers[j].segment);
      const auto parent_of = [&](std::size_t a, std::size_t b) {
        return skeleton.segments[a].parent && static_cast<std::size_t>(*skeleton.segments[a].parent) == b;
      };
      if (on != s && !parent_of(on, s) && !parent_of(s, on)) continue;
      for (std::size_t f = 0; f < frames.size(); ++f) {
        if (missed[j][f]) whole[f] = false;
      }
    }
    std::optional<std::size_t> last;
    for (std::size_t f = 0; f < frames.size(); ++f) {
      if (whole[f]) last = f;
      all[s][f].before = last;
    }
    last.reset();
    for (std::size_t f = frames.size(); f-- > 0;) {
      if (whole[f]) last = f;
      all[s][f].after = last;
    }
  }
  return all;
}

Fractions fractions_of(const WholeFrames& whole, std::size_t frame, std::size_t hidden) {
  if (whole.before == frame) return {};
  double length = static_cast<double>(hidden);
  if (whole.before && whole.after) length = std::min(length, static_cast<double>(*whole.after - *whole.before));
  const auto fraction = [&](std::size_t distance) { return std::max(0.0, 1 - static_cast<double>(distance) / length); };
  return {whole.before ? fraction(frame - *whole.before) : 0, whole.after ? fraction(*whole.after - frame) : 0};
}

}  // namespace marey::solve::skeleton
