#include "marey/format/match/ground_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/core/limits.h"
#include "marey/core/text_safety.h"

namespace marey::format::match {
namespace {

constexpr double kFarthest = 1e5;  // m

bool by_frame(const GroundBuilder::Row& a, const GroundBuilder::Row& b) {
  return a.frame < b.frame;
}

void require_short(const std::string& label, const std::string& name) {
  if (label.size() <= Limits{}.label_bytes) return;
  throw Error("{}: a name has {} bytes; they have at most {} (the limit label_bytes)", name, label.size(), Limits{}.label_bytes);
}

/// Puts the frames of a person's rows, which are sorted, among those that are there already.
void add_moments(const std::deque<GroundBuilder::Row>& rows, std::vector<Recording::Moment>& moments) {
  const auto by_index = [](const Recording::Moment& a, const Recording::Moment& b) { return a.index < b.index; };
  std::vector<Recording::Moment> fresh;
  auto at = moments.begin();
  for (const GroundBuilder::Row& row : rows) {
    const Recording::Moment moment{row.frame, timestamp_from_seconds(row.time)};
    if (at == moments.begin()) at = std::lower_bound(at, moments.end(), moment, by_index);
    while (at != moments.end() && at->index < row.frame) ++at;
    if (at == moments.end() || at->index != row.frame) fresh.push_back(moment);
  }
  const auto known = std::ssize(moments);
  moments.insert(moments.end(), fresh.begin(), fresh.end());
  std::inplace_merge(moments.begin(), moments.begin() + known, moments.end(), by_index);
}

TrackColumns columns_of(const TrackName& name, const std::deque<GroundBuilder::Row>& rows,
                        const std::vector<Recording::Moment>& moments) {
  TrackColumns track(name, 2);
  track.reserve(rows.size());
  std::size_t at = 0;
  for (const GroundBuilder::Row& row : rows) {
    while (moments[at].index < row.frame) ++at;
    Sample sample;
    sample.position.head<2>() = row.place;
    if (row.velocity) sample.velocity = Vector<3>(row.velocity->x(), row.velocity->y(), 0);
    sample.provenance = row.observed ? Provenance::measured : Provenance::predicted;
    sample.cameras = row.cameras;
    track.add(static_cast<std::int32_t>(at), sample);
  }
  return track;
}

}  // namespace

std::int32_t GroundBuilder::person(const std::string& key, int wanted, const std::string& label, const std::string& team) {
  const auto [entry, is_new] = index_of_.try_emplace(key, static_cast<std::int32_t>(people_.size()));
  if (!is_new) return entry->second;
  const bool free = wanted > 0 && !by_id_.contains(wanted);
  return person(free ? wanted : by_id_.empty() ? 1 : by_id_.rbegin()->first + 1, label, team);
}

std::int32_t GroundBuilder::person(int id, const std::string& label, const std::string& team) {
  const auto [entry, is_new] = by_id_.try_emplace(id, static_cast<std::int32_t>(people_.size()));
  if (is_new) {
    require_short(label, name_);
    require_short(team, name_);
    if (people_.size() == Limits{}.tracks) throw Error("{}: names more than {} people (the limit tracks)", name_, Limits{}.tracks);
    people_.push_back({{TrackId{id}, {}, {}}, {}});
  }
  TrackName& name = people_[static_cast<std::size_t>(entry->second)].name;
  if (name.label.empty()) name.label = plain_text(label);
  if (name.team.empty()) name.team = plain_text(team);
  return entry->second;
}

void GroundBuilder::add(std::int32_t frame, double time, std::int32_t person, double x, double y, std::string_view where) {
  if (!(std::abs(x) <= kFarthest && std::abs(y) <= kFarthest))
    throw Error("{}: ({:g}, {:g}) m is no place near a pitch", where, x, y);
  add(person, {.frame = frame, .time = time, .place = {x, y}});
}

void GroundBuilder::for_each_row(const std::function<void(Row&)>& change) {
  for (Person& person : people_) {
    for (Row& row : person.rows) change(row);
  }
}

void GroundBuilder::require_once() const {
  const Person* who = nullptr;
  std::pair<std::int32_t, int> first;  // frame and id
  for (const Person& person : people_) {
    const auto twice = std::adjacent_find(person.rows.begin(), person.rows.end(),
                                          [](const Row& a, const Row& b) { return a.frame == b.frame; });
    if (twice == person.rows.end()) continue;
    const std::pair found(twice->frame, number(person.name.id));
    if (who == nullptr || found < first) who = &person, first = found;
  }
  if (who == nullptr) return;
  const TrackName& name = who->name;
  if (index_of_.empty()) throw Error("{}: person {} is twice in frame {}", name_, number(name.id), first.first);
  throw Error("{}: someone (\"{}\", team \"{}\") is twice in frame {}", name_, name.label, name.team, first.first);
}

std::vector<TrackId> GroundBuilder::finish(Recording& recording) {
  std::vector<TrackId> order;
  for (Person& person : people_) {
    order.push_back(person.name.id);
    if (!std::is_sorted(person.rows.begin(), person.rows.end(), by_frame))
      std::stable_sort(person.rows.begin(), person.rows.end(), by_frame);
  }
  require_once();
  std::vector<Recording::Moment> moments;
  for (const auto& [id, index] : by_id_) add_moments(people_[static_cast<std::size_t>(index)].rows, moments);
  FrameNumbers numbers;
  for (const Recording::Moment& moment : moments) numbers.add(moment.index);
  numbers.check(name_);
  for (const Recording::Moment& moment : moments) recording.add_moment(moment);
  for (const auto& [id, index] : by_id_) {
    Person& person = people_[static_cast<std::size_t>(index)];
    recording.put(columns_of(person.name, person.rows, moments));
    person.rows = {};
  }
  return order;
}

std::string label_of(const std::string& name, int number) {
  std::string digits = std::to_string(number);
  if (name.empty()) return digits;
  if (!name.ends_with(digits)) return name;
  const std::string rest = name.substr(0, name.size() - digits.size());
  for (const char* word : {"", "Player", "Player ", "Player No.", "Track_"}) {
    if (rest == word) return digits;
  }
  return name;
}

}  // namespace marey::format::match
