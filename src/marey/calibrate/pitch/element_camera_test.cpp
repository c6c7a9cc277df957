#include "marey/calibrate/pitch/element_camera.h"

#include <gtest/gtest.h>

#include "marey/calibrate/pitch/element_scene_test.h"
#include "marey/calibrate/pitch/element_score.h"

namespace marey::calibrate::pitch {
namespace {

const cv::Size kLabelled(960, 540);

/// px: how far two cameras see the places of the labelled elements apart, at most.
double apart(const geometry::Camera& one, const geometry::Camera& other, const std::vector<geometry::LabelledElement>& labels) {
  double maximum = 0;
  for (const auto& label : labels) {
    for (const Vector<3>& location : geometry::sampled(geometry::pitch_elements({})[static_cast<std::size_t>(label.element)], 5)) {
      const auto a = one.project(location), b = other.project(location);
      if (a && b && one.in_image(*a)) maximum = std::max(maximum, (*a - *b).norm());
    }
  }
  return maximum;
}

TEST(ElementCamera, IsFoundFromLabelsOfOnePicture) {
  std::mt19937 random(11);
  for (int scene = 0; scene < 12; ++scene) {
    const geometry::Camera truth = camera_of(main_camera(random), kLabelled);
    const auto labels = labels_of(truth, 1, random);
    const ElementCamera found = camera_from_elements(labels, kLabelled);
    ASSERT_EQ(found.verdict, ElementVerdict::found) << "scene " << scene << ", seed 11";
    EXPECT_LT(apart(truth, *found.camera, labels), 8) << "scene " << scene << ", seed 11, " << labels.size() << " labels";
  }
}

TEST(ElementCamera, ExcludesWrongName) {
  std::mt19937 random(12);
  for (int scene = 0; scene < 6; ++scene) {
    const geometry::Camera truth = camera_of(main_camera(random), kLabelled);
    auto labels = labels_of(truth, 1, random);
    if (labels.size() < 8) continue;
    const auto front = std::find_if(labels.begin(), labels.end(), [](const auto& label) {
      return geometry::pitch_elements({})[static_cast<std::size_t>(label.element)].name.ends_with("main");
    });
    ASSERT_NE(front, labels.end());
    for (Vector<2>& point : front->points) point.x() = 959 - point.x();
    const ElementCamera found = camera_from_elements(labels, kLabelled);
    ASSERT_EQ(found.verdict, ElementVerdict::found) << "scene " << scene;
    EXPECT_FALSE(found.used[static_cast<std::size_t>(front - labels.begin())]) << "scene " << scene;
    labels.erase(front);
    EXPECT_LT(apart(truth, *found.camera, labels), 10) << "scene " << scene;
  }
}

TEST(ElementCamera, AMirroredPitchIsSaid) {
  std::mt19937 random(13);
  for (int scene = 0; scene < 6; ++scene) {
    const auto labels = labels_of(camera_of(main_camera(random), kLabelled), 1, random);
    for (const bool left_right : {true, false}) {
      auto mirrored = labels;
      for (auto& label : mirrored)
        label.element = geometry::mirrored_element(label.element, {.left_right = left_right, .near_far = !left_right});
      EXPECT_EQ(camera_from_elements(mirrored, kLabelled).verdict, ElementVerdict::mirrored) << "scene " << scene;
    }
    auto rotated = labels;
    for (auto& label : rotated) label.element = geometry::mirrored_element(label.element, {.left_right = true, .near_far = true});
    EXPECT_EQ(camera_from_elements(rotated, kLabelled).verdict, ElementVerdict::far_side) << "scene " << scene;
  }
}

TEST(ElementCamera, TwoElementsAreEnoughForAnAnswerAndOneIsNot) {
  std::mt19937 random(14);
  const geometry::Camera truth = camera_of(main_camera(random), kLabelled);
  auto labels = labels_of(truth, 0.5, random);
  labels.resize(2);
  const ElementCamera found = camera_from_elements(labels, kLabelled);
  ASSERT_EQ(found.verdict, ElementVerdict::found);
  EXPECT_LT(apart(*found.camera, *camera_from_elements(labels, kLabelled).camera, labels), 1e-12) << "the same bits every time";
  labels.resize(1);
  EXPECT_EQ(camera_from_elements(labels, kLabelled).verdict, ElementVerdict::too_few);
  EXPECT_EQ(camera_from_elements({}, kLabelled).verdict, ElementVerdict::too_few);
}

TEST(ElementCamera, ScribblesHaveNoCamera) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> x(0, 959), y(0, 539);
  for (int scene = 0; scene < 5; ++scene) {
    std::vector<geometry::LabelledElement> labels;
    for (const int element : {0, 1, 2, 6, 15, 16, 17, 19, 21})
      labels.push_back({element, {{x(random), y(random)}, {x(random), y(random)}, {x(random), y(random)}}});
    EXPECT_FALSE(camera_from_elements(labels, kLabelled).camera) << "scene " << scene;
  }
}

}  // namespace
}  // namespace marey::calibrate::pitch
