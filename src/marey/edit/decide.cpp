#include "marey/edit/decide.h"

#include <algorithm>
#include <charconv>

#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/edit/fill_gap.h"
#include "marey/edit/lowpass.h"
#include "marey/files/text_safety.h"
#include "marey/geometry/median.h"

namespace marey::edit {
namespace {

using Kind = Operation::Kind;

constexpr double kDefaultCutoff_hz = 6;  // of walking (Winter), where a path is too short to propose one

TrackId track_named(const std::string& name, const std::vector<TrackName>& names) {
  if (name.starts_with('#')) {
    int id = 0;
    const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), id);
    const bool whole = error == std::errc() && end == name.data() + name.size();
    for (const TrackName& track : names) {
      if (whole && number(track.id) == id) return track.id;
    }
    throw Error("there is no track {}", plain_text(name));
  }
  const auto named = [&](const TrackName& track) { return track.label == name; };
  const auto found = std::find_if(names.begin(), names.end(), named);
  if (found == names.end()) throw Error("there is no track called \"{}\"", plain_text(name));
  if (std::count_if(names.begin(), names.end(), named) > 1)
    throw Error("several tracks are called \"{}\"; name one by its number, as #{}", plain_text(name), number(found->id));
  return found->id;
}

std::vector<TrackId> tracks_named(const Request& request, const std::vector<TrackName>& names) {
  std::vector<TrackId> tracks;
  const bool all = request.tracks.size() == 1 && request.tracks[0] == "all" &&
                   std::none_of(names.begin(), names.end(), [](const TrackName& track) { return track.label == "all"; });
  if (all && (request.kind == Kind::fill || request.kind == Kind::filter)) {
    for (const TrackName& track : names) tracks.push_back(track.id);
    return tracks;
  }
  for (const std::string& name : request.tracks) {
    const TrackId track = track_named(name, names);
    if (std::find(tracks.begin(), tracks.end(), track) != tracks.end())
      throw Error("{}: \"{}\" is named twice", name_of(request.kind), plain_text(name));
    tracks.push_back(track);
  }
  return tracks;
}

/// The cut-off of one track: residual analysis on its longest piece without a gap.
double cutoff_of(Tracks& tracks, TrackId track) {
  const Tracks::Rows& rows = tracks.rows(track);
  std::size_t best_begin = 0, best_end = 0;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin + 1;
    while (end < rows.size() && rows[end].at == rows[end - 1].at + 1) ++end;
    if (end - begin > best_end - best_begin) best_begin = begin, best_end = end;
    begin = end;
  }
  if (best_end - best_begin < 2) return kDefaultCutoff_hz;
  std::vector<Vector<3>> path;
  for (std::size_t row = best_begin; row < best_end; ++row) path.push_back(rows[row].sample.position);
  const double rate_hz = rate_between(tracks.time_steps(), rows[best_begin].at, rows[best_end - 1].at);
  return proposed_cutoff(path, rate_hz).value_or(kDefaultCutoff_hz);
}

/// Throws Error if a filter would do nothing at this cut-off: two passes at half the rate or above.
double require_cutoff(double cutoff_hz, const Tracks& tracks) {
  const auto time_steps = tracks.time_steps();
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < time_steps.size(); ++i) steps_s.push_back(seconds(time_steps[i].time - time_steps[i - 1].time));
  if (steps_s.empty()) return cutoff_hz;
  const auto median = geometry::median(steps_s);  // instants may be omitted
  if (!(median > 0)) return cutoff_hz;
  const double rate_hz = 1 / median;
  if (cutoff_hz < highest_cutoff(rate_hz)) return cutoff_hz;
  throw Error("filter: at {:.4g} frames a second a cut-off of {:g} Hz would change nothing; it lies below {:.1f} Hz", rate_hz,
              cutoff_hz, highest_cutoff(rate_hz));
}

/// A range that ends after the recording is a slip of the pen; one without an end goes as far as there is.
void require_frames(const Request& request, const Tracks& tracks) {
  if (!request.frames || request.frames->last == FrameRange::kToTheEnd || tracks.time_steps().empty()) return;
  const std::int64_t last = tracks.time_steps().back().index;
  if (request.frames->last > last)
    throw Error("{}: frame {} is named, and the last one is {}", name_of(request.kind), request.frames->last, last);
}

void require_rows(const Request& request, Tracks& tracks, const std::vector<TrackId>& named) {
  if (!request.frames || request.kind == Kind::fill) return;
  const auto within = [&](TrackId track) {
    const auto& rows = tracks.rows(track);
    return std::any_of(rows.begin(), rows.end(), [&](const Tracks::Row& row) {
      const std::int64_t index = tracks.time_steps()[static_cast<std::size_t>(row.at)].index;
      return request.kind == Kind::split ? index >= request.frames->first : request.frames->holds(index);
    });
  };
  if (std::none_of(named.begin(), named.end(), within))
    throw Error("{}: nothing is there in frames {} to {}", name_of(request.kind), request.frames->first, request.frames->last);
}

/// Pieces of one marker may share its name; two that are there at once may not: files know markers by their names.
void require_free_name(const Request& request, Tracks& tracks, TrackId named, const std::vector<TrackName>& names) {
  if (request.label.empty()) return;
  const auto begins = [&](const Tracks::Row& row) {
    return request.kind != Kind::split || tracks.time_steps()[static_cast<std::size_t>(row.at)].index >= request.frames->first;
  };
  for (const TrackName& other : names) {
    if (other.id == named || other.label != request.label) continue;
    const Tracks::Rows& theirs = tracks.rows(other.id);
    for (const Tracks::Row& row : tracks.rows(named)) {
      const auto same = std::lower_bound(theirs.begin(), theirs.end(), row.at,
                                         [](const Tracks::Row& their, std::int32_t at) { return their.at < at; });
      if (begins(row) && same != theirs.end() && same->at == row.at)
        throw Error(
            "{}: #{} is called \"{}\" already and is there at the same time, as in frame {}; rename, join or delete it first",
            name_of(request.kind), number(other.id), plain_text(request.label),
            tracks.time_steps()[static_cast<std::size_t>(row.at)].index);
    }
  }
}

}  // namespace

std::string words_of(const OpenGaps& open, const Request& request) {
  if (open.all() == 0) return "there is no gap to fill";
  std::vector<std::string> why;
  if (open.too_long > 0) why.push_back(fmt::format("{} longer than {:g} s (longest=)", open.too_long, request.longest_s));
  if (open.too_far_off > 0)
    why.push_back(fmt::format("{} expected to be filled with an error of more than {:g} mm (within=)", open.too_far_off,
                              1e3 * request.within_m));
  if (open.unreported > 0)
    why.push_back(fmt::format("{} for which there is too little to tell the position from", open.unreported));
  return fmt::format("{} {} open: {}", open.all(), open.all() == 1 ? "gap stays" : "gaps stay", fmt::join(why, ", "));
}

Operation decide(const Request& request, Tracks& tracks, OpenGaps* open) {
  const std::vector<TrackName> names = tracks.names();
  Operation operation{
      .kind = request.kind, .tracks = tracks_named(request, names), .frames = request.frames, .label = request.label};
  require_frames(request, tracks);
  require_rows(request, tracks, operation.tracks);
  if (!operation.tracks.empty() && request.kind != Kind::team) require_free_name(request, tracks, operation.tracks.front(), names);
  if (request.kind == Kind::split) operation.initiated = tracks.unused_id();
  if (request.kind == Kind::filter) {
    for (const TrackId track : operation.tracks)
      operation.cutoffs_hz.push_back(request.cutoff_hz ? require_cutoff(*request.cutoff_hz, tracks) : cutoff_of(tracks, track));
  }
  if (request.kind == Kind::fill) {
    OpenGaps left;
    for (const TrackId track : operation.tracks) {
      const auto fills =
          decide_fills(tracks, track, request.frames,
                       {.method = request.method, .longest_s = request.longest_s, .within_m = request.within_m}, &left);
      operation.gaps.insert(operation.gaps.end(), fills.begin(), fills.end());
    }
    operation.tracks.clear();
    if (open != nullptr) *open = left;
    if (operation.gaps.empty() && open == nullptr) throw Error("fill: {}", words_of(left, request));
  }
  return operation;
}

}  // namespace marey::edit
