// Two to four discs in one blob. The blob is told as the union of k discs with one edge width and one brightness: a pixel's share
// is 1 − Π (1 − sᵢ), whichever disc lies in front. All centres and radii, the contrast, the background and the blur are fitted
// together by Levenberg-Marquardt, begun from k-means of the bright pixels along the blob's long axis. Where discs add up instead
// of hiding each other the overlap is brighter than a disc; such pixels are cut to the discs' own level first. The rival is one
// marker in motion: a disc swept along a segment (distance to the segment instead of the point). The blob is split when the discs
// leave clearly less than the swept disc does, their radii are alike, and their centres lie apart. Cost: about 10 steps of k error
// functions a pixel, 50–100 µs a pair; the caller bounds the number of pairs.
#include "marey/detect/markers/marker_split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>

namespace marey::detect::markers {
namespace {

constexpr int kMostDiscs = 4;
constexpr int kMostSplitSteps = 20;
constexpr double kSplitSettled = 5e-3;    // px; the next step would be a hundredth of it
constexpr double kClearly = 0.5;          // of the squares that one swept disc leaves
constexpr double kClearlyExpected = 0.8;  // where the tracker knows of several
constexpr double kSurely = 20;            // noise variances: where discs fit to the noise, by how much they must fit better
constexpr double kSurelyExpected = -9;    // the tracker saw both: nearly as good will do
constexpr double kModelError = 0.006;     // of the contrast
constexpr double kLeastApart = 0.8;       // centres, in mean radii
constexpr double kFlat = 4.5;             // blurs from the edge beyond which it is not felt
constexpr double kMostUnlike = 2.2;       // larger radius over smaller

// Parameters: contrast, background, blur, then either x, y, radius of each disc, or x, y, radius and the half axis of a swept one.
enum { kDiscsContrast, kDiscsBackground, kDiscsBlur, kFirstDisc };

// On the stack, whatever the number of discs.
constexpr int kMostParameters = kFirstDisc + 3 * kMostDiscs;
using Parameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostParameters, 1>;
using Information = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostParameters, kMostParameters>;

struct Model {
  Parameters p;
  int discs = 1;
  bool swept = false;
  bool adds = false;     ///< discs add up instead of hiding each other
  double ceiling = 1e9;  ///< where they add up: saturation, in units of the window
};

struct Edge {
  double share = 0;
  double slope_x = 0, slope_y = 0, slope_radius = 0, slope_blur = 0;
};

/// A disc's share at (dx, dy) from its centre and its derivatives by centre, radius and blur.
Edge edge(double dx, double dy, double radius, double blur) {
  const double distance = std::sqrt(dx * dx + dy * dy + 1.0 / 12);
  const double u = (distance - radius) / blur;
  if (std::abs(u) > kFlat) return {u < 0 ? 1.0 : 0.0};
  const double density = std::exp(-u * u / 2) / (std::sqrt(2 * std::numbers::pi) * blur);
  return {std::erfc(u / std::numbers::sqrt2) / 2, density * dx / distance, density * dy / distance, density, density * u};
}

/// The model at a pixel; `slope` becomes its derivatives.
double swept_share(const Model& model, double x, double y, Parameters& slope) {
  const double hx = model.p[kFirstDisc + 3], hy = model.p[kFirstDisc + 4];
  const double dx = x - model.p[kFirstDisc], dy = y - model.p[kFirstDisc + 1];
  const double length = hx * hx + hy * hy;
  const double t = length > 1e-9 ? std::clamp((dx * hx + dy * hy) / length, -1.0, 1.0) : 0;
  const Edge e = edge(dx - t * hx, dy - t * hy, model.p[kFirstDisc + 2], model.p[kDiscsBlur]);
  slope[kDiscsBlur] = e.slope_blur;
  slope[kFirstDisc] = e.slope_x;
  slope[kFirstDisc + 1] = e.slope_y;
  slope[kFirstDisc + 2] = e.slope_radius;
  slope[kFirstDisc + 3] = t * e.slope_x;
  slope[kFirstDisc + 4] = t * e.slope_y;
  return e.share;
}

double union_share(const Model& model, double x, double y, Parameters& slope) {
  std::array<Edge, kMostDiscs> edges;
  double outside = 1;
  for (int i = 0; i < model.discs; ++i) {
    const auto disc = model.p.segment<3>(kFirstDisc + 3 * i);
    edges[i] = edge(x - disc[0], y - disc[1], disc[2], model.p[kDiscsBlur]);
    outside *= 1 - edges[i].share;
  }
  slope[kDiscsBlur] = 0;
  for (int i = 0; i < model.discs; ++i) {
    double others = 1;
    for (int j = 0; j < model.discs; ++j) others *= j == i ? 1 : 1 - edges[j].share;
    slope[kFirstDisc + 3 * i] = others * edges[i].slope_x;
    slope[kFirstDisc + 3 * i + 1] = others * edges[i].slope_y;
    slope[kFirstDisc + 3 * i + 2] = others * edges[i].slope_radius;
    slope[kDiscsBlur] += others * edges[i].slope_blur;
  }
  return 1 - outside;
}

/// Discs whose light adds up, as far as the sensor goes.
double sum_share(const Model& model, double x, double y, Parameters& slope) {
  double sum = 0;
  slope[kDiscsBlur] = 0;
  for (int i = 0; i < model.discs; ++i) {
    const auto disc = model.p.segment<3>(kFirstDisc + 3 * i);
    const Edge e = edge(x - disc[0], y - disc[1], disc[2], model.p[kDiscsBlur]);
    sum += e.share;
    slope.segment<3>(kFirstDisc + 3 * i) << e.slope_x, e.slope_y, e.slope_radius;
    slope[kDiscsBlur] += e.slope_blur;
  }
  const double most = (model.ceiling - model.p[kDiscsBackground]) / model.p[kDiscsContrast];
  if (sum <= most) return sum;
  slope.setZero();
  return most;
}

double share_at(const Model& model, double x, double y, Parameters& slope) {
  if (model.swept) return swept_share(model, x, y, slope);
  return model.adds ? sum_share(model, x, y, slope) : union_share(model, x, y, slope);
}

struct Normal {
  Information information;
  Parameters gradient;
  double squares = 0;
};

Normal linearise(const Model& model, const MarkerWindow& window, const std::vector<float>& value) {
  const auto n = model.p.size();
  Normal normal{Information::Zero(n, n), Parameters::Zero(n)};
  Parameters slope(n);
  for (int i = 0; i < window.count; ++i) {
    const double share = share_at(model, window.x[i], window.y[i], slope);
    const double residual = value[i] - model.p[kDiscsBackground] - model.p[kDiscsContrast] * share;
    slope.tail(n - kDiscsBlur) *= model.p[kDiscsContrast];
    slope[kDiscsContrast] = share;
    slope[kDiscsBackground] = 1;
    for (Eigen::Index a = 0; a < n; ++a) {
      if (slope[a] == 0) continue;  // most discs are far from most pixels
      for (Eigen::Index b = 0; b <= a; ++b) normal.information(a, b) += slope[a] * slope[b];
    }
    normal.gradient += slope * residual;
    normal.squares += residual * residual;
  }
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = a + 1; b < n; ++b) normal.information(a, b) = normal.information(b, a);
  }
  return normal;
}

bool sensible(const Model& model, double reach) {
  const auto& p = model.p;
  if (!p.allFinite() || p[kDiscsBlur] < 0.2 || p[kDiscsBlur] > reach || p[kDiscsContrast] < 0.1 || p[kDiscsContrast] > 10)
    return false;
  for (int i = 0; i < model.discs; ++i) {
    const double radius = p[kFirstDisc + 3 * i + 2];
    if (radius < 0.2 || radius > reach || p.segment<2>(kFirstDisc + 3 * i).norm() > reach) return false;
  }
  return true;
}

struct Solution {
  Model model;
  Normal normal;
};

/// `stiffness` pulls the blur to where it began: two close discs hardly tell it.
Solution minimise(Model model, const MarkerWindow& window, const std::vector<float>& value, double stiffness) {
  const double blur = model.p[kDiscsBlur];
  const auto cost = [&](const Model& m, const Normal& n) { return n.squares + stiffness * std::pow(m.p[kDiscsBlur] - blur, 2); };
  Solution best{model, linearise(model, window, value)};
  double damping = 1e-2;
  for (int step = 0; step < kMostSplitSteps; ++step) {
    Information information = best.normal.information;
    information.diagonal() += damping * best.normal.information.diagonal() + Parameters::Constant(model.p.size(), 1e-9);
    information(kDiscsBlur, kDiscsBlur) += stiffness;
    Parameters gradient = best.normal.gradient;
    gradient[kDiscsBlur] -= stiffness * (best.model.p[kDiscsBlur] - blur);
    const Parameters change = information.llt().solve(gradient);
    model.p = best.model.p + change;
    if (sensible(model, window.reach)) {
      Normal there = linearise(model, window, value);
      if (cost(model, there) < cost(best.model, best.normal)) {
        best = {model, std::move(there)};
        damping *= 0.2;
        if (change.cwiseAbs().maxCoeff() < kSplitSettled) break;
        continue;
      }
    }
    damping *= 8;
    if (damping > 1e4) break;
  }
  return best;
}

/// The level of a disc, where pixels are brighter than that: an overlap of discs that add up. Else nothing.
std::optional<float> level_below_overlap(const std::vector<float>& value, double noise) {
  std::vector<float> bright;
  std::copy_if(value.begin(), value.end(), std::back_inserter(bright), [](float v) { return v > 0.25f; });
  if (bright.size() < 8) return std::nullopt;
  const auto at = bright.begin() + static_cast<std::ptrdiff_t>(bright.size() * 6 / 10);
  std::nth_element(bright.begin(), at, bright.end());
  if (1.0f <= 1.2f * *at + 5.0f * static_cast<float>(noise)) return std::nullopt;
  return *at;
}

/// k centres by k-means over the pixels above half the contrast, begun in even steps along the long axis.
std::vector<Vector<2>> centres(const MarkerWindow& window, const std::vector<float>& value, int k, const Vector<2>& axis) {
  std::vector<Vector<2>> result;
  result.reserve(k);
  for (int i = 0; i < k; ++i) result.push_back(window.centroid + axis * (2.0 * i / (k - 1) - 1));
  for (int round = 0; round < 10; ++round) {
    std::array<Vector<2>, kMostDiscs> sums;
    std::array<double, kMostDiscs> counts{};
    sums.fill(Vector<2>::Zero());
    for (int i = 0; i < window.count; ++i) {
      if (value[i] < 0.4f) continue;
      const Vector<2> place(window.x[i], window.y[i]);
      const auto nearest = std::min_element(result.begin(), result.end(), [&](const auto& a, const auto& b) {
        return (a - place).squaredNorm() < (b - place).squaredNorm();
      });
      sums[nearest - result.begin()] += place;
      counts[nearest - result.begin()] += 1;
    }
    for (int j = 0; j < k; ++j) {
      if (counts[j] > 0) result[j] = sums[j] / counts[j];
    }
  }
  return result;
}

bool distinct(const Model& model) {
  for (int i = 0; i < model.discs; ++i) {
    for (int j = 0; j < i; ++j) {
      const auto a = model.p.segment<3>(kFirstDisc + 3 * i), b = model.p.segment<3>(kFirstDisc + 3 * j);
      const double apart = (a.head<2>() - b.head<2>()).norm();
      if (apart < kLeastApart * (a[2] + b[2]) / 2) return false;
      if (std::max(a[2], b[2]) > kMostUnlike * std::min(a[2], b[2])) return false;
    }
  }
  return true;
}

std::vector<MarkerShape> shapes(const Solution& solution, const MarkerWindow& window, double stiffness) {
  const Model& model = solution.model;
  Information information = solution.normal.information;
  information(kDiscsBlur, kDiscsBlur) += stiffness;
  information.diagonal().array() += 1e-9;
  const double left = solution.normal.squares / std::max<double>(1, window.count - static_cast<double>(model.p.size()));
  const Information spread = information.llt().solve(Information::Identity(model.p.size(), model.p.size())) * left;
  std::vector<MarkerShape> result;
  for (int i = 0; i < model.discs; ++i) {
    MarkerShape shape;
    const int at = kFirstDisc + 3 * i;
    shape.centre = window.origin + model.p.segment<2>(at);
    shape.covariance = spread.block<2, 2>(at, at) + Matrix<2>::Identity() * 1e-4;
    shape.radius = model.p[at + 2];
    shape.blur = model.p[kDiscsBlur];
    shape.contrast = model.p[kDiscsContrast] * window.scale;
    shape.misfit = std::sqrt(solution.normal.squares / window.count);
    shape.fitted = true;
    result.push_back(shape);
  }
  std::sort(result.begin(), result.end(), [](const MarkerShape& a, const MarkerShape& b) {
    return std::pair(a.centre.x(), a.centre.y()) < std::pair(b.centre.x(), b.centre.y());
  });
  return result;
}

/// The ellipse of a blob's moments, px.
struct BlobEllipse {
  double half_length = 0, half_width = 0;
  Vector<2> along = Vector<2>::UnitX();
};

BlobEllipse ellipse_of(const MarkerBlob& blob) {
  const double mean = (blob.var_x + blob.var_y) / 2;
  const double spread = std::hypot((blob.var_x - blob.var_y) / 2, blob.cov_xy);
  const double angle = std::atan2(blob.cov_xy, (blob.var_x - blob.var_y) / 2) / 2;
  return {2 * std::sqrt(mean + spread), 2 * std::sqrt(std::max(mean - spread, 1.0 / 12)), {std::cos(angle), std::sin(angle)}};
}

/// One disc that moved while it was seen.
Model swept_disc(const BlobEllipse& ellipse, const MarkerWindow& window, double blur) {
  Model swept{Parameters(kFirstDisc + 5), 1, true};
  const Vector<2> reach = ellipse.along * std::max(ellipse.half_length - ellipse.half_width, 0.3);
  swept.p << 0.9, 0.0, blur, window.centroid.x(), window.centroid.y(), std::max(ellipse.half_width - 0.3, 0.4), reach.x(),
      reach.y();
  return swept;
}

/// So many discs, whose places are still to be set.
Model several_discs(int count, const MarkerWindow& window, const MarkerSurroundings& around, double blur) {
  Model discs{Parameters(kFirstDisc + 3 * count), count};
  discs.ceiling = around.dark ? window.background / window.scale : std::abs(around.white - window.background) / window.scale;
  discs.p.head<kFirstDisc>() << 0.9, 0.0, blur;
  return discs;
}

}  // namespace

std::vector<MarkerShape> split_markers(const MarkerWindow& window, const MarkerBlob& blob, const MarkerSurroundings& around,
                                       std::size_t expected) {
  if (window.count < 20) return {};
  const BlobEllipse ellipse = ellipse_of(blob);
  const double noise = around.noise / window.scale;
  const double stiffness = noise * noise / 0.01;
  const double blur = around.blur.value_or(0.65);
  const std::vector<float> whole(window.value.begin(), window.value.begin() + window.count);
  const std::optional<float> overlap = level_below_overlap(whole, noise);
  std::vector<float> value = whole;
  if (overlap) {
    for (float& v : value) v = std::min(v, 1.05f * *overlap);
  }

  const Solution rival = minimise(swept_disc(ellipse, window, blur), window, value, stiffness);
  const double share = expected >= 2 ? kClearlyExpected : kClearly;
  const double floor = window.count * (1.5 * noise * noise + kModelError * kModelError);  // what right models leave
  const double surely = expected >= 2 ? kSurelyExpected : kSurely;
  double to_beat = rival.normal.squares;
  std::vector<MarkerShape> best;
  for (int k = 2; k <= kMostDiscs; ++k) {
    Model discs = several_discs(k, window, around, blur);
    const double radius = std::max(0.4, std::sqrt(window.half_area / (k * std::numbers::pi)));
    const auto places = centres(window, value, k, ellipse.along * ellipse.half_length * (1 - 1.0 / k));
    for (int i = 0; i < k; ++i) discs.p.segment<3>(kFirstDisc + 3 * i) << places[i].x(), places[i].y(), radius;
    Solution solution = minimise(discs, window, value, stiffness);
    if (overlap && k == 2) {  // more discs that add up could tell any streak
      discs.adds = true;
      discs.p[kDiscsContrast] = *overlap;
      Solution sum = minimise(discs, window, whole, stiffness);
      if (sum.normal.squares < std::min(floor, solution.normal.squares)) solution = std::move(sum);
    }
    const double left = solution.normal.squares;
    const bool clear = left < share * to_beat || (left < floor && to_beat - left > surely * noise * noise);
    if (!distinct(solution.model) || !clear) {
      if (k == 2) continue;  // three in a corner may fit where two do not
      break;
    }
    best = shapes(solution, window, stiffness);
    if (left < floor || best.front().misfit < 0.04) break;
    to_beat = left;
  }
  return best;
}

}  // namespace marey::detect::markers
