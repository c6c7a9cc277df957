#include "marey/simulate/camera_shake.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "marey/simulate/random.h"

namespace marey::simulate {
namespace {

constexpr int kWaves = 24;
constexpr double kSlowest = 0.3, kFastest = 8;      // Hz, of the wind
constexpr double kOwnRate = 2.2, kOwnWidth = 0.25;  // Hz and e-folds: where a mast swings by itself
constexpr double kRollFraction = 1.0 / 3;
constexpr double kStepEvery = 5, kStepRings = 0.3, kStepRate = 6;  // s, s, Hz
constexpr double kStepSize = 2;                                    // in what the wind does

}  // namespace

CameraShake::CameraShake(double rms_px, double focal, double reach, std::uint64_t seed)
    : rms_(rms_px / focal, rms_px / focal, kRollFraction * rms_px / reach), seed_(seed) {
  Random random(seed * 2654435761U + 77);
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (int i = 0; i < kWaves; ++i) {
      const double hz = kSlowest * std::pow(kFastest / kSlowest, (i + random.uniform()) / kWaves);
      const double own = std::exp(-std::pow(std::log(hz / kOwnRate) / kOwnWidth, 2));
      const double strength = std::pow(hz, -0.7) * (1 + 2 * own);
      waves_[axis].push_back({2 * std::numbers::pi * hz, random.uniform(0, 2 * std::numbers::pi), strength});
      sum += strength * strength / 2;
    }
    for (Wave& wave : waves_[axis]) wave.strength *= rms_[axis] / std::sqrt(sum);
  }
}

Vector<3> CameraShake::turn(double time) const {
  Vector<3> turn = Vector<3>::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (const Wave& wave : waves_[axis]) turn[axis] += wave.strength * std::sin(wave.rate * time + wave.phase);
  }
  const auto slot = static_cast<std::int64_t>(std::floor(time / kStepEvery));
  for (std::int64_t s = slot - 1; s <= slot; ++s) {
    Random step(seed_ * 7919 + static_cast<std::uint64_t>(s + 1'000'000));
    const double since = time - kStepEvery * (static_cast<double>(s) + step.uniform());
    const double size = step.uniform(0.5, 1) * kStepSize, across = step.uniform(-0.4, 0.4);
    if (since < 0) continue;
    const double ring = size * std::exp(-since / kStepRings) * std::sin(2 * std::numbers::pi * kStepRate * since);
    turn += ring * Vector<3>(rms_.x(), across * rms_.y(), across * rms_.z());
  }
  return turn;
}

std::function<Vector<2>(const Vector<2>&)> rotated_pixels(const Vector<3>& turn, double focal, const Vector<2>& principal) {
  const Matrix<3> rotation =
      turn.isZero() ? Matrix<3>::Identity().eval() : Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  return [rotation, focal, principal](const Vector<2>& pixel) -> Vector<2> {
    const Vector<3> ray = rotation * Vector<3>((pixel - principal).x() / focal, (pixel - principal).y() / focal, 1);
    return principal + focal * ray.head<2>() / ray.z();
  };
}

}  // namespace marey::simulate
