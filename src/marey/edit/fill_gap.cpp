#include "marey/edit/fill_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "marey/core/error.h"
#include "marey/edit/gap_methods.h"
#include "marey/edit/lowpass.h"

namespace marey::edit {
namespace {

using Path = std::vector<Vector<3>>;

constexpr double kAround_s = 20;           // of the recording on either side of a gap, that is looked at
constexpr std::size_t kMostFrames = 4000;  // of it
constexpr std::size_t kMostTrials = 24;    // holes that a method is tried on
constexpr double kShortUntried_s = 0.15;   // where nothing can be tried: a polynomial up to here
constexpr double kUntriedShare = 0.1;      // and what it is expected to be off, as a share of how far the marker went

/// A gap by the recording's instants, both ends included.
struct Gap {
  std::int32_t first = 0, last = 0;
};

/// A piece of the recording round a gap, and the gap in it.
struct Surroundings {
  std::int32_t begin = 0;  // the instant that is frame 0 of the piece
  Places places;
  Hole hole;
};

Surroundings surroundings_of(Tracks& tracks, const std::vector<TrackId>& markers, const Gap& gap) {
  const auto moments = tracks.moments();
  const double rate_hz = rate_between(moments, gap.first - 1, gap.last + 1);
  const auto around = static_cast<std::int32_t>(std::min(kAround_s * rate_hz, static_cast<double>(kMostFrames) / 2));
  const std::int32_t begin = std::max(0, gap.first - around);
  const std::int32_t end = std::min(static_cast<std::int32_t>(moments.size()), gap.last + 1 + around);
  Surroundings piece{.begin = begin,
                     .places = {.rate_hz = rate_hz, .markers = {}},
                     .hole = {static_cast<std::size_t>(gap.first - begin), static_cast<std::size_t>(gap.last - begin)}};
  const auto frames = static_cast<std::size_t>(end - begin);
  for (const TrackId track : markers) {
    Places::Marker marker{.place = Path(frames, Vector<3>::Zero()), .known = std::vector<char>(frames, 0)};
    const Tracks::Rows& rows = tracks.rows(track);
    auto row =
        std::lower_bound(rows.begin(), rows.end(), begin, [](const Tracks::Row& one, std::int32_t at) { return one.at < at; });
    for (; row != rows.end() && row->at < end; ++row) {
      if (!row->sample.measured()) continue;
      marker.place[static_cast<std::size_t>(row->at - begin)] = row->sample.position;
      marker.known[static_cast<std::size_t>(row->at - begin)] = 1;
    }
    piece.places.markers.push_back(std::move(marker));
  }
  return piece;
}

std::optional<Path> filled(FillMethod method, const Places& places, const Hole& hole, const std::vector<std::size_t>& donors,
                           const Hole& hidden) {
  if (method == FillMethod::spline) return spline_fill(places, 0, hole);
  if (method == FillMethod::rigid) return rigid_fill(places, 0, hole, donors);
  return pattern_fill(places, 0, hole, donors, hidden);
}

/// Holes as long as the gap, where the marker and the donors were seen: the nearest ones, on both sides.
std::vector<Hole> trials(const Places& places, const Hole& gap, const std::vector<std::size_t>& donors) {
  std::vector<Hole> all;
  const std::size_t step = std::max<std::size_t>(1, gap.size() / 3);
  for (std::size_t first = 1; first + gap.size() < places.size(); first += step) {
    const Hole hole{first, first + gap.size() - 1};
    const bool whole = places.markers[0].spans(hole) && std::all_of(donors.begin(), donors.end(), [&](std::size_t donor) {
                         return places.markers[donor].spans(hole);
                       });
    if (whole) all.push_back(hole);
  }
  const auto away = [&](const Hole& hole) { return std::abs(static_cast<double>(hole.first) - static_cast<double>(gap.first)); };
  std::stable_sort(all.begin(), all.end(), [&](const Hole& a, const Hole& b) { return away(a) < away(b); });
  if (all.size() > kMostTrials) all.resize(kMostTrials);
  return all;
}

struct Judged {
  double mean_square = std::numeric_limits<double>::infinity();  // m²
  double expected_m = 0;
};

/// How a method did on the trials; an infinite error where it could not say anything anywhere.
Judged judge(FillMethod method, const Places& places, const Hole& gap, const std::vector<std::size_t>& donors,
             const std::vector<Hole>& holes) {
  double squares = 0;
  std::size_t count = 0;
  std::vector<double> middle;  // errors in the middle half of the holes
  for (const Hole& hole : holes) {
    const auto path = filled(method, places, hole, donors, gap);
    if (!path) continue;
    for (std::size_t i = 0; i < path->size(); ++i) {
      const double error = ((*path)[i] - places.markers[0].place[hole.first + i]).norm();
      squares += error * error;
      ++count;
      if (4 * i + 1 >= path->size() && 4 * i <= 3 * path->size()) middle.push_back(error);
    }
  }
  if (count == 0) return {};
  // Nine tenths of the errors lie within two deviations.
  const auto tenth = middle.begin() + static_cast<std::ptrdiff_t>(middle.size() * 9 / 10);
  std::nth_element(middle.begin(), tenth, middle.end());
  return {squares / static_cast<double>(count), std::max(0.5 * *tenth, 1e-5)};
}

/// Where nothing could be tried: what the field's rule says.
Judged untried(FillMethod method, const Places& places, const Hole& gap) {
  const bool brief = static_cast<double>(gap.size()) <= kShortUntried_s * places.rate_hz;
  const double went = (places.markers[0].place[gap.last + 1] - places.markers[0].place[gap.first - 1]).norm();
  const double rank = method == FillMethod::rigid ? 1 : (method == FillMethod::spline) == brief ? 0 : 2;
  return {1 + rank, std::max(kUntriedShare * went, 0.005)};
}

std::optional<FilledGap> decide(Tracks& tracks, TrackId track, const Gap& gap, const std::vector<TrackId>& markers,
                                std::optional<FillMethod> wanted) {
  const Surroundings piece = surroundings_of(tracks, markers, gap);
  const std::vector<std::size_t> donors = donors_of(piece.places, 0, piece.hole);
  const std::vector<Hole> holes = trials(piece.places, piece.hole, donors);
  std::optional<std::pair<FillMethod, Judged>> best;
  for (const FillMethod method : {FillMethod::spline, FillMethod::rigid, FillMethod::pattern}) {
    if ((wanted && method != *wanted) || !filled(method, piece.places, piece.hole, donors, piece.hole)) continue;
    Judged judged = judge(method, piece.places, piece.hole, donors, holes);
    if (holes.empty()) judged = untried(method, piece.places, piece.hole);
    if (!best || judged.mean_square < best->second.mean_square) best = {method, judged};
  }
  if (!best) return std::nullopt;
  const auto index = [&](std::int32_t at) { return tracks.moments()[static_cast<std::size_t>(at)].index; };
  FilledGap decided{.track = track,
                    .frames = {index(gap.first), index(gap.last)},
                    .method = best->first,
                    .donors = {},
                    .expected_m = best->second.expected_m,
                    .places = *filled(best->first, piece.places, piece.hole, donors, piece.hole)};
  if (decided.method != FillMethod::spline) {
    for (const std::size_t donor : donors) decided.donors.push_back(markers[donor]);
  }
  return decided;
}

std::int32_t instant_of(const Tracks& tracks, std::int64_t index) {
  const auto moments = tracks.moments();
  const auto found =
      std::partition_point(moments.begin(), moments.end(), [&](const Recording::Moment& moment) { return moment.index < index; });
  return static_cast<std::int32_t>(found - moments.begin());
}

}  // namespace

std::vector<FilledGap> decide_fills(Tracks& tracks, TrackId track, const std::optional<FrameRange>& frames,
                                    const FillOptions& options) {
  std::vector<TrackId> markers{track};
  for (const TrackName& name : tracks.names()) {
    if (name.id != track) markers.push_back(name.id);
  }
  std::vector<FilledGap> fills;
  const Tracks::Rows& rows = tracks.rows(track);
  const auto moments = tracks.moments();
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const Gap gap{rows[row - 1].at + 1, rows[row].at - 1};
    if (gap.last < gap.first) continue;
    const auto &from = moments[static_cast<std::size_t>(gap.first)], &to = moments[static_cast<std::size_t>(gap.last)];
    if (frames && !(frames->holds(from.index) && frames->holds(to.index))) continue;
    if (seconds(to.time - from.time) > options.longest_s) continue;
    auto fill = decide(tracks, track, gap, markers, options.method);
    if (fill && fill->expected_m <= options.within_m) fills.push_back(std::move(*fill));
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
  const bool told =
      std::all_of(donors.begin(), donors.end(), [&](std::size_t one) { return piece.places.markers[one].spans(piece.hole); });
  auto path = told ? filled(gap.method, piece.places, piece.hole, donors, piece.hole) : std::nullopt;
  if (!path) fail_to_fill(tracks, gap);
  return std::move(*path);
}

}  // namespace

Tracks::Rows rows_in_gap(Tracks& tracks, const FilledGap& gap) {
  const Gap at{instant_of(tracks, gap.frames.first), instant_of(tracks, gap.frames.last + 1) - 1};
  if (at.first <= 0 || at.last < at.first || at.last + 1 >= std::ssize(tracks.moments())) fail_to_fill(tracks, gap);
  const bool kept = std::ssize(gap.places) == at.last - at.first + 1;
  if (!kept && !gap.places.empty()) fail_to_fill(tracks, gap);
  const Path path = kept ? gap.places : found_again(tracks, gap, at);
  Tracks::Rows rows;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double share = static_cast<double>(i + 1) / static_cast<double>(path.size() + 1);
    const double variance = gap.expected_m * gap.expected_m * 4 * share * (1 - share) / 3;  // of each coordinate
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
