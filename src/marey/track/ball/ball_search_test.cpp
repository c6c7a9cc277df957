#include "marey/track/ball/ball_search.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "marey/track/ball/ball_trajectory.h"

namespace marey::track::ball {
namespace {

constexpr double kRate = 25;

/// 10 m up, facing across the pitch from a place before its touchline.
GroundView facing_across(double x) {
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
  std::vector<Vector<3>> locations;
  Vector<3> location(20, 20, kBallRadius), velocity(13, 5, 8.5);
  constexpr int kFine = 20;
  for (int i = 0; i < frames; ++i) {
    locations.push_back(location);
    for (int k = 0; k < kFine; ++k) {
      velocity += (Vector<3>(0, 0, -9.81) - 0.0133 * velocity.norm() * velocity) / (kRate * kFine);
      location += velocity / (kRate * kFine);
    }
  }
  return locations;
}

struct Scene {
  std::shared_ptr<GroundViews> views;
  std::vector<BallObservations> time_steps;
};

BallSighting spot(const Vector<2>& pixel, double score) {
  BallSighting detected;
  detected.pixel = pixel;
  detected.score = score;
  return detected;
}

/// What the cameras see of it: noisy by half a pixel, missed now and then, among `clutter` other things.
Scene detected(const std::vector<Vector<3>>& ball, const std::vector<double>& cameras, int clutter, double missed,
               std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 0.5);
  std::uniform_real_distribution<double> even(0, 1);
  std::vector<GroundView> views;
  for (const double x : cameras) views.push_back(facing_across(x));
  Scene scene{ground_views(views), {}};
  for (std::size_t i = 0; i < ball.size(); ++i) {
    BallObservations& time_step = scene.time_steps.emplace_back();
    time_step.index = static_cast<std::int64_t>(i);
    time_step.time = timestamp_from_seconds(static_cast<double>(i) / kRate);
    time_step.people.push_back({TrackId{1}, {19.6, 20}, {0, 0}});
    for (std::size_t c = 0; c < views.size(); ++c) {
      BallView& view = time_step.views.emplace_back();
      view.camera = CameraId{static_cast<int>(c)};
      view.time = time_step.time;
      if (even(random) >= missed)
        view.detected.push_back(spot(*views[c].camera()->project(ball[i]) + Vector<2>(noise(random), noise(random)), 1));
      for (int k = 0; k < clutter; ++k) view.detected.push_back(spot({1920 * even(random), 200 + 880 * even(random)}, 0));
    }
  }
  return scene;
}

std::vector<BallState> tracked(const Scene& scene) {
  BallSearch search(scene.views, {});
  for (const BallObservations& time_step : scene.time_steps) search.add(time_step);
  search.finish();
  const std::vector<BallStep> steps = search.take_decided();
  return smooth_ball(scene.time_steps, steps, *scene.views, {});
}

double worst(const std::vector<Vector<3>>& ball, const std::vector<BallState>& states) {
  double maximum = 0;
  for (std::size_t i = 3; i + 3 < ball.size(); ++i) maximum = std::max(maximum, (states[i].belief.location() - ball[i]).norm());
  return maximum;
}

TEST(BallSearch, SingleCameraFindsArcDepthByGravity) {
  const auto ball = arc(38);
  std::vector<double> off;
  for (std::uint64_t seed = 5; seed < 14; ++seed) off.push_back(worst(ball, tracked(detected(ball, {30}, 10, 0.1, seed))));
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() / 2], 0.8);
}

TEST(BallSearch, TwoCamerasTriangulate) {
  const auto ball = arc(38);
  for (std::uint64_t seed = 5; seed < 14; ++seed)
    EXPECT_LT(worst(ball, tracked(detected(ball, {10, 50}, 10, 0.1, seed))), 0.12) << "seed " << seed;
}

std::vector<std::optional<BallState>> reported(Scene scene) {
  return ball_trajectory(scene.time_steps, scene.views, {}, {});
}

TEST(BallWay, WithoutABallNothingIsTold) {
  for (const std::uint64_t seed : {7, 8, 9, 10, 11}) {
    for (const auto& state : reported(detected(arc(60), {30}, 3, 1.1, seed))) EXPECT_FALSE(state) << "seed " << seed;
  }
}

TEST(BallWay, AKickIsTold) {
  const auto ball = arc(38);
  const auto states = reported(detected(ball, {10, 50}, 3, 0.1, 12));
  for (std::size_t i = 3; i + 3 < states.size(); ++i) {
    ASSERT_TRUE(states[i]) << i;
    EXPECT_LT((states[i]->belief.location() - ball[i]).norm(), 0.2) << i;
  }
}

TEST(BallWay, ReportsRestingPositionAfterKick) {
  auto ball = std::vector<Vector<3>>(50, Vector<3>(20, 20, kBallRadius));
  const std::size_t lay = ball.size();
  for (int i = 1; i <= 40; ++i) ball.push_back(ball[0] + Vector<3>(9, 5, 0) * (i / kRate));
  const auto states = reported(detected(ball, {10, 50}, 3, 0.1, 13));
  for (std::size_t i = 3; i < lay; ++i) {
    ASSERT_TRUE(states[i]) << i;
    EXPECT_LT((states[i]->belief.location() - ball[i]).norm(), 0.2) << i;
  }
  ball.resize(lay);  // it is never kicked: a bit of paint
  for (const auto& state : reported(detected(ball, {10, 50}, 3, 0.1, 14))) EXPECT_FALSE(state);
}

TEST(BallWay, RejectsObjectMovingWithPerson) {
  std::vector<Vector<3>> knee;
  for (int i = 0; i < 75; ++i) knee.emplace_back(20 + 5 * i / kRate, 20, 0.5);
  Scene scene = detected(knee, {10, 50}, 3, 0.1, 15);
  for (std::size_t i = 0; i < scene.time_steps.size(); ++i) {
    for (BallView& view : scene.time_steps[i].views) {
      const Camera& camera = *scene.views->view_at(view.camera, view.time).camera();
      const Vector<2> foot = *camera.project({knee[i].x(), knee[i].y(), 0}),
                      head = *camera.project({knee[i].x(), knee[i].y(), 1.75});
      const double height = foot.y() - head.y();
      view.people.push_back({head.x() - 0.2 * height, head.y(), 0.4 * height, height});
    }
  }
  for (const auto& state : reported(scene)) EXPECT_FALSE(state);
}

/// A ball rolls on the pitch, often missed; a bright thing runs along the stands behind it, seen in every frame, between others.
TEST(BallWay, RejectsObjectAlongTheStands) {
  std::vector<Vector<3>> ball, runner;
  for (int i = 0; i < 60; ++i) {
    ball.emplace_back(20 + 8 * i / kRate, 20 + 3 * i / kRate, kBallRadius);
    runner.emplace_back(15 + 12 * i / kRate, 110, kBallRadius);
  }
  Scene scene = detected(ball, {10, 50}, 2, 0.35, 16);
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> along(-20, 90), behind(85, 160);
  for (std::size_t i = 0; i < scene.time_steps.size(); ++i) {
    for (BallView& view : scene.time_steps[i].views) {
      const Camera& camera = *scene.views->view_at(view.camera, view.time).camera();
      view.detected.push_back(spot(*camera.project(runner[i]), 2));
      for (int k = 0; k < 12; ++k) {
        if (const auto pixel = camera.project({along(random), behind(random), 1})) view.detected.push_back(spot(*pixel, 1));
      }
    }
  }
  BallArea area;
  area.possible = [](const Vector<2>& location) { return location.y() < 80; };
  area.pitch = [](const Vector<2>& location) { return location.y() < 69; };
  const auto states = ball_trajectory(scene.time_steps, scene.views, area, {});
  int found = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!states[i]) continue;
    ++found;
    EXPECT_LT((states[i]->belief.location() - ball[i]).norm(), 0.5) << i;
  }
  EXPECT_GE(found, 50);
}

/// Everything that may follow, without a beam and without taking like for like.
double best_of_all(const std::shared_ptr<BallNode>& node, const Scene& scene, std::size_t next, const BallSearchOptions& options) {
  if (next == scene.time_steps.size()) return node->score;
  double best = -1e300;
  const double step = next == 0 ? 0 : 1 / kRate;
  for (BallNode& one : successors(node, scene.time_steps[next], step, *scene.views, options))
    best = std::max(best, best_of_all(std::make_shared<BallNode>(std::move(one)), scene, next + 1, options));
  return best;
}

TEST(BallSearch, FindsWhatTryingEverythingFinds) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Scene scene = detected(arc(4), {30}, 2, 0.2, seed);
    const BallSearchOptions options;
    BallSearch search(scene.views, options);
    for (const BallObservations& time_step : scene.time_steps) search.add(time_step);
    const double all = best_of_all(std::make_shared<BallNode>(), scene, 0, options);
    EXPECT_LE(search.best_score(), all + 1e-9) << "seed " << seed;
    EXPECT_NEAR(search.best_score(), all, 0.3) << "seed " << seed;  // like was taken for like
  }
}

}  // namespace
}  // namespace marey::track::ball
