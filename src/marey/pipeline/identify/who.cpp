#include "marey/pipeline/identify/who.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/whole_file.h"
#include "marey/edit/edited.h"
#include "marey/format/take/take_file.h"
#include "marey/pipeline/identify/who_effects.h"

namespace marey::pipeline::identify {
namespace {

/// A take as its edits have left it.
struct EditedTake {
  Recording recording;
  take::EditHistory history;
  TrackId born{};  ///< the first id that no track has had
};

EditedTake edited_take(const std::string& path) {
  EditedTake take{.recording = edit::edited(format::take::read_recording(path)), .history = take::edit_history(path)};
  const take::EditHistory& history = take.history;
  require_ground(take.recording, "naming people");
  int last = 0;
  for (const TrackName& name : history.tracks) last = std::max(last, number(name.id));
  for (const take::DoneEdit& done : history.edits) {
    const bool counts = std::find(history.counting.begin(), history.counting.end(), done.edit.id) != history.counting.end();
    if (counts && done.operation && done.operation->born) last = std::max(last, number(*done.operation->born));
  }
  take.born = TrackId{last + 1};
  return take;
}

/// Names of a run before would be in the way of those of this one.
void require_unnamed(const EditedTake& take, const std::string& path, const std::vector<SquadMember>& squads) {
  for (const TrackColumns& track : take.recording.tracks()) {
    for (const SquadMember& member : squads) {
      if (track.name.label != member.label()) continue;
      throw Error("{}: #{} is called {} already; `marey edit {} --to 0` takes names and other edits back, --list shows them", path,
                  number(track.id()), member.label(), path);
    }
  }
}

/// The row of the first naming on a path.
std::size_t naming_on(std::size_t path, const track::ground::offline::GroundIdentities& found,
                      const std::vector<track::ground::offline::GroundNaming>& namings) {
  for (std::size_t i = 0; i < namings.size(); ++i) {
    if (namings[i].name != found.paths[path].name) continue;
    for (const int s : found.paths[path].stretches) {
      const auto& stretch = found.stretches[static_cast<std::size_t>(s)];
      if (stretch.tracklet == namings[i].tracklet && stretch.first <= namings[i].instant && namings[i].instant <= stretch.last)
        return i;
    }
  }
  return namings.size();
}

/// Nobody is two people at once: where no exchange leads from one naming to another, one of them is wrong.
void require_one_each(const track::ground::offline::GroundIdentities& found,
                      const std::vector<track::ground::offline::GroundNaming>& namings, const std::vector<SquadNaming>& given,
                      const std::vector<SquadMember>& squads) {
  const auto together = [&](std::size_t a, std::size_t b) {
    for (const int one : found.paths[a].stretches) {
      for (const int other : found.paths[b].stretches) {
        const auto &first = found.stretches[static_cast<std::size_t>(one)],
                   &second = found.stretches[static_cast<std::size_t>(other)];
        if (first.first <= second.last && second.first <= first.last) return true;
      }
    }
    return false;
  };
  for (std::size_t a = 0; a < found.paths.size(); ++a) {
    for (std::size_t b = a + 1; b < found.paths.size(); ++b) {
      if (found.paths[a].name < 0 || found.paths[a].name != found.paths[b].name) continue;
      if (!together(a, b)) continue;
      const std::size_t one = naming_on(a, found, namings), other = naming_on(b, found, namings);
      if (one == namings.size() || other == namings.size()) continue;
      const SquadNaming &first = given[std::min(one, other)], &second = given[std::max(one, other)];
      throw Error(
          "{}: {} is #{} at {} here and, by {}, #{} at {}; both are there at the same time, and no meeting is found at which "
          "they may have been exchanged",
          second.where, squads[static_cast<std::size_t>(second.member)].label(), second.track,
          format::match::clock_of_seconds(second.time_s), first.where, first.track, format::match::clock_of_seconds(first.time_s));
    }
  }
}

WhoSummary summary_of(const track::ground::offline::GroundIdentities& found, const NamedPaths& named, const Recording& recording,
                      const std::vector<SquadMember>& squads) {
  WhoSummary summary;
  if (!recording.instants().empty())
    summary.recorded_s = seconds(recording.instants().back().time - recording.instants().front().time);
  for (std::size_t member = 0; member < squads.size(); ++member) {
    WhoSummary::Person person{squads[member].label(), squads[member].team};
    for (std::size_t path = 0; path < found.paths.size(); ++path) {
      if (found.paths[path].name != static_cast<int>(member) || !named.tracks[path]) continue;
      person.known_s += named.known_s[path];
      if (person.track == 0) person.track = number(*named.tracks[path]);
    }
    if (person.track != 0) summary.people.push_back(std::move(person));
  }
  for (std::size_t path = 0; path < found.paths.size(); ++path) {
    if (found.paths[path].name < 0) summary.unnamed_s += named.known_s[path];
  }
  summary.left_out = named.left_out;
  return summary;
}

}  // namespace

WhoSummary name_people(const std::string& path, const WhoOptions& options, const Hooks& hooks) {
  const std::vector<SquadMember> squads = format::match::read_squads(options.roster);
  const std::vector<SquadNaming> given = format::match::read_namings(options.names, squads);
  const EditedTake take = edited_take(path);
  require_unnamed(take, path, squads);
  const TrackedPeople people = tracked_people(take.recording);
  const auto namings = namings_of(given, squads, take.recording, people);
  hooks.advance({.step = "finding who is who", .done = 0, .total = 1});
  const auto found = track::ground::offline::identify(people.tracklets, people.teams, people.times, namings);
  require_one_each(found, namings, given, squads);
  const NamedPaths named = named_paths(found, people, take.recording, squads, take.born);
  WhoSummary summary = summary_of(found, named, take.recording, squads);
  summary.doubts = doubts_of(found, people, named, take.recording, squads, options.least);
  std::optional<WholeFile> list;
  if (!options.doubts.empty()) list.emplace(options.doubts);
  const std::vector<take::DoneEdit> done = take::edit_take(path, named.edits, hooks, take.history.state);
  summary.edits = std::ssize(done);
  for (Doubt& doubt : summary.doubts) doubt.edit = done.empty() ? take.history.state.head : done.back().edit.id;
  const EditedTake now = edited_take(path);
  summary.doubts = doubts_that_matter(std::move(summary.doubts), now.recording, now.history, squads, now.born);
  if (list) {
    list->write(doubts_csv(summary.doubts));
    list->finish();
  }
  return summary;
}

AnswerSummary apply_answers(const std::string& path, const std::string& doubts, const std::string& roster, const Hooks& hooks) {
  const std::vector<Doubt> rows = read_doubts(doubts);
  const std::vector<SquadMember> squads = roster.empty() ? std::vector<SquadMember>() : format::match::read_squads(roster);
  const EditedTake take = edited_take(path);
  const AnswerEdits answers = edits_of_answers(rows, take.recording, take.history, squads, take.born);
  AnswerSummary summary{.before = answers.before};
  summary.blank = std::count_if(rows.begin(), rows.end(), [](const Doubt& row) { return row.answer.empty(); });
  summary.answered = std::ssize(rows) - summary.blank;
  if (!answers.edits.empty()) summary.edits = std::ssize(take::edit_take(path, answers.edits, hooks, take.history.state));
  return summary;
}

}  // namespace marey::pipeline::identify
