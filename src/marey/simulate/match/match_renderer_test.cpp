#include "marey/simulate/match/match_renderer.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/simulate/match/match_cameras.h"
#include "marey/simulate/match/match_ground.h"

namespace marey::simulate::match {
namespace {

Rig small_stand() {
  MatchCamerasOptions options;
  options.stand = MatchStand::football;
  options.size = cv::Size(1536, 864);
  return match_cameras(options, 1);
}

TEST(MatchGround, LinesLieWhereTheCameraSeesThem) {
  const Rig rig = small_stand();
  const Camera camera = *rig.cameras[0].camera();
  const Image ground = draw_match_ground(GroundView(camera), *rig.ground_from_world, {}, 1);
  const cv::Mat& luma = ground.luma();
  const auto level = [&](const Vector<2>& pixel) {
    return static_cast<int>(
        luma.at<std::uint8_t>(static_cast<int>(std::lround(pixel.y())), static_cast<int>(std::lround(pixel.x()))));
  };
  int requested = 0, bright = 0;
  for (double x = 20; x < 50; x += 0.5) {  // the near touchline, y = 68
    const auto on = camera.project({x, -68, 0}), off = camera.project({x, -67, 0});
    if (!on || !camera.in_image(*on) || !camera.in_image(*off)) continue;
    ++requested;
    bright += level(*on) > level(*off) + 30 ? 1 : 0;
  }
  EXPECT_GT(requested, 30);
  EXPECT_EQ(bright, requested);
}

TEST(MatchGround, ACrownedPitchIsPaintedAndClickedWhereItIsSeen) {
  MatchCamerasOptions options;
  options.stand = MatchStand::football;
  options.size = cv::Size(1536, 864);
  options.ground.across = 0.4, options.ground.along = 0.3;
  const Rig rig = match_cameras(options, 1);
  const GroundView view = rig.cameras[0].ground_view(rig.ground).value(), plane(*view.camera());
  EXPECT_NEAR(rig.ground.height({52.5, -34}), 0.7, 1e-9);
  const Image ground = draw_match_ground(view, *rig.ground_from_world, {}, 1);
  const cv::Mat& luma = ground.luma();
  const auto level = [&](const Vector<2>& pixel) {
    return static_cast<int>(
        luma.at<std::uint8_t>(static_cast<int>(std::lround(pixel.y())), static_cast<int>(std::lround(pixel.x()))));
  };
  int bright = 0, bright_on_plane = 0, requested = 0;
  for (double x = 30; x < 50; x += 0.5) {
    const auto on = view.pixel({x, -68}), level_on = plane.pixel({x, -68}), off_line = view.pixel({x, -67});
    const auto detected = [&](const std::optional<Vector<2>>& pixel) { return pixel && view.camera()->in_image(*pixel); };
    if (!detected(on) || !detected(level_on) || !detected(off_line)) continue;
    ++requested;
    bright += level(*on) > level(*off_line) + 30 ? 1 : 0;
    bright_on_plane += level(*level_on) > level(*off_line) + 30 ? 1 : 0;
  }
  EXPECT_GT(requested, 20);
  EXPECT_EQ(bright, requested);
  EXPECT_LT(bright_on_plane, requested / 2) << "or the crown would not be seen";
  for (const MatchClick& click : match_clicks(view, rig.ground_from_world->inverse(), {}, 0, 0, 1))
    EXPECT_LT((*view.pixel({click.ground.x(), -click.ground.y()}) - click.pixel).norm(), 1e-9);
}

TEST(MatchRenderer, PeopleAreDrawnWithinTheirBoxes) {
  const Rig rig = small_stand();
  const Camera camera = *rig.cameras[1].camera();
  const Matrix<3> world_from_pitch = rig.ground_from_world->inverse();
  MatchVideoOptions options;
  options.noise = 0;
  options.light_change = 0;
  options.shadows = false;
  const MatchRenderer video(GroundView(camera), world_from_pitch, {}, options, 1);
  const auto figures = match_figures(1);
  MatchMotion motion(1);
  const auto stances_now = [&] {
    std::array<people::Stance, kMatchPeople> stances;
    for (std::size_t i = 0; i < stances.size(); ++i) stances[i] = match_stance(motion.people()[i], world_from_pitch);
    return stances;
  };
  motion.advance(3);
  const auto first = stances_now();
  motion.advance(20);
  const auto second = stances_now();
  cv::Mat changed;
  cv::absdiff(video.render(figures, first, 3, 0).luma(), video.render(figures, second, 3, 1).luma(), changed);
  EXPECT_GT(cv::countNonZero(changed > 20), 500);
  for (const auto& stances : {first, second}) {
    for (const ObservedPerson& detected : people_in_view(GroundView(camera), figures, stances)) {
      const Box& box = detected.shown;
      const cv::Rect around(static_cast<int>(std::floor(box.left)) - 1, static_cast<int>(std::floor(box.top)) - 1,
                            static_cast<int>(box.width) + 3, static_cast<int>(box.height) + 3);
      changed(around & cv::Rect({0, 0}, changed.size())).setTo(0);
    }
  }
  EXPECT_EQ(cv::countNonZero(changed > 4), 0) << "something was drawn outside all boxes";
}

TEST(MatchClicks, LieOnThePlacesThatTheyName) {
  const Rig rig = small_stand();
  const Camera camera = *rig.cameras[0].camera();
  const Matrix<3> world_from_pitch = rig.ground_from_world->inverse();
  const auto off = [&](const MatchClick& click) {
    const Vector<3> at = world_from_pitch * click.ground.homogeneous();
    return (*camera.project({at.x(), at.y(), 0}) - click.pixel).norm();
  };
  const auto good = match_clicks(GroundView(camera), world_from_pitch, {}, 1, 0, 1),
             bad = match_clicks(GroundView(camera), world_from_pitch, {}, 1, 2, 1);
  EXPECT_GE(good.size(), 12u);
  for (const MatchClick& click : good) EXPECT_LT(off(click), 5);
  int wrong = 0;
  for (const MatchClick& click : bad) wrong += off(click) > 5 ? 1 : 0;
  EXPECT_EQ(wrong, 2);
}

}  // namespace
}  // namespace marey::simulate::match
