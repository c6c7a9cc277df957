#include "marey/track/ground/ground_smooth.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/LU>

namespace marey {
namespace {

constexpr double student_degrees = 4;  // of the distribution that errors of places are taken to have

/// One step of the damped walk: place += drift · velocity, velocity *= kept, and what noise adds per axis.
struct Step {
  double drift = 0, kept = 1;
  double pp = 0, pv = 0, vv = 0;

  Step(double dt, const GroundMotion& motion) {
    const double q = motion.acceleration * motion.acceleration;
    const double tau = motion.settling;
    kept = std::exp(-dt / tau);
    const double lost = -std::expm1(-dt / tau);
    drift = tau * lost;
    vv = q * tau / 2 * lost * (1 + kept);
    pv = q * drift * drift / 2;
    // The closed form loses its digits in short steps, where damping does not matter.
    pp = dt < 1e-3 * tau ? q * dt * dt * dt / 3 : q * tau * tau * (dt - 2 * drift + tau / 2 * lost * (1 + kept));
  }
};

void advance(GroundState& state, const Step& step) {
  state.place += step.drift * state.velocity;
  state.velocity *= step.kept;
  state.Ppp += step.drift * (state.Ppv + state.Ppv.transpose()) + step.drift * step.drift * state.Pvv;
  state.Ppv = step.kept * (state.Ppv + step.drift * state.Pvv);
  state.Pvv *= step.kept * step.kept;
  state.Ppp.diagonal().array() += step.pp;
  state.Ppv.diagonal().array() += step.pv;
  state.Pvv.diagonal().array() += step.vv;
}

void correct(GroundState& state, const Vector<2>& z, const Matrix<2>& R) {
  const Matrix<2> S_inverse = (state.Ppp + R).inverse();
  const Vector<2> residual = z - state.place;
  const Matrix<2> Kp = state.Ppp * S_inverse;
  const Matrix<2> Kv = state.Ppv.transpose() * S_inverse;
  state.place += Kp * residual;
  state.velocity += Kv * residual;
  // P − K S Kᵀ; the blocks of the place as R S⁻¹ P, which loses no digits where P is far larger than R.
  state.Pvv -= Kv * state.Ppv;
  state.Ppv = (R * S_inverse * state.Ppv).eval();
  state.Ppp = (R * S_inverse * state.Ppp).eval();
  state.Ppp = (0.5 * (state.Ppp + state.Ppp.transpose())).eval();
  state.Pvv = (0.5 * (state.Pvv + state.Pvv.transpose())).eval();
}

/// One who is first seen at z, before that is taken in.
GroundState unknown(const Vector<2>& z, const Matrix<2>& R, const GroundMotion& motion) {
  constexpr double vague = 1e4;  // times the variance of the first observation: as good as nothing
  GroundState state;
  state.place = z;
  state.Ppp = vague * R;
  state.Pvv = motion.speed_variance() * Matrix<2>::Identity();
  return state;
}

double weight_of(const GroundSample& sample, const Vector<2>& place) {
  const Vector<2> residual = sample.at() - place;
  const double distance = residual.dot(sample.spread().inverse() * residual);
  return (student_degrees + 2) / (student_degrees + distance);
}

/// Forwards, keeping each state before its observation; then back with the adjoint.
void smooth_once(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                 std::vector<GroundState>& before, std::vector<GroundMoment>& moments) {
  const auto spread = [&](std::size_t i) -> Matrix<2> { return samples[i].spread() / moments[i].fit; };
  const auto step_to = [&](std::size_t i) {
    return Step(seconds(times[samples[i].instant] - times[samples[i - 1].instant]), motion);
  };
  GroundState state = unknown(samples[0].at(), spread(0), motion);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0) advance(state, step_to(i));
    before[i] = state;
    correct(state, samples[i].at(), spread(i));
  }
  Vector<2> lp = Vector<2>::Zero();  // adjoint of the place
  Vector<2> lv = Vector<2>::Zero();  // and of the velocity
  for (std::size_t i = samples.size(); i-- > 0;) {
    const GroundState& b = before[i];
    const Vector<2> residual = samples[i].at() - b.place;
    lp -= (b.Ppp + spread(i)).inverse() * (residual + b.Ppp * lp + b.Ppv * lv);
    moments[i].place = b.place - b.Ppp * lp - b.Ppv * lv;
    moments[i].velocity = b.velocity - b.Ppv.transpose() * lp - b.Pvv * lv;
    if (i == 0) break;
    const Step step = step_to(i);
    lv = (step.drift * lp + step.kept * lv).eval();
  }
}

/// The filter alone, over `count` samples from `from` on, in steps of 1 or −1.
GroundState filtered(std::span<const GroundSample> samples, std::span<const GroundMoment> moments, std::span<const Timestamp> times,
                     const GroundMotion& motion, bool forwards) {
  const std::size_t n = samples.size();
  const auto at = [&](std::size_t k) { return forwards ? k : n - 1 - k; };
  const auto spread = [&](std::size_t i) -> Matrix<2> { return samples[i].spread() / moments[i].fit; };
  GroundState state = unknown(samples[at(0)].at(), spread(at(0)), motion);
  for (std::size_t k = 0; k < n; ++k) {
    const GroundSample& sample = samples[at(k)];
    if (k > 0) advance(state, Step(std::abs(seconds(times[sample.instant] - times[samples[at(k - 1)].instant])), motion));
    correct(state, sample.at(), spread(at(k)));
  }
  return state;
}

}  // namespace

GroundState predicted(const GroundState& state, double dt, const GroundMotion& motion) {
  GroundState later = state;
  advance(later, Step(dt, motion));
  return later;
}

std::vector<GroundMoment> smooth_ground(std::span<const GroundSample> samples, std::span<const Timestamp> times,
                                        const GroundMotion& motion, int passes) {
  assert(!samples.empty() && passes > 0 && "there is something to smooth");
  std::vector<GroundMoment> moments(samples.size());
  std::vector<GroundState> before(samples.size());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; pass > 0 && i < samples.size(); ++i) moments[i].fit = weight_of(samples[i], moments[i].place);
    smooth_once(samples, times, motion, before, moments);
  }
  return moments;
}

GroundState first_state(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                        double span) {
  const Timestamp last = times[samples.front().instant] + duration_from_seconds(span);
  const auto past = std::find_if(samples.begin(), samples.end(), [&](const GroundSample& s) { return times[s.instant] > last; });
  const auto some = samples.first(static_cast<std::size_t>(past - samples.begin()));
  GroundState state = filtered(some, smooth_ground(some, times, motion), times, motion, false);
  state.velocity = -state.velocity;  // the walk looks the same backwards
  state.Ppv = -state.Ppv;
  return state;
}

GroundState last_state(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                       double span) {
  const Timestamp first = times[samples.back().instant] - duration_from_seconds(span);
  const auto some_rev =
      std::find_if(samples.rbegin(), samples.rend(), [&](const GroundSample& s) { return times[s.instant] < first; });
  const auto some = samples.last(static_cast<std::size_t>(some_rev - samples.rbegin()));
  return filtered(some, smooth_ground(some, times, motion), times, motion, true);
}

GroundMoment between(const GroundMoment& earlier, double since, const GroundMoment& later, double until,
                     const GroundMotion& motion) {
  const Step one(since, motion);
  const Step two(until, motion);
  // Per axis: x = F₁ a + C (b − F₂ F₁ a), C = Q₁ F₂ᵀ (F₂ Q₁ F₂ᵀ + Q₂)⁻¹.
  const Matrix<2> F2 = (Matrix<2>() << 1, two.drift, 0, two.kept).finished();
  const Matrix<2> Q1 = (Matrix<2>() << one.pp, one.pv, one.pv, one.vv).finished();
  const Matrix<2> Q2 = (Matrix<2>() << two.pp, two.pv, two.pv, two.vv).finished();
  const Matrix<2> C = Q1 * F2.transpose() * (F2 * Q1 * F2.transpose() + Q2).inverse();
  const Matrix<2> from = (Matrix<2>() << 1, one.drift, 0, one.kept).finished();
  GroundMoment moment;
  for (int axis = 0; axis < 2; ++axis) {
    const Vector<2> a = from * Vector<2>(earlier.place[axis], earlier.velocity[axis]);
    const Vector<2> x = a + C * (Vector<2>(later.place[axis], later.velocity[axis]) - F2 * a);
    moment.place[axis] = x[0];
    moment.velocity[axis] = x[1];
  }
  return moment;
}

}  // namespace marey
