#include "marey/calibrate/pitch/element_score.h"

#include <gtest/gtest.h>

#include "marey/calibrate/pitch/element_camera.h"
#include "marey/calibrate/pitch/element_scene_test.h"

namespace marey::calibrate::pitch {
namespace {

const cv::Size kScored(960, 540);

TEST(ElementScore, TheTrueCameraExplainsWhatItProjects) {
  std::mt19937 random(7);
  for (int scene = 0; scene < 10; ++scene) {
    const geometry::Camera camera = camera_of(main_camera(random), kScored);
    const auto labels = labels_of(camera, 0, random);
    const ElementScore score = score_elements(camera, labels, {}, 1);
    EXPECT_EQ(score.right, static_cast<int>(labels.size()));
    EXPECT_EQ(score.missed, 0);
  }
}

TEST(ElementScore, DisplacedPointFailsItsElement) {
  std::mt19937 random(8);
  const geometry::Camera camera = camera_of(main_camera(random), kScored);
  auto labels = labels_of(camera, 0, random);
  const ElementScore before = score_elements(camera, labels, {}, 5);
  labels[0].points[0] += Vector<2>(30, 30);
  const ElementScore after = score_elements(camera, labels, {}, 5);
  EXPECT_EQ(after.right, before.right - 1);
  EXPECT_EQ(after.wrong, before.wrong + 1);
}

TEST(ElementScore, CountsUnlabelledAsFalseAndUndetectedAsMissed) {
  std::mt19937 random(9);
  const geometry::Camera camera = camera_of(main_camera(random), kScored);
  auto labels = labels_of(camera, 0, random);
  const ElementScore before = score_elements(camera, labels, {}, 5);
  labels.pop_back();
  EXPECT_EQ(score_elements(camera, labels, {}, 5).wrong, before.wrong + 1);
  EXPECT_EQ(score_elements(camera, {}, {}, 5).jaccard(), 0);
}

TEST(ElementScore, APitchTurnedByHalfATurnCountsAsWell) {
  std::mt19937 random(10);
  const geometry::Camera camera = camera_of(main_camera(random), kScored);
  auto labels = labels_of(camera, 0, random);
  const double straight = score_elements(camera, labels, {}, 5).jaccard();
  for (auto& label : labels) label.element = geometry::mirrored_element(label.element, {.left_right = true, .near_far = true});
  EXPECT_EQ(score_elements(camera, labels, {}, 5).jaccard(), straight);
}

}  // namespace
}  // namespace marey::calibrate::pitch
