#include "marey/pipeline/identify/effects.h"

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

constexpr double kMinChange = 0.5;  // s of person-time; unswept

/// Which person has which name, by instant and place.
using NamesOfPositions = std::map<std::tuple<std::int32_t, double, double>, std::string>;

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
      if (operation.initiated) touched_.insert(*operation.initiated);
      tracks_.apply(operation);
    }
  }

  double changed_s() {
    NamesOfPositions before, after;
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
    for (const auto& [location, name] : before) {
      const auto now = after.find(location);
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
std::vector<std::string> other_answers(const ReviewItem& review_item, const Recording& recording,
                                       const std::vector<SquadMember>& squads) {
  if (review_item.kind == "exchange") return {"yes"};
  if (review_item.kind == "same") return {"no"};
  std::vector<std::string> answers;
  if (!review_item.b.empty()) answers.push_back("yes");
  for (const SquadMember& member : squads) {  // who is not in the take at all
    const auto is_called_so = [&](const TrackColumns& track) { return track.name.label == member.label(); };
    if (std::none_of(recording.tracks().begin(), recording.tracks().end(), is_called_so)) answers.push_back(member.label());
  }
  return answers;
}

}  // namespace

std::optional<double> effect_of_answer(const ReviewItem& review_item, const std::string& answer, const Recording& recording,
                                       const take::EditHistory& history, const std::vector<SquadMember>& squads,
                                       TrackId initiated) {
  ReviewItem answered = review_item;
  answered.answer = answer;
  answered.where = "an answer";
  try {
    TriedAnswer tried(recording);
    tried.apply(edits_of_answers({answered}, recording, history, squads, initiated).edits);
    return tried.changed_s();
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::vector<ReviewItem> ambiguities_that_matter(std::vector<ReviewItem> review_items, const Recording& recording,
                                                const take::EditHistory& history, const std::vector<SquadMember>& squads,
                                                TrackId initiated) {
  for (ReviewItem& review_item : review_items) {
    for (const std::string& answer : other_answers(review_item, recording, squads)) {
      const auto changed = effect_of_answer(review_item, answer, recording, history, squads, initiated);
      review_item.changes_s = std::max(review_item.changes_s, changed.value_or(0));
      if (review_item.kind == "who" && review_item.changes_s > 0) break;  // the one who it is, the same places are named
    }
  }
  std::erase_if(review_items, [](const ReviewItem& review_item) { return review_item.changes_s < kMinChange; });
  std::stable_sort(review_items.begin(), review_items.end(), [](const ReviewItem& a, const ReviewItem& b) {
    return a.probability * a.changes_s > b.probability * b.changes_s;
  });
  return review_items;
}

}  // namespace marey::pipeline::identify
