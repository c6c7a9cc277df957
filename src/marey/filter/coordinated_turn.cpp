#include "marey/filter/coordinated_turn.h"

#include <cmath>

#include <Eigen/Geometry>

namespace marey::filter {
namespace {

/// A = sin θ/θ, B = (1 − cos θ)/θ², C = (θ − sin θ)/θ³, and each one's derivative to θ, divided by θ.
struct Coefficients {
  double A = 0, B = 0, C = 0;
  double dA = 0, dB = 0, dC = 0;
};

Coefficients coefficients(double squared_angle) {
  Coefficients c;
  if (squared_angle < 1) {
    double power = 1;   // (−θ²)^k / (2k + 1)!
    double before = 0;  // −(−θ²)^(k−1) / (2k + 1)!
    for (int k = 0; k < 11; ++k) {
      const double n = 2.0 * k;
      c.A += power;
      c.B += power / (n + 2);
      c.C += power / ((n + 2) * (n + 3));
      c.dA += n * before;
      c.dB += n * before / (n + 2);
      c.dC += n * before / ((n + 2) * (n + 3));
      before = -power / ((n + 2) * (n + 3));
      power = before * squared_angle;
    }
    return c;
  }
  const double angle = std::sqrt(squared_angle);
  const double cosine = std::cos(angle);
  c.A = std::sin(angle) / angle;
  c.B = (1 - cosine) / squared_angle;
  c.C = (1 - c.A) / squared_angle;
  c.dA = (cosine - c.A) / squared_angle;
  c.dB = (c.A - 2 * c.B) / squared_angle;
  c.dC = (c.B - 3 * c.C) / squared_angle;
  return c;
}

Matrix<3> cross_matrix(const Vector<3>& a) {
  Matrix<3> m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

/// v + A (θ × v) + B (θ × (θ × v)) and its derivatives, A and B being functions of |θ|.
struct Rotated {
  Vector<3> value;
  Matrix<3> by_v;
  Matrix<3> by_angle;
};

Rotated rotated(const Vector<3>& v, const Vector<3>& angle, double A, double B, double dA, double dB) {
  const Vector<3> once = angle.cross(v);
  const Vector<3> twice = angle.cross(once);
  const Matrix<3> cross = cross_matrix(angle);
  Rotated result;
  result.value = v + A * once + B * twice;
  result.by_v = Matrix<3>::Identity() + A * cross + B * cross * cross;
  result.by_angle = (dA * once + dB * twice) * angle.transpose() - A * cross_matrix(v) +
                    B * (angle.dot(v) * Matrix<3>::Identity() + angle * v.transpose() - 2 * v * angle.transpose());
  return result;
}

double fading(double dt, const TurnNoise& noise) {
  return std::exp(-dt / noise.turn_time);
}

}  // namespace

template <int D>
typename CoordinatedTurn<D>::State CoordinatedTurn<D>::move(const State& x, double dt, const TurnNoise& noise, Square* jacobian) {
  // The plane is the third axis's: the same formulas serve both dimensions.
  Vector<3> v = Vector<3>::Zero();
  v.template head<D>() = x.template segment<D>(D);
  Vector<3> rate = Vector<3>::Zero();
  rate.template tail<kTurn>() = x.template tail<kTurn>();

  const Vector<3> angle = rate * dt;
  const Coefficients c = coefficients(angle.squaredNorm());
  const Rotated velocity = rotated(v, angle, c.A, c.B, c.dA, c.dB);
  const Rotated displacement = rotated(v, angle, c.B, c.C, c.dB, c.dC);
  const double fade = fading(dt, noise);

  State moved;
  moved.template head<D>() = x.template head<D>() + dt * displacement.value.template head<D>();
  moved.template segment<D>(D) = velocity.value.template head<D>();
  moved.template tail<kTurn>() = fade * x.template tail<kTurn>();
  if (jacobian != nullptr) {
    Square& F = *jacobian;
    F.setIdentity();
    F.template block<D, D>(0, D) = dt * displacement.by_v.template topLeftCorner<D, D>();
    F.template block<D, D>(D, D) = velocity.by_v.template topLeftCorner<D, D>();
    F.template block<D, kTurn>(0, 2 * D) = dt * dt * displacement.by_angle.template topRightCorner<D, kTurn>();
    F.template block<D, kTurn>(D, 2 * D) = dt * velocity.by_angle.template topRightCorner<D, kTurn>();
    F.template bottomRightCorner<kTurn, kTurn>().diagonal().setConstant(fade);
  }
  return moved;
}

template <int D>
typename CoordinatedTurn<D>::Square CoordinatedTurn<D>::noise(double dt, const TurnNoise& noise) {
  const double q = noise.acceleration_noise * noise.acceleration_noise;
  const double fade = fading(dt, noise);
  Square Q = Square::Zero();
  Q.template block<D, D>(0, 0).diagonal().setConstant(q * dt * dt * dt / 3);
  Q.template block<D, D>(0, D).diagonal().setConstant(q * dt * dt / 2);
  Q.template block<D, D>(D, 0).diagonal().setConstant(q * dt * dt / 2);
  Q.template block<D, D>(D, D).diagonal().setConstant(q * dt);
  Q.template bottomRightCorner<kTurn, kTurn>().diagonal().setConstant(noise.turn_sigma * noise.turn_sigma * (1 - fade * fade));
  return Q;
}

template <int D>
typename CoordinatedTurn<D>::State CoordinatedTurn<D>::start(const Vector<D>& z) {
  State x = State::Zero();
  x.template head<D>() = z;
  return x;
}

template <int D>
typename CoordinatedTurn<D>::Square CoordinatedTurn<D>::start_covariance(const Matrix<D>& R, double initial_speed,
                                                                         const TurnNoise& noise) {
  Square P = Square::Zero();
  P.template topLeftCorner<D, D>() = R;
  P.template block<D, D>(D, D).diagonal().setConstant(initial_speed * initial_speed);
  P.template bottomRightCorner<kTurn, kTurn>().diagonal().setConstant(noise.turn_sigma * noise.turn_sigma);
  return P;
}

template struct CoordinatedTurn<2>;
template struct CoordinatedTurn<3>;

}  // namespace marey::filter
