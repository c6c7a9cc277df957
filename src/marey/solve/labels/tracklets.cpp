#include "marey/solve/labels/tracklets.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "marey/assign/successors.h"

namespace marey::solve::labels {
namespace {

constexpr std::int32_t kFit = 4;          // instants from which a velocity is taken at an end
constexpr double kTied = 0.012;           // m: what two ends may be off in the middle of their gap, and by this much more
constexpr double kTiedAcceleration = 60;  // m/s² the longer it is

bool counts(Provenance provenance) {
  return provenance == Provenance::measured || provenance == Provenance::filled;
}

/// Whether a path breaks between two rows that follow each other: what comes before and what comes after do not lead there.
bool jumps_between(const TrackColumns& track, std::size_t row, std::size_t first, std::size_t end, double limit) {
  const Vector<3> step = track.position(row + 1) - track.position(row);
  const bool has_before = row > first, has_after = row + 2 < end;
  if (!has_before && !has_after) return step.norm() > 3 * limit;
  double off = 1e9;
  if (has_before) off = std::min(off, (step - (track.position(row) - track.position(row - 1))).norm());
  if (has_after) off = std::min(off, (step - (track.position(row + 2) - track.position(row + 1))).norm());
  return off > limit;
}

void cut(const TrackColumns& track, std::size_t begin, std::size_t end, double limit, std::vector<Tracklet>& tracklets) {
  std::size_t first = begin;
  bool jumped = false;
  for (std::size_t row = begin; row < end; ++row) {
    const bool last = row + 1 == end;
    if (!last && !jumps_between(track, row, first, end, limit)) continue;
    Tracklet tracklet{.track = track.id(),
                      .first_row = first,
                      .last_row = row,
                      .first = track.at()[first],
                      .last = track.at()[row],
                      .locations = {},
                      .after_jump = jumped};
    for (std::size_t i = first; i <= row; ++i) tracklet.locations.push_back(track.position(i));
    tracklets.push_back(std::move(tracklet));
    first = row + 1;
    jumped = true;
  }
}

/// Where a tracklet's end, or its beginning, leads: place and velocity an instant.
struct Lead {
  std::int32_t time = 0;  // instants
  Vector<3> location = Vector<3>::Zero(), velocity = Vector<3>::Zero();
  bool moving = false;  // its velocity is known
};

Lead lead_of(const Tracklet& tracklet, bool end) {
  const auto& locations = tracklet.locations;
  const std::int32_t span = std::min(kFit, tracklet.length()) - 1;
  Lead lead;
  lead.time = end ? tracklet.last : tracklet.first;
  lead.location = end ? locations.back() : locations.front();
  lead.moving = span > 0;
  if (!lead.moving) return lead;
  const Vector<3>& other =
      end ? locations[locations.size() - 1 - static_cast<std::size_t>(span)] : locations[static_cast<std::size_t>(span)];
  lead.velocity = (end ? lead.location - other : other - lead.location) / span;
  return lead;
}

/// How far two ends are from continuing in each other.
double off_between(const Lead& end, const Lead& begin, double gap) {
  const Vector<3> velocity = end.moving && begin.moving ? Vector<3>((end.velocity + begin.velocity) / 2)
                             : end.moving               ? end.velocity
                                                        : begin.velocity;
  return (end.location + gap * velocity - begin.location).norm();
}

}  // namespace

std::vector<Tracklet> tracklets_of(const Recording& recording, const TrackletOptions& options) {
  std::vector<Tracklet> tracklets;
  const double rate = recording.header.rate_hz;
  const double limit = std::max(options.jump, options.acceleration / (rate * rate));
  for (const TrackColumns& track : recording.tracks()) {
    std::size_t begin = 0;
    for (std::size_t row = 0; row < track.size(); ++row) {
      if (!counts(track.provenance()[row])) {
        cut(track, begin, row, limit, tracklets);
        begin = row + 1;
      } else if (row + 1 == track.size() || track.at()[row + 1] != track.at()[row] + 1) {
        cut(track, begin, row + 1, limit, tracklets);
        begin = row + 1;
      }
    }
  }
  std::sort(tracklets.begin(), tracklets.end(),
            [](const Tracklet& a, const Tracklet& b) { return std::tie(a.first, a.track) < std::tie(b.first, b.track); });
  return tracklets;
}

std::vector<int> chains_of(const std::vector<Tracklet>& tracklets, double rate_hz, const TrackletOptions& options) {
  std::vector<Lead> ends, begins;
  for (const Tracklet& tracklet : tracklets) {
    ends.push_back(lead_of(tracklet, true));
    begins.push_back(lead_of(tracklet, false));
  }
  const auto off = [&](int end, int begin) {
    const Lead &from = ends[static_cast<std::size_t>(end)], &to = begins[static_cast<std::size_t>(begin)];
    const double gap = to.time - from.time, gap_s = gap / rate_hz;
    return off_between(from, to, gap) / (kTied + kTiedAcceleration * gap_s * gap_s / 2);
  };
  const auto longest = static_cast<std::int32_t>(std::max(1.0, std::round(options.longest_tied * rate_hz)));
  std::vector<int> chain_of(tracklets.size());
  int number = 0;
  for (const std::vector<int>& chain : assign::chains_of(assign::clear_successors(ends, begins, longest, off))) {
    for (const int tracklet : chain) chain_of[static_cast<std::size_t>(tracklet)] = number;
    ++number;
  }
  return chain_of;
}

}  // namespace marey::solve::labels
