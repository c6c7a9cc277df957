#include "marey/track/ground/offline/ground_tracklet.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace marey::track::ground::offline {

std::size_t index_from(std::span<const GroundSample> samples, std::int32_t instant) {
  const auto found = std::lower_bound(samples.begin(), samples.end(), instant,
                                      [](const GroundSample& sample, std::int32_t sought) { return sample.instant < sought; });
  return static_cast<std::size_t>(found - samples.begin());
}

GroundTracklet split(GroundTracklet& tracklet, std::size_t from) {
  assert(from > 0 && from < tracklet.samples.size() && "both parts hold something");
  GroundTracklet later{.runs = {}, .confirmed = tracklet.confirmed, .samples = {}, .goes_on = tracklet.goes_on};
  later.samples.assign(tracklet.samples.begin() + static_cast<std::ptrdiff_t>(from), tracklet.samples.end());
  tracklet.samples.resize(from);
  auto run =
      std::find_if(tracklet.runs.begin(), tracklet.runs.end(), [&](const GroundTracklet::Run& r) { return r.first >= from; });
  if (run == tracklet.runs.end() || run->first > from) later.runs.push_back({std::prev(run)->track, 0});
  for (auto it = run; it != tracklet.runs.end(); ++it) later.runs.push_back({it->track, it->first - from});
  tracklet.runs.erase(run, tracklet.runs.end());
  return later;
}

void erase(GroundTracklet& tracklet, std::size_t from, std::size_t end) {
  assert(from < end && end <= tracklet.samples.size() && end - from < tracklet.samples.size() && "something is left");
  tracklet.samples.erase(tracklet.samples.begin() + static_cast<std::ptrdiff_t>(from),
                         tracklet.samples.begin() + static_cast<std::ptrdiff_t>(end));
  std::vector<GroundTracklet::Run> runs;
  for (GroundTracklet::Run run : tracklet.runs) {
    run.first = run.first >= end ? run.first - (end - from) : std::min(run.first, from);
    if (!runs.empty() && runs.back().first == run.first) runs.pop_back();
    if (run.first < tracklet.samples.size()) runs.push_back(run);
  }
  tracklet.runs = std::move(runs);
}

void append(GroundTracklet& tracklet, const GroundTracklet& later) {
  for (const GroundTracklet::Run& run : later.runs) tracklet.runs.push_back({run.track, run.first + tracklet.samples.size()});
  tracklet.samples.insert(tracklet.samples.end(), later.samples.begin(), later.samples.end());
}

}  // namespace marey::track::ground::offline
