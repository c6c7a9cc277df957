#include "marey/track/ball/ball_search.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "marey/track/ball/ball_smooth.h"

namespace marey::track::ball {
namespace {

constexpr double kRate = 25;

/// 10 m up, looking across the pitch from a place before its touchline.
GroundView looking_across(double x) {
  const double tilt = 0.25;
  Matrix<3> turn;
  turn.row(0) = Vector<3>(1, 0, 0);
  turn.row(1) = Vector<3>(0, -std::sin(tilt), -std::cos(tilt));
  turn.row(2) = Vector<3>(0, std::cos(tilt), -std::sin(tilt));
  return GroundView(
      Camera(geometry::BrownLens{{1400, 1400}, {959.5, 539.5}, {}}, {turn, -turn * Vector<3>(x, -15, 10)}, {1920, 1080}));
}

/// A ball that is kicked from the grass at once and comes down: 26 m far, 4 m high.
std::vector<Vector<3>> arc(int frames) {
  std::vector<Vector<3>> places;
  Vector<3> place(20, 20, kBallRadius), velocity(13, 5, 8.5);
  constexpr int kFine = 20;
  for (int i = 0; i < frames; ++i) {
    places.push_back(place);
    for (int k = 0; k < kFine; ++k) {
      velocity += (Vector<3>(0, 0, -9.81) - 0.0133 * velocity.norm() * velocity) / (kRate * kFine);
      place += velocity / (kRate * kFine);
    }
  }
  return places;
}

struct Scene {
  std::shared_ptr<GroundViews> views;
  std::vector<BallMoment> moments;
};

/// What the cameras see of it: noisy by half a pixel, missed now and then, among `clutter` other things.
Scene seen(const std::vector<Vector<3>>& ball, const std::vector<double>& cameras, int clutter, double missed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 0.5);
  std::uniform_real_distribution<double> even(0, 1);
  std::vector<GroundView> views;
  for (const double x : cameras) views.push_back(looking_across(x));
  Scene scene{ground_views(views), {}};
  for (std::size_t i = 0; i < ball.size(); ++i) {
    BallMoment& moment = scene.moments.emplace_back();
    moment.index = static_cast<std::int64_t>(i);
    moment.time = timestamp_from_seconds(static_cast<double>(i) / kRate);
    moment.people.push_back({TrackId{1}, {19.6, 20}, {0, 0}});
    for (std::size_t c = 0; c < views.size(); ++c) {
      BallView& view = moment.views.emplace_back();
      view.camera = CameraId{static_cast<int>(c)};
      view.time = moment.time;
      if (even(random) >= missed)
        view.seen.push_back({*views[c].camera()->project(ball[i]) + Vector<2>(noise(random), noise(random)), 0.6, 1});
      for (int k = 0; k < clutter; ++k) view.seen.push_back({{1920 * even(random), 200 + 880 * even(random)}, 0.6, 0});
    }
  }
  return scene;
}

std::vector<BallState> followed(const Scene& scene) {
  BallSearch search(scene.views, {});
  for (const BallMoment& moment : scene.moments) search.add(moment);
  search.finish();
  const std::vector<BallStep> steps = search.take_decided();
  return smooth_ball(scene.moments, steps, *scene.views, {});
}

double worst(const std::vector<Vector<3>>& ball, const std::vector<BallState>& states) {
  double most = 0;
  for (std::size_t i = 3; i + 3 < ball.size(); ++i) most = std::max(most, (states[i].belief.place() - ball[i]).norm());
  return most;
}

TEST(BallSearch, OneCameraTellsAnArcsDepthByGravity) {
  const auto ball = arc(38);
  const auto states = followed(seen(ball, {30}, 10, 0.1, 5));
  ASSERT_EQ(states.size(), ball.size());
  for (std::size_t i = 3; i + 3 < ball.size(); ++i) EXPECT_EQ(states[i].mode, BallMode::flying) << i;
  EXPECT_LT(worst(ball, states), 1.8);
}

TEST(BallSearch, TwoCamerasTriangulate) {
  const auto ball = arc(38);
  EXPECT_LT(worst(ball, followed(seen(ball, {10, 50}, 10, 0.1, 6))), 1.2);
}

TEST(BallSearch, WithoutABallNothingIsFound) {
  const Scene scene = seen(arc(40), {30}, 12, 1.1, 7);
  int claimed = 0;
  for (const BallState& state : followed(scene)) claimed += state.cameras != 0 ? 1 : 0;
  EXPECT_LE(claimed, 6);
}

/// Everything that may follow, without a beam and without taking like for like.
double best_of_all(const std::shared_ptr<BallNode>& node, const Scene& scene, std::size_t next, const BallSearchOptions& options) {
  if (next == scene.moments.size()) return node->score;
  double best = -1e300;
  const double step = next == 0 ? 0 : 1 / kRate;
  for (BallNode& one : successors(node, scene.moments[next], step, *scene.views, options))
    best = std::max(best, best_of_all(std::make_shared<BallNode>(std::move(one)), scene, next + 1, options));
  return best;
}

TEST(BallSearch, FindsWhatTryingEverythingFinds) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Scene scene = seen(arc(4), {30}, 2, 0.2, seed);
    const BallSearchOptions options;
    BallSearch search(scene.views, options);
    for (const BallMoment& moment : scene.moments) search.add(moment);
    const double all = best_of_all(std::make_shared<BallNode>(), scene, 0, options);
    EXPECT_LE(search.best_score(), all + 1e-9) << "seed " << seed;
    EXPECT_NEAR(search.best_score(), all, 0.3) << "seed " << seed;  // like was taken for like
  }
}

}  // namespace
}  // namespace marey::track::ball
