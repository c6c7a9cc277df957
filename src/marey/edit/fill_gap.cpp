#include "marey/edit/fill_gap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/error.h"
#include "marey/edit/fill_trials.h"
#include "marey/edit/gap_methods.h"
#include "marey/edit/lowpass.h"
#include "marey/filter/bridge.h"

namespace marey::edit {
namespace {

using Path = std::vector<Vector<3>>;

constexpr double kAround_s = 20;          // of the recording on either side of a gap, that is used
constexpr std::size_t kMaxFrames = 4000;  // of it

/// A gap by the recording's instants, both ends included.
struct Gap {
  std::int32_t first = 0, last = 0;
};

/// A piece of the recording round a gap, and the gap in it.
struct Surroundings {
  std::int32_t begin = 0;  // the instant that is frame 0 of the piece
  Locations locations;
  Hole hole;
};

Surroundings surroundings_of(Tracks& tracks, const std::vector<TrackId>& markers, const Gap& gap) {
  const auto time_steps = tracks.time_steps();
  const double rate_hz = rate_between(time_steps, gap.first - 1, gap.last + 1);
  const auto around = static_cast<std::int32_t>(std::min(kAround_s * rate_hz, static_cast<double>(kMaxFrames) / 2));
  const std::int32_t begin = std::max(0, gap.first - around);
  const std::int32_t end = std::min(static_cast<std::int32_t>(time_steps.size()), gap.last + 1 + around);
  Surroundings piece{.begin = begin,
                     .locations = {.rate_hz = rate_hz, .markers = {}},
                     .hole = {static_cast<std::size_t>(gap.first - begin), static_cast<std::size_t>(gap.last - begin)}};
  const auto frames = static_cast<std::size_t>(end - begin);
  for (const TrackId track : markers) {
    Locations::Marker marker{.location = Path(frames, Vector<3>::Zero()), .known = std::vector<char>(frames, 0)};
    const Tracks::Rows& rows = tracks.rows(track);
    auto row =
        std::lower_bound(rows.begin(), rows.end(), begin, [](const Tracks::Row& one, std::int32_t at) { return one.at < at; });
    for (; row != rows.end() && row->at < end; ++row) {
      if (!row->sample.measured()) continue;
      marker.location[static_cast<std::size_t>(row->at - begin)] = row->sample.position;
      marker.known[static_cast<std::size_t>(row->at - begin)] = 1;
    }
    piece.locations.markers.push_back(std::move(marker));
  }
  return piece;
}

std::optional<FilledGap> decide(Tracks& tracks, TrackId track, const Gap& gap, const std::vector<TrackId>& markers,
                                std::optional<FillMethod> required) {
  const Surroundings piece = surroundings_of(tracks, markers, gap);
  const std::vector<std::size_t> donors = donors_of(piece.locations, 0, piece.hole);
  const FillTrials trials(piece.locations, piece.hole, donors);
  std::optional<std::pair<FillMethod, FillScore>> best;
  for (const FillMethod method : {FillMethod::spline, FillMethod::rigid, FillMethod::pattern}) {
    if (required.value_or(method) != method || !filled(method, piece.locations, piece.hole, donors, piece.hole)) continue;
    const FillScore score = trials.score(method);
    if (!best || score.typical_m < best->second.typical_m) best = {method, score};
  }
  if (!best) return std::nullopt;
  const auto index = [&](std::int32_t at) { return tracks.time_steps()[static_cast<std::size_t>(at)].index; };
  FilledGap decided{.track = track,
                    .frames = {index(gap.first), index(gap.last)},
                    .method = best->first,
                    .donors = {},
                    .expected_m = best->second.expected_m,
                    .locations = *filled(best->first, piece.locations, piece.hole, donors, piece.hole)};
  if (decided.method != FillMethod::spline) {
    for (const std::size_t donor : donors) decided.donors.push_back(markers[donor]);
  }
  return decided;
}

std::int32_t instant_of(const Tracks& tracks, std::int64_t index) {
  const auto time_steps = tracks.time_steps();
  const auto found = std::partition_point(time_steps.begin(), time_steps.end(),
                                          [&](const Recording::TimeStep& time_step) { return time_step.index < index; });
  return static_cast<std::int32_t>(found - time_steps.begin());
}

}  // namespace

std::vector<FilledGap> decide_fills(Tracks& tracks, TrackId track, const std::optional<FrameRange>& frames,
                                    const FillOptions& options, OpenGaps* open) {
  OpenGaps left;
  std::vector<TrackId> markers{track};
  for (const TrackName& name : tracks.names()) {
    if (name.id != track) markers.push_back(name.id);
  }
  std::vector<FilledGap> fills;
  const Tracks::Rows& rows = tracks.rows(track);
  const auto time_steps = tracks.time_steps();
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const Gap gap{rows[row - 1].at + 1, rows[row].at - 1};
    if (gap.last < gap.first) continue;
    const auto &from = time_steps[static_cast<std::size_t>(gap.first)], &to = time_steps[static_cast<std::size_t>(gap.last)];
    if (frames && !(frames->holds(from.index) && frames->holds(to.index))) continue;
    if (seconds(to.time - from.time) > options.longest_s) {
      ++left.too_long;
      continue;
    }
    auto fill = decide(tracks, track, gap, markers, options.method);
    if (!fill) {
      ++left.unreported;
    } else if (fill->expected_m > options.within_m) {
      ++left.too_far_off;
    } else {
      fills.push_back(std::move(*fill));
    }
  }
  if (open != nullptr) {
    open->too_long += left.too_long;
    open->too_far_off += left.too_far_off;
    open->unreported += left.unreported;
  }
  return fills;
}

namespace {

[[noreturn]] void fail_to_fill(const Tracks& tracks, const FilledGap& gap) {
  throw Error("the gap of {} in frames {} to {} cannot be filled again: what it was filled from is not there any more",
              tracks.name(gap.track).label, gap.frames.first, gap.frames.last);
}

/// As it was found when it was decided.
Path found_again(Tracks& tracks, const FilledGap& gap, const Gap& at) {
  std::vector<TrackId> markers{gap.track};
  markers.insert(markers.end(), gap.donors.begin(), gap.donors.end());
  const Surroundings piece = surroundings_of(tracks, markers, at);
  std::vector<std::size_t> donors(gap.donors.size());
  for (std::size_t i = 0; i < donors.size(); ++i) donors[i] = i + 1;
  const bool reported =
      std::all_of(donors.begin(), donors.end(), [&](std::size_t one) { return piece.locations.markers[one].spans(piece.hole); });
  auto path = reported ? filled(gap.method, piece.locations, piece.hole, donors, piece.hole) : std::nullopt;
  if (!path) fail_to_fill(tracks, gap);
  return std::move(*path);
}

}  // namespace

Tracks::Rows rows_in_gap(Tracks& tracks, const FilledGap& gap) {
  const Gap at{instant_of(tracks, gap.frames.first), instant_of(tracks, gap.frames.last + 1) - 1};
  if (at.first <= 0 || at.last < at.first || at.last + 1 >= std::ssize(tracks.time_steps())) fail_to_fill(tracks, gap);
  const bool kept = std::ssize(gap.locations) == at.last - at.first + 1;
  if (!kept && !gap.locations.empty()) fail_to_fill(tracks, gap);
  const Path path = kept ? gap.locations : found_again(tracks, gap, at);
  Tracks::Rows rows;
  const double end = static_cast<double>(path.size() + 1);
  const filter::Bridge<filter::RandomWalk, 1> known_ends(Vector<1>::Zero(), 0, Vector<1>::Zero(), end);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double shape = 4 * known_ends.covariance(static_cast<double>(i + 1))(0) / end;  // 1 in the middle
    const double variance = gap.expected_m * gap.expected_m * shape / 3;                  // of each coordinate
    Sample sample;
    sample.track = gap.track;
    sample.position = path[i];
    sample.provenance = Provenance::filled;
    sample.covariance = Matrix<3>(variance * Matrix<3>::Identity());
    rows.push_back({at.first + static_cast<std::int32_t>(i), sample});
  }
  return rows;
}

}  // namespace marey::edit
