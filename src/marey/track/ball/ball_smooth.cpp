#include "marey/track/ball/ball_smooth.h"

#include <algorithm>

#include "marey/filter/smoother.h"

namespace marey::track::ball {
namespace {

using Known = filter::Estimate<6>;

const BallPerson* holder_of(const BallStep& step, const BallObservations& time_step) {
  const auto is = [&](const BallPerson& person) { return step.holder == person.id; };
  const auto found = std::find_if(time_step.people.begin(), time_step.people.end(), is);
  return found == time_step.people.end() ? nullptr : &*found;
}

/// What the cameras saw of it corrects it, by how they see what is `around`.
BallBelief detected(BallBelief belief, const BallStep& step, const BallObservations& time_step, const GroundViews& views,
                    const std::optional<Vector<3>>& around) {
  for (std::size_t v = 0; v < step.used.size(); ++v) {
    if (step.used[v] < 0) continue;
    const BallView& view = time_step.views[v];
    const auto at = project(belief, views.view_at(view.camera, view.time), around);
    if (at) correct(belief, *at, view.detected[static_cast<std::size_t>(step.used[v])]);
  }
  return belief;
}

/// Modes that hold the ball leave its covariance without some directions: a trifle makes it one that can be inverted.
Known regular(const BallBelief& belief) {
  return {belief.mean, belief.covariance + 1e-9 * Matrix<6>::Identity()};
}

/// A segment without a gap, from the state at its first instant. Where a belief was wide, cameras do not see it in proportion
/// to its place: each further pass takes what they see of the places that the pass before came to (an iterated smoother: Bell
/// 1994, "The iterated Kalman smoother as a Gauss-Newton method").
void smooth_segment(std::span<const BallObservations> time_steps, std::span<const BallStep> steps, const GroundViews& views,
                    const BallMotionOptions& options, std::span<BallState> states) {
  constexpr int kPasses = 4;
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto around = [&](std::size_t i) {
      return pass == 0 ? std::nullopt : std::optional<Vector<3>>(states[i].belief.location());
    };
    filter::Smoother<6> smoother;
    BallBelief filtered = steps[0].belief;
    smoother.add(Matrix<6>::Identity(), regular(filtered), {filtered.mean, filtered.covariance});
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const BallPerson* holder = holder_of(steps[i], time_steps[i]);
      const double later = seconds(time_steps[i].time - time_steps[i - 1].time);
      const BallPrediction predicted = predict(filtered, steps[i].mode, steps[i].event, later, holder, options);
      filtered = predicted.belief;
      settle(filtered, steps[i].mode, steps[i].event, later, holder, options);
      filtered = detected(filtered, steps[i], time_steps[i], views, around(i));
      smoother.add(predicted.F, regular(predicted.belief), {filtered.mean, filtered.covariance});
    }
    const std::vector<Known> smoothed = smoother.smoothed();
    for (std::size_t i = 0; i < smoothed.size(); ++i) states[i].belief = {smoothed[i].mean, smoothed[i].covariance};
  }
}

}  // namespace

std::vector<BallState> smooth_ball(std::span<const BallObservations> time_steps, std::span<const BallStep> steps,
                                   const GroundViews& views, const BallMotionOptions& options) {
  std::vector<BallState> states(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    states[i].mode = steps[i].mode;
    states[i].event = steps[i].event;
    states[i].holder = steps[i].holder;
    for (std::size_t v = 0; v < steps[i].used.size(); ++v) {
      if (steps[i].used[v] >= 0) states[i].cameras |= mask_of(time_steps[i].views[v].camera);
    }
  }
  const auto lost = [&](std::size_t i) { return steps[i].mode == BallMode::lost; };
  for (std::size_t first = 0, end = 0; first < steps.size(); first = end) {
    end = first + 1;
    if (lost(first)) continue;
    while (end < steps.size() && !lost(end) && !steps[end].initiated) ++end;
    smooth_segment(time_steps.subspan(first, end - first), steps.subspan(first, end - first), views, options,
                   std::span(states).subspan(first, end - first));
  }
  return states;
}

}  // namespace marey::track::ball
