#include "marey/track/ball/ball_smooth.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace marey::track::ball {
namespace {

struct Pass {
  BallPrediction predicted;  // from the instant before
  BallBelief filtered;
};

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

/// Backwards from the end of a segment without a gap.
void smooth_back(std::span<const Pass> passes, std::span<BallState> states) {
  states.back().belief = passes.back().filtered;
  for (std::size_t i = passes.size() - 1; i-- > 0;) {
    const BallBelief& filtered = passes[i].filtered;
    const BallPrediction& next = passes[i + 1].predicted;
    const Matrix<6> regular = next.belief.covariance + 1e-9 * Matrix<6>::Identity();
    const Matrix<6> gain = regular.ldlt().solve(next.F * filtered.covariance).transpose();
    BallBelief& smoothed = states[i].belief;
    const BallBelief& after = states[i + 1].belief;
    smoothed.mean = filtered.mean + gain * (after.mean - next.belief.mean);
    smoothed.covariance = filtered.covariance + gain * (after.covariance - next.belief.covariance) * gain.transpose();
    smoothed.covariance = 0.5 * (smoothed.covariance + smoothed.covariance.transpose().eval());
  }
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
    std::vector<Pass> passes;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      Pass& one = passes.emplace_back();
      if (i == 0) {
        one.predicted = {steps[0].belief, Matrix<6>::Identity()};
        one.filtered = steps[0].belief;
        continue;
      }
      const BallPerson* holder = holder_of(steps[i], time_steps[i]);
      const double later = seconds(time_steps[i].time - time_steps[i - 1].time);
      one.predicted = predict(passes[i - 1].filtered, steps[i].mode, steps[i].event, later, holder, options);
      one.filtered = one.predicted.belief;
      settle(one.filtered, steps[i].mode, steps[i].event, later, holder, options);
      one.filtered = detected(one.filtered, steps[i], time_steps[i], views, around(i));
    }
    smooth_back(passes, states);
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
