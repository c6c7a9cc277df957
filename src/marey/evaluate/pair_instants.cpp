#include "marey/evaluate/pair_instants.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "marey/geometry/median.h"

namespace marey::evaluate {
namespace {

constexpr double kSame = 0.02;  // share by which periods may differ and still be one

bool alike(double a, double b) {
  return std::abs(a - b) <= kSame * std::max(std::abs(a), std::abs(b));
}

/// Which of `others` is the same instant: index into it.
std::vector<std::optional<std::size_t>> partners(const InstantClock& clock, const InstantClock& others, bool by_time) {
  std::vector<std::optional<std::size_t>> result;
  const auto key = [by_time](const Recording::TimeStep& time_step) {
    return by_time ? seconds(time_step.time) : static_cast<double>(time_step.index);
  };
  const double reach = by_time ? std::min(clock.period, others.period) / 2 + 1e-9 : 0;
  const auto begin = others.instants.begin(), end = others.instants.end();
  for (const Recording::TimeStep& time_step : clock.instants) {
    auto next = std::lower_bound(begin, end, key(time_step), [&](const Recording::TimeStep& a, double b) { return key(a) < b; });
    if (next != begin && (next == end || key(*next) - key(time_step) > key(time_step) - key(*(next - 1)))) --next;
    const bool near = next != end && std::abs(key(*next) - key(time_step)) <= reach;
    result.push_back(near ? std::optional(static_cast<std::size_t>(next - begin)) : std::nullopt);
  }
  return result;
}

/// CommonNumbers in the order of `leader`'s instants, given to `follower`'s partners too. Where `all`, the follower's instants that
/// have no partner get numbers of their own.
void number(const InstantClock& leader, const InstantClock& tracker, bool by_time, bool all, CommonNumbers& leading,
            CommonNumbers& tracking) {
  const auto partner = partners(leader, tracker, by_time);
  leading.assign(leader.instants.size(), std::nullopt);
  tracking.assign(tracker.instants.size(), std::nullopt);
  std::int32_t next = 0;
  for (std::size_t i = 0; i < leading.size(); ++i) {
    leading[i] = next;
    if (partner[i] && !tracking[*partner[i]]) tracking[*partner[i]] = next;
    ++next;
  }
  for (std::size_t i = 0; all && i < tracking.size(); ++i) {
    if (!tracking[i]) tracking[i] = next++;
  }
}

/// How much later the tracks' first common frame is than the truth's, s; 0 if no such frame exists.
double time_between(const InstantClock& truth, const InstantClock& tracks) {
  const auto partner = partners(truth, tracks, false);
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i]) return tracks.time(*partner[i]) - truth.time(i);
  }
  return 0;
}

}  // namespace

InstantClock clock_of(const Recording& recording) {
  InstantClock clock{recording.instants()};
  std::vector<double> steps, per_frame;
  for (std::size_t i = 1; i < clock.instants.size(); ++i) {
    const double step = clock.time(i) - clock.time(i - 1);
    steps.push_back(step);
    per_frame.push_back(step / static_cast<double>(clock.instants[i].index - clock.instants[i - 1].index));
  }
  clock.period = geometry::median_or(std::move(steps), 0);
  clock.frame_s = geometry::median_or(std::move(per_frame), 0);
  return clock;
}

InstantPairing pair_instants(const InstantClock& truth, const InstantClock& tracks) {
  InstantPairing pairing;
  const bool known = truth.period > 0 && tracks.period > 0;
  pairing.by_time = known && !alike(truth.frame_s, tracks.frame_s);
  if (!known || alike(truth.period, tracks.period)) {
    number(truth, tracks, pairing.by_time, true, pairing.truth, pairing.tracks);
  } else {
    const bool truth_leads = truth.period > tracks.period;
    if (truth_leads) {
      number(truth, tracks, pairing.by_time, false, pairing.truth, pairing.tracks);
    } else {
      number(tracks, truth, pairing.by_time, false, pairing.tracks, pairing.truth);
    }
    pairing.warnings.push_back(
        fmt::format("the truth has an instant every {:.3g} s, the tracks every {:.3g} s; evaluated are those of {}", truth.period,
                    tracks.period, truth_leads ? "the truth" : "the tracks"));
  }
  if (const double apart = pairing.by_time ? 0 : time_between(truth, tracks);
      std::abs(apart) > std::max(truth.period, tracks.period))
    pairing.warnings.push_back(fmt::format(
        "the same frame is {:.3g} s later in the tracks than in the truth; instants are paired by frame all the same", apart));
  if (pairing.by_time)
    pairing.warnings.push_back(
        "frame numbers mean other times in the two files; instants are paired by time, the nearest within half a period");
  return pairing;
}

}  // namespace marey::evaluate
