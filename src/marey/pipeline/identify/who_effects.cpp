#include "marey/pipeline/identify/who_effects.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "marey/core/error.h"
#include "marey/edit/decide.h"
#include "marey/edit/tracks.h"

namespace marey::pipeline::identify {
namespace {

constexpr double kLeastChange = 0.5;  // s of person-time; unswept

/// Who bears which name where: by instant and place.
using NamesOfPlaces = std::map<std::tuple<std::int32_t, double, double>, std::string>;

class TriedAnswer {
 public:
  explicit TriedAnswer(const Recording& recording)
      : recording_(recording),
        tracks_({recording.instants().begin(), recording.instants().end()}, names_of(recording),
                [&recording](TrackId track) { return *recording.find(track); }) {}

  void apply(const std::vector<take::EditRequest>& edits) {
    for (const take::EditRequest& edit : edits) {
      const edit::Operation operation = edit::decide(edit::parse_request(edit.text), tracks_);
      touched_.insert(operation.tracks.begin(), operation.tracks.end());
      if (operation.born) touched_.insert(*operation.born);
      tracks_.apply(operation);
    }
  }

  double changed_s() {
    NamesOfPlaces before, after;
    for (const TrackId id : touched_) {
      if (const TrackColumns* track = recording_.find(id)) {
        for (std::size_t row = 0; row < track->size(); ++row)
          before[{track->at()[row], track->x()[row], track->y()[row]}] = track->name.label;
      }
      if (!tracks_.has(id)) continue;
      for (const edit::Tracks::Row& row : tracks_.rows(id))
        after[{row.at, row.sample.position.x(), row.sample.position.y()}] = tracks_.name(id).label;
    }
    std::int64_t changed = 0;
    for (const auto& [place, name] : before) {
      const auto now = after.find(place);
      changed += now == after.end() || now->second != name;
    }
    return static_cast<double>(changed) / recording_.header.rate_hz;
  }

 private:
  static std::vector<TrackName> names_of(const Recording& recording) {
    std::vector<TrackName> names;
    for (const TrackColumns& track : recording.tracks()) names.push_back(track.name);
    return names;
  }

  const Recording& recording_;
  edit::Tracks tracks_;
  std::set<TrackId> touched_;
};

/// The answers to a doubt that are not what the take says already.
std::vector<std::string> other_answers(const Doubt& doubt, const Recording& recording, const std::vector<SquadMember>& squads) {
  if (doubt.kind == "exchange") return {"yes"};
  if (doubt.kind == "same") return {"no"};
  std::vector<std::string> answers;
  if (!doubt.b.empty()) answers.push_back("yes");
  for (const SquadMember& member : squads) {  // who is not in the take at all
    const auto is_called_so = [&](const TrackColumns& track) { return track.name.label == member.label(); };
    if (std::none_of(recording.tracks().begin(), recording.tracks().end(), is_called_so)) answers.push_back(member.label());
  }
  return answers;
}

}  // namespace

std::optional<double> effect_of_answer(const Doubt& doubt, const std::string& answer, const Recording& recording,
                                       const take::EditHistory& history, const std::vector<SquadMember>& squads, TrackId born) {
  Doubt answered = doubt;
  answered.answer = answer;
  answered.where = "an answer";
  try {
    TriedAnswer tried(recording);
    tried.apply(edits_of_answers({answered}, recording, history, squads, born).edits);
    return tried.changed_s();
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::vector<Doubt> doubts_that_matter(std::vector<Doubt> doubts, const Recording& recording, const take::EditHistory& history,
                                      const std::vector<SquadMember>& squads, TrackId born) {
  for (Doubt& doubt : doubts) {
    for (const std::string& answer : other_answers(doubt, recording, squads)) {
      const auto changed = effect_of_answer(doubt, answer, recording, history, squads, born);
      doubt.changes_s = std::max(doubt.changes_s, changed.value_or(0));
      if (doubt.kind == "who" && doubt.changes_s > 0) break;  // whoever it is, the same places are named
    }
  }
  std::erase_if(doubts, [](const Doubt& doubt) { return doubt.changes_s < kLeastChange; });
  std::stable_sort(doubts.begin(), doubts.end(),
                   [](const Doubt& a, const Doubt& b) { return a.probability * a.changes_s > b.probability * b.changes_s; });
  return doubts;
}

}  // namespace marey::pipeline::identify
