#include "marey/source/stabilise/scene_appearance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace marey::source::stabilise {
namespace {

constexpr int kMaxAcross = 400, kMinAcross = 60;   // px: halved until below
constexpr int kAround = 13;                        // px, on each size, over which contrast is local
constexpr double kNoise = 3;                       // grey levels of local contrast that are nothing
constexpr double kAlikeReach = 0.8;                // of local contrast: what differs by more is something else
constexpr double kByChance = 0.25;                 // share of any two images that is alike
constexpr double kUnobserved = 0.3;                // of the scene, which counts as seen by chance
constexpr std::size_t kStarts = 10, kTracked = 3;  // shifts; of those, followed to the larger sizes
constexpr int kApart = 2;                          // px of the smallest size between two starts
constexpr int kSteps = 8;
constexpr double kStill = 0.03;            // px of a step that is the last
constexpr double kMinAlike = 0.4;          // share
constexpr double kMinTexture = 0.05;       // mean weight
constexpr double kAnotherPosition = 0.02;  // of the image's width

SceneAppearance::Level level_of(const cv::Mat& image, double scale) {
  SceneAppearance::Level level{.contrast = {}, .weight = {}, .scale = scale};
  cv::Mat grey, mean, squares, deviation;
  image.convertTo(grey, CV_32F);
  cv::boxFilter(grey, mean, CV_32F, {kAround, kAround}, {-1, -1}, true, cv::BORDER_REFLECT);
  grey -= mean;
  cv::boxFilter(grey.mul(grey), squares, CV_32F, {kAround, kAround}, {-1, -1}, true, cv::BORDER_REFLECT);
  cv::sqrt(squares, deviation);
  cv::divide(grey, cv::max(deviation, kNoise), level.contrast);
  level.weight = cv::min(cv::max((deviation - kNoise) / kNoise, 0.0), 1.0);
  return level;
}

double alike(double off) {
  return std::max(0.0, 1 - off * off / (kAlikeReach * kAlikeReach));
}

/// What is not seen counts as what is alike by chance.
double fraction_of(double seen_alike, double detected, double all) {
  return all > 0 ? (seen_alike + kUnobserved * kByChance * all) / (detected + kUnobserved * all) : 0;
}

/// The share that is alike where `now` is shifted by whole pixels.
double alike_at(const SceneAppearance::Level& scene, const SceneAppearance::Level& now, cv::Point by, double all) {
  const cv::Rect detected = cv::Rect({}, scene.contrast.size()) & cv::Rect(-by, now.contrast.size());
  double sum = 0, weights = 0;
  for (int y = detected.y; y < detected.br().y; ++y) {
    const auto* here = scene.contrast.ptr<float>(y);
    const auto* weight = scene.weight.ptr<float>(y);
    const auto* there = now.contrast.ptr<float>(y + by.y);
    for (int x = detected.x; x < detected.br().x; ++x) {
      sum += static_cast<double>(weight[x]) * alike(there[x + by.x] - here[x]);
      weights += static_cast<double>(weight[x]);
    }
  }
  return fraction_of(sum, weights, all);
}

struct Start {
  cv::Point by;
  double fraction = 0;
};

/// The best few of all shifts, apart from each other.
std::vector<Start> best_shifts(const SceneAppearance::Level& scene, const SceneAppearance::Level& now, int farthest) {
  std::vector<Start> all, best;
  const double weights = cv::sum(scene.weight)[0];
  for (int y = -farthest; y <= farthest; ++y) {
    for (int x = -farthest; x <= farthest; ++x) all.push_back({{x, y}, alike_at(scene, now, {x, y}, weights)});
  }
  std::stable_sort(all.begin(), all.end(), [](const Start& a, const Start& b) { return a.fraction > b.fraction; });
  for (const Start& one : all) {
    const auto near = [&](const Start& other) {
      return std::abs(one.by.x - other.by.x) <= kApart && std::abs(one.by.y - other.by.y) <= kApart;
    };
    if (best.size() < kStarts && std::none_of(best.begin(), best.end(), near)) best.push_back(one);
  }
  return best;
}

PinholeView scaled_view(const PinholeView& view, double scale) {
  return {view.focal / scale, (view.principal + Vector<2>(0.5, 0.5)) / scale - Vector<2>(0.5, 0.5)};
}

/// `now` as the camera at rest would see it; `seen` is 1 where it does.
cv::Mat brought_back(const SceneAppearance::Level& now, const SceneMotion& motion, const PinholeView& view, cv::Mat& detected) {
  const Matrix<3> h = moved_from_rest(motion, view);
  const cv::Matx33d by(h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1), h(2, 2));
  const int how = cv::INTER_LINEAR | cv::WARP_INVERSE_MAP;
  cv::Mat back;
  cv::warpPerspective(now.contrast, back, by, now.contrast.size(), how, cv::BORDER_REPLICATE);
  cv::warpPerspective(cv::Mat::ones(now.contrast.size(), CV_8UC1), detected, by, now.contrast.size(),
                      cv::INTER_NEAREST | cv::WARP_INVERSE_MAP);
  return back;
}

double alike_with(const SceneAppearance::Level& scene, const SceneAppearance::Level& now, const SceneMotion& motion,
                  const PinholeView& view) {
  cv::Mat detected;
  const cv::Mat back = brought_back(now, motion, view, detected);
  double sum = 0, weights = 0;
  for (int y = 0; y < back.rows; ++y) {
    for (int x = 0; x < back.cols; ++x) {
      if (detected.at<std::uint8_t>(y, x) == 0) continue;
      const double weight = scene.weight.at<float>(y, x);
      sum += weight * alike(back.at<float>(y, x) - scene.contrast.at<float>(y, x));
      weights += weight;
    }
  }
  return fraction_of(sum, weights, cv::sum(scene.weight)[0]);
}

/// One step of Gauss and Newton; how far it moved the image, px.
double refine_once(SceneMotion& motion, const SceneAppearance::Level& scene, const SceneAppearance::Level& now,
                   const PinholeView& view) {
  cv::Mat detected;
  const cv::Mat back = brought_back(now, motion, view, detected);
  Matrix<3> information = 1e-3 * Matrix<3>::Identity();
  information(2, 2) = 1e-3 * view.focal * view.focal;
  Vector<3> slope = Vector<3>::Zero();
  for (int y = 1; y + 1 < back.rows; ++y) {
    const auto *above = back.ptr<float>(y - 1), *row = back.ptr<float>(y), *below = back.ptr<float>(y + 1);
    for (int x = 1; x + 1 < back.cols; ++x) {
      const double weight = scene.weight.at<float>(y, x);
      if (weight <= 0 || detected.at<std::uint8_t>(y, x) == 0) continue;
      const double off = row[x] - scene.contrast.at<float>(y, x);
      const double robust = weight / std::pow(1 + off * off / (kAlikeReach * kAlikeReach / 4), 2);
      const double across = (row[x + 1] - row[x - 1]) / 2.0, down = (below[x] - above[x]) / 2.0;
      const Vector<3> by(across, down, down * (x - view.principal.x()) - across * (y - view.principal.y()));
      information += robust * by * by.transpose();
      slope += robust * off * by;
    }
  }
  const Vector<3> step = information.ldlt().solve(slope);
  motion.turn += Vector<3>(step.y() / view.focal, -step.x() / view.focal, -step.z());
  return step.head<2>().norm() + std::abs(step.z()) * view.principal.x();
}

}  // namespace

SceneAppearance::SceneAppearance(const cv::Mat& image) {
  cv::Mat now = image;
  double scale = 1;
  const auto halve = [&] {
    cv::resize(now, now, {now.cols / 2, now.rows / 2}, 0, 0, cv::INTER_AREA);
    scale *= 2;
  };
  while (now.cols > kMaxAcross) halve();
  levels_.push_back(level_of(now, scale));
  while (now.cols > kMinAcross && now.rows > kAround) {
    halve();
    levels_.push_back(level_of(now, scale));
  }
  std::reverse(levels_.begin(), levels_.end());
}

bool SceneAppearance::can_be_found() const {
  return !levels_.empty() && cv::mean(levels_.back().weight)[0] > kMinTexture;
}

SceneAppearance::Found SceneAppearance::tracked(const SceneAppearance& now, SceneMotion motion, const PinholeView& view,
                                                std::size_t first, std::size_t end) const {
  for (std::size_t i = first; i < end; ++i) {
    const PinholeView here = scaled_view(view, levels_[i].scale);
    for (int step = 0; step < kSteps; ++step) {
      if (refine_once(motion, levels_[i], now.levels_[i], here) < kStill) break;
    }
  }
  const std::size_t last = end - 1;
  return {motion, alike_with(levels_[last], now.levels_[last], motion, scaled_view(view, levels_[last].scale))};
}

std::optional<SceneAppearance::Found> SceneAppearance::find(const SceneAppearance& now, const PinholeView& view, double farthest,
                                                            double plainly) const {
  if (!can_be_found() || now.empty() || now.levels_.back().contrast.size() != levels_.back().contrast.size()) return std::nullopt;
  const Level &small = levels_.front(), &small_now = now.levels_.front();
  const std::size_t all = levels_.size(), evaluated = std::max<std::size_t>(1, all - 1);  // without the largest, which noise fills
  const std::size_t chosen = std::min<std::size_t>(2, evaluated);
  std::vector<Found> found;
  for (const Start& start : best_shifts(small, small_now, static_cast<int>(std::ceil(farthest / small.scale)))) {
    SceneMotion motion;
    motion.turn = {-start.by.y * small.scale / view.focal, start.by.x * small.scale / view.focal, 0};
    found.push_back(tracked(now, motion, view, 0, chosen));
  }
  const auto better = [](const Found& a, const Found& b) { return a.alike > b.alike; };
  const auto elsewhere = [&](const Found& a, const Found& b) {
    return (a.motion.turn - b.motion.turn).head<2>().norm() * view.focal > kAnotherPosition * 2 * view.principal.x();
  };
  std::stable_sort(found.begin(), found.end(), better);
  std::vector<Found> apart;
  for (Found& one : found) {
    const bool too_far = one.motion.turn.head<2>().norm() * view.focal > farthest;
    if (too_far || apart.size() == kTracked ||
        !std::all_of(apart.begin(), apart.end(), [&](const Found& other) { return elsewhere(one, other); }))
      continue;
    apart.push_back(evaluated > chosen ? tracked(now, one.motion, view, chosen, evaluated) : one);
  }
  std::stable_sort(apart.begin(), apart.end(), better);
  if (apart.empty() || apart.front().alike < kMinAlike) return std::nullopt;
  const auto second =
      std::find_if(apart.begin() + 1, apart.end(), [&](const Found& other) { return elsewhere(apart.front(), other); });
  if (second != apart.end() && apart.front().alike < second->alike + plainly) return std::nullopt;
  if (evaluated == all) return apart.front();
  return Found{tracked(now, apart.front().motion, view, evaluated, all).motion, apart.front().alike};
}

}  // namespace marey::source::stabilise
