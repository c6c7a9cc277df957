#include "marey/evaluate/label_loss.h"

#include <cassert>
#include <map>

namespace marey::evaluate {
namespace {

const NamedPosition* nearest_within(const std::vector<NamedPosition>& tracks, const Vector<2>& location, double reach) {
  const NamedPosition* nearest = nullptr;
  for (const NamedPosition& track : tracks) {
    const double distance = (track.location - location).norm();
    if (distance <= reach) {
      reach = distance;
      nearest = &track;
    }
  }
  return nearest;
}

bool is_near(const std::vector<NamedPosition>& tracks, const std::string& name, const Vector<2>& location, double reach) {
  for (const NamedPosition& track : tracks) {
    if (track.name == name && (track.location - location).norm() <= reach) return true;
  }
  return false;
}

}  // namespace

std::vector<LabelFate> evaluate_labels(std::span<const std::vector<NamedPosition>> truth,
                                       std::span<const std::vector<NamedPosition>> tracks, double reach) {
  assert(truth.size() == tracks.size());
  std::map<std::string, LabelFate> fates;
  for (std::size_t frame = 0; frame < truth.size(); ++frame) {
    for (const NamedPosition& marker : truth[frame]) {
      LabelFate& fate = fates[marker.name];
      ++fate.visible;
      if (fate.visible == 1) {
        fate.marker = marker.name;
        if (const NamedPosition* first = nearest_within(tracks[frame], marker.location, reach)) fate.given = first->name;
      }
      // Where two markers touch, two names are near both: the name counts wherever it is near, not only where it is nearest.
      fate.named_at_last = !fate.given.empty() && is_near(tracks[frame], fate.given, marker.location, reach);
      fate.named += fate.named_at_last ? 1 : 0;
    }
  }
  std::vector<LabelFate> result;
  for (auto& [name, fate] : fates) result.push_back(std::move(fate));
  return result;
}

}  // namespace marey::evaluate
