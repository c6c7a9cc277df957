#include "marey/track/offline/tracklet_log.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace marey::track::offline {
namespace {

TrackRow row_of(std::int32_t frame, const Track<2>& track) {
  TrackRow row;
  row.frame = frame;
  row.id = row.first_id = number(track.id);
  row.x = static_cast<float>(track.position.x());
  row.y = static_cast<float>(track.position.y());
  row.vx = static_cast<float>(track.velocity.x());
  row.vy = static_cast<float>(track.velocity.y());
  if (track.box) {
    row.left = static_cast<float>(track.box->left);
    row.top = static_cast<float>(track.box->top);
    row.width = static_cast<float>(track.box->width);
    row.height = static_cast<float>(track.box->height);
  }
  if (track.outline && track.outline->state != Outline::State::held) {
    row.centre_x = static_cast<float>(track.outline->centre.x());
    row.centre_y = static_cast<float>(track.outline->centre.y());
    row.has_centre = true;
  }
  row.score = static_cast<float>(track.score);
  row.provenance = track.provenance;
  return row;
}

/// Where `target_from_source` puts it.
TrackRow moved(TrackRow row, const geometry::Similarity2& target_from_source) {
  const auto put = [](const Vector<2>& value, float& x, float& y) {
    x = static_cast<float>(value.x());
    y = static_cast<float>(value.y());
  };
  put(target_from_source * Vector<2>(row.x, row.y), row.x, row.y);
  put(target_from_source.turn * Vector<2>(row.vx, row.vy), row.vx, row.vy);
  put(target_from_source * Vector<2>(row.centre_x, row.centre_y), row.centre_x, row.centre_y);
  if (!row.has_box()) return row;
  const Box box = target_from_source * Box{row.left, row.top, row.width, row.height};
  put({box.left, box.top}, row.left, row.top);
  put({box.width, box.height}, row.width, row.height);
  return row;
}

bool is_identity(const geometry::Similarity2& motion) {
  return motion.turn == Matrix<2>::Identity() && motion.shift == Vector<2>::Zero();
}

}  // namespace

void TrackletLog::add(std::int64_t frame, Timestamp time, std::span<const Track<2>> tracks, std::span<const image::Clothes> clothes,
                      const geometry::Similarity2& view_from_scene) {
  const auto index = static_cast<std::int32_t>(frame);
  if (times_.empty()) first_frame_ = index;
  assert(index == first_frame_ + static_cast<std::int32_t>(times_.size()) && "frames are added in order, each once");
  if (views_from_scene_.empty() && !is_identity(view_from_scene)) views_from_scene_.resize(times_.size());
  times_.push_back(time);
  if (!views_from_scene_.empty() || !is_identity(view_from_scene)) views_from_scene_.push_back(view_from_scene);
  const geometry::Similarity2 scene_from_view = view_from_scene.inverse();
  std::vector<Open> still_open;
  still_open.reserve(tracks.size());
  auto open = open_.begin();  // both lists are in the order of ids
  for (const Track<2>& track : tracks) {
    for (; open != open_.end() && open->rows.back().id < number(track.id); ++open) close(*open);
    const bool known = open != open_.end() && open->rows.back().id == number(track.id);
    still_open.push_back(known ? std::move(*open++) : Open{});
    const TrackRow row = row_of(index, track);
    still_open.back().rows.push_back(views_from_scene_.empty() ? row : moved(row, scene_from_view));
    if (track.observation && static_cast<std::size_t>(*track.observation) < clothes.size())
      still_open.back().rows.back().clothes = image::PackedClothes(clothes[*track.observation]);
    still_open.back().confirmed |= track.confirmed;
  }
  for (; open != open_.end(); ++open) close(*open);
  open_ = std::move(still_open);
}

void TrackletLog::close(Open& open) {
  if (!open.confirmed) return;
  open.rows.shrink_to_fit();  // in a match of 90 minutes, tens of megabytes
  closed_.push_back(std::move(open.rows));
}

TrackRow TrackletLog::in_view(const TrackRow& row) const {
  if (views_from_scene_.empty()) return row;
  return moved(row, views_from_scene_.at(static_cast<std::size_t>(row.frame - first_frame_)));
}

Timestamp TrackletLog::time_of(std::int32_t frame) const {
  return times_.at(static_cast<std::size_t>(frame - first_frame_));
}

std::vector<TrackletLog::Tracklet> TrackletLog::take_tracklets() {
  for (Open& open : open_) close(open);
  open_.clear();
  std::vector<Tracklet> all = std::move(closed_);
  closed_.clear();
  std::sort(all.begin(), all.end(), [](const Tracklet& a, const Tracklet& b) { return a.front().id < b.front().id; });
  return all;
}

}  // namespace marey::track::offline
