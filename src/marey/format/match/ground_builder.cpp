#include "marey/format/match/ground_builder.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/files/limits.h"
#include "marey/files/text_safety.h"

namespace marey::format::match {
namespace {

Sample sample_of(const GroundBuilder::Row& row) {
  Sample sample;
  sample.position = {row.location.x(), row.location.y(), row.height};
  if (row.velocity) sample.velocity = Vector<3>(row.velocity->x(), row.velocity->y(), row.climb);
  sample.provenance = row.provenance;
  sample.cameras = row.cameras;
  if (row.covariance) sample.covariance.emplace(Matrix<3>::Zero()).topLeftCorner<2, 2>() = *row.covariance;
  sample.box = row.box;
  sample.score = row.score;
  return sample;
}

void require_short(const std::string& label, const std::string& name) {
  if (label.size() <= Limits::in_force().label_bytes) return;
  throw Error("{}: a name has {} bytes; they have at most {} (the limit label_bytes)", name, label.size(),
              Limits::in_force().label_bytes);
}

/// Each frame once, in order.
void put_in_order(std::vector<Recording::TimeStep>& time_steps) {
  const auto before = [](const Recording::TimeStep& a, const Recording::TimeStep& b) { return a.index < b.index; };
  if (!std::is_sorted(time_steps.begin(), time_steps.end(), before)) std::stable_sort(time_steps.begin(), time_steps.end(), before);
  const auto same = [](const Recording::TimeStep& a, const Recording::TimeStep& b) { return a.index == b.index; };
  time_steps.erase(std::unique(time_steps.begin(), time_steps.end(), same), time_steps.end());
}

std::vector<std::int32_t> instants_of(std::span<const std::int32_t> frames, const std::vector<Recording::TimeStep>& time_steps) {
  std::vector<std::int32_t> instants;
  instants.reserve(frames.size());
  std::size_t at = 0;
  for (const std::int32_t frame : frames) {
    while (time_steps[at].index < frame) ++at;
    instants.push_back(static_cast<std::int32_t>(at));
  }
  return instants;
}

}  // namespace

std::int32_t GroundBuilder::person(const std::string& key, int required, const std::string& label, const std::string& team) {
  const auto [entry, is_new] = index_of_.try_emplace(key, static_cast<std::int32_t>(people_.size()));
  if (!is_new) return entry->second;
  const bool free = required > 0 && !by_id_.contains(required);
  return person(free ? required : by_id_.empty() ? 1 : by_id_.rbegin()->first + 1, label, team);
}

std::int32_t GroundBuilder::person(int id, const std::string& label, const std::string& team) {
  const auto [entry, is_new] = by_id_.try_emplace(id, static_cast<std::int32_t>(people_.size()));
  if (is_new) {
    require_short(label, name_);
    require_short(team, name_);
    if (people_.size() == Limits::in_force().tracks)
      throw Error("{}: names more than {} people (the limit tracks)", name_, Limits::in_force().tracks);
    const TrackKind kind = kind_by_label(label, team);
    people_.push_back(
        {TrackColumns({.id = TrackId{id}, .label = {}, .team = {}, .kind = kind}, kind == TrackKind::ball ? 3 : 2), {}});
  }
  TrackName& name = people_[static_cast<std::size_t>(entry->second)].rows.name;
  if (name.label.empty()) name.label = plain_text(label);
  if (name.team.empty()) name.team = plain_text(team);
  return entry->second;
}

void GroundBuilder::add(std::int32_t frame, double time, std::int32_t person, double x, double y, std::string_view where) {
  if (!(std::abs(x) <= kMaxOnGround && std::abs(y) <= kMaxOnGround))
    throw Error("{}: ({:g}, {:g}) m is not a place near a pitch", where, x, y);
  add(person, {.frame = frame, .time = time, .location = {x, y}});
}

void GroundBuilder::add(std::int32_t person, const Row& row) {
  if (time_steps_.empty() || time_steps_.back().index != row.frame)
    time_steps_.push_back({row.frame, timestamp_from_seconds(row.time)});
  Person& one = people_[static_cast<std::size_t>(person)];
  if (!one.rows.empty() && one.rows.at().back() >= row.frame) {
    one.late.push_back(row);
  } else {
    one.rows.add(row.frame, sample_of(row));
  }
}

void GroundBuilder::forget_velocities() {
  for (Person& person : people_) {
    person.rows.forget_velocities();
    for (Row& row : person.late) row.velocity.reset();
  }
}

/// Rows of one frame stay late but for one, so that they are found.
void GroundBuilder::put_in_order(Person& person) const {
  if (person.late.empty()) return;
  std::vector<std::pair<std::int32_t, Sample>> rows;
  for (std::size_t i = 0; i < person.rows.size(); ++i) rows.emplace_back(person.rows.at()[i], person.rows.sample(i));
  for (const Row& row : person.late) rows.emplace_back(row.frame, sample_of(row));
  person.late.clear();
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  TrackColumns ordered(person.rows.name, person.rows.dimensions());
  ordered.reserve(rows.size());
  for (const auto& [frame, sample] : rows) {
    if (ordered.empty() || ordered.at().back() < frame) {
      ordered.add(frame, sample);
    } else {
      person.late.push_back({.frame = frame});
    }
  }
  person.rows = std::move(ordered);
}

void GroundBuilder::require_once() const {
  const TrackName* identity = nullptr;
  std::pair<std::int32_t, int> first;  // frame and id
  for (const Person& person : people_) {
    if (person.late.empty()) continue;
    const std::pair found(person.late.front().frame, number(person.rows.id()));
    if (identity == nullptr || found < first) identity = &person.rows.name, first = found;
  }
  if (identity == nullptr) return;
  if (index_of_.empty()) throw Error("{}: person {} is twice in frame {}", name_, number(identity->id), first.first);
  throw Error("{}: a person (\"{}\", team \"{}\") is twice in frame {}", name_, identity->label, identity->team, first.first);
}

std::vector<TrackId> GroundBuilder::finish(Recording& recording) {
  std::vector<TrackId> order;
  for (Person& person : people_) {
    order.push_back(person.rows.id());
    put_in_order(person);
  }
  require_once();
  match::put_in_order(time_steps_);
  FrameNumbers numbers;
  for (const Recording::TimeStep& time_step : time_steps_) numbers.add(time_step.index);
  numbers.check(name_);
  for (const Recording::TimeStep& time_step : time_steps_) recording.add_time_step(time_step);
  for (const auto& [id, index] : by_id_) {
    TrackColumns& rows = people_[static_cast<std::size_t>(index)].rows;
    rows.set_at(instants_of(rows.at(), time_steps_));
    recording.put(std::move(rows));
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
