#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "marey/calibrate/board/board_scene_test.h"
#include "marey/calibrate/line_placement.h"
#include "marey/calibrate/wand/wand_marks.h"
#include "marey/calibrate/wand/wand_table.h"
#include "marey/core/error.h"
#include "marey/core/geometry.h"
#include "marey/core/rig.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::wand {

/// A wand that is waved before a ring of cameras: the truth of the tests of this folder, and of those beside it.
struct WandScene {
  explicit WandScene(std::uint64_t seed, int cameras = 4, MarkerLine shape = {{0, 0.12, 0.30}})
      : noise(seed), wand(std::move(shape)) {
    for (int c = 0; c < cameras; ++c) {
      const double angle = 0.3 + 2 * M_PI * c / cameras;
      RigCamera camera;
      camera.name = "cam" + std::to_string(c + 1);
      camera.size = cv::Size(1280, 1024);
      camera.lens = geometry::BrownLens{{1100 + 10.0 * c, 1100 + 10.0 * c}, {639.5, 511.5}, {}};
      camera.camera_from_world = board::facing({4 * std::cos(angle), 4 * std::sin(angle), 1.5 + 0.5 * (c % 2)}, {0, 0, 0.5});
      rig.cameras.push_back(camera);
    }
  }

  /// The wand's markers at an instant: it swings through two metres and turns.
  std::vector<Vector<3>> markers(double time_s) const {
    const double t = time_s;
    const Vector<3> origin(0.9 * std::sin(1.3 * t), 0.9 * std::sin(1.9 * t + 1), 0.6 + 0.5 * std::sin(2.3 * t + 2));
    const Vector<3> direction =
        Vector<3>(std::cos(2.1 * t), std::sin(1.7 * t + 0.5), 0.8 * std::cos(1.1 * t + 1) + 0.1).normalized();
    std::vector<Vector<3>> locations;
    for (const double distance : wand.distances) locations.push_back(origin + distance * direction);
    return locations;
  }

  /// Where camera `c` sees them, `sigma` px off; nothing if one is out of the image.
  std::optional<Marks> detected(std::size_t c, double time_s, double sigma = 0) {
    const Camera camera = *rig.cameras[c].camera();
    Marks marks;
    const auto locations = markers(time_s);
    for (std::size_t m = 0; m < locations.size(); ++m) {
      const auto pixel = camera.project(locations[m]);
      if (!pixel || !camera.in_image(*pixel)) return std::nullopt;
      marks[m] = *pixel + Vector<2>(noise.gaussian(sigma), noise.gaussian(sigma));
    }
    return marks;
  }

  /// What camera `c`, started `offset_s` before the rig's clock, saw in frames at `rate_hz`.
  MarkTrack track(std::size_t c, int frames, double sigma, double rate_hz = 50, double offset_s = 0) {
    MarkTrack result{{}, 1 / rate_hz, 0};
    for (int i = 0; i < frames; ++i) {
      const double own = i / rate_hz;
      if (const auto marks = detected(c, own + offset_s, sigma)) result.frames.push_back({own, *marks});
    }
    return result;
  }

  std::vector<StartingCamera> cameras(double sigma_px = 1) const {
    std::vector<StartingCamera> list;
    for (const RigCamera& camera : rig.cameras) list.push_back({camera.name, *camera.lens, *camera.size, {}, sigma_px});
    return list;
  }

  MarkTable table(int instants, double sigma, double step_s = 0.11) {
    MarkTable rows(static_cast<std::size_t>(instants), std::vector<std::optional<Marks>>(rig.cameras.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t c = 0; c < rig.cameras.size(); ++c) rows[i][c] = detected(c, step_s * static_cast<double>(i), sigma);
    }
    return rows;
  }

  board::Noise noise;
  Rig rig;
  MarkerLine wand;
};

/// rad.
inline double angle_between(const Matrix<3>& a, const Matrix<3>& b) {
  return Eigen::AngleAxisd(Matrix<3>(a.transpose() * b)).angle();
}

/// The message with which `act` is refused; empty if it is not.
template <typename Act>
std::string refusal(const Act& act) {
  try {
    act();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace marey::calibrate::wand
