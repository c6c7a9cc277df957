// The second pass. Tracklets that end and begin at short notice are joined first. What that gives is cut wherever identity is in
// doubt (ambiguous_intervals.h), and all pieces of the recording are linked again in one assignment, by motion, size and clothes
// together (tracklet_linker.h). Where no clothes were seen, motion alone decides no better than the tracker did: nothing is cut.
// The rest is evaluated as a whole: false alarms go, gaps are filled, paths smoothed; at last, one who left the image and came back
// gets the number from before (returns.h). Cost: near linear in tracklets, by the
// number that begin while a gap may last; the rows are skipped a few times.
#include "marey/track/offline/join.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "marey/geometry/median.h"
#include "marey/track/offline/fill_gaps.h"
#include "marey/track/offline/tracklet_linker.h"

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

constexpr double weak_lasting = 1.5;   // s that weak observations must last to be trusted
constexpr double weak_fraction = 0.6;  // and of the frames, the share they must be in

constexpr double kShortNotice = 1;  // s

// Of recordings whose boxes' noise was learned; bench/tuning.md has the sweep.
constexpr double kPositionKernel = 0.5;  // beside the time over which an optimal smoother of places averages
constexpr double kSizeKernel = 0.7;      // the same for sizes
constexpr double kStraying = 1;          // speed_noise for each unit of acceleration noise

/// Predicted rows at the ends are cut.
void trim(Tracklet& rows) {
  while (!rows.empty() && !rows.back().observed()) rows.pop_back();
  const auto first = std::find_if(rows.begin(), rows.end(), [](const TrackRow& row) { return row.observed(); });
  rows.erase(rows.begin(), first);
}

/// What the observations of one target say of it.
struct Standing {
  std::int64_t detected = 0;
  double lasted = 0;    // s
  double fraction = 0;  // of its frames in which it was seen
  double score = 0;     // mean
};

Standing standing_of(const Tracklet& rows, const TrackletLog& log) {
  Standing standing;
  for (const TrackRow& row : rows) {
    if (!row.observed()) continue;
    ++standing.detected;
    standing.score += row.score;
  }
  standing.score /= static_cast<double>(std::max<std::int64_t>(1, standing.detected));
  standing.lasted = seconds(log.time_of(rows.back().frame) - log.time_of(rows.front().frame));
  standing.fraction = static_cast<double>(standing.detected) / (rows.back().frame - rows.front().frame + 1);
  return standing;
}

/// The score that half of the observations reach.
double median_score(std::span<const Tracklet> tracklets) {
  std::vector<float> scores;
  for (const Tracklet& tracklet : tracklets) {
    for (const TrackRow& row : tracklet) {
      if (row.observed()) scores.push_back(row.score);
    }
  }
  if (scores.empty()) return 1;
  return geometry::median(scores);
}

/// Too short, seen too rarely, or both rather short or rarely seen and unusually weak.
bool is_false_alarm(const Standing& standing, double typical, const JoinOptions& options) {
  if (standing.detected < options.min_detections || standing.lasted < options.shortest || standing.fraction < options.rarest)
    return true;
  const bool weak = standing.score < typical - options.weaker;
  return weak && (standing.lasted < weak_lasting || standing.fraction < weak_fraction);
}

std::vector<TrackRow> by_frame(std::vector<Tracklet>& tracklets) {
  std::sort(tracklets.begin(), tracklets.end(), [](const Tracklet& a, const Tracklet& b) {
    return std::pair(a.front().frame, a.front().id) < std::pair(b.front().frame, b.front().id);
  });
  std::size_t total = 0;
  for (const Tracklet& tracklet : tracklets) total += tracklet.size();
  std::vector<TrackRow> rows;
  rows.reserve(total);
  std::int32_t id = 0;
  for (Tracklet& tracklet : tracklets) {
    ++id;
    for (TrackRow& row : tracklet) {
      row.id = id;
      rows.push_back(row);
    }
    Tracklet().swap(tracklet);
  }
  std::sort(rows.begin(), rows.end(),
            [](const TrackRow& a, const TrackRow& b) { return a.frame != b.frame ? a.frame < b.frame : a.id < b.id; });
  return rows;
}

}  // namespace

JoinOptions adapted(JoinOptions options, const image::BoxNoise& noise) {
  const image::BoxNoiseLevels frame = noise.levels_of_a_frame(), all = noise.levels();
  const double dt = noise.frame_time();
  const double location = std::pow(frame.location * frame.location * dt / (frame.acceleration * frame.acceleration), 0.25);
  const double size = frame.size * std::sqrt(dt) / frame.drift;
  options.smoothing.location = std::min(options.smoothing.location, kPositionKernel * location);
  options.smoothing.size = std::min(options.smoothing.size, kSizeKernel * size);
  options.speed_noise = std::max(options.speed_noise, kStraying * all.acceleration);
  return options;
}

std::vector<TrackRow> join(TrackletLog& log, const JoinOptions& options, JoinReport* report) {
  std::vector<Tracklet> tracklets = log.take_tracklets();
  for (Tracklet& tracklet : tracklets) trim(tracklet);
  std::erase_if(tracklets, [](const Tracklet& tracklet) { return tracklet.empty(); });
  const TrackletLinker linker(tracklets, log, options);
  tracklets = linker.join(std::move(tracklets), std::min(kShortNotice, options.longest_gap));
  if (linker.knows_clothes()) tracklets = linker.decide_again(std::move(tracklets));
  tracklets = linker.join(std::move(tracklets), options.longest_gap);
  const double typical = median_score(tracklets);
  std::erase_if(tracklets, [&](const Tracklet& rows) { return is_false_alarm(standing_of(rows, log), typical, options); });
  for (Tracklet& tracklet : tracklets) {
    fill_gaps(tracklet, log, options.longest_filled, GapInterpolation::straight);
    smooth(tracklet, log, options.smoothing);
    for (TrackRow& row : tracklet) row = log.in_view(row);
  }
  if (options.view) {
    const std::vector<Returned> returned = find_returned(tracklets, log, *options.view, options.returns);
    join_returned(tracklets, returned);
    if (report) report->returned = returned;
  }
  return by_frame(tracklets);
}

}  // namespace marey::track::offline
