#include "marey/pipeline/keypoints/placed_people.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace marey::pipeline::keypoints {
namespace {

using reconstruct::keypoints::PlacedPerson;

std::optional<Vector<3>> mean_place(const PlacedPerson& person) {
  Vector<3> sum = Vector<3>::Zero();
  double count = 0;
  for (const auto& point : person.points) {
    if (point) sum += point->position, ++count;
  }
  if (count == 0) return std::nullopt;
  return Vector<3>(sum / count);
}

}  // namespace

PlacedPeople::PlacedPeople(const KeypointSet& set, const PlacedPeopleOptions& options) : set_(set), options_(options) {}

const PlacedPeople::Slot* PlacedPeople::slot_of(int person) const {
  const auto found = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.person == person; });
  return found == slots_.end() ? nullptr : &*found;
}

PlacedPeople::Slot* PlacedPeople::slot_of(int person) {
  return const_cast<Slot*>(std::as_const(*this).slot_of(person));
}

/// A number for a person who has none: that of who was nearest among those who have gone, else a new one.
PlacedPeople::Slot* PlacedPeople::give_slot(const PlacedPerson& person) {
  auto known = std::find_if(candidates_.begin(), candidates_.end(), [&](const Candidate& one) { return one.person == person.id; });
  if (known == candidates_.end()) known = candidates_.insert(known, Candidate{person.id, 0});
  if (++known->instants < options_.settle) return nullptr;
  const auto place = mean_place(person);
  if (!place) return nullptr;
  Slot* given = nullptr;
  for (Slot& slot : slots_) {
    if (slot.unseen_s < options_.free_s) continue;
    if (given == nullptr || (slot.place - *place).norm() < (given->place - *place).norm()) given = &slot;
  }
  if (given == nullptr) {
    if (options_.most > 0 && std::ssize(slots_) >= options_.most) return nullptr;
    given = &slots_.emplace_back();
    given->points.resize(set_.points.size());
  }
  candidates_.erase(known);
  given->person = person.id;
  for (auto& point : given->points) point.reset();
  news_.push_back(fmt::format("P{} is here", given - slots_.data() + 1));
  return given;
}

void PlacedPeople::correct(Slot& slot, const PlacedPerson& person) const {
  for (std::size_t i = 0; i < slot.points.size(); ++i) {
    auto& point = slot.points[i];
    const auto& seen = person.points[i];
    if (!seen || seen->covariance.trace() > 3 * options_.max_sigma_m * options_.max_sigma_m) continue;
    const bool outside = point && point->filter.gate_distance(seen->position, seen->covariance) > 1;
    if (outside && ++point->refused < options_.max_refused) continue;
    if (!point || outside) {
      point.emplace(Point{filter::Kalman<3>(options_.filter, seen->position, seen->covariance)});
    } else {
      point->filter.correct(seen->position, seen->covariance);
    }
    point->unseen_s = 0;
    point->refused = 0;
  }
}

void PlacedPeople::tell(const Slot& slot, std::size_t number, const PlacedPerson* seen, Instant& instant) const {
  for (std::size_t i = 0; i < slot.points.size(); ++i) {
    const auto& point = slot.points[i];
    if (!point) continue;
    Sample sample;
    sample.track = TrackId{static_cast<int>(number * set_.points.size() + i) + 1};
    sample.position = point->filter.position();
    sample.velocity = point->filter.velocity();
    sample.covariance = point->filter.covariance();
    sample.provenance = point->unseen_s == 0 ? Provenance::measured : Provenance::predicted;
    if (seen != nullptr && seen->points[i] && point->unseen_s == 0) {
      sample.cameras = seen->points[i]->used;
      sample.residual_px = seen->points[i]->residual_px;
    }
    instant.samples.push_back(std::move(sample));
  }
}

void PlacedPeople::step(std::span<const PlacedPerson> people, double step_s, Instant& instant) {
  for (Slot& slot : slots_) {
    slot.unseen_s += step_s;
    for (auto& point : slot.points) {
      if (!point) continue;
      point->filter.predict(step_s);
      point->unseen_s += step_s;
    }
  }
  std::erase_if(candidates_, [&](const Candidate& one) {
    return std::none_of(people.begin(), people.end(), [&](const PlacedPerson& person) { return person.id == one.person; });
  });
  for (const PlacedPerson& person : people) {
    Slot* slot = slot_of(person.id);
    if (slot == nullptr) slot = give_slot(person);
    if (slot == nullptr) continue;
    correct(*slot, person);
    slot->unseen_s = 0;
    slot->place = mean_place(person).value_or(slot->place);
  }
  for (std::size_t number = 0; number < slots_.size(); ++number) {
    Slot& slot = slots_[number];
    for (auto& point : slot.points) {
      if (point && point->unseen_s > options_.predict_s) point.reset();
    }
    if (!slot.named) {
      for (std::size_t i = 0; i < set_.points.size(); ++i)
        instant.named.push_back({.id = TrackId{static_cast<int>(number * set_.points.size() + i) + 1},
                                 .label = fmt::format("P{}:{}", number + 1, set_.points[i]),
                                 .team = {},
                                 .colour = {},
                                 .kind = TrackKind::keypoint});
      slot.named = true;
    }
    const auto seen = std::find_if(people.begin(), people.end(), [&](const auto& person) { return person.id == slot.person; });
    tell(slot, number, seen == people.end() ? nullptr : &*seen, instant);
  }
}

std::vector<std::optional<Vector<3>>> PlacedPeople::points_of(int person) const {
  std::vector<std::optional<Vector<3>>> places;
  const Slot* slot = slot_of(person);
  if (slot == nullptr) return places;
  for (const auto& point : slot->points)
    places.push_back(point ? std::optional<Vector<3>>(point->filter.position()) : std::nullopt);
  return places;
}

std::optional<TrackId> PlacedPeople::track_of(int person, std::size_t point) const {
  const Slot* slot = slot_of(person);
  if (slot == nullptr) return std::nullopt;
  const auto number = static_cast<std::size_t>(slot - slots_.data());
  return TrackId{static_cast<int>(number * set_.points.size() + point) + 1};
}

std::size_t PlacedPeople::present() const {
  return static_cast<std::size_t>(
      std::count_if(slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.unseen_s < options_.free_s; }));
}

std::vector<std::string> PlacedPeople::take_news() {
  return std::exchange(news_, {});
}

}  // namespace marey::pipeline::keypoints
