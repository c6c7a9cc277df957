#include "marey/format/match/ground_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/error.h"

namespace marey::format::match {
namespace {

constexpr double kFarthest = 1e5;  // m

}  // namespace

std::int32_t GroundBuilder::person(const std::string& key, int wanted, const std::string& label, const std::string& team) {
  const auto [entry, is_new] = index_of_.try_emplace(key, static_cast<std::int32_t>(recording_.people.size()));
  if (!is_new) return entry->second;
  const bool free = wanted > 0 && !by_id_.contains(wanted);
  const int id = free ? wanted : by_id_.empty() ? 1 : by_id_.rbegin()->first + 1;
  by_id_[id] = entry->second;
  recording_.people.push_back({id, label, team});
  return entry->second;
}

void GroundBuilder::add(std::int32_t frame, double time, std::int32_t person, double x, double y, std::string_view where) {
  if (!(std::abs(x) <= kFarthest && std::abs(y) <= kFarthest))
    throw Error("{}: ({:g}, {:g}) m is no place near a pitch", where, x, y);
  GroundRecording::Sample sample;
  sample.frame = frame, sample.time = time, sample.person = person;
  sample.place = {x, y};
  recording_.samples.push_back(sample);
}

GroundRecording GroundBuilder::finish() {
  const auto order = [&](const GroundRecording::Sample& one) {
    return std::pair(one.frame, recording_.people[static_cast<std::size_t>(one.person)].id);
  };
  auto& samples = recording_.samples;
  const auto before = [&](const auto& a, const auto& b) { return order(a) < order(b); };
  if (!std::is_sorted(samples.begin(), samples.end(), before)) std::stable_sort(samples.begin(), samples.end(), before);
  const auto twice =
      std::adjacent_find(samples.begin(), samples.end(), [&](const auto& a, const auto& b) { return order(a) == order(b); });
  if (twice != samples.end()) {
    const GroundRecording::Person& person = recording_.people[static_cast<std::size_t>(twice->person)];
    throw Error("{}: someone (\"{}\", team \"{}\") is twice in frame {}", name_, person.label, person.team, twice->frame);
  }
  return std::move(recording_);
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
