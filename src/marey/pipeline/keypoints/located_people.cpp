#include "marey/pipeline/keypoints/located_people.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace marey::pipeline::keypoints {
namespace {

using reconstruct::keypoints::LocatedPerson;

std::optional<Vector<3>> mean_position(const LocatedPerson& person) {
  Vector<3> sum = Vector<3>::Zero();
  double count = 0;
  for (const auto& point : person.points) {
    if (point) sum += point->position, ++count;
  }
  if (count == 0) return std::nullopt;
  return Vector<3>(sum / count);
}

}  // namespace

LocatedPeople::LocatedPeople(const KeypointSet& set, const LocatedPeopleOptions& options) : set_(set), options_(options) {}

const LocatedPeople::Slot* LocatedPeople::slot_of(int person) const {
  const auto found = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.person == person; });
  return found == slots_.end() ? nullptr : &*found;
}

LocatedPeople::Slot* LocatedPeople::slot_of(int person) {
  return const_cast<Slot*>(std::as_const(*this).slot_of(person));
}

/// A number for a person who has none: that of who was nearest among those who have gone, else a new one.
LocatedPeople::Slot* LocatedPeople::give_slot(const LocatedPerson& person) {
  auto known = std::find_if(candidates_.begin(), candidates_.end(), [&](const Candidate& one) { return one.person == person.id; });
  if (known == candidates_.end()) known = candidates_.insert(known, Candidate{person.id, 0});
  if (++known->instants < options_.settle) return nullptr;
  const auto location = mean_position(person);
  if (!location) return nullptr;
  Slot* given = nullptr;
  for (Slot& slot : slots_) {
    if (slot.unobserved_s < options_.free_s) continue;
    if (given == nullptr || (slot.location - *location).norm() < (given->location - *location).norm()) given = &slot;
  }
  if (given == nullptr) {
    if (options_.maximum > 0 && std::ssize(slots_) >= options_.maximum) return nullptr;
    given = &slots_.emplace_back();
    given->points.resize(set_.points.size());
  }
  candidates_.erase(known);
  given->person = person.id;
  for (auto& point : given->points) point.reset();
  news_.push_back(fmt::format("P{} is here", given - slots_.data() + 1));
  return given;
}

void LocatedPeople::correct(Slot& slot, const LocatedPerson& person) const {
  for (std::size_t i = 0; i < slot.points.size(); ++i) {
    auto& point = slot.points[i];
    const auto& detected = person.points[i];
    if (!detected || detected->covariance.trace() > 3 * options_.max_sigma_m * options_.max_sigma_m) continue;
    const bool outside = point && point->filter.gate_distance(detected->position, detected->covariance) > 1;
    if (outside && ++point->refused < options_.max_refused) continue;
    if (!point || outside) {
      point.emplace(Point{filter::Kalman<3>(options_.filter, detected->position, detected->covariance)});
    } else {
      point->filter.correct(detected->position, detected->covariance);
    }
    point->unobserved_s = 0;
    point->refused = 0;
  }
}

void LocatedPeople::notify(const Slot& slot, std::size_t number, const LocatedPerson* detected, Instant& instant) const {
  for (std::size_t i = 0; i < slot.points.size(); ++i) {
    const auto& point = slot.points[i];
    if (!point) continue;
    Sample sample;
    sample.track = TrackId{static_cast<int>(number * set_.points.size() + i) + 1};
    sample.position = point->filter.position();
    sample.velocity = point->filter.velocity();
    sample.covariance = point->filter.covariance();
    sample.provenance = point->unobserved_s == 0 ? Provenance::measured : Provenance::predicted;
    if (detected != nullptr && detected->points[i] && point->unobserved_s == 0) {
      sample.cameras = detected->points[i]->used;
      sample.residual_px = detected->points[i]->residual_px;
    }
    instant.samples.push_back(std::move(sample));
  }
}

void LocatedPeople::step(std::span<const LocatedPerson> people, double step_s, Instant& instant) {
  for (Slot& slot : slots_) {
    slot.unobserved_s += step_s;
    for (auto& point : slot.points) {
      if (!point) continue;
      point->filter.predict(step_s);
      point->unobserved_s += step_s;
    }
  }
  std::erase_if(candidates_, [&](const Candidate& one) {
    return std::none_of(people.begin(), people.end(), [&](const LocatedPerson& person) { return person.id == one.person; });
  });
  for (const LocatedPerson& person : people) {
    Slot* slot = slot_of(person.id);
    if (slot == nullptr) slot = give_slot(person);
    if (slot == nullptr) continue;
    correct(*slot, person);
    slot->unobserved_s = 0;
    slot->location = mean_position(person).value_or(slot->location);
  }
  for (std::size_t number = 0; number < slots_.size(); ++number) {
    Slot& slot = slots_[number];
    for (auto& point : slot.points) {
      if (point && point->unobserved_s > options_.predict_s) point.reset();
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
    const auto detected = std::find_if(people.begin(), people.end(), [&](const auto& person) { return person.id == slot.person; });
    notify(slot, number, detected == people.end() ? nullptr : &*detected, instant);
  }
}

std::vector<std::optional<Vector<3>>> LocatedPeople::points_of(int person) const {
  std::vector<std::optional<Vector<3>>> locations;
  const Slot* slot = slot_of(person);
  if (slot == nullptr) return locations;
  for (const auto& point : slot->points)
    locations.push_back(point ? std::optional<Vector<3>>(point->filter.position()) : std::nullopt);
  return locations;
}

std::optional<TrackId> LocatedPeople::track_of(int person, std::size_t point) const {
  const Slot* slot = slot_of(person);
  if (slot == nullptr) return std::nullopt;
  const auto number = static_cast<std::size_t>(slot - slots_.data());
  return TrackId{static_cast<int>(number * set_.points.size() + point) + 1};
}

std::size_t LocatedPeople::present() const {
  return static_cast<std::size_t>(
      std::count_if(slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.unobserved_s < options_.free_s; }));
}

std::vector<std::string> LocatedPeople::take_news() {
  return std::exchange(news_, {});
}

}  // namespace marey::pipeline::keypoints
