#include "marey/calibrate/board/board_graph.h"

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"
#include "marey/core/error.h"

namespace marey::calibrate::board {
namespace {

/// A board that is carried about: world_from_board at an instant.
Rigid3 carried(double t) {
  return {geometry::rotation_from({0.5 * std::sin(1.1 * t), 0.4 * std::cos(0.9 * t), 0.6 * std::sin(0.7 * t + 1)}),
          {0.6 * std::sin(0.8 * t), 0.5 * std::sin(1.3 * t + 1), 2 + 0.4 * std::sin(0.5 * t)}};
}

const std::vector<Rigid3> kCameras{{},
                                   {geometry::rotation_from({0, 0.3, 0}), {-0.8, 0.1, 0.2}},
                                   {geometry::rotation_from({0.1, -0.4, 0.2}), {0.9, -0.2, 0.3}}};  // camera_from_world

/// Views from `begin` to `end` seconds of the world's clock; the camera's own shows `offset_s` less. `noise` in m and rad.
std::vector<PosedView> views_of(const Rigid3& camera, double begin, double end, double offset_s, double noise, Noise& numbers) {
  std::vector<PosedView> views;
  for (double t = begin; t < end; t += 0.04) {
    const auto off = [&] { return Vector<3>(numbers.gaussian(noise), numbers.gaussian(noise), numbers.gaussian(noise)); };
    views.push_back({t - offset_s, Rigid3{geometry::rotation_from(off()), off()} * (camera * carried(t))});
  }
  return views;
}

double angle(const Matrix<3>& a, const Matrix<3>& b) {
  return Eigen::AngleAxisd(Matrix<3>(a.transpose() * b)).angle();
}

std::vector<BoardRigCamera> named(std::size_t count) {
  std::vector<BoardRigCamera> cameras(count);
  for (std::size_t c = 0; c < count; ++c) cameras[c].name = "cam" + std::to_string(c + 1);
  return cameras;
}

TEST(BoardGraph, TwoCamerasAndTheirClocksAreCompared) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const double offset = noise.uniform(-2, 2);
    const auto first = views_of(kCameras[0], 0, 8, 0, 0.002, noise), second = views_of(kCameras[1], 0, 8, offset, 0.002, noise);
    const auto pair = compare_views(first, second, 0, 3);
    ASSERT_TRUE(pair);
    EXPECT_NEAR(pair->offset_s, offset, 0.021) << "half a frame";
    EXPECT_LT(angle(pair->second_from_first.rotation, kCameras[1].rotation), 0.02);
    EXPECT_LT((pair->second_from_first.translation - kCameras[1].translation).norm(), 0.04);
    EXPECT_LT(pair->spread, 0.05);
  }
}

TEST(BoardGraph, AWrongOffsetThatIsHeldShowsInTheSpread) {
  Noise noise(5);
  const auto first = views_of(kCameras[0], 0, 8, 0, 0, noise), second = views_of(kCameras[1], 0, 8, 0, 0, noise);
  const auto right = compare_views(first, second, 0, 0), wrong = compare_views(first, second, 0.4, 0);
  ASSERT_TRUE(right && wrong);
  EXPECT_LT(right->spread, 1e-6);
  EXPECT_GT(wrong->spread, 0.03);
}

TEST(BoardGraph, ViewsThatAreNotCommonCompareNothing) {
  Noise noise(6);
  const auto early = views_of(kCameras[0], 0, 2, 0, 0, noise), late = views_of(kCameras[1], 5, 7, 0, 0, noise);
  EXPECT_FALSE(compare_views(early, late, 0, 0));
  EXPECT_FALSE(compare_views({}, late, 0, 1));
  EXPECT_FALSE(compare_views(std::span(early).first(2), std::span(early).first(2), 0, 0)) << "three at least";
}

TEST(BoardGraph, CamerasAreChainedByWhomTheyShareViewsWith) {
  Noise noise(7);
  // The first and the last never see the board together.
  const std::vector views{views_of(kCameras[0], 0, 5, 0, 1e-4, noise), views_of(kCameras[1], 2, 9, 0.5, 1e-4, noise),
                          views_of(kCameras[2], 6, 12, -0.3, 1e-4, noise)};
  BoardRigOptions options;
  options.max_offset_s = 2;
  const auto located = position_cameras(views, named(3), options);
  ASSERT_EQ(located.size(), 3U);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LT(angle(located[c].camera_from_world.rotation, kCameras[c].rotation), 0.03) << c;
    EXPECT_LT((located[c].camera_from_world.translation - kCameras[c].translation).norm(), 0.08) << c;
  }
  EXPECT_NEAR(located[1].offset_s, 0.5, 0.021);
  EXPECT_NEAR(located[2].offset_s, -0.3, 0.041);
}

TEST(BoardGraph, ACameraThatSharesNoViewIsNamed) {
  Noise noise(8);
  const std::vector views{views_of(kCameras[0], 0, 4, 0, 0, noise), views_of(kCameras[1], 0, 4, 0, 0, noise), {}};
  BoardRigOptions options;
  options.timing = BoardRigOptions::Timing::synced;
  try {
    position_cameras(views, named(3), options);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("camera \"cam3\" never sees the board"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace marey::calibrate::board
