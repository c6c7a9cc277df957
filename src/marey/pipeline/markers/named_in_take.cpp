#include "marey/pipeline/markers/named_in_take.h"

#include <map>
#include <optional>
#include <utility>

#include "marey/core/ids.h"
#include "marey/core/time.h"
#include "marey/format/take/take_file.h"

namespace marey::pipeline::markers {

MarkerSet named_in_take(const std::string& path) {
  constexpr double kBeginning = 1;  // s
  MarkerSet set;
  if (path.empty() || !format::take::is_take(path)) return set;
  format::take::TakeReader take(path);
  std::map<TrackId, std::string> labels;
  for (TrackName& track : take.tracks()) {
    if (!track.label.empty()) labels.emplace(track.id, std::move(track.label));
  }
  std::optional<Timestamp> begin;
  while (const auto instant = labels.empty() ? std::nullopt : take.next()) {
    if (!begin) begin = instant->time;
    if (seconds(instant->time - *begin) > kBeginning) break;
    MarkerSet now;
    for (const Sample& sample : instant->samples) {
      const auto label = labels.find(sample.track);
      if (label == labels.end()) continue;
      now.labels.push_back(label->second);
      now.locations.push_back(sample.position);
    }
    if (now.labels.size() > set.labels.size()) set = std::move(now);
  }
  return set;
}

}  // namespace marey::pipeline::markers
