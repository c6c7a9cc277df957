#include "marey/geometry/camera.h"

#include <random>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace marey::geometry {
namespace {

const BrownLens kBrown{{900, 910}, {639.5, 359.5}, {-0.30, 0.12, 0.001, -0.0005, -0.02, 0, 0, 0}};
const BrownLens kRational{{900, 910}, {639.5, 359.5}, {0.4, -0.1, 0.001, -0.0005, 0.01, 0.7, -0.05, 0.02}};
const FisheyeLens kFisheye{{320, 322}, {639.5, 359.5}, {0.02, -0.01, 0.003, -0.0004}};
const TsaiLens kTsai{{1000, 1020}, {384, 288}, {0.12}};
const TsaiLens kTsaiBarrel{{1000, 1020}, {384, 288}, {-0.15}};

std::vector<Lens> lenses() {
  return {kBrown, kRational, kFisheye, kTsai, kTsaiBarrel};
}

Rigid3 pose() {
  return {rotation_from({0.3, -0.5, 0.2}), {0.1, -0.2, 4.0}};
}

/// Points of the world before a camera with `pose()`, up to 31° from its axis.
std::vector<Vector<3>> points_before(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> aside(-0.6, 0.6), depth(1, 9);
  std::vector<Vector<3>> points;
  const Rigid3 world_from_camera = pose().inverse();
  for (int i = 0; i < count; ++i) {
    const double z = depth(random);
    points.push_back(world_from_camera * Vector<3>(aside(random) * z * 0.7, aside(random) * z * 0.7, z));
  }
  return points;
}

cv::Point3d cv_point(const Vector<3>& p) {
  return {p.x(), p.y(), p.z()};
}

TEST(Camera, BrownAgreesWithOpenCv) {
  const Vector<3> rvec(0.3, -0.5, 0.2);
  for (const BrownLens& lens : {kBrown, kRational}) {
    const Camera camera(lens, pose(), {1280, 720});
    const cv::Matx33d K(lens.focal.x(), 0, lens.principal.x(), 0, lens.focal.y(), lens.principal.y(), 0, 0, 1);
    for (const Vector<3>& point : points_before(100)) {
      std::vector<cv::Point2d> theirs;
      cv::projectPoints(std::vector{cv_point(point)}, cv::Vec3d(rvec.x(), rvec.y(), rvec.z()), cv::Vec3d(0.1, -0.2, 4.0), K,
                        cv::Mat(1, 8, CV_64F, const_cast<double*>(lens.distortion.data())), theirs);
      const auto ours = camera.project(point);
      ASSERT_TRUE(ours);
      EXPECT_NEAR(ours->x(), theirs[0].x, 1e-9);
      EXPECT_NEAR(ours->y(), theirs[0].y, 1e-9);
    }
  }
}

TEST(Camera, FisheyeAgreesWithOpenCv) {
  const Camera camera(kFisheye, pose(), {1280, 720});
  const cv::Matx33d K(320, 0, 639.5, 0, 322, 359.5, 0, 0, 1);
  for (const Vector<3>& point : points_before(100)) {
    std::vector<cv::Point2d> theirs;
    cv::fisheye::projectPoints(std::vector{cv_point(point)}, theirs,
                               cv::Affine3d(cv::Vec3d(0.3, -0.5, 0.2), cv::Vec3d(0.1, -0.2, 4.0)), K,
                               cv::Vec4d(0.02, -0.01, 0.003, -0.0004));
    const auto ours = camera.project(point);
    ASSERT_TRUE(ours);
    EXPECT_NEAR(ours->x(), theirs[0].x, 1e-9);
    EXPECT_NEAR(ours->y(), theirs[0].y, 1e-9);
  }
}

TEST(Camera, TsaiObeysItsDefinition) {
  for (const TsaiLens& lens : {kTsai, kTsaiBarrel}) {
    const Camera camera(lens, pose(), {768, 576});
    for (const Vector<3>& point : points_before(100)) {
      const auto pixel = camera.project(point);
      ASSERT_TRUE(pixel);
      const Vector<2> distorted = (*pixel - lens.principal).cwiseQuotient(lens.focal);
      const Vector<2> undistorted = distorted * (1 + lens.distortion[0] * distorted.squaredNorm());
      EXPECT_LT((undistorted - (pose() * point).hnormalized()).norm(), 1e-12);
    }
  }
}

TEST(Camera, RaysLeadBackToTheirPoints) {
  for (const Lens& lens : lenses()) {
    const Camera camera(lens, pose(), {1280, 720});
    for (const Vector<3>& point : points_before(200)) {
      const auto pixel = camera.project(point);
      ASSERT_TRUE(pixel) << name_of(lens);
      const auto ray = camera.ray(*pixel);
      ASSERT_TRUE(ray) << name_of(lens);
      EXPECT_NEAR(ray->direction.norm(), 1, 1e-12);
      EXPECT_LT((point - ray->origin).cross(ray->direction).norm(), 1e-7) << name_of(lens);
    }
  }
}

TEST(Camera, JacobianAgreesWithDifferences) {
  for (const Lens& lens : lenses()) {
    const Camera camera(lens, pose(), {1280, 720});
    for (const Vector<3>& point : points_before(50)) {
      const auto detected = camera.project_with_jacobian(point);
      ASSERT_TRUE(detected);
      EXPECT_LT((detected->pixel - *camera.project(point)).norm(), 1e-9);
      for (int axis = 0; axis < 3; ++axis) {
        const Vector<3> step = 1e-6 * Vector<3>::Unit(axis);
        const Vector<2> slope = (*camera.project(point + step) - *camera.project(point - step)) / 2e-6;
        EXPECT_LT((slope - detected->by_world.col(axis)).norm(), 1e-4 * (1 + slope.norm())) << name_of(lens);
      }
    }
  }
}

TEST(Camera, SeesNothingBehindItself) {
  for (const Lens& lens : {Lens(kBrown), Lens(kTsai)}) {
    const Camera camera(lens, {}, {1280, 720});
    EXPECT_FALSE(camera.project({0.1, 0.1, -2}));
    EXPECT_FALSE(camera.project({0, 0, 0}));
  }
  EXPECT_FALSE(Camera(kFisheye, {}, {1280, 720}).project({0, 0, 0}));
  EXPECT_TRUE(Camera(kFisheye, {}, {1280, 720}).project({1, 0, -0.05})) << "a fisheye sees a little more than half of the world";
}

TEST(Camera, PointsBeyondTheFoldAreNotSeen) {
  // With k1 = -0.4 alone the distorted radius grows up to a tangent of 1 / sqrt(1.2) = 0.91 only.
  const Camera camera(BrownLens{{500, 500}, {320, 240}, {-0.4}}, {}, {640, 480});
  EXPECT_TRUE(camera.project({0.85, 0, 1}));
  EXPECT_FALSE(camera.project({1.0, 0, 1}));
  EXPECT_FALSE(camera.ray({320 + 500 * 0.7, 240})) << "no direction is seen that far aside";
}

TEST(Camera, EveryPixelGivesAFiniteRayOrNone) {
  for (const Lens& lens : lenses()) {
    const Camera camera(lens, pose(), {1280, 720});
    for (double x = -2000; x < 4000; x += 97) {
      for (double y = -2000; y < 4000; y += 89) {
        const auto ray = camera.ray({x, y});
        if (!ray) continue;
        ASSERT_TRUE(ray->direction.allFinite());
        const auto back = camera.project(ray->origin + 3 * ray->direction);
        if (back) {
          ASSERT_LT((*back - Vector<2>(x, y)).norm(), 1e-5) << name_of(lens) << " " << x << " " << y;
        }
      }
    }
  }
}

TEST(Lens, ScalingKeepsWhatIsSeen) {
  for (const Lens& lens : lenses()) {
    const Camera full(lens, pose(), {1280, 720}), half(scaled(lens, 0.5), pose(), {640, 360});
    for (const Vector<3>& point : points_before(20)) {
      const Vector<2> expected = (full.project(point)->array() + 0.5) / 2 - 0.5;
      EXPECT_LT((*half.project(point) - expected).norm(), 1e-9);
    }
  }
}

TEST(Rigid, InverseAndProductAreThoseOfMotions) {
  const Rigid3 a = pose(), b{rotation_from({-1, 0.4, 2}), {3, 2, 1}};
  const Vector<3> point(0.3, 0.7, -1.1);
  EXPECT_LT(((a * b) * point - a * (b * point)).norm(), 1e-14);
  EXPECT_LT((a.inverse() * (a * point) - point).norm(), 1e-14);
  EXPECT_LT((rotation_from(angle_axis_of(b.rotation)) - b.rotation).norm(), 1e-14);
}

TEST(Lens, EveryModelIsFoundByItsName) {
  ASSERT_EQ(lens_names().size(), std::variant_size_v<Lens>);
  for (const std::string_view name : lens_names()) {
    const auto lens = lens_named(name);
    ASSERT_TRUE(lens) << name;
    EXPECT_EQ(name_of(*lens), name);
    EXPECT_GT(coefficients_of(*lens), 0) << name;
  }
  EXPECT_FALSE(lens_named("pinhole"));
  EXPECT_TRUE(ahead_only(BrownLens{}));
  EXPECT_FALSE(ahead_only(FisheyeLens{}));
}

}  // namespace
}  // namespace marey::geometry
