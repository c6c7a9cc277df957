#include "marey/track/ball/ball_smooth.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace marey::track::ball {
namespace {

struct Pass {
  BallPrediction predicted;  // from the moment before
  BallBelief filtered;
};

const BallPerson* holder_of(const BallStep& step, const BallMoment& moment) {
  const auto is = [&](const BallPerson& person) { return step.holder == person.id; };
  const auto found = std::find_if(moment.people.begin(), moment.people.end(), is);
  return found == moment.people.end() ? nullptr : &*found;
}

/// What the cameras saw of it corrects it.
BallBelief seen(BallBelief belief, const BallStep& step, const BallMoment& moment, const GroundViews& views) {
  for (std::size_t v = 0; v < step.used.size(); ++v) {
    if (step.used[v] < 0) continue;
    const BallView& view = moment.views[v];
    const auto at = project(belief, views.view_at(view.camera, view.time));
    if (at) correct(belief, *at, view.seen[static_cast<std::size_t>(step.used[v])]);
  }
  return belief;
}

/// Backwards from the end of a stretch without a gap.
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

}  // namespace

std::vector<BallState> smooth_ball(std::span<const BallMoment> moments, std::span<const BallStep> steps, const GroundViews& views,
                                   const BallMotionOptions& options) {
  std::vector<BallState> states(steps.size());
  std::vector<Pass> passes;
  const auto close = [&](std::size_t end) {
    if (!passes.empty()) smooth_back(passes, std::span(states).subspan(end - passes.size(), passes.size()));
    passes.clear();
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const BallStep& step = steps[i];
    states[i].mode = step.mode;
    states[i].event = step.event;
    states[i].holder = step.holder;
    for (std::size_t v = 0; v < step.used.size(); ++v) {
      if (step.used[v] >= 0) states[i].cameras |= mask_of(moments[i].views[v].camera);
    }
    if (step.mode == BallMode::lost || step.born) close(i);
    if (step.mode == BallMode::lost) continue;
    if (passes.empty()) {
      passes.push_back({{step.belief, Matrix<6>::Identity()}, step.belief});
      continue;
    }
    const BallPerson* holder = holder_of(step, moments[i]);
    Pass pass;
    const double later = seconds(moments[i].time - moments[i - 1].time);
    pass.predicted = predict(passes.back().filtered, step.mode, step.event, later, holder, options);
    pass.filtered = pass.predicted.belief;
    settle(pass.filtered, step.mode, step.event, later, holder, options);
    pass.filtered = seen(pass.filtered, step, moments[i], views);
    passes.push_back(pass);
  }
  close(steps.size());
  return states;
}

}  // namespace marey::track::ball
