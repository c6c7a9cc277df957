// Levenberg-Marquardt on sums that a kernel makes of eight pixels at a time (marker_kernel.inl).
#include "marey/detect/markers/marker_disc_models.h"

#include <algorithm>
#include <array>
#include <utility>

#include <Eigen/Cholesky>

namespace marey::detect::markers {
namespace {

constexpr int kMaxSplitSteps = 20;      // numerical: it ends earlier where it settles
constexpr double kSplitSettled = 5e-3;  // px, numerical: the next step would be a hundredth of it
constexpr double kSplitGain = 3e-3;     // of the squares left, numerical: a smaller step changes no decision

bool sensible_discs(const DiscsModel& model, double reach) {
  const auto& p = model.p;
  if (!p.allFinite() || p[kDiscsBlur] < 0.2 || p[kDiscsBlur] > reach || p[kDiscsContrast] < 0.1 || p[kDiscsContrast] > 10)
    return false;
  for (int i = 0; i < model.discs; ++i) {
    const double radius = p[kFirstDisc + 3 * i + 2];
    if (radius < 0.2 || radius > reach || p.segment<2>(kFirstDisc + 3 * i).norm() > reach) return false;
  }
  return true;
}

}  // namespace

DiscsNormal linearised(const DiscsModel& model, const MarkerWindow& window, const std::vector<float>& value,
                       const MarkerKernels& kernels) {
  const Eigen::Index n = model.p.size();
  std::array<float, kMaxParameters> parameters{};
  for (Eigen::Index i = 0; i < n; ++i) parameters[static_cast<std::size_t>(i)] = static_cast<float>(model.p[i]);
  const double maximum = (model.ceiling - model.p[kDiscsBackground]) / model.p[kDiscsContrast];
  MarkerSamples samples = window.samples();
  samples.value = value.data();
  DiscsSums sums;
  kernels.linearise_discs(samples, {parameters.data(), model.discs, model.swept, model.adds, static_cast<float>(maximum)}, sums);
  DiscsNormal normal{DiscsInformation(n, n), DiscsParameters(n), sums.squares};
  int k = 0;
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = a; b < n; ++b) normal.information(a, b) = normal.information(b, a) = sums.information[k++];
    normal.gradient[a] = sums.gradient[a];
  }
  return normal;
}

DiscsSolution fit_discs(DiscsModel model, const MarkerWindow& window, const std::vector<float>& value, double stiffness) {
  const double blur = model.p[kDiscsBlur];
  const auto cost = [&](const DiscsModel& m, const DiscsNormal& n) {
    return n.squares + stiffness * (m.p[kDiscsBlur] - blur) * (m.p[kDiscsBlur] - blur);
  };
  DiscsSolution best{model, linearised(model, window, value)};
  double damping = 1e-2;
  for (int step = 0; step < kMaxSplitSteps; ++step) {
    DiscsInformation information = best.normal.information;
    information.diagonal() += damping * best.normal.information.diagonal() + DiscsParameters::Constant(model.p.size(), 1e-9);
    information(kDiscsBlur, kDiscsBlur) += stiffness;
    DiscsParameters gradient = best.normal.gradient;
    gradient[kDiscsBlur] -= stiffness * (best.model.p[kDiscsBlur] - blur);
    const DiscsParameters change = information.llt().solve(gradient);
    model.p = best.model.p + change;
    if (sensible_discs(model, window.reach)) {
      DiscsNormal there = linearised(model, window, value);
      const double before = cost(best.model, best.normal), after = cost(model, there);
      if (after < before) {
        best = {model, std::move(there)};
        damping *= 0.2;
        if (change.cwiseAbs().maxCoeff() < kSplitSettled || before - after < kSplitGain * after) break;
        continue;
      }
    }
    damping *= 8;
    if (damping > 1e4) break;
  }
  return best;
}

}  // namespace marey::detect::markers
