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
/// What n people's mean displacement is worth beside their spread: 2 in the mean if all people move independently.
constexpr double kTogether = 10;

}  // namespace

void CameraSpan::observe_frame(Timestamp now, std::span<const Track<2>> tracks) {
  if (!before_.empty() && seconds(now - taken_) < kApart) return;
  std::map<TrackId, Location> locations;
  for (const Track<2>& track : tracks) {
    if (track.confirmed && track.box && track.measured()) locations[track.id] = {track.position, track.box->height};
  }
  compare(locations);
  before_ = std::move(locations);
  taken_ = now;
}

void CameraSpan::compare(const std::map<TrackId, Location>& now) {
  std::vector<Vector<2>> steps;
  double height = 0;
  for (const auto& [id, location] : now) {
    const auto before = before_.find(id);
    if (before == before_.end()) continue;
    steps.push_back(location.location - before->second.location);
    height += location.height;
  }
  if (steps.size() < kPeople) return;
  const double n = static_cast<double>(steps.size());
  Vector<2> mean = Vector<2>::Zero();
  for (const Vector<2>& step : steps) mean += step / n;
  double spread = 0;  // of each axis
  for (const Vector<2>& step : steps) spread += (step - mean).squaredNorm() / (2 * (n - 1));
  const double minimum = kStanding * height / n;
  coherence_ += n * mean.squaredNorm() / (spread + minimum * minimum);
  farthest_ = std::max(farthest_, mean.norm());
  ++seconds_;
}

bool CameraSpan::moved() const {
  return seconds_ >= kSeconds && coherence_ > kTogether * seconds_;
}

}  // namespace marey::pipeline::people
