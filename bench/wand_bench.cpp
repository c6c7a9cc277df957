// A rig from a wand, from blobs to poses, by the number of cameras and frames; and two cameras by a board, beside OpenCV's
// stereoCalibrate.
#include <cmath>

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>

#include "marey/calibrate/bundle/bundle.h"
#include "marey/calibrate/wand/wand.h"
#include "marey/simulate/random.h"
#include "marey/simulate/room/room.h"

namespace {

using namespace marey;

calibrate::wand::WandInput waved(int cameras, std::int64_t frames) {
  simulate::room::RoomOptions room;
  room.motion = simulate::room::RoomMotion::wand;
  room.cameras = cameras;
  room.frames = frames;
  const simulate::room::RoomScene scene(room);
  calibrate::wand::WandInput input;
  input.rig = scene.rig();
  input.wand.distances = room.wand;
  for (RigCamera& camera : input.rig.cameras) camera.camera_from_world.reset();
  input.detected.resize(input.rig.cameras.size());
  for (std::int64_t i = 0; i < frames; ++i) {
    const simulate::room::RoomFrame frame = scene.frame(i);
    for (std::size_t c = 0; c < frame.detected.size(); ++c) {
      calibrate::wand::BlobFrame blobs{frame.time_s, {}};
      for (const simulate::room::RoomBlob& blob : frame.detected[c]) blobs.blobs.push_back(blob.pixel);
      input.detected[c].push_back(std::move(blobs));
    }
  }
  return input;
}

void calibrate_wand_by_cameras_and_frames(benchmark::State& state) {
  const calibrate::wand::WandInput input = waved(static_cast<int>(state.range(0)), state.range(1));
  int observations = 0;
  for (auto _ : state) observations = calibrate::wand::calibrate_wand(input).report.all.observations;
  state.counters["observations"] = observations;
  state.counters["us/observation"] =
      benchmark::Counter(observations * 1e-6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(calibrate_wand_by_cameras_and_frames)
    ->ArgsProduct({{2, 4, 8, 16}, {500}})
    ->Args({8, 2000})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->Repetitions(3)
    ->ReportAggregatesOnly();

constexpr int kViews = 25;

/// Two cameras and a board of 9 × 6 corners before both.
calibrate::bundle::Bundle board_before_two_cameras() {
  simulate::Random random(5);
  calibrate::bundle::Bundle bundle;
  const geometry::BrownLens lens{{1000, 1000}, {639.5, 511.5}, {-0.1, 0.02}};
  bundle.cameras = {{lens, {}}, {lens, {geometry::rotation_from({0, 0.2, 0}), {-0.5, 0, 0.1}}}};
  bundle.cameras[0].refine_pose = false;
  for (int i = 0; i < 54; ++i) bundle.board.emplace_back(0.05 * (i % 9), 0.05 * (i / 9), 0);
  for (int v = 0; v < kViews; ++v) {
    const Vector<3> turn(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4));
    bundle.bodies.emplace_back(
        Rigid3{geometry::rotation_from(turn), {random.uniform(-0.4, 0.1), random.uniform(-0.3, 0.1), random.uniform(1.5, 2.5)}});
    for (int c = 0; c < 2; ++c) {
      for (int m = 0; m < 54; ++m) {
        calibrate::bundle::BundleObservation detected{c, v, m};
        detected.pixel = calibrate::bundle::predicted_pixel(bundle, detected).value() +
                         Vector<2>(random.gaussian(0, 0.1), random.gaussian(0, 0.1));
        bundle.observations.push_back(detected);
      }
    }
  }
  return bundle;
}

void two_cameras_by_a_board_bundle(benchmark::State& state) {
  const calibrate::bundle::Bundle truth = board_before_two_cameras();
  calibrate::bundle::BundleResult result;
  for (auto _ : state) {
    calibrate::bundle::Bundle bundle = truth;
    bundle.cameras[1].camera_from_world.translation += Vector<3>(0.02, -0.01, 0.02);
    result = calibrate::bundle::adjust(bundle);
  }
  state.counters["rms_px"] = result.rms_px;
}
BENCHMARK(two_cameras_by_a_board_bundle)->Unit(benchmark::kMillisecond);

void two_cameras_by_a_board_opencv(benchmark::State& state) {
  const calibrate::bundle::Bundle truth = board_before_two_cameras();
  std::vector<std::vector<cv::Point3f>> board(kViews);
  std::array<std::vector<std::vector<cv::Point2f>>, 2> detected = {std::vector<std::vector<cv::Point2f>>(kViews),
                                                                   std::vector<std::vector<cv::Point2f>>(kViews)};
  for (auto& view : board) {
    for (const auto& p : truth.board) view.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0F);
  }
  for (const calibrate::bundle::BundleObservation& one : truth.observations) {
    detected[static_cast<std::size_t>(one.camera)][static_cast<std::size_t>(one.body)].emplace_back(
        static_cast<float>(one.pixel.x()), static_cast<float>(one.pixel.y()));
  }
  double rms = 0;
  for (auto _ : state) {
    cv::Mat K1 = (cv::Mat_<double>(3, 3) << 1000, 0, 639.5, 0, 1000, 511.5, 0, 0, 1), K2 = K1.clone();
    cv::Mat d1 = (cv::Mat_<double>(1, 4) << -0.1, 0.02, 0, 0), d2 = d1.clone(), R, T, E, F;
    rms = cv::stereoCalibrate(board, detected[0], detected[1], K1, d1, K2, d2, {1280, 1024}, R, T, E, F, cv::CALIB_FIX_INTRINSIC);
  }
  state.counters["rms_px"] = rms;
}
BENCHMARK(two_cameras_by_a_board_opencv)->Unit(benchmark::kMillisecond);

}  // namespace
