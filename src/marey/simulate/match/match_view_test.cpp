#include "marey/simulate/match/match_view.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/simulate/match/match_cameras.h"

namespace marey::simulate::match {
namespace {

std::array<people::Stance, kMatchPeople> stances_of(const MatchMotion& motion, const Matrix<3>& world_from_pitch) {
  std::array<people::Stance, kMatchPeople> stances;
  for (std::size_t i = 0; i < stances.size(); ++i) stances[i] = match_stance(motion.people()[i], world_from_pitch);
  return stances;
}

TEST(MatchCameras, EveryStandSeesThePitch) {
  for (const MatchStand stand : {MatchStand::round, MatchStand::football, MatchStand::corners, MatchStand::sides}) {
    MatchCamerasOptions options;
    options.stand = stand;
    const Rig rig = match_cameras(options, 1);
    const Matrix<3> world_from_pitch =
        rig.ground_from_world ? Matrix<3>(rig.ground_from_world->inverse()) : Matrix<3>(Matrix<3>::Identity());
    int unobserved = 0;
    for (double x = 1; x < 105; x += 2) {
      for (double y = 1; y < 68; y += 2) {
        const Vector<3> at = world_from_pitch * Vector<3>(x, y, 1);
        int cameras = 0;
        for (const RigCamera& eye : rig.cameras) {
          const Camera camera = *eye.camera();
          const auto pixel = camera.project({at.x(), at.y(), 0});
          if (pixel && camera.in_image(*pixel)) ++cameras;
        }
        if (cameras == 0) ++unobserved;
      }
    }
    EXPECT_LT(unobserved, 53 * 34 / 30) << static_cast<int>(stand);
  }
}

TEST(MatchCameras, TheFootballStandIsLeftHandedOnTheGround) {
  MatchCamerasOptions options;
  options.stand = MatchStand::football;
  const Rig rig = match_cameras(options, 1);
  ASSERT_EQ(rig.cameras.size(), 2u);
  ASSERT_TRUE(rig.ground_from_world);
  EXPECT_LT(rig.ground_from_world->determinant(), 0);
  const Vector<3> left = rig.cameras[0].camera()->centre(), right = rig.cameras[1].camera()->centre();
  EXPECT_NEAR((left - right).norm(), 0.5, 1e-9);
  const Vector<3> far_left = *rig.ground_from_world * Vector<3>(10, -20, 1);
  EXPECT_EQ(far_left, Vector<3>(10, 20, 1));
  EXPECT_TRUE(rig.cameras[0].camera()->in_image(*rig.cameras[0].camera()->project({10, -20, 0})));
}

TEST(MatchCameras, RefuseWhatCannotBe) {
  const auto refused = [](auto change) {
    MatchCamerasOptions options;
    change(options);
    EXPECT_THROW(match_cameras(options, 1), Error);
  };
  refused([](MatchCamerasOptions& o) { o.cameras = 0; });
  refused([](MatchCamerasOptions& o) { o.cameras = 65; });
  refused([](MatchCamerasOptions& o) { o.rate_hz = 0; });
  refused([](MatchCamerasOptions& o) { o.offset_s = -1; });
  refused([](MatchCamerasOptions& o) { o.size = cv::Size(10, 10); });
  refused([](MatchCamerasOptions& o) { o.pitch = {20, 10}; });
}

TEST(MatchView, BoxesHoldHeadAndFeetAndHideWhatIsBehind) {
  MatchCamerasOptions options;
  const Rig rig = match_cameras(options, 2);
  const auto figures = match_figures(2);
  MatchMotion motion(2);
  int hidden = 0;
  for (int k = 0; k < 40; ++k) {
    motion.advance(2.0 * k);
    const auto stances = stances_of(motion, Matrix<3>::Identity());
    for (const RigCamera& eye : rig.cameras) {
      const Camera camera = *eye.camera();
      for (const ObservedPerson& detected : people_in_view(GroundView(camera), figures, stances)) {
        const auto i = static_cast<std::size_t>(detected.person);
        const Vector<2> at = motion.people()[i].location;
        const auto foot = camera.project({at.x(), at.y(), 0});
        const auto chest = camera.project({at.x(), at.y(), 0.65 * figures[i].stature});
        ASSERT_TRUE(foot && chest);
        // The box is round a figure that strides and leans: its foot and its head lie at its ends to a quarter of its height.
        EXPECT_NEAR(foot->y(), detected.whole.bottom() - 0.5, 0.25 * detected.whole.height);
        EXPECT_GT(chest->y(), detected.whole.top);
        EXPECT_LT(chest->y(), detected.whole.bottom());
        EXPECT_GT(chest->x(), detected.whole.left - 0.5);
        EXPECT_LT(chest->x(), detected.whole.right() - 0.5);
        EXPECT_GE(detected.visible_fraction, 0);
        EXPECT_LE(detected.visible_fraction, 1);
        if (detected.visible_fraction < kHiddenFraction && detected.shown == detected.whole) ++hidden;
      }
    }
  }
  EXPECT_GT(hidden, 5) << "people never hide each other";
}

TEST(MatchView, TheDetectorErrsAsOftenAsItSays) {
  MatchCamerasOptions cameras;
  const Rig rig = match_cameras(cameras, 3);
  const Camera camera = *rig.cameras[0].camera();
  const auto figures = match_figures(3);
  MatchMotion motion(3);
  MatchDetectorOptions truthful{.missed = 0, .size_noise = 0, .false_alarms = 0, .hidden_found = 1};
  MatchDetectorOptions missing = truthful, ghosts = truthful, noisy = truthful;
  missing.missed = 0.1;
  ghosts.false_alarms = 0.5;
  noisy.size_noise = 0.05;
  Random random(7);
  double people = 0, found = 0, alarms = 0, squares = 0;
  constexpr int kFrames = 800;
  for (int k = 0; k < kFrames; ++k) {
    motion.advance(0.2 * k);
    const auto detected = people_in_view(GroundView(camera), figures, stances_of(motion, Matrix<3>::Identity()));
    const auto detect = [&](const MatchDetectorOptions& options) {
      return detect_match(detected, GroundView(camera), Matrix<3>::Identity(), cameras.pitch, k, options, random);
    };
    EXPECT_EQ(detect(truthful).size(), detected.size());
    people += static_cast<double>(detected.size());
    found += static_cast<double>(detect(missing).size());
    alarms += static_cast<double>(detect(ghosts).size() - detected.size());
    const std::vector<ObservedPerson> one(detected.begin(), detected.begin() + 1);
    const auto box = detect_match(one, GroundView(camera), Matrix<3>::Identity(), cameras.pitch, k, noisy, random);
    squares += std::pow(box.front().box.height / one.front().shown.height - 1, 2);
  }
  EXPECT_NEAR(found / people, 0.9, 0.01);
  EXPECT_NEAR(alarms / kFrames, 0.5, 0.1);
  EXPECT_NEAR(std::sqrt(squares / kFrames), 0.05, 0.006);
}

}  // namespace
}  // namespace marey::simulate::match
