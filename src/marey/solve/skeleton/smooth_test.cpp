#include "marey/solve/skeleton/smooth.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "marey/solve/skeleton/human.h"

namespace marey::solve::skeleton {
namespace {

TEST(Smooth, BendsWhatWasHiddenToBothEnds) {
  std::mt19937 random(11);
  const auto noise = [&](double size) { return size * (static_cast<double>(random()) / 2147483648.0 - 1); };
  std::vector<StandingSegment> segments;
  std::vector<StandingMarker> markers;
  for (const auto& [name, location] : std::vector<std::pair<std::string, Vector<3>>>{{"pelvis", {0, 0, 0.95}},
                                                                                     {"left_thigh", {0, 0.09, 0.9}},
                                                                                     {"left_shank", {0, 0.09, 0.48}},
                                                                                     {"left_foot", {0, 0.09, 0.08}}}) {
    segments.push_back({name, {Matrix<3>::Identity(), location}});
    for (int i = 0; i < 4; ++i)
      markers.push_back({name + std::to_string(i), name, location + Vector<3>(noise(0.08), noise(0.08), noise(0.08))});
  }
  const Skeleton skeleton = human_skeleton("leg", segments, markers);
  const auto knee = static_cast<std::size_t>(*skeleton.coordinate("left_knee_flexion"));
  const int shank = *skeleton.segment("left_shank");
  std::vector<ObservedMarkers> frames;
  std::vector<double> truth;
  std::vector<std::vector<double>> first_pass;
  PoseSolver solver(skeleton);
  for (int f = 0; f < 200; ++f) {
    std::vector<double> coordinates = skeleton.rest();
    for (std::size_t c = 0; c < coordinates.size(); ++c) coordinates[c] = 0.4 * std::sin(0.05 * f + static_cast<double>(c));
    coordinates[knee] = 0.7 + 0.6 * std::sin(0.06 * f);
    truth.push_back(coordinates[knee]);
    const auto pose = pose_of(skeleton, coordinates);
    ObservedMarkers detected;
    for (const SkeletonMarker& marker : skeleton.markers) {
      const bool hidden = f >= 90 && f < 120 && marker.segment >= shank;
      const Vector<3> location =
          pose[static_cast<std::size_t>(marker.segment)] * marker.position + Vector<3>(noise(0.001), noise(0.001), noise(0.001));
      detected.push_back(hidden ? std::nullopt : std::optional<Vector<3>>(location));
    }
    first_pass.push_back(solver.step(0.01, detected).coordinates);
    frames.push_back(std::move(detected));
  }
  const auto worst = [&](const std::vector<std::vector<double>>& rows) {
    double off = 0;
    for (std::size_t f = 0; f < rows.size(); ++f) off = std::max(off, std::abs(rows[f][knee] - truth[f]));
    return off;
  };
  const auto smoothed = smooth(skeleton, first_pass, frames, 100);
  ASSERT_EQ(smoothed.size(), first_pass.size());
  EXPECT_GT(worst(first_pass), 0.2) << "what continues as it went is wrong soon";
  EXPECT_LT(worst(smoothed), 0.06);
  // Windows change nothing.
  const auto in_windows = smooth(skeleton, first_pass, frames, 100, {.window = 70, .overlap = 60});
  for (std::size_t f = 0; f < smoothed.size(); ++f) EXPECT_NEAR(in_windows[f][knee], smoothed[f][knee], 2e-3) << f;
}

}  // namespace
}  // namespace marey::solve::skeleton
