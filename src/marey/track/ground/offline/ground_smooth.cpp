#include "marey/track/ground/offline/ground_smooth.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include <Eigen/LU>

namespace marey::track::ground::offline {
namespace {

constexpr double student_degrees = 4;  // of the distribution that errors of places are taken to have
constexpr int default_passes = 3;
constexpr double round_time_step = 0.5;  // s before and after within which the strength of pushes is measured
constexpr double strongest = 3;          // in units of the pushes' typical power
constexpr double shared_memory = 0.5;    // s for which errors persist of who is seen in one region with others

constexpr int upper(int i, int j) {
  constexpr std::array<std::array<int, 3>, 3> at = {{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
  return at[i][j];
}

/// What a step of time does to each axis: x becomes F x, and Q is added. F is upper triangular.
struct Step {
  Matrix<3> F = Matrix<3>::Identity();
  Matrix<3> Q = Matrix<3>::Zero();
};

/// Covariance of velocity and acceleration that the motion tends to, per axis.
Matrix<2> settled(const GroundMotion& motion) {
  const double a = motion.acceleration * motion.acceleration / (2 * motion.push);
  const double both = motion.settling * motion.push / (motion.settling + motion.push);
  return (Matrix<2>() << a * motion.settling * both, a * both, a * both, a).finished();
}

/// A step so short that a few terms of its series are exact, by quadrature; doubled until it is as long as asked for.
Step step_of(double dt, const GroundMotion& motion) {
  const int doublings =
      std::max(0, static_cast<int>(std::ceil(std::log2(dt / (0.1 * std::min(motion.push, motion.settling)) + 1e-9))));
  const double h = std::ldexp(dt, -doublings);
  Matrix<3> A = Matrix<3>::Zero();
  A(0, 1) = A(1, 2) = 1;
  A(1, 1) = -1 / motion.settling;
  A(2, 2) = -1 / motion.push;
  const auto flow = [&](double t) {
    Matrix<3> sum = Matrix<3>::Identity(), term = Matrix<3>::Identity();
    for (int k = 1; k < 10; ++k) {
      term = (term * A * (t / k)).eval();
      sum += term;
    }
    return sum;
  };
  Step step;
  step.F = flow(h);
  const double density = motion.acceleration * motion.acceleration / (motion.push * motion.push);
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

/// Steps, of which most are as long as the one before.
class Steps {
 public:
  explicit Steps(const GroundMotion& motion) : motion_(motion) {}
  const Step& operator()(double dt) {
    if (!last_ || std::abs(dt - *last_) > 1e-7) {
      last_ = dt;
      step_ = step_of(dt, motion_);
    }
    return step_;
  }

 private:
  const GroundMotion& motion_;
  std::optional<double> last_;
  Step step_;
};

/// `push`: the power of the pushes in units of the typical.
void advance(GroundState& state, const Step& step, double push = 1) {
  const Matrix<3>& F = step.F;
  std::array<Matrix<2>, 6> P;
  // Rows of F P, then times Fᵀ: sums over what lies on or right of the diagonal.
  std::array<std::array<Matrix<2>, 3>, 3> FP;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      FP[i][j].setZero();
      for (int k = i; k < 3; ++k) {
        if (k <= j) {
          FP[i][j] += F(i, k) * state.P[upper(k, j)];
        } else {
          FP[i][j] += F(i, k) * state.P[upper(j, k)].transpose();
        }
      }
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      Matrix<2>& block = P[upper(i, j)];
      block = F(j, j) * FP[i][j];
      for (int k = j + 1; k < 3; ++k) block += F(j, k) * FP[i][k];
      block.diagonal().array() += push * step.Q(i, j);
    }
  }
  state.P = P;
  state.x[0] += F(0, 1) * state.x[1] + F(0, 2) * state.x[2];
  state.x[1] = (F(1, 1) * state.x[1] + F(1, 2) * state.x[2]).eval();
  state.x[2] *= F(2, 2);
}

void correct(GroundState& state, const Vector<2>& z, const Matrix<2>& R) {
  const Matrix<2> S_inverse = (state.P[0] + R).inverse();
  const Vector<2> residual = z - state.x[0];
  const std::array<Matrix<2>, 3> K = {state.P[0] * S_inverse, state.P[1].transpose() * S_inverse,
                                      state.P[2].transpose() * S_inverse};
  for (int i = 0; i < 3; ++i) state.x[i] += K[i] * residual;
  // P − K S Kᵀ; the blocks of the place as R S⁻¹ P, which loses no digits where P is far larger than R.
  for (int i = 1; i < 3; ++i) {
    for (int j = i; j < 3; ++j) state.P[upper(i, j)] -= K[i] * state.P[j];
  }
  const Matrix<2> left = R * S_inverse;
  for (int j = 0; j < 3; ++j) state.P[j] = (left * state.P[j]).eval();
  for (const int i : {0, 3, 5}) state.P[i] = (0.5 * (state.P[i] + state.P[i].transpose())).eval();
}

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
  std::vector<Matrix<2>> flagged;  ///< in place of the samples' own covariances, where there are any

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
  void ambiguity_shared() {
    flagged.clear();
    for (const GroundSample& sample : samples) flagged.push_back(sample.spread());
    const auto review_item = [&](std::size_t i, std::size_t shared) {
      if (std::abs(seconds(times[samples[i].instant] - times[samples[shared].instant])) > shared_memory) return;
      if (samples[shared].spread().trace() > flagged[i].trace()) flagged[i] = samples[shared].spread();
      const double before = i > 0 ? seconds_to(i) : seconds_to(1);
      const double after = i + 1 < samples.size() ? seconds_to(i + 1) : before;
      echoes[i] = std::max(echoes[i], 1 / std::tanh((before + after) / 4 / shared_memory));
    };
    const std::size_t none = samples.size();
    std::size_t last = none;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (samples[i].shared) last = i;
      if (last != none) review_item(i, last);
    }
    last = none;
    for (std::size_t i = samples.size(); i-- > 0;) {
      if (samples[i].shared) last = i;
      if (last != none) review_item(i, last);
    }
  }

  Matrix<2> spread(std::size_t i) const {
    const Matrix<2> own = flagged.empty() ? samples[i].spread() : flagged[i];
    return own * (echoes[i] / time_steps[i].fit);
  }
  /// From the sample before.
  double seconds_to(std::size_t i) const { return seconds(times[samples[i].instant] - times[samples[i - 1].instant]); }
};

/// The power of the pushes round each instant, from the accelerations found there.
void weigh_pushes(SmoothingPass& detected) {
  const std::size_t n = detected.samples.size();
  const double typical = 2 * settled(detected.motion)(1, 1);
  const auto mix = [&](std::size_t i) { return std::exp(-detected.seconds_to(i) / round_time_step); };
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

Matrix<6> whole_covariance(const GroundState& state) {
  Matrix<6> P;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      P.block<2, 2>(2 * i, 2 * j) = state.P[upper(i, j)];
      P.block<2, 2>(2 * j, 2 * i) = state.P[upper(i, j)].transpose();
    }
  }
  return P;
}

/// The covariance of places, given all samples: that of each state before its observation, less what this one and all later ones
/// show of it (the adjoint's information, Bierman 1973).
void spread_positions(SmoothingPass& detected, const std::vector<GroundState>& before) {
  Steps steps(detected.motion);
  Matrix<6> reported = Matrix<6>::Zero();
  for (std::size_t i = detected.samples.size(); i-- > 0;) {
    const Matrix<6> P = whole_covariance(before[i]);
    const Matrix<2> S_inverse = (P.topLeftCorner<2, 2>() + detected.spread(i)).inverse();
    Matrix<6> left = Matrix<6>::Identity();
    left.leftCols<2>() -= P.leftCols<2>() * S_inverse;
    reported = (left.transpose() * reported * left).eval();
    reported.topLeftCorner<2, 2>() += S_inverse;
    detected.time_steps[i].spread = P.topLeftCorner<2, 2>() - P.topRows<2>() * reported * P.leftCols<2>();
    if (i == 0) break;
    const Matrix<3>& F = steps(detected.seconds_to(i)).F;
    Matrix<6> forward = Matrix<6>::Zero();
    for (int row = 0; row < 3; ++row) {
      for (int column = row; column < 3; ++column) forward.block<2, 2>(2 * row, 2 * column).diagonal().setConstant(F(row, column));
    }
    reported = (forward.transpose() * reported * forward).eval();
  }
}

/// Forwards, keeping each state before its observation; then back with the adjoint.
void smooth_once(SmoothingPass& detected, std::vector<GroundState>& before) {
  const std::span<const GroundSample> samples = detected.samples;
  std::vector<GroundTimeStep>& time_steps = detected.time_steps;
  Steps steps(detected.motion);
  GroundState state = unknown(samples[0].at(), detected.spread(0), detected.motion);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0) advance(state, steps(detected.seconds_to(i)), detected.pushes[i]);
    before[i] = state;
    correct(state, samples[i].at(), detected.spread(i));
  }
  std::array<Vector<2>, 3> l{Vector<2>::Zero(), Vector<2>::Zero(), Vector<2>::Zero()};  // the adjoint
  for (std::size_t i = samples.size(); i-- > 0;) {
    const GroundState& b = before[i];
    const std::array<Matrix<2>, 6>& P = b.P;
    l[0] -= (P[0] + detected.spread(i)).inverse() * (samples[i].at() - b.x[0] + P[0] * l[0] + P[1] * l[1] + P[2] * l[2]);
    time_steps[i].location = b.x[0] - P[0] * l[0] - P[1] * l[1] - P[2] * l[2];
    time_steps[i].velocity = b.x[1] - P[1].transpose() * l[0] - P[3] * l[1] - P[4] * l[2];
    time_steps[i].acceleration = b.x[2] - P[2].transpose() * l[0] - P[4].transpose() * l[1] - P[5] * l[2];
    if (i == 0) break;
    const Matrix<3>& F = steps(detected.seconds_to(i)).F;
    l[2] = (F(0, 2) * l[0] + F(1, 2) * l[1] + F(2, 2) * l[2]).eval();
    l[1] = (F(0, 1) * l[0] + F(1, 1) * l[1]).eval();
  }
}

/// How sure the places of the last pass are; `before` are its states.
void find_spreads(SmoothingPass& detected, std::vector<GroundState>& before) {
  const bool shared =
      std::any_of(detected.samples.begin(), detected.samples.end(), [](const GroundSample& one) { return one.shared; });
  if (!shared || detected.samples.size() < 2) return spread_positions(detected, before);
  SmoothingPass doubting = detected;
  doubting.ambiguity_shared();
  smooth_once(doubting, before);
  spread_positions(doubting, before);
  for (std::size_t i = 0; i < detected.time_steps.size(); ++i) detected.time_steps[i].spread = doubting.time_steps[i].spread;
}

SmoothingPass smoothed(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                       int passes, bool with_spread) {
  SmoothingPass detected(samples, times, motion);
  std::vector<GroundState> before(samples.size());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; pass > 0 && i < samples.size(); ++i)
      detected.time_steps[i].fit = weight_of(samples[i], detected.time_steps[i].location);
    if (pass > 0 && motion.calm < 1) weigh_pushes(detected);
    smooth_once(detected, before);
  }
  if (with_spread) find_spreads(detected, before);
  return detected;
}

/// The filter alone, over all samples, from the first or from the last on. Of what comes beyond nothing is known: all push alike.
GroundState filtered(std::span<const GroundSample> samples, std::span<const Timestamp> times, GroundMotion motion, bool forwards) {
  motion.calm = 1;
  const SmoothingPass detected = smoothed(samples, times, motion, default_passes, false);
  const std::size_t n = detected.samples.size();
  const auto at = [&](std::size_t k) { return forwards ? k : n - 1 - k; };
  Steps steps(detected.motion);
  GroundState state = unknown(detected.samples[at(0)].at(), detected.spread(at(0)), detected.motion);
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) advance(state, steps(detected.seconds_to(std::max(at(k), at(k - 1)))));
    correct(state, detected.samples[at(k)].at(), detected.spread(at(k)));
  }
  return state;
}

}  // namespace

double speed_variance(const GroundMotion& motion) {
  return settled(motion)(0, 0);
}

GroundState predicted(const GroundState& state, double dt, const GroundMotion& motion) {
  GroundState later = state;
  advance(later, step_of(dt, motion));
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

GroundTimeStep between(const GroundTimeStep& earlier, double since, const GroundTimeStep& later, double until,
                       const GroundMotion& motion) {
  const Step one = step_of(since, motion);
  const Step two = step_of(until, motion);
  // Per axis: x = F₁ a + C (b − F₂ F₁ a), C = Q₁ F₂ᵀ (F₂ Q₁ F₂ᵀ + Q₂)⁻¹.
  const Matrix<3> C = one.Q * two.F.transpose() * (two.F * one.Q * two.F.transpose() + two.Q).inverse();
  GroundTimeStep time_step;
  for (int axis = 0; axis < 2; ++axis) {
    const Vector<3> a = one.F * Vector<3>(earlier.location[axis], earlier.velocity[axis], earlier.acceleration[axis]);
    const Vector<3> b(later.location[axis], later.velocity[axis], later.acceleration[axis]);
    const Vector<3> x = a + C * (b - two.F * a);
    time_step.location[axis] = x[0];
    time_step.velocity[axis] = x[1];
    time_step.acceleration[axis] = x[2];
  }
  return time_step;
}

}  // namespace marey::track::ground::offline
