#include "marey/track/ground/offline/ground_smooth.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <Eigen/LU>

namespace marey::track::ground::offline {
namespace {

constexpr double student_degrees = 4;  // of the distribution that errors of places are taken to have
constexpr int kPasses = 3;             // numerical: iterations of the weights
constexpr double push_memory = 0.5;    // s before and after within which the strength of pushes is measured
constexpr double strongest = 3;        // in units of the pushes' typical power
constexpr double shared_memory = 0.5;  // s for which errors persist of who is seen in one region with others

/// Covariance of velocity and acceleration that the motion tends to, per axis.
Matrix<2> settled(const GroundMotion& motion) {
  const double a = motion.acceleration * motion.acceleration / (2 * motion.push);
  const double both = motion.settling * motion.push / (motion.settling + motion.push);
  return (Matrix<2>() << a * motion.settling * both, a * both, a * both, a).finished();
}

using PathSmoother = filter::PositionSmoother<GroundMotion, 2>;

/// One who is first seen at z, before that is taken in.
GroundState unknown(const Vector<2>& z, const Matrix<2>& R, const GroundMotion& motion) {
  constexpr double vague = 1e4;  // times the variance of the first observation: as good as nothing
  const Matrix<2> moves = settled(motion);
  GroundState state;
  state.x[0] = z;
  state.P[0] = vague * R;
  state.P[3] = moves(0, 0) * Matrix<2>::Identity();
  state.P[4] = moves(0, 1) * Matrix<2>::Identity();
  state.P[5] = moves(1, 1) * Matrix<2>::Identity();
  return state;
}

double weight_of(const GroundSample& sample, const Vector<2>& location) {
  const Vector<2> residual = sample.at() - location;
  const double distance = residual.dot(sample.spread().inverse() * residual);
  return (student_degrees + 2) / (student_degrees + distance);
}

/// Samples with what is made of them: each one's weight is its instant's fit, less for errors that it shares with its neighbours.
struct SmoothingPass {
  std::span<const GroundSample> samples;
  std::span<const Timestamp> times;
  const GroundMotion& motion;
  std::vector<GroundTimeStep> time_steps;
  std::vector<double> echoes;      ///< factor on covariances
  std::vector<double> pushes;      ///< up to the sample, in units of the typical power
  std::vector<Matrix<2>> widened;  ///< in place of the samples' own covariances, where there are any

  SmoothingPass(std::span<const GroundSample> s, std::span<const Timestamp> t, const GroundMotion& m)
      : samples(s), times(t), motion(m), time_steps(s.size()), echoes(s.size(), 1.0), pushes(s.size(), 1.0) {
    if (!(motion.error_memory > 0) || samples.size() < 2) return;
    // Samples of an autoregressive process of the first order, ρ from one to the next: n of them show as much of its mean as
    // n (1 − ρ) / (1 + ρ) that err on their own.
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double before = i > 0 ? seconds_to(i) : seconds_to(1);
      const double after = i + 1 < samples.size() ? seconds_to(i + 1) : before;
      echoes[i] = 1 / std::tanh((before + after) / 4 / motion.error_memory);
    }
  }

  /// Counts samples of regions that are shared by how long their errors really persist, and those right before and after for no
  /// better: two who run together are seen as one before it is noticed. Paths are not found with that: too little would hold them.
  void widen_shared() {
    widened.clear();
    for (const GroundSample& sample : samples) widened.push_back(sample.spread());
    const auto widen = [&](std::size_t i, std::size_t shared) {
      if (std::abs(seconds(times[samples[i].instant] - times[samples[shared].instant])) > shared_memory) return;
      if (samples[shared].spread().trace() > widened[i].trace()) widened[i] = samples[shared].spread();
      const double before = i > 0 ? seconds_to(i) : seconds_to(1);
      const double after = i + 1 < samples.size() ? seconds_to(i + 1) : before;
      echoes[i] = std::max(echoes[i], 1 / std::tanh((before + after) / 4 / shared_memory));
    };
    const std::size_t none = samples.size();
    std::size_t last = none;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (samples[i].shared) last = i;
      if (last != none) widen(i, last);
    }
    last = none;
    for (std::size_t i = samples.size(); i-- > 0;) {
      if (samples[i].shared) last = i;
      if (last != none) widen(i, last);
    }
  }

  Matrix<2> spread(std::size_t i) const {
    const Matrix<2> own = widened.empty() ? samples[i].spread() : widened[i];
    return own * (echoes[i] / time_steps[i].fit);
  }
  /// From the sample before.
  double seconds_to(std::size_t i) const { return seconds(times[samples[i].instant] - times[samples[i - 1].instant]); }
};

/// The power of the pushes round each instant, from the accelerations found there.
void weigh_pushes(SmoothingPass& detected) {
  const std::size_t n = detected.samples.size();
  const double typical = 2 * settled(detected.motion)(1, 1);
  const auto mix = [&](std::size_t i) { return std::exp(-detected.seconds_to(i) / push_memory); };
  std::vector<double> power(n);
  for (std::size_t i = 0; i < n; ++i) power[i] = detected.time_steps[i].acceleration.squaredNorm() / typical;
  detected.pushes = power;
  for (std::size_t i = 1; i < n; ++i) detected.pushes[i] += mix(i) * (detected.pushes[i - 1] - power[i]);
  for (std::size_t i = n - 1; i-- > 0;) power[i] += mix(i + 1) * (power[i + 1] - power[i]);
  for (std::size_t i = 0; i < n; ++i) {
    detected.pushes[i] =
        std::min(strongest, detected.motion.calm + (1 - detected.motion.calm) * (detected.pushes[i] + power[i]) / 2);
  }
}

/// Forwards over all samples.
PathSmoother path_of(const SmoothingPass& detected) {
  PathSmoother path(detected.motion, unknown(detected.samples[0].at(), detected.spread(0), detected.motion));
  path.reserve(detected.samples.size());
  for (std::size_t i = 0; i < detected.samples.size(); ++i)
    path.add(i > 0 ? detected.seconds_to(i) : 0, detected.pushes[i], detected.samples[i].at(), detected.spread(i));
  return path;
}

PathSmoother smooth_once(SmoothingPass& detected) {
  PathSmoother path = path_of(detected);
  const std::vector<PathSmoother::Values> states = path.smoothed();
  for (std::size_t i = 0; i < states.size(); ++i) {
    detected.time_steps[i].location = states[i][0];
    detected.time_steps[i].velocity = states[i][1];
    detected.time_steps[i].acceleration = states[i][2];
  }
  return path;
}

/// How sure the places of the last pass are, whose path is `last`.
void find_spreads(SmoothingPass& detected, const PathSmoother& last) {
  const bool shared =
      std::any_of(detected.samples.begin(), detected.samples.end(), [](const GroundSample& one) { return one.shared; });
  std::vector<Matrix<2>> spreads;
  if (shared && detected.samples.size() > 1) {
    SmoothingPass doubting = detected;
    doubting.widen_shared();
    spreads = path_of(doubting).position_covariances();
  } else {
    spreads = last.position_covariances();
  }
  for (std::size_t i = 0; i < spreads.size(); ++i) detected.time_steps[i].spread = spreads[i];
}

SmoothingPass smoothed(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                       int passes, bool with_spread) {
  SmoothingPass detected(samples, times, motion);
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; pass > 0 && i < samples.size(); ++i)
      detected.time_steps[i].fit = weight_of(samples[i], detected.time_steps[i].location);
    if (pass > 0 && motion.calm < 1) weigh_pushes(detected);
    const PathSmoother path = smooth_once(detected);
    if (with_spread && pass + 1 == passes) find_spreads(detected, path);
  }
  return detected;
}

/// The filter alone, over all samples, from the first or from the last on. Of what comes beyond nothing is known: all push alike.
GroundState filtered(std::span<const GroundSample> samples, std::span<const Timestamp> times, GroundMotion motion, bool forwards) {
  motion.calm = 1;
  const SmoothingPass detected = smoothed(samples, times, motion, kPasses, false);
  const std::size_t n = detected.samples.size();
  const auto at = [&](std::size_t k) { return forwards ? k : n - 1 - k; };
  PathSmoother path(detected.motion, unknown(detected.samples[at(0)].at(), detected.spread(at(0)), detected.motion));
  for (std::size_t k = 0; k < n; ++k)
    path.add(k > 0 ? detected.seconds_to(std::max(at(k), at(k - 1))) : 0, 1, detected.samples[at(k)].at(), detected.spread(at(k)));
  return {path.state()};
}

}  // namespace

/// A step so short that a few terms of its series are exact, by quadrature; doubled until it is as long as asked for.
filter::Transition<3> GroundMotion::over(double dt) const {
  const int doublings = std::max(0, static_cast<int>(std::ceil(std::log2(dt / (0.1 * std::min(push, settling)) + 1e-9))));
  const double h = std::ldexp(dt, -doublings);
  Matrix<3> A = Matrix<3>::Zero();
  A(0, 1) = A(1, 2) = 1;
  A(1, 1) = -1 / settling;
  A(2, 2) = -1 / push;
  const auto flow = [&](double t) {
    Matrix<3> sum = Matrix<3>::Identity(), term = Matrix<3>::Identity();
    for (int k = 1; k < 10; ++k) {
      term = (term * A * (t / k)).eval();
      sum += term;
    }
    return sum;
  };
  filter::Transition<3> step;
  step.F = flow(h);
  const double density = acceleration * acceleration / (push * push);
  constexpr std::array<std::array<double, 2>, 4> gauss = {{{0.0694318442029737, 0.1739274225687269},
                                                           {0.3300094782075719, 0.3260725774312731},
                                                           {0.6699905217924281, 0.3260725774312731},
                                                           {0.9305681557970263, 0.1739274225687269}}};
  for (const auto& [location, weight] : gauss) {
    const Vector<3> reached = flow(h * location).col(2);
    step.Q += density * h * weight * reached * reached.transpose();
  }
  for (int k = 0; k < doublings; ++k) {
    step.Q = (step.F * step.Q * step.F.transpose() + step.Q).eval();
    step.F = (step.F * step.F).eval();
  }
  return step;
}

double speed_variance(const GroundMotion& motion) {
  return settled(motion)(0, 0);
}

GroundState predicted(const GroundState& state, double dt, const GroundMotion& motion) {
  GroundState later = state;
  filter::advance<3, 2, 1>(later, motion.over(dt));
  return later;
}

std::vector<GroundTimeStep> smooth_ground(std::span<const GroundSample> samples, std::span<const Timestamp> times,
                                          const GroundMotion& motion, int passes) {
  assert(!samples.empty() && passes > 0 && "there is something to smooth");
  return std::move(smoothed(samples, times, motion, passes, true).time_steps);
}

GroundState first_state(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                        double span) {
  const Timestamp last = times[samples.front().instant] + duration_from_seconds(span);
  const auto past = std::find_if(samples.begin(), samples.end(), [&](const GroundSample& s) { return times[s.instant] > last; });
  const auto some = samples.first(static_cast<std::size_t>(past - samples.begin()));
  GroundState state = filtered(some, times, motion, false);
  state.x[1] = -state.x[1];  // velocities stray backwards as they do forwards
  state.P[1] = -state.P[1];
  // Pushes do not: nothing is known of them.
  state.x[2].setZero();
  state.P[2].setZero();
  state.P[4].setZero();
  state.P[5] = settled(motion)(1, 1) * Matrix<2>::Identity();
  return state;
}

GroundState last_state(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                       double span) {
  const Timestamp first = times[samples.back().instant] - duration_from_seconds(span);
  const auto some_rev =
      std::find_if(samples.rbegin(), samples.rend(), [&](const GroundSample& s) { return times[s.instant] < first; });
  const auto some = samples.last(static_cast<std::size_t>(some_rev - samples.rbegin()));
  return filtered(some, times, motion, true);
}

}  // namespace marey::track::ground::offline
