#include "marey/track/ground/offline/ground_doubles.h"

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace marey::track::ground::offline {
namespace {

constexpr double kRate = 25;  // Hz

std::vector<Timestamp> instants(int count) {
  std::vector<Timestamp> times;
  for (int k = 0; k < count; ++k) times.push_back(timestamp_from_seconds(k / kRate));
  return times;
}

/// Which cameras see it at an instant; none: it is not seen.
using ObservedBy = std::function<CameraMask(int)>;

GroundTracklet tracklet(int track, int from, int to, const std::function<Vector<2>(double)>& method, const ObservedBy& observed_by,
                        std::uint64_t seed, double sigma = 0.15, std::array<std::int8_t, 3> colour = {90, 0, 0}) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> off;
  GroundTracklet one{.runs = {{TrackId{track}, 0}}, .confirmed = true, .samples = {}};
  for (int k = from; k < to; ++k) {
    const CameraMask cameras = observed_by(k);
    const double dx = sigma * off(engine), dy = sigma * off(engine);
    if (cameras == 0) continue;
    const Vector<2> location = method(k / kRate) + Vector<2>(dx, dy);
    GroundSample sample;
    sample.instant = k;
    sample.location = {static_cast<float>(location.x()), static_cast<float>(location.y())};
    sample.covariance = {static_cast<float>(sigma * sigma), 0, static_cast<float>(sigma * sigma)};
    sample.cameras = cameras;
    sample.colour = colour;
    sample.colour_deviation = 5;
    one.samples.push_back(sample);
  }
  return one;
}

Vector<2> strolls(double t) {
  return {20 + 1.5 * t, 30 + 0.4 * std::sin(t)};
}
Vector<2> a_little_aside(double t) {
  return strolls(t) + Vector<2>(0.2, 0.6);
}

TEST(GroundDoubles, TwoTracksThatAreFedByTurnsAreOne) {
  const auto times = instants(250);
  // The second begins beside the first, takes most of what the cameras see, and continues when the first ends.
  const auto merged =
      merge_doubles({tracklet(
                         3, 0, 150, strolls, [](int k) { return CameraMask(k < 60 || k % 4 == 0 ? 3 : 0); }, 1),
                     tracklet(
                         8, 60, 250, a_little_aside, [](int k) { return CameraMask(k % 4 == 0 && k < 150 ? 0 : 2); }, 2)},
                    times);
  ASSERT_EQ(merged.size(), 1U);
  ASSERT_EQ(merged[0].samples.size(), 250U);
  for (int k = 0; k < 250; ++k) EXPECT_EQ(merged[0].samples[static_cast<std::size_t>(k)].instant, k);
  EXPECT_EQ(merged[0].runs.front().track, TrackId{3});
  EXPECT_EQ(merged[0].runs.back().track, TrackId{8});
}

TEST(GroundDoubles, AHollowCopyWithinAnothersLifeGoes) {
  const auto merged = merge_doubles({tracklet(
                                         1, 0, 250, strolls, [](int k) { return CameraMask(k % 3 == 0 ? 1 : 3); }, 1),
                                     tracklet(
                                         2, 100, 130, a_little_aside, [](int k) { return CameraMask(k % 3 == 0 ? 2 : 0); }, 2)},
                                    instants(250));
  ASSERT_EQ(merged.size(), 1U);
  EXPECT_EQ(merged[0].samples.size(), 250U);
}

TEST(GroundDoubles, TwoWhomACameraSeesBothStayTwo) {
  for (const double aside : {0.5, 1.0}) {
    const auto alongside = [&](double t) { return Vector<2>(strolls(t) + Vector<2>(0, aside)); };
    EXPECT_EQ(merge_doubles({tracklet(
                                 1, 0, 250, strolls, [](int) { return CameraMask(1); }, 1),
                             tracklet(
                                 2, 60, 250, alongside, [](int k) { return CameraMask(k % 5 == 0 ? 1 : 0); }, 2)},
                            instants(250))
                  .size(),
              2U);
  }
}

TEST(GroundDoubles, OccludedPersonKeepsIdentity) {
  // Seen both before and after; for two seconds between only the one or the other.
  const auto one = [](int k) { return CameraMask(k < 100 || k >= 150 || k % 3 != 0 ? 1 : 0); };
  const auto other = [](int k) { return CameraMask(k < 100 || k >= 150 || k % 3 == 0 ? 1 : 0); };
  EXPECT_EQ(
      merge_doubles({tracklet(1, 0, 250, strolls, one, 1), tracklet(2, 0, 250, a_little_aside, other, 2)}, instants(250)).size(),
      2U);
}

TEST(GroundDoubles, OtherShirtsAreOtherPeople) {
  EXPECT_EQ(merge_doubles({tracklet(
                               1, 0, 150, strolls, [](int) { return CameraMask(1); }, 1),
                           tracklet(2, 60, 250, a_little_aside, [](int) { return CameraMask(2); }, 2, 0.15, {35, 15, -50})},
                          instants(250))
                .size(),
            2U);
}

TEST(GroundDoubles, SeparatingPersonIsDistinct) {
  const auto leaves = [](double t) { return Vector<2>(strolls(t) + Vector<2>(0.2, 0.4 + std::max(0.0, t - 5))); };
  EXPECT_EQ(merge_doubles({tracklet(
                               1, 0, 250, strolls, [](int) { return CameraMask(1); }, 1),
                           tracklet(
                               2, 60, 250, leaves, [](int) { return CameraMask(2); }, 2)},
                          instants(250))
                .size(),
            2U);
}

}  // namespace
}  // namespace marey::track::ground::offline
