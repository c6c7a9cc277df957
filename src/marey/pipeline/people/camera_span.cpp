#include "marey/pipeline/people/camera_span.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace marey::pipeline::people {
namespace {

// All of these are unswept.
constexpr double kApart = 1;        // s between the frames that are compared
constexpr std::size_t kPeople = 4;  // in both frames
constexpr int kSeconds = 3;         // that must have been compared
constexpr double kStanding = 0.05;  // heights: people who stand are not known to better than this
/// What n people's mean displacement is worth beside their spread: 2 in the mean where everybody goes his own way.
constexpr double kTogether = 10;

}  // namespace

void CameraSpan::see(Timestamp now, std::span<const Track<2>> tracks) {
  if (!before_.empty() && seconds(now - taken_) < kApart) return;
  std::map<TrackId, Place> places;
  for (const Track<2>& track : tracks) {
    if (track.confirmed && track.box && track.measured()) places[track.id] = {track.position, track.box->height};
  }
  compare(places);
  before_ = std::move(places);
  taken_ = now;
}

void CameraSpan::compare(const std::map<TrackId, Place>& now) {
  std::vector<Vector<2>> ways;
  double height = 0;
  for (const auto& [id, place] : now) {
    const auto before = before_.find(id);
    if (before == before_.end()) continue;
    ways.push_back(place.place - before->second.place);
    height += place.height;
  }
  if (ways.size() < kPeople) return;
  const double n = static_cast<double>(ways.size());
  Vector<2> mean = Vector<2>::Zero();
  for (const Vector<2>& way : ways) mean += way / n;
  double spread = 0;  // of each axis
  for (const Vector<2>& way : ways) spread += (way - mean).squaredNorm() / (2 * (n - 1));
  const double least = kStanding * height / n;
  coherence_ += n * mean.squaredNorm() / (spread + least * least);
  farthest_ = std::max(farthest_, mean.norm());
  ++seconds_;
}

bool CameraSpan::moved() const {
  return seconds_ >= kSeconds && coherence_ > kTogether * seconds_;
}

}  // namespace marey::pipeline::people
