// Lens calibration beside OpenCV's, on the same corners: time, and the error that is left (counter rms_px).
#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>

#include "marey/calibrate/lens_calibration.h"
#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"
#include "marey/simulate/random.h"

namespace {

using namespace marey;

const calibrate::board::Board kBoard = calibrate::board::parse_board("chess:9x6:0.03");
const cv::Size kSize(1280, 960);

std::vector<calibrate::LensView> views(int count) {
  simulate::Random random(7);
  const Camera camera(geometry::BrownLens{{1100, 1090}, {650, 470}, {-0.25, 0.08, 0.001, -0.0007, 0.01, 0, 0, 0}}, {}, kSize);
  std::vector<calibrate::LensView> all;
  while (static_cast<int>(all.size()) < count) {
    const auto tilt = [&] { return random.uniform(-0.6, 0.6); };
    const Matrix<3> turn = geometry::rotation_from({tilt(), tilt(), tilt()});
    const double far = random.uniform(0.35, 0.9);
    const Vector<3> location(random.uniform(-0.5, 0.5) * far, random.uniform(-0.4, 0.4) * far, far);
    const Rigid3 pose{turn, location - turn * Vector<3>(0.12, 0.075, 0)};
    calibrate::LensView view;
    for (int id = 0; id < kBoard.corner_count(); ++id) {
      const auto pixel = camera.project(pose * kBoard.corner(id));
      if (!pixel || !camera.in_image(*pixel)) break;
      view.board.corners.push_back({id, *pixel + Vector<2>(random.gaussian(0, 0.2), random.gaussian(0, 0.2))});
    }
    if (static_cast<int>(view.board.corners.size()) == kBoard.corner_count()) all.push_back(std::move(view));
  }
  return all;
}

void lens_marey(benchmark::State& state) {
  const auto detected = views(static_cast<int>(state.range(0)));
  double rms = 0;
  for (auto _ : state) rms = calibrate::calibrate_lens(kBoard, kSize, detected).rms_px;
  state.counters["rms_px"] = rms;
}

void lens_opencv(benchmark::State& state) {
  std::vector<std::vector<cv::Point3f>> locations;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const calibrate::LensView& view : views(static_cast<int>(state.range(0)))) {
    locations.emplace_back();
    pixels.emplace_back();
    for (const calibrate::board::BoardCorner& corner : view.board.corners) {
      const Vector<3> at = kBoard.corner(corner.id);
      locations.back().emplace_back(static_cast<float>(at.x()), static_cast<float>(at.y()), 0.F);
      pixels.back().emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
    }
  }
  double rms = 0;
  for (auto _ : state) {
    cv::Mat K, distortion;
    std::vector<cv::Mat> rotations, translations;
    rms = cv::calibrateCamera(locations, pixels, kSize, K, distortion, rotations, translations);
  }
  state.counters["rms_px"] = rms;
}

BENCHMARK(lens_opencv)->Arg(15)->Arg(60)->Unit(benchmark::kMillisecond);
BENCHMARK(lens_marey)->Arg(15)->Arg(60)->Unit(benchmark::kMillisecond);

}  // namespace
