#include "marey/simulate/people/people_scene.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

namespace marey::simulate::people {
namespace {

TEST(PeopleScene, TheSameSeedGivesTheSameScene) {
  const auto a = simulate_people({}, 5);
  const auto b = simulate_people({}, 5);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].box, b[i].box);
  EXPECT_NE(a.front().box, simulate_people({}, 6).front().box);
}

TEST(PeopleScene, BoxesAreInThePictureAndPeopleOnceAFrame) {
  const PeopleSceneOptions options{.camera_speed = 1, .camera_turn = 0.1};
  std::set<std::pair<int, int>> detected;
  for (const TrueBox& one : simulate_people(options, 2)) {
    EXPECT_TRUE(detected.insert({one.frame, one.id}).second);
    EXPECT_GE(one.box.left, 0);
    EXPECT_GE(one.box.top, 0);
    EXPECT_LE(one.box.right(), options.width + 1e-9);
    EXPECT_LE(one.box.bottom(), options.height + 1e-9);
  }
}

TEST(SimulatedDetector, MissesAsOftenAsItIsTold) {
  // One person alone, who stands in the open: nothing is hidden, nothing suppressed.
  std::vector<TrueBox> truth;
  for (int k = 0; k < 20000; ++k) truth.push_back({k, 1, {100, 100, 40, 100}});
  const DetectorModel model{.miss = 0.25, .false_alarms = 0, .haunted_positions = 0};
  double detected = 0;
  double error = 0;
  for (const auto& frame : simulate_detector(truth, 20000, 15, model, 3)) {
    detected += static_cast<double>(frame.size());
    for (const auto& one : frame) error += (one.value - truth[0].box.centre()).squaredNorm() / 2;
  }
  EXPECT_NEAR(detected / 20000, 0.75, 0.03);
  EXPECT_NEAR(std::sqrt(error / detected) / 100, model.position_noise, 0.1 * model.position_noise);
}

TEST(SimulatedDetector, DoesNotSeeWhoIsHidden) {
  std::vector<TrueBox> truth;
  for (int k = 0; k < 100; ++k) {
    truth.push_back({k, 1, {100, 100, 40, 100}});
    truth.push_back({k, 2, {80, 90, 80, 160}});  // nearer: the feet are lower
  }
  const DetectorModel model{.miss = 0, .false_alarms = 0, .haunted_positions = 0};
  for (const auto& frame : simulate_detector(truth, 100, 15, model, 3)) {
    ASSERT_EQ(frame.size(), 1U);
    EXPECT_GT(frame[0].box->height, 130);
  }
}

}  // namespace
}  // namespace marey::simulate::people
