// A pixel's share of each disc is Φ of its distance from the edge in blurs, and all derivatives are products of the density there:
// both are read off one table, which errs by less than 3e-5, a hundredth of what real pixels leave. Pixels further from every edge
// than it is felt tell of contrast and background alone: only what a pixel tells of is summed. Cost: about 5 ns a disc and pixel,
// 10 where it lies at an edge.
#include "marey/detect/markers/marker_disc_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

namespace marey::detect::markers {
namespace {

constexpr int kMostSplitSteps = 20;
constexpr double kSplitSettled = 5e-3;  // px; the next step would be a hundredth of it
constexpr double kSplitGain = 3e-3;     // of the squares left: a smaller step changes no decision
constexpr double kFlat = 4.5;           // blurs from the edge beyond which it is not felt

/// The normal distribution from −kFlat to kFlat: what lies above, and the density.
class EdgeTable {
 public:
  EdgeTable() {
    for (int i = 0; i <= kEntries; ++i) {
      const double u = static_cast<double>(i) / kPerBlur - kFlat;
      table_[static_cast<std::size_t>(i)] = {std::erfc(u / std::numbers::sqrt2) / 2,
                                             std::exp(-u * u / 2) / std::sqrt(2 * std::numbers::pi)};
    }
    table_[kEntries + 1] = table_[kEntries];
  }

  /// For |u| <= kFlat.
  std::pair<double, double> at(double u) const {
    const double place = (u + kFlat) * kPerBlur;
    const auto i = static_cast<std::size_t>(place);
    const double within = place - static_cast<double>(i);
    const auto &low = table_[i], &high = table_[i + 1];
    return {low.first + within * (high.first - low.first), low.second + within * (high.second - low.second)};
  }

 private:
  static constexpr int kPerBlur = 64;
  static constexpr int kEntries = static_cast<int>(2 * kFlat * kPerBlur);
  std::array<std::pair<double, double>, kEntries + 2> table_;
};

const EdgeTable kEdges;

struct Edge {
  double share = 0;
  double slope_x = 0, slope_y = 0, slope_radius = 0, slope_blur = 0;
};

/// A disc's share at (dx, dy) from its centre and its derivatives by centre, radius and blur.
Edge edge(double dx, double dy, double radius, double blur) {
  const double away = dx * dx + dy * dy + 1.0 / 12;
  const double outer = radius + kFlat * blur, inner = radius - kFlat * blur;
  if (away >= outer * outer) return {};
  if (inner > 0 && away <= inner * inner) return {1.0};
  const double distance = std::sqrt(away), steep = 1 / blur, turn = 1 / distance;
  const double u = (distance - radius) * steep;
  if (std::abs(u) >= kFlat) return {u < 0 ? 1.0 : 0.0};
  const auto [share, height] = kEdges.at(u);
  const double density = height * steep;
  return {share, density * dx * turn, density * dy * turn, density, density * u};
}

/// What a pixel tells: the model's share there, and its derivatives by the parameters that it tells of.
struct PixelSlopes {
  double share = 0;
  std::array<double, kMostParameters> slope;
  std::array<int, kMostParameters> which;
  int count = 0;

  void add(int parameter, double value) {
    slope[static_cast<std::size_t>(count)] = value;
    which[static_cast<std::size_t>(count++)] = parameter;
  }
};

/// How far along the sweep a pixel lies that is (dx, dy) from a disc's middle place: −1 at one end, 1 at the other.
double along_sweep(const Vector<2>& half, double dx, double dy) {
  const double length = half.squaredNorm();
  return length > 1e-9 ? std::clamp((dx * half.x() + dy * half.y()) / length, -1.0, 1.0) : 0;
}

/// Discs that hide each other, whichever lies in front; or whose light adds up, as far as the sensor goes.
void tell(const DiscsModel& model, double x, double y, PixelSlopes& told) {
  std::array<Edge, kMostDiscs> edges;
  std::array<double, kMostDiscs> place{};
  const Vector<2> half = model.swept ? Vector<2>(model.p.tail<2>()) : Vector<2>(0, 0);
  double outside = 1, sum = 0, blur = 0;
  for (int i = 0; i < model.discs; ++i) {
    const double* disc = model.p.data() + kFirstDisc + 3 * i;
    double dx = x - disc[0], dy = y - disc[1];
    if (model.swept) {
      const double t = place[static_cast<std::size_t>(i)] = along_sweep(half, dx, dy);
      dx -= t * half.x(), dy -= t * half.y();
    }
    const Edge& e = edges[static_cast<std::size_t>(i)] = edge(dx, dy, disc[2], model.p[kDiscsBlur]);
    outside *= 1 - e.share;
    sum += e.share;
  }
  const double most = (model.ceiling - model.p[kDiscsBackground]) / model.p[kDiscsContrast];
  told.share = model.adds ? std::min(sum, most) : 1 - outside;
  if (model.adds && sum > most) return;
  Vector<2> sweep(0, 0);
  for (int i = 0; i < model.discs; ++i) {
    const Edge& e = edges[static_cast<std::size_t>(i)];
    if (e.slope_radius == 0) continue;
    double others = 1;
    for (int j = 0; j < model.discs && !model.adds; ++j) others *= j == i ? 1 : 1 - edges[static_cast<std::size_t>(j)].share;
    told.add(kFirstDisc + 3 * i, others * e.slope_x);
    told.add(kFirstDisc + 3 * i + 1, others * e.slope_y);
    told.add(kFirstDisc + 3 * i + 2, others * e.slope_radius);
    sweep += others * place[static_cast<std::size_t>(i)] * Vector<2>(e.slope_x, e.slope_y);
    blur += others * e.slope_blur;
  }
  if (told.count == 0) return;
  told.add(kDiscsBlur, blur);
  if (!model.swept) return;
  told.add(kFirstDisc + 3 * model.discs, sweep.x());
  told.add(kFirstDisc + 3 * model.discs + 1, sweep.y());
}

DiscsNormal linearised(const DiscsModel& model, const MarkerWindow& window, const std::vector<float>& value) {
  const auto n = model.p.size();
  DiscsNormal normal{DiscsInformation::Zero(n, n), DiscsParameters::Zero(n)};
  const double contrast = model.p[kDiscsContrast], background = model.p[kDiscsBackground];
  for (std::size_t i = 0; i < static_cast<std::size_t>(window.count); ++i) {
    PixelSlopes told;
    tell(model, window.x[i], window.y[i], told);
    const double residual = value[i] - background - contrast * told.share;
    for (int a = 0; a < told.count; ++a) told.slope[static_cast<std::size_t>(a)] *= contrast;
    if (told.share != 0) told.add(kDiscsContrast, told.share);
    told.add(kDiscsBackground, 1);
    for (int a = 0; a < told.count; ++a) {
      const double slope = told.slope[static_cast<std::size_t>(a)];
      const int row = told.which[static_cast<std::size_t>(a)];
      for (int b = 0; b <= a; ++b)
        normal.information(row, told.which[static_cast<std::size_t>(b)]) += slope * told.slope[static_cast<std::size_t>(b)];
      normal.gradient[row] += slope * residual;
    }
    normal.squares += residual * residual;
  }
  // Each pair stands in one of its two places, whichever parameter was told of first.
  const DiscsInformation both = normal.information + normal.information.transpose();
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) normal.information(a, b) = a == b ? normal.information(a, a) : both(a, b);
  }
  return normal;
}

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

DiscsSolution fit_discs(DiscsModel model, const MarkerWindow& window, const std::vector<float>& value, double stiffness) {
  const double blur = model.p[kDiscsBlur];
  const auto cost = [&](const DiscsModel& m, const DiscsNormal& n) {
    return n.squares + stiffness * (m.p[kDiscsBlur] - blur) * (m.p[kDiscsBlur] - blur);
  };
  DiscsSolution best{model, linearised(model, window, value)};
  double damping = 1e-2;
  for (int step = 0; step < kMostSplitSteps; ++step) {
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
