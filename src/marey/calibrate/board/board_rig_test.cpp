#include "marey/calibrate/board/board_rig.h"

#include <numbers>

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"
#include "marey/core/error.h"

namespace marey::calibrate::board {
namespace {

const Board kBoard = parse_board("charuco:6x8:0.06:0.045:4X4_50");

/// A hand's movement: a few swings of every speed up to 2 a second.
struct HandMotion {
  explicit HandMotion(Noise& noise) {
    for (auto& axis : swings) {
      for (std::size_t i = 0; i < axis.size(); ++i) {
        const double frequency = 0.15 * std::pow(1.6, static_cast<double>(i)) * noise.uniform(0.9, 1.1);
        axis[i] = {frequency, 0.1 / (1 + 4 * frequency * frequency), noise.uniform(0, 2 * std::numbers::pi)};
      }
    }
  }
  Rigid3 at(double t) const {
    std::array<double, 6> value{};
    for (std::size_t k = 0; k < 6; ++k) {
      for (const auto& [frequency, size, phase] : swings[k])
        value[k] += size * std::sin(2 * std::numbers::pi * frequency * t + phase);
    }
    Matrix<3> facing;  // the board's z away from static cameras at negative y, its y down
    facing << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    const Vector<3> turn(2.5 * value[3], 2.5 * value[4], 2.5 * value[5]);
    return {geometry::rotation_from(turn) * facing, Vector<3>(value[0] - 0.2, value[1], 1.2 + value[2])};
  }
  struct Swing {
    double frequency, size, phase;
  };
  std::array<std::array<Swing, 6>, 6> swings{};
};

struct Rigged {
  std::vector<Camera> cameras;
  std::vector<BoardRigCamera> inputs;
};

struct SweepVideo {
  double rate_hz = 25, seconds = 12, noise_px = 0.1;
  std::vector<double> offsets_s{0, 0};
  double readout_s = 0;
  bool last_behind = false;  ///< the last camera stands on the board's other side
};

Rigged video(const SweepVideo& how, std::uint64_t seed) {
  Noise noise(seed);
  const HandMotion motion(noise);
  Rigged rigged;
  const std::vector<Vector<3>> centres{{-0.6, -2.2, 1.4}, {0.7, -2.0, 1.1}, {0.1, -2.6, 2.0}};
  const Vector<3> behind(-0.3, 2.3, 1.5);
  for (std::size_t c = 0; c < how.offsets_s.size(); ++c) {
    const geometry::BrownLens lens{{900, 905}, {640, 355}, {-0.2, 0.05, 0.001, -0.001, 0, 0, 0, 0}};
    rigged.cameras.emplace_back(lens, facing(how.last_behind && c + 1 == how.offsets_s.size() ? behind : centres[c], {0, 0, 1.2}),
                                cv::Size(1280, 720));
    BoardRigCamera input{"camera " + std::to_string(c), {1280, 720}, lens, 0, {}};
    for (int i = 0; i < how.rate_hz * how.seconds; ++i) {
      const double time = i / how.rate_hz;
      const auto pose_of = [&](double fraction) { return motion.at(time + how.offsets_s[c] + fraction * how.readout_s); };
      auto view = observe_board(rigged.cameras[c], kBoard, pose_of, how.noise_px, noise);
      if (view) input.views.push_back({i, time, std::move(*view)});
    }
    rigged.inputs.push_back(std::move(input));
  }
  return rigged;
}

double centre_error(const Rigged& scene, const BoardRig& found, std::size_t camera) {
  const Rigid3 truth = scene.cameras[camera].camera_from_world() * scene.cameras[0].camera_from_world().inverse();
  return (found.cameras[camera].camera_from_world.inverse().translation - truth.inverse().translation).norm();
}

std::string refusal(std::span<const BoardRigCamera> cameras, const BoardRigOptions& options = {}) {
  try {
    calibrate_board_rig(kBoard, cameras, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(BoardRig, OffsetIsFoundToAFractionOfAFrame) {
  for (const double rate : {6.0, 25.0}) {
    const Rigged scene = video({rate, 48 / rate, 0.1, {0, 0.7 / rate, -3.3 / rate}}, 11);
    const BoardRig found = calibrate_board_rig(kBoard, scene.inputs);
    EXPECT_NEAR(found.cameras[1].offset_s * rate, 0.7, 0.01);
    EXPECT_NEAR(found.cameras[2].offset_s * rate, -3.3, 0.01);
    EXPECT_LT(found.rms_px, 1.1 * 0.1 * std::numbers::sqrt2);
    EXPECT_NEAR(found.noise_px, 0.1, 0.01);
    for (const std::size_t c : {1, 2})
      EXPECT_LT(centre_error(scene, found, c), 4 * found.cameras[c].centre_deviation.norm() + 2e-4);
  }
}

TEST(BoardRig, ACameraBehindAGlassBoardIsTiedToTheOthers) {
  SweepVideo how{25, 3, 0.1, {0, 0, 0.01}};
  how.last_behind = true;
  const Rigged scene = video(how, 13);
  const BoardRig found = calibrate_board_rig(kBoard, scene.inputs);
  EXPECT_NEAR(found.cameras[2].offset_s, 0.01, 0.001);
  for (const std::size_t c : {1, 2}) EXPECT_LT(centre_error(scene, found, c), 4 * found.cameras[c].centre_deviation.norm() + 5e-4);
}

TEST(BoardRig, OffsetsHeldStayAndPosesAreFoundAllTheSame) {
  const Rigged scene = video({25, 2, 0.1, {0, 0}}, 3);
  const BoardRig found = calibrate_board_rig(kBoard, scene.inputs, {.timing = BoardRigOptions::Timing::synced});
  EXPECT_EQ(found.cameras[1].offset_s, 0);
  EXPECT_LT(centre_error(scene, found, 1), 0.003);
}

TEST(BoardRig, ARollingShutterIsMeasured) {
  SweepVideo how{25, 2.5, 0.05, {0, 0.01}};
  how.readout_s = 0.02;
  const Rigged scene = video(how, 5);
  const BoardRig found = calibrate_board_rig(kBoard, scene.inputs, {.rolling_shutter = true});
  EXPECT_NEAR(found.cameras[0].readout_s, 0.02, 0.002);
  EXPECT_NEAR(found.cameras[1].readout_s, 0.02, 0.002);
  EXPECT_NEAR(found.cameras[1].offset_s, 0.01, 0.001);
}

TEST(BoardRig, StillsBelongTogetherByTheirInstant) {
  Rigged scene = video({1, 20, 0.1, {0, 0}}, 7);
  const BoardRig found = calibrate_board_rig(kBoard, scene.inputs, {.timing = BoardRigOptions::Timing::stills});
  EXPECT_LT(centre_error(scene, found, 1), 0.003);
  EXPECT_NEAR(found.noise_px, 0.1, 0.01);
  EXPECT_EQ(found.inliers, found.observations);
}

TEST(BoardRig, RejectsUnconnectedCamerasByName) {
  Rigged scene = video({25, 4, 0.1, {0, 0}}, 9);
  scene.inputs[1].views.resize(2);
  EXPECT_NE(refusal(scene.inputs).find("camera \"camera 1\" never sees the board together with"), std::string::npos)
      << refusal(scene.inputs);
  for (TimedView& view : scene.inputs[1].views) view.instant += 1000;
  EXPECT_NE(refusal(scene.inputs, {.timing = BoardRigOptions::Timing::stills}).find("carry the board"), std::string::npos);
  scene.inputs[1].views.clear();
  EXPECT_NE(refusal(scene.inputs).find("is not seen"), std::string::npos);
  scene.inputs.pop_back();
  EXPECT_NE(refusal(scene.inputs).find("two cameras at least"), std::string::npos);
}

}  // namespace
}  // namespace marey::calibrate::board
