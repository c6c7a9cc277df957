#include "marey/calibrate/board/choose_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <Eigen/LU>

#include "marey/core/geometry.h"

namespace marey::calibrate::board {
namespace {

constexpr int kColumns = 10, kRows = 8;  // fields of the image
constexpr double kBlurred = 0.5;         // of the median sharpness

struct Features {
  std::vector<int> fields;              // where corners are
  Vector<3> shape = Vector<3>::Zero();  // log size, and two numbers of its slant: 1 is a step that matters
  double sharpness = 0;
};

Features features_of(const ViewCandidate& candidate, const cv::Size& size) {
  Features features;
  features.sharpness = candidate.sharpness;
  std::set<int> fields;
  Vector<2> mean = Vector<2>::Zero();
  const auto& corners = candidate.view->corners;
  for (const BoardCorner& corner : corners) {
    const int x = std::clamp(static_cast<int>((corner.pixel.x() + 0.5) / size.width * kColumns), 0, kColumns - 1);
    const int y = std::clamp(static_cast<int>((corner.pixel.y() + 0.5) / size.height * kRows), 0, kRows - 1);
    fields.insert(y * kColumns + x);
    mean += corner.pixel / static_cast<double>(corners.size());
  }
  features.fields.assign(fields.begin(), fields.end());
  Matrix<2> scatter = Matrix<2>::Identity() * 1e-6;
  for (const BoardCorner& corner : corners) scatter += (corner.pixel - mean) * (corner.pixel - mean).transpose();
  const double area = std::sqrt(scatter.determinant());
  // The scatter's shape shows how the board is turned and foreshortened.
  features.shape = {std::log(area) / 2 / 0.5, (scatter(0, 0) - scatter(1, 1)) / scatter.trace() / 0.3,
                    2 * scatter(0, 1) / scatter.trace() / 0.3};
  return features;
}

}  // namespace

std::vector<std::size_t> choose_views(std::span<const ViewCandidate> candidates, cv::Size size, std::size_t maximum) {
  std::vector<double> sharpness;
  for (const ViewCandidate& candidate : candidates) sharpness.push_back(candidate.sharpness);
  std::ranges::sort(sharpness);
  const double limit = sharpness.empty() ? 0 : kBlurred * sharpness[sharpness.size() / 2];
  std::vector<std::size_t> open, taken;
  std::vector<Features> features;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    features.push_back(features_of(candidates[i], size));
    if (candidates[i].sharpness >= limit) open.push_back(i);
  }
  std::array<int, static_cast<std::size_t>(kColumns * kRows)> detected{};
  while (!open.empty() && taken.size() < maximum) {
    const auto merit = [&](std::size_t i) {
      double value = 0;
      for (const int field : features[i].fields) value += 1.0 / (1 + detected[static_cast<std::size_t>(field)]);
      double apart = 4;
      for (const std::size_t other : taken) apart = std::min(apart, (features[i].shape - features[other].shape).norm());
      return (value / 4 + apart) * features[i].sharpness;
    };
    auto best = open.begin();
    double most_worth = -1;
    for (auto at = open.begin(); at != open.end(); ++at) {
      const double value = merit(*at);
      if (value > most_worth) most_worth = value, best = at;
    }
    for (const int field : features[*best].fields) ++detected[static_cast<std::size_t>(field)];
    taken.push_back(*best);
    open.erase(best);
  }
  std::ranges::sort(taken);
  return taken;
}

}  // namespace marey::calibrate::board
