#include "marey/pipeline/identify/identify.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/edit/edited.h"
#include "marey/files/whole_file.h"
#include "marey/format/take/take_file.h"
#include "marey/pipeline/identify/effects.h"
#include "marey/pipeline/identify/numbers.h"

namespace marey::pipeline::identify {
namespace {

/// A take as its edits have left it.
struct EditedTake {
  Recording recording;
  take::EditHistory history;
  TrackId initiated{};  ///< the first id that no track has had
};

EditedTake edited_take(const std::string& path) {
  EditedTake take{.recording = edit::edited(format::take::read_recording(path)), .history = take::edit_history(path)};
  const take::EditHistory& history = take.history;
  require_ground(take.recording, "naming people");
  int last = 0;
  for (const TrackName& name : history.tracks) last = std::max(last, number(name.id));
  for (const take::DoneEdit& done : history.edits) {
    const bool counts = std::find(history.counting.begin(), history.counting.end(), done.edit.id) != history.counting.end();
    if (counts && done.operation && done.operation->initiated) last = std::max(last, number(*done.operation->initiated));
  }
  take.initiated = TrackId{last + 1};
  return take;
}

/// Names of a run before would conflict with those of this one.
void require_unnamed(const EditedTake& take, const std::string& path, const std::vector<SquadMember>& squads) {
  for (const TrackColumns& track : take.recording.tracks()) {
    for (const SquadMember& member : squads) {
      if (track.name.label != member.label()) continue;
      throw Error("{}: #{} is called {} already; `marey edit {} --undo-to 0` takes names and other edits back, --list shows them",
                  path, number(track.id()), member.label(), path);
    }
  }
}

/// The row of the first naming on a path.
std::size_t naming_on(std::size_t path, const track::ground::offline::GroundIdentities& found,
                      const std::vector<track::ground::offline::IdentityAnnotation>& namings) {
  for (std::size_t i = 0; i < namings.size(); ++i) {
    if (namings[i].name != found.paths[path].name) continue;
    for (const int s : found.paths[path].segments) {
      const auto& segment = found.segments[static_cast<std::size_t>(s)];
      if (segment.tracklet == namings[i].tracklet && segment.first <= namings[i].instant && namings[i].instant <= segment.last)
        return i;
    }
  }
  return namings.size();
}

/// Two rows that make one person two people at once: no exchange leads from one to the other.
std::optional<std::pair<std::size_t, std::size_t>> contradiction(
    const track::ground::offline::GroundIdentities& found, const std::vector<track::ground::offline::IdentityAnnotation>& namings) {
  const auto together = [&](std::size_t a, std::size_t b) {
    for (const int one : found.paths[a].segments) {
      for (const int other : found.paths[b].segments) {
        const auto &first = found.segments[static_cast<std::size_t>(one)],
                   &second = found.segments[static_cast<std::size_t>(other)];
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
      return std::pair(std::min(one, other), std::max(one, other));
    }
  }
  return std::nullopt;
}

[[noreturn]] void fail_contradiction(const SquadNaming& first, const SquadNaming& second, const std::vector<SquadMember>& squads) {
  throw Error(
      "{}: {} is #{} at {} here and, by {}, #{} at {}; both are there at the same time, and no meeting is found at which "
      "they may have been exchanged",
      second.where, squads[static_cast<std::size_t>(second.member)].label(), second.track,
      format::match::clock_of_seconds(second.time_s), first.where, first.track, format::match::clock_of_seconds(first.time_s));
}

/// Who is who by the rows of a hand and those of read numbers. A number that contradicts another row is dropped, with a message;
/// two rows of a hand that do are an Error.
track::ground::offline::GroundIdentities identities_of(const std::vector<SquadNaming>& given, NumberNamings& numbers,
                                                       const std::vector<SquadMember>& squads, const Recording& recording,
                                                       const TrackedPeople& people) {
  while (true) {
    std::vector<SquadNaming> rows = given;
    rows.insert(rows.end(), numbers.namings.begin(), numbers.namings.end());
    std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
    const auto namings = namings_of(rows, squads, recording, people);
    auto found = track::ground::offline::identify(people.tracklets, people.teams, people.times, namings);
    const auto pair = contradiction(found, namings);
    if (!pair) return found;
    const std::size_t before = numbers.namings.size();
    std::erase_if(numbers.namings, [&](const SquadNaming& read) {
      const bool is_one = read.where == rows[pair->first].where || read.where == rows[pair->second].where;
      if (is_one)
        numbers.messages.push_back(fmt::format("#{} has the number of {}, who is another person at the same time: it is not used",
                                               read.track, squads[static_cast<std::size_t>(read.member)].label()));
      return is_one;
    });
    if (numbers.namings.size() == before) fail_contradiction(rows[pair->first], rows[pair->second], squads);
  }
}

IdentifySummary summary_of(const track::ground::offline::GroundIdentities& found, const NamedPaths& named,
                           const Recording& recording, const std::vector<SquadMember>& squads) {
  IdentifySummary summary;
  if (!recording.instants().empty())
    summary.recorded_s = seconds(recording.instants().back().time - recording.instants().front().time);
  for (std::size_t member = 0; member < squads.size(); ++member) {
    IdentifySummary::Person person{squads[member].label(), squads[member].team};
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
  summary.excluded = named.excluded;
  return summary;
}

}  // namespace

IdentifySummary name_people(const std::string& path, const IdentifyOptions& options, const Hooks& hooks) {
  const std::vector<SquadMember> squads = format::match::read_squads(options.roster);
  std::vector<SquadNaming> given;
  if (!options.names.empty()) given = format::match::read_namings(options.names, squads);
  std::vector<ReadNumber> numbers;
  if (!options.numbers.empty()) numbers = read_numbers(options.numbers);
  const EditedTake take = edited_take(path);
  require_unnamed(take, path, squads);
  NumberNamings by_number = namings_by_numbers(numbers, options.min_number, squads, given, take.recording);
  if (given.empty() && by_number.namings.empty())
    throw Error("{}: no number names a person{}", options.numbers,
                by_number.messages.empty() ? "" : fmt::format(" ({})", by_number.messages.front()));
  const TrackedPeople people = tracked_people(take.recording);
  hooks.advance({.step = "finding who is who", .done = 0, .total = 1});
  const auto found = identities_of(given, by_number, squads, take.recording, people);
  const NamedPaths named = named_paths(found, people, take.recording, squads, take.initiated);
  IdentifySummary summary = summary_of(found, named, take.recording, squads);
  summary.unused_numbers = by_number.messages;
  summary.numbered = std::ssize(by_number.namings);
  summary.review_items = review_items_of(found, people, named, take.recording, squads, options.minimum);
  std::optional<WholeFile> list;
  if (!options.review_items.empty()) list.emplace(options.review_items);
  const std::vector<take::DoneEdit> done = take::edit_take(path, named.edits, hooks, take.history.state);
  summary.edits = std::ssize(done);
  for (ReviewItem& review_item : summary.review_items)
    review_item.edit = done.empty() ? take.history.state.head : done.back().edit.id;
  const EditedTake now = edited_take(path);
  summary.review_items =
      ambiguities_that_matter(std::move(summary.review_items), now.recording, now.history, squads, now.initiated);
  if (list) {
    list->write(review_csv(summary.review_items));
    list->finish();
  }
  return summary;
}

AnswerSummary apply_answers(const std::string& path, const std::string& review_items, const std::string& roster,
                            const Hooks& hooks) {
  const std::vector<ReviewItem> rows = read_review_items(review_items);
  const std::vector<SquadMember> squads = roster.empty() ? std::vector<SquadMember>() : format::match::read_squads(roster);
  const EditedTake take = edited_take(path);
  const AnswerEdits answers = edits_of_answers(rows, take.recording, take.history, squads, take.initiated);
  AnswerSummary summary{.before = answers.before};
  summary.blank = std::count_if(rows.begin(), rows.end(), [](const ReviewItem& row) { return row.answer.empty(); });
  summary.answered = std::ssize(rows) - summary.blank;
  if (!answers.edits.empty()) summary.edits = std::ssize(take::edit_take(path, answers.edits, hooks, take.history.state));
  return summary;
}

}  // namespace marey::pipeline::identify
