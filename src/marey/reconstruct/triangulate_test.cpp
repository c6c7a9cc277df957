#include "marey/reconstruct/triangulate.h"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "marey/reconstruct/room_test.h"

namespace marey::reconstruct {
namespace {

using room::cameras_round;
using room::Random;

std::vector<SightLine> detected(const std::vector<Camera>& cameras, const Vector<3>& point, double sigma, Random& random) {
  std::vector<SightLine> rays;
  for (int i = 0; i < std::ssize(cameras); ++i) {
    const auto pixel = cameras[i].project(point);
    if (!pixel) continue;
    const Vector<2> noisy = *pixel + random.gaussian_2d(sigma);
    if (const auto ray = sight_line(cameras[i], i, noisy, std::max(sigma, 1e-3))) rays.push_back(*ray);
  }
  return rays;
}

TEST(SightLine, ErrorIsTheCamerasReprojectionError) {
  Random random(1);
  for (const Camera& camera : cameras_round(5)) {
    const Vector<3> point = random.in_room();
    const Vector<2> pixel = camera.project(point).value();
    const Vector<2> off = pixel + Vector<2>(1.5, -2);
    const auto ray = sight_line(camera, 0, off, 1);
    ASSERT_TRUE(ray);
    EXPECT_LT((ray->error(point) - (pixel - off)).norm(), 0.02);
  }
}

TEST(Triangulate, ExactRaysMeetInTheirPoint) {
  Random random(2);
  const auto cameras = cameras_round(6);
  for (int i = 0; i < 50; ++i) {
    const Vector<3> point = random.in_room();
    const auto result = triangulate(detected(cameras, point, 0, random));
    const auto* found = std::get_if<SpacePoint>(&result);
    ASSERT_TRUE(found);
    EXPECT_LT((found->position - point).norm(), 1e-8);
    EXPECT_EQ(found->rays, 6);
  }
}

/// The slow and obvious twin: coordinate descent on the cameras' own reprojection errors.
Vector<3> by_descent(const std::vector<Camera>& cameras, const std::vector<Vector<2>>& pixels, Vector<3> point) {
  const auto cost = [&](const Vector<3>& at) {
    double sum = 0;
    for (std::size_t i = 0; i < cameras.size(); ++i) sum += (cameras[i].project(at).value() - pixels[i]).squaredNorm();
    return sum;
  };
  double best = cost(point);
  for (double step = 1e-3; step > 1e-8;) {
    bool moved = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        Vector<3> tried = point;
        tried[axis] += sign * step;
        if (const double here = cost(tried); here < best) best = here, point = tried, moved = true;
      }
    }
    if (!moved) step /= 2;
  }
  return point;
}

TEST(Triangulate, AgreesWithDescentOnThePixelErrors) {
  Random random(3);
  const auto cameras = cameras_round(4);
  for (int i = 0; i < 20; ++i) {
    const Vector<3> point = random.in_room();
    std::vector<Vector<2>> pixels;
    std::vector<SightLine> rays;
    for (int c = 0; c < std::ssize(cameras); ++c) {
      pixels.push_back(cameras[c].project(point).value() + random.gaussian_2d(0.3));
      rays.push_back(sight_line(cameras[c], c, pixels.back(), 0.3).value());
    }
    const auto result = triangulate(rays, {.huber = 100});
    const auto* found = std::get_if<SpacePoint>(&result);
    ASSERT_TRUE(found);
    EXPECT_LT((found->position - by_descent(cameras, pixels, point)).norm(), 2e-6) << "seed 3, point " << i;
  }
}

TEST(Triangulate, ReachesTheCramerRaoBound) {
  Random random(4);
  const auto cameras = cameras_round(8);
  double error = 0, bound = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector<3> point = random.in_room();
    const auto result = triangulate(detected(cameras, point, 0.05, random));
    const auto* found = std::get_if<SpacePoint>(&result);
    ASSERT_TRUE(found);
    error += (found->position - point).squaredNorm();
    Matrix<3> information = Matrix<3>::Zero();
    for (const Camera& camera : cameras) {
      const auto at = camera.project_with_jacobian(point).value();
      information += at.by_world.transpose() * at.by_world / (0.05 * 0.05);
    }
    bound += information.inverse().trace();
  }
  EXPECT_LT(std::sqrt(error / bound), 1.02);
  EXPECT_GT(std::sqrt(error / bound), 0.97);
}

TEST(Triangulate, LeavesOutWrongRays) {
  Random random(5);
  const auto cameras = cameras_round(8);
  for (int i = 0; i < 200; ++i) {
    const Vector<3> point = random.in_room();
    auto rays = detected(cameras, point, 0.1, random);
    const Vector<2> pixel = cameras[i % 8].project(point).value();
    rays[i % 8] = sight_line(cameras[i % 8], i % 8, pixel + Vector<2>(9, -7), 0.1).value();
    const auto result = triangulate(rays);
    const auto* found = std::get_if<SpacePoint>(&result);
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->used >> (i % 8) & 1);
    EXPECT_GE(found->rays, 6);
    EXPECT_LT((found->position - point).norm(), 0.002);
  }
}

TEST(Triangulate, SaysWhyThereIsNoPoint) {
  Random random(6);
  const auto cameras = cameras_round(4);
  const Vector<3> point(0.2, -0.3, 1);
  auto rays = detected(cameras, point, 0, random);
  EXPECT_EQ(std::get<NoPoint>(triangulate(std::span(rays).first(1))), NoPoint::too_few_rays);
  const std::vector<SightLine> twice = {rays[0], rays[0]};
  EXPECT_EQ(std::get<NoPoint>(triangulate(twice)), NoPoint::parallel_rays);
  std::vector<SightLine> apart = {rays[0], rays[1]};
  apart[1].origin.z() += 0.5;
  EXPECT_EQ(std::get<NoPoint>(triangulate(apart)), NoPoint::rays_disagree);
  std::vector<SightLine> backwards = {rays[0], rays[1]};
  for (SightLine& ray : backwards) ray.direction = -ray.direction;
  EXPECT_EQ(std::get<NoPoint>(triangulate(backwards)), NoPoint::behind_camera);
  for (const NoPoint reason :
       {NoPoint::too_few_rays, NoPoint::parallel_rays, NoPoint::behind_camera, NoPoint::rays_disagree, NoPoint::no_solution}) {
    EXPECT_FALSE(meaning(reason).empty());
  }
}

TEST(Triangulate, DoubtsFewSoundPoints) {
  Random random(7);
  const auto cameras = cameras_round(4);
  int flagged = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto result = triangulate(detected(cameras, random.in_room(), 0.2, random), {.false_alarm = 0.01});
    const auto* found = std::get_if<SpacePoint>(&result);
    flagged += !found || found->rays < 4;
  }
  EXPECT_NEAR(flagged / 5000.0, 0.01, 0.005);
}

}  // namespace
}  // namespace marey::reconstruct
