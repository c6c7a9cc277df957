#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"

namespace marey::track::image {

/// Whose box was where in one camera's images; 24 bytes a person and frame.
class ViewLog {
 public:
  /// The camera gave its frame `own` to the instant `instant`. Instants grow from call to call.
  void add_frame(std::int32_t instant, std::int32_t own) { frames_.push_back({instant, own}); }
  void add_box(std::int32_t instant, TrackId track, const Box& box);

  /// The frame that the camera gave to this instant.
  std::optional<std::int32_t> frame_at(std::int64_t instant) const;

  /// Puts the recording's tracks in the place of the tracker's; boxes of those in no track are forgotten.
  void name(const std::function<std::optional<TrackId>(TrackId, std::int32_t instant)>& track_of);
  /// The box of this track of the recording at this instant, where the camera saw it. After `name`.
  std::optional<Box> box(std::int64_t instant, TrackId track) const;

 private:
  struct FramePair {
    std::int32_t instant = 0, own = 0;
  };
  struct Row {
    std::int32_t instant = 0, track = 0;
    float left = 0, top = 0, width = 0, height = 0;
  };
  std::vector<FramePair> frames_;
  std::vector<Row> rows_;  // by instant, then by track once named
};

}  // namespace marey::track::image
