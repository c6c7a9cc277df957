#include "marey/track/bramble/evidence_sums.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/filter/random_stream.h"
#include "marey/geometry/rigid.h"

namespace marey::track::bramble {
namespace {

/// Above (0, −12, 5), aimed at the origin.
Camera camera_above() {
  geometry::BrownLens lens;
  lens.focal = {700, 700};
  lens.principal = {319.5, 239.5};
  const double pitch = std::atan2(5, 12), c = std::cos(pitch), s = std::sin(pitch);
  Rigid3 pose;
  pose.rotation << 1, 0, 0, 0, -s, -c, 0, c, -s;
  pose.translation = {0, 0, 13};
  return {lens, pose, {640, 480}};
}

BlobEvidence random_evidence(filter::RandomStream& random) {
  BlobEvidence evidence;
  evidence.step = 4;
  evidence.origin = {1.5, 1.5};
  evidence.log_ratio.create(120, 160, CV_32FC1);
  for (float& value : cv::Mat_<float>(evidence.log_ratio)) value = static_cast<float>(8 * random.uniform() - 4);
  return evidence;
}

/// The slow twin: asks every point of the grid whether any person's polygon holds it.
double point_by_point(const BlobEvidence& evidence, const std::vector<CylinderOutline>& outlines) {
  std::vector<std::vector<cv::Point2f>> polygons;
  for (const CylinderOutline& outline : outlines) {
    std::vector<cv::Point2f>& polygon = polygons.emplace_back();
    for (const Vector<2>& corner : outline) {
      const Vector<2> at = (corner - evidence.origin) / evidence.step;
      polygon.emplace_back(static_cast<float>(at.x()), static_cast<float>(at.y()));
    }
  }
  double all = 0;
  for (int row = 0; row < evidence.log_ratio.rows; ++row) {
    for (int column = 0; column < evidence.log_ratio.cols; ++column) {
      const cv::Point2f point(static_cast<float>(column), static_cast<float>(row));
      const bool covered = std::any_of(polygons.begin(), polygons.end(),
                                       [&](const auto& polygon) { return cv::pointPolygonTest(polygon, point, false) >= 0; });
      if (covered) all += static_cast<double>(evidence.log_ratio.at<float>(row, column));
    }
  }
  return all;
}

TEST(EvidenceSums, OfAUnionAreThoseOfItsPointsOneByOne) {
  const Camera camera = camera_above();
  const std::uint64_t seed = 20011;
  SCOPED_TRACE(seed);
  filter::RandomStream random(seed);
  for (int round = 0; round < 60; ++round) {
    const BlobEvidence evidence = random_evidence(random);
    const EvidenceSums sums(evidence);
    std::vector<CylinderOutline> outlines;
    std::vector<GridShape> shapes;
    for (int person = 0; person < 1 + round % 6; ++person) {
      // Some stand outside the image, in part or wholly; many hide each other.
      const PersonCylinder one{.foot = {10 * random.uniform() - 5, 10 * random.uniform() - 6, 0},
                               .stature = 1.5 + 0.5 * random.uniform(),
                               .girth = 0.7 + 0.8 * random.uniform()};
      outlines.push_back(cylinder_outline(camera, one));
      cover(outlines.back(), evidence, shapes.emplace_back());
    }
    double all = 0;
    int points = 0;
    std::vector<const GridShape*> before;
    for (const GridShape& shape : shapes) {
      const EvidenceSums::Gain gain = sums.gain(shape, before);
      all += gain.evidence;
      points += gain.points;
      before.push_back(&shape);
    }
    // The twin's corners are rounded to float: a point on an edge may fall to either side.
    EXPECT_NEAR(all, point_by_point(evidence, outlines), 1e-3) << "round " << round << ", " << points << " points";
  }
}

TEST(PersonCylinder, SpansAPersonFromSolesToCrown) {
  const Camera camera = camera_above();
  const CylinderOutline outline = cylinder_outline(camera, {.foot = {1, 2, 0}, .stature = 1.8});
  ASSERT_FALSE(outline.empty());
  const auto [highest, lowest] =
      std::minmax_element(outline.begin(), outline.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  const Vector<2> sole = *camera.project({1, 2, 0}), crown = *camera.project({1, 2, 1.8});
  EXPECT_NEAR(highest->y(), crown.y(), 3);
  EXPECT_NEAR(lowest->y(), sole.y(), 4);
  EXPECT_GT(lowest->y(), sole.y());
  EXPECT_TRUE(cylinder_outline(camera, {.foot = {0, -30, 0}}).empty()) << "behind the camera";
}

TEST(PersonCylinder, CountsWhatLiesOutsideTheGrid) {
  const Camera camera = camera_above();
  filter::RandomStream random(7);
  const BlobEvidence evidence = random_evidence(random);
  GridShape inside, outside;
  cover(cylinder_outline(camera, {.foot = {0, 0, 0}}), evidence, inside);
  cover(cylinder_outline(camera, {.foot = {0, -8.2, 0}}), evidence, outside);
  EXPECT_EQ(inside.fraction_in_grid(), 1);
  EXPECT_LT(outside.fraction_in_grid(), 0.7);
}

}  // namespace
}  // namespace marey::track::bramble
