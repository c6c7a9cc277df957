#include "marey/evaluate/pair_instants.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace marey::evaluate {
namespace {

using Instant = InstantClock::Instant;

constexpr double kSame = 0.02;  // share by which periods may differ and still be one

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool alike(double a, double b) {
  return std::abs(a - b) <= kSame * std::max(std::abs(a), std::abs(b));
}

/// Which of `others` is the same instant: an index into it, where there is one.
std::vector<std::optional<std::size_t>> partners(const InstantClock& clock, const InstantClock& others, bool by_time) {
  std::vector<std::optional<std::size_t>> result;
  const auto key = [by_time](const Instant& instant) { return by_time ? instant.time : static_cast<double>(instant.frame); };
  const double reach = by_time ? std::min(clock.period.value_or(0), others.period.value_or(0)) / 2 + 1e-9 : 0;
  const auto begin = others.instants.begin(), end = others.instants.end();
  for (const Instant& instant : clock.instants) {
    auto next = std::lower_bound(begin, end, key(instant), [&](const Instant& a, double b) { return key(a) < b; });
    if (next != begin && (next == end || key(*next) - key(instant) > key(instant) - key(*(next - 1)))) --next;
    const bool near = next != end && std::abs(key(*next) - key(instant)) <= reach;
    result.push_back(near ? std::optional(static_cast<std::size_t>(next - begin)) : std::nullopt);
  }
  return result;
}

/// Numbers in the order of `leader`'s instants, given to `follower`'s partners too. Where `all`, the follower's instants that have
/// no partner get numbers of their own.
void number(const InstantClock& leader, const InstantClock& follower, bool by_time, bool all, CommonNumbers& leading,
            CommonNumbers& following) {
  const auto partner = partners(leader, follower, by_time);
  std::vector<bool> taken(follower.instants.size(), false);
  std::int32_t next = 0;
  for (std::size_t i = 0; i < leader.instants.size(); ++i) {
    leading[leader.instants[i].frame] = next;
    if (partner[i] && !taken[*partner[i]]) {
      taken[*partner[i]] = true;
      following[follower.instants[*partner[i]].frame] = next;
    }
    ++next;
  }
  for (std::size_t i = 0; all && i < follower.instants.size(); ++i) {
    if (!taken[i]) following[follower.instants[i].frame] = next++;
  }
}

/// How much later the tracks' first common frame is than the truth's, s; 0 where there is none.
double time_between(const InstantClock& truth, const InstantClock& tracks) {
  const auto partner = partners(truth, tracks, false);
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i]) return tracks.instants[*partner[i]].time - truth.instants[i].time;
  }
  return 0;
}

}  // namespace

InstantClock clock_of(const GroundRecording& recording) {
  InstantClock clock;
  for (const auto& sample : recording.samples) {
    if (clock.instants.empty() || clock.instants.back().frame != sample.frame)
      clock.instants.push_back({sample.frame, sample.time});
  }
  std::vector<double> steps, per_frame;
  for (std::size_t i = 1; i < clock.instants.size(); ++i) {
    const Instant &before = clock.instants[i - 1], &now = clock.instants[i];
    steps.push_back(now.time - before.time);
    per_frame.push_back((now.time - before.time) / (now.frame - before.frame));
  }
  clock.period = median(std::move(steps));
  clock.frame_s = median(std::move(per_frame));
  return clock;
}

InstantPairing pair_instants(const InstantClock& truth, const InstantClock& tracks) {
  InstantPairing pairing;
  const double true_period = truth.period.value_or(0), track_period = tracks.period.value_or(0);
  const bool known = true_period > 0 && track_period > 0;
  pairing.by_time = known && !alike(*truth.frame_s, *tracks.frame_s);
  if (!known || alike(true_period, track_period)) {
    number(truth, tracks, pairing.by_time, true, pairing.truth, pairing.tracks);
  } else {
    const bool truth_leads = true_period > track_period;
    if (truth_leads) {
      number(truth, tracks, pairing.by_time, false, pairing.truth, pairing.tracks);
    } else {
      number(tracks, truth, pairing.by_time, false, pairing.tracks, pairing.truth);
    }
    pairing.warnings.push_back(
        fmt::format("the truth has an instant every {:.3g} s, the tracks every {:.3g} s; judged are those of {}", true_period,
                    track_period, truth_leads ? "the truth" : "the tracks"));
  }
  if (const double apart = pairing.by_time ? 0 : time_between(truth, tracks); std::abs(apart) > std::max(true_period, track_period))
    pairing.warnings.push_back(fmt::format(
        "the same frame is {:.3g} s later in the tracks than in the truth; instants are paired by frame all the same", apart));
  if (pairing.by_time)
    pairing.warnings.push_back(
        "frame numbers mean other times in the two files; instants are paired by time, the nearest within half a period");
  return pairing;
}

std::vector<PersonPlace> places_of(const GroundRecording& recording, const CommonNumbers& numbers) {
  std::vector<PersonPlace> places;
  places.reserve(recording.samples.size());
  std::optional<std::int32_t> last;
  auto number = numbers.end();
  for (const auto& sample : recording.samples) {
    if (sample.frame != last) number = numbers.find(sample.frame);
    last = sample.frame;
    if (number == numbers.end()) continue;
    places.push_back({number->second, recording.people[static_cast<std::size_t>(sample.person)].id, sample.place, sample.velocity});
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
  return places;
}

}  // namespace marey::evaluate
