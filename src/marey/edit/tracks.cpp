#include "marey/edit/tracks.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "marey/core/error.h"
#include "marey/edit/fill_gap.h"
#include "marey/edit/lowpass.h"

namespace marey::edit {
namespace {

using Rows = Tracks::Rows;

std::string shown_name(const TrackName& name) {
  return name.label.empty() ? "track " + std::to_string(number(name.id)) : "\"" + name.label + "\"";
}

/// Takes what lies in [begin, end) out of `rows`.
Rows cut(Rows& rows, std::span<const Tracks::Row> part) {
  const auto begin = rows.begin() + (part.data() - rows.data());
  const auto end = begin + std::ssize(part);
  Rows taken(std::make_move_iterator(begin), std::make_move_iterator(end));
  rows.erase(begin, end);
  return taken;
}

/// Puts rows of instants that `rows` does not have into it.
void put_in(Rows& rows, Rows more) {
  if (more.empty()) return;
  const auto location = std::lower_bound(rows.begin(), rows.end(), more.front().at,
                                         [](const Tracks::Row& row, std::int32_t at) { return row.at < at; });
  const auto middle = rows.insert(location, std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  const auto after = middle + std::ssize(more);
  if (after != rows.end() && after->at < std::prev(after)->at) {
    std::inplace_merge(middle, after, rows.end(), [](const Tracks::Row& a, const Tracks::Row& b) { return a.at < b.at; });
  }
}

}  // namespace

Tracks::Tracks(std::vector<Recording::TimeStep> time_steps, const std::vector<TrackName>& names, Load load)
    : time_steps_(std::move(time_steps)), load_(std::move(load)) {
  for (const TrackName& name : names) {
    tracks_[name.id] = {.name = name, .rows = {}, .changed = false};
    last_id_ = std::max(last_id_, name.id);
  }
}

std::vector<TrackName> Tracks::names() const {
  std::vector<TrackName> all;
  for (const auto& [id, track] : tracks_) all.push_back(track.name);
  return all;
}

Tracks::Entry& Tracks::entry(TrackId track) {
  const auto found = tracks_.find(track);
  if (found == tracks_.end()) throw Error("there is no track {}", number(track));
  return found->second;
}

const TrackName& Tracks::name(TrackId track) const {
  const auto found = tracks_.find(track);
  if (found == tracks_.end()) throw Error("there is no track {}", number(track));
  return found->second.name;
}

bool Tracks::changed(TrackId track) const {
  const auto found = tracks_.find(track);
  return found != tracks_.end() && found->second.changed;
}

Rows& Tracks::rows(TrackId track) {
  Entry& required = entry(track);
  if (!required.rows) {
    const TrackColumns columns = load_(track);
    required.rows.emplace();
    required.rows->reserve(columns.size());
    required.dimensions = columns.dimensions();
    for (std::size_t row = 0; row < columns.size(); ++row) required.rows->push_back({columns.at()[row], columns.sample(row)});
    for (const FilledGap& gap : std::exchange(required.due, {})) put_in(*required.rows, rows_in_gap(*this, gap));
  }
  return *required.rows;
}

TrackId Tracks::unused_id() const {
  return TrackId{number(last_id_) + 1};
}

std::span<Tracks::Row> Tracks::within(Rows& rows, const std::optional<FrameRange>& frames) const {
  if (!frames) return rows;
  const auto index = [&](const Row& row) { return time_steps_[static_cast<std::size_t>(row.at)].index; };
  const auto begin = std::partition_point(rows.begin(), rows.end(), [&](const Row& row) { return index(row) < frames->first; });
  const auto end = std::partition_point(begin, rows.end(), [&](const Row& row) { return index(row) <= frames->last; });
  return {begin, end};
}

void Tracks::apply(const Operation& operation) {
  using Kind = Operation::Kind;
  switch (operation.kind) {
    case Kind::rename:
      entry(operation.tracks[0]).name.label = operation.label;
      entry(operation.tracks[0]).changed = true;
      return;
    case Kind::swap:
      return swap(operation);
    case Kind::split:
      return split(operation);
    case Kind::join:
      return join(operation);
    case Kind::remove:
      return remove(operation);
    case Kind::fill:
      return fill(operation);
    case Kind::team:
      for (const TrackId track : operation.tracks) {
        entry(track).name.team = operation.label;
        entry(track).changed = true;
      }
      return;
    case Kind::filter:
      return filter(operation);
    case Kind::turn:
      return;  // of a body (turn_body.h)
  }
}

void Tracks::swap(const Operation& operation) {
  Rows &a = rows(operation.tracks[0]), &b = rows(operation.tracks[1]);
  Rows from_a = cut(a, within(a, operation.frames)), from_b = cut(b, within(b, operation.frames));
  put_in(a, std::move(from_b));
  put_in(b, std::move(from_a));
  for (const TrackId track : operation.tracks) entry(track).changed = true;
}

void Tracks::split(const Operation& operation) {
  Rows& whole = rows(operation.tracks[0]);
  if (has(*operation.initiated)) throw Error("track {} is there already", number(*operation.initiated));
  const FrameRange later{operation.frames->first, time_steps_.empty() ? operation.frames->first : time_steps_.back().index};
  Rows part = cut(whole, within(whole, later));
  entry(operation.tracks[0]).changed = true;
  TrackName name = entry(operation.tracks[0]).name;
  name.id = *operation.initiated;
  name.label = operation.label;
  tracks_[name.id] = {.name = name, .rows = std::move(part), .changed = true};
  last_id_ = std::max(last_id_, name.id);
}

void Tracks::join(const Operation& operation) {
  const TrackId kept = operation.tracks[0], used_up = operation.tracks[1];
  Rows &a = rows(kept), &b = rows(used_up);
  Rows both;
  both.reserve(a.size() + b.size());
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both),
             [](const Row& x, const Row& y) { return x.at < y.at; });
  const auto twice = std::adjacent_find(both.begin(), both.end(), [](const Row& x, const Row& y) { return x.at == y.at; });
  if (twice != both.end())
    throw Error("{} and {} are both there in frame {}; split or delete one of them first", shown_name(name(kept)),
                shown_name(name(used_up)), time_steps_[static_cast<std::size_t>(twice->at)].index);
  a = std::move(both);
  entry(kept).changed = true;
  tracks_.erase(used_up);
}

void Tracks::remove(const Operation& operation) {
  for (const TrackId track : operation.tracks) {
    Rows& all = rows(track);
    cut(all, within(all, operation.frames));
    entry(track).changed = true;
    if (all.empty()) tracks_.erase(track);
  }
}

void Tracks::fill(const Operation& operation) {
  std::vector<Rows> filled(operation.gaps.size());  // a marker that is filled gives nothing about another
  for (std::size_t i = 0; i < filled.size(); ++i) {
    Entry& own = entry(operation.gaps[i].track);
    if (operation.gaps[i].locations.empty() || own.rows) {
      filled[i] = rows_in_gap(*this, operation.gaps[i]);
    } else {
      own.due.push_back(operation.gaps[i]);
    }
    own.changed = true;
  }
  for (std::size_t i = 0; i < filled.size(); ++i) {
    if (!filled[i].empty()) put_in(rows(operation.gaps[i].track), std::move(filled[i]));
  }
}

void Tracks::filter(const Operation& operation) {
  for (std::size_t i = 0; i < operation.tracks.size(); ++i) {
    const std::span<Row> part = within(rows(operation.tracks[i]), operation.frames);
    std::size_t begin = 0;
    while (begin < part.size()) {  // each piece without a gap by itself
      std::size_t end = begin + 1;
      while (end < part.size() && part[end].at == part[end - 1].at + 1) ++end;
      std::vector<Vector<3>> path;
      for (std::size_t row = begin; row < end; ++row) path.push_back(part[row].sample.position);
      const double rate_hz = rate_between(time_steps_, part[begin].at, part[end - 1].at);
      lowpass(path, rate_hz, operation.cutoffs_hz[i]);
      for (std::size_t row = begin; row < end; ++row) {
        part[row].sample.position = path[row - begin];
        part[row].sample.velocity.reset();
      }
      begin = end;
    }
    entry(operation.tracks[i]).changed = true;
  }
}

TrackColumns Tracks::columns(TrackId track, int dimensions) {
  const Rows& all = rows(track);
  TrackColumns columns(name(track), std::max(dimensions, entry(track).dimensions));  // a ball on the ground has a height
  columns.reserve(all.size());
  for (const Row& row : all) {
    Sample sample = row.sample;
    sample.track = track;
    columns.add(row.at, sample);
  }
  return columns;
}

}  // namespace marey::edit
