// A camera over a pitch, calibrated from clicked points that are in memory.
//   calibrate_from_arrays
#include <cstdio>
#include <vector>

#include "marey/calibrate/pitch/pitch.h"
#include "marey/core/error.h"
#include "marey/geometry/lens.h"
#include "marey/geometry/rigid.h"

int main() try {
  // The camera that is to be found: 8 m up, 15 m behind the touchline, aimed at the middle and down.
  const marey::geometry::BrownLens lens{.focal = {1200, 1200}, .principal = {959.5, 539.5}, .distortion = {}};
  marey::Matrix<3> level;
  level << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const marey::Matrix<3> turn = marey::geometry::rotation_from({-0.25, 0, 0}) * level;
  const marey::Vector<3> centre(52.5, -15, 8);
  const marey::Camera truth(lens, marey::Rigid3{turn, -turn * centre}, {1920, 1080});

  marey::calibrate::pitch::PitchView view;
  view.name = "stand", view.size = truth.size();
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{{52.5, 0},
                                                                   {52.5, 24.85},
                                                                   {52.5, 43.15},
                                                                   {52.5, 68},
                                                                   {43.35, 34},
                                                                   {61.65, 34},
                                                                   {16.5, 54.16},
                                                                   {88.5, 54.16},
                                                                   {52.5, 34}}) {
    const auto pixel = truth.project({x, y, 0});
    if (pixel && truth.in_image(*pixel)) view.points.push_back({{x, y}, *pixel, "clicked"});
  }
  const auto found = marey::calibrate::pitch::calibrate_pitch({view});
  const marey::Camera& camera = found.views.front().camera;
  const double off = (camera.centre() - centre).norm();
  std::printf("%zu clicks; the camera is found %.3f m from where it stands\n", view.points.size(), off);
  return off < 0.05 ? 0 : 1;
} catch (const marey::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
