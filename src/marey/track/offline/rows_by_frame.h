#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/track.h"
#include "marey/track/offline/outline_log.h"
#include "marey/track/offline/outlines_of_rows.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::track::offline {

/// Distributes a table of rows, sorted by frame, frame by frame. The table must outlive it.
class RowsByFrame {
 public:
  /// `labels[id]` is the label of track `id`, where there is one. With `outlines`, which must outlive it, tracks have theirs.
  explicit RowsByFrame(const std::vector<TrackRow>& rows, std::vector<std::string> labels = {}, OutlineLog* outlines = nullptr)
      : at_(rows.begin()), end_(rows.end()), labels_(std::move(labels)) {
    if (outlines != nullptr) outlines_.emplace(*outlines);
  }

  /// The tracks of `frame`, which grows from call to call; valid until the next call.
  const std::vector<Track<2>>& at(std::int64_t frame) {
    tracks_.clear();
    while (at_ != end_ && at_->frame < frame) ++at_;
    const auto first = at_;
    for (; at_ != end_ && at_->frame == frame; ++at_) tracks_.push_back(track_of(*at_));
    if (outlines_) outlines_->attach(frame, std::span(first, at_), tracks_);
    return tracks_;
  }

 private:
  Track<2> track_of(const TrackRow& row) const {
    Track<2> track;
    track.id = TrackId{row.id};
    if (const auto id = static_cast<std::size_t>(row.id); id < labels_.size()) track.label = labels_[id];
    track.position = {row.x, row.y};
    track.velocity = {row.vx, row.vy};
    if (row.has_box()) track.box = Box{row.left, row.top, row.width, row.height};
    track.score = row.score;
    track.provenance = row.provenance;
    return track;
  }

  std::vector<TrackRow>::const_iterator at_, end_;
  std::vector<std::string> labels_;
  std::optional<OutlinesOfRows> outlines_;
  std::vector<Track<2>> tracks_;
};

}  // namespace marey::track::offline
