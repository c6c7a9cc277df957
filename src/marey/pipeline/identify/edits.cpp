#include "marey/pipeline/identify/edits.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace marey::pipeline::identify {
namespace {

using track::ground::offline::GroundIdentities;

constexpr int kNoPath = -1;  // by definition

/// Whose each row of a track is.
struct OwnedRows {
  const TrackColumns* track = nullptr;
  std::vector<int> path;  // or kNoPath
};

class Owners {
 public:
  Owners(const GroundIdentities& found, const TrackedPeople& people, const Recording& recording)
      : found_(found), recording_(recording), taken_(found.paths.size()) {
    for (std::size_t s = 0; s < found.segments.size(); ++s) {
      const int tracklet = found.segments[s].tracklet;
      segments_[people.tracklets[static_cast<std::size_t>(tracklet)].runs.front().track].push_back(static_cast<int>(s));
    }
    for (const GroundIdentities::Path& path : found.paths) {
      for (std::size_t i = 1; i < path.segments.size(); ++i) successor_[path.segments[i - 1]] = path.segments[i];
    }
    for (auto& taken : taken_) taken.assign(recording.instants().size(), false);
  }

  /// Of the tracks that were measured. What lies within a segment comes first: no person is in two places at once.
  std::vector<OwnedRows> rows() {
    std::vector<OwnedRows> all;
    for (const auto& [id, segments] : segments_) {
      OwnedRows& rows = all.emplace_back(OwnedRows{recording_.find(id), {}});
      for (std::size_t row = 0; row < rows.track->size(); ++row)
        rows.path.push_back(claim(within(segments, rows.track->at()[row]), rows.track->at()[row]));
    }
    for (OwnedRows& rows : all) {
      for (std::size_t row = 0; row < rows.path.size(); ++row) {
        const std::int32_t instant = rows.track->at()[row];
        if (rows.path[row] == kNoPath) rows.path[row] = claim(between(segments_[rows.track->id()], instant), instant);
      }
    }
    return all;
  }

 private:
  const GroundIdentities::TimeChunk& segment(int index) const { return found_.segments[static_cast<std::size_t>(index)]; }

  int claim(int path, std::int32_t instant) {
    if (path == kNoPath || taken_[static_cast<std::size_t>(path)][static_cast<std::size_t>(instant)]) return kNoPath;
    taken_[static_cast<std::size_t>(path)][static_cast<std::size_t>(instant)] = true;
    return path;
  }

  /// The first segment that begins after an instant.
  std::vector<int>::const_iterator first_after(const std::vector<int>& segments, std::int32_t instant) const {
    return std::upper_bound(segments.begin(), segments.end(), instant,
                            [&](std::int32_t sought, int s) { return sought < segment(s).first; });
  }

  int within(const std::vector<int>& segments, std::int32_t instant) const {
    const auto after = first_after(segments, instant);
    if (after == segments.begin() || segment(*std::prev(after)).last < instant) return kNoPath;
    return segment(*std::prev(after)).path;
  }

  /// What lies between two segments of one person's, or before the first or after the last of the track.
  int between(const std::vector<int>& segments, std::int32_t instant) const {
    if (instant < segment(segments.front()).first) return segment(segments.front()).path;
    const auto after = first_after(segments, instant);
    const int before = *std::prev(after);
    const auto next = successor_.find(before);
    if (after == segments.end()) return next == successor_.end() ? segment(before).path : kNoPath;
    return next != successor_.end() && next->second == *after ? segment(before).path : kNoPath;
  }

  const GroundIdentities& found_;
  const Recording& recording_;
  std::map<TrackId, std::vector<int>> segments_;  // of each track, by time
  std::map<int, int> successor_;                  // of segments, within paths
  std::vector<std::vector<bool>> taken_;          // of each path, by instant
};

class Namer {
 public:
  Namer(const GroundIdentities& found, const Recording& recording, TrackId initiated)
      : found_(found), recording_(recording), next_(number(initiated)), parts_(found.paths.size()) {
    named_.tracks.resize(found.paths.size());
    named_.known_s.assign(found.paths.size(), 0);
  }

  NamedPaths name(const std::vector<OwnedRows>& all, const std::vector<SquadMember>& squads) {
    for (const OwnedRows& rows : all) take_apart(rows);
    for (std::size_t path = 0; path < parts_.size(); ++path) put_together(path, squads);
    return std::move(named_);
  }

 private:
  struct PathPart {
    std::int32_t first = 0;
    int track = 0;
    const TrackName* was = nullptr;
  };

  void edit(std::string text) { named_.edits.push_back({.text = std::move(text), .where = "naming people"}); }

  void take_apart(const OwnedRows& rows) {
    struct Run {
      std::size_t first = 0;
      int path = kNoPath;
    };
    std::vector<Run> runs;
    for (std::size_t row = 0; row < rows.path.size(); ++row) {
      if (runs.empty() || runs.back().path != rows.path[row]) runs.push_back({row, rows.path[row]});
      if (rows.path[row] != kNoPath) named_.known_s[static_cast<std::size_t>(rows.path[row])] += 1 / recording_.header.rate_hz;
    }
    for (std::size_t r = runs.size(); r-- > 0;) {
      int id = number(rows.track->id());
      const std::int32_t first = rows.track->at()[runs[r].first];
      if (r > 0) {
        edit(fmt::format("split #{} {}", id, recording_.instants()[static_cast<std::size_t>(first)].index));
        id = next_++;
      }
      if (runs[r].path == kNoPath) {
        edit(fmt::format("delete #{}", id));
        const std::size_t end = r + 1 < runs.size() ? runs[r + 1].first : rows.path.size();
        named_.excluded += static_cast<std::int64_t>(end - runs[r].first);
      } else {
        parts_[static_cast<std::size_t>(runs[r].path)].push_back({first, id, &rows.track->name});
      }
    }
  }

  void put_together(std::size_t path, const std::vector<SquadMember>& squads) {
    std::vector<PathPart>& parts = parts_[path];
    if (parts.empty()) return;
    std::sort(parts.begin(), parts.end(), [](const PathPart& a, const PathPart& b) { return a.first < b.first; });
    const int id = parts.front().track;
    named_.tracks[path] = TrackId{id};
    for (std::size_t i = 1; i < parts.size(); ++i) edit(fmt::format("join #{} #{}", id, parts[i].track));
    const int name = found_.paths[path].name;
    if (name < 0) return;
    const SquadMember& member = squads[static_cast<std::size_t>(name)];
    edit(fmt::format("rename #{} {}", id, quoted_name(member.label())));
    if (!member.team.empty() && member.team != parts.front().was->team)
      edit(fmt::format("team #{} {}", id, quoted_name(member.team)));
  }

  const GroundIdentities& found_;
  const Recording& recording_;
  int next_;
  std::vector<std::vector<PathPart>> parts_;  // of each path
  NamedPaths named_;
};

}  // namespace

std::string quoted_name(const std::string& name) {
  return '"' + name + '"';
}

NamedPaths named_paths(const GroundIdentities& found, const TrackedPeople& people, const Recording& recording,
                       const std::vector<SquadMember>& squads, TrackId initiated) {
  return Namer(found, recording, initiated).name(Owners(found, people, recording).rows(), squads);
}

}  // namespace marey::pipeline::identify
