#pragma once

#include <random>
#include <vector>

#include "marey/calibrate/pitch/element_residual.h"

namespace marey::calibrate::pitch {

/// What a main camera would have labelled of a pitch: of each element in the image its visible ends and some points between,
/// `noise_px` off.
inline std::vector<geometry::LabelledElement> labels_of(const geometry::Camera& camera, double noise_px, std::mt19937& random) {
  std::normal_distribution<double> noise(0, noise_px > 0 ? noise_px : 1);
  std::vector<geometry::LabelledElement> labels;
  const auto elements = geometry::pitch_elements({});
  for (int i = 0; i < geometry::kPitchElements; ++i) {
    std::vector<Vector<2>> detected;
    for (const Vector<3>& location : geometry::sampled(elements[static_cast<std::size_t>(i)], 0.25)) {
      const auto pixel = camera.project(location);
      if (pixel && camera.in_image(*pixel)) detected.push_back(*pixel);
    }
    if (detected.size() < 2 ||
        (detected.front() - detected.back()).norm() + (detected[detected.size() / 2] - detected.back()).norm() < 20)
      continue;
    geometry::LabelledElement label{i, {}};
    const std::size_t count = std::holds_alternative<geometry::ArcElement>(elements[static_cast<std::size_t>(i)].shape) ? 9 : 2;
    for (std::size_t k = 0; k < count; ++k) {
      label.points.push_back(detected[k * (detected.size() - 1) / (count - 1)]);
      if (noise_px > 0) label.points.back() += Vector<2>(noise(random), noise(random));
    }
    labels.push_back(std::move(label));
  }
  return labels;
}

/// A camera as they stand at matches: aimed at a goal's half, or (every fourth) at the middle.
inline ElementView main_camera(std::mt19937& random) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  ElementView view;
  view.p = {between(0.35, 0.75), between(0.12, 0.28), between(-0.01, 0.01), between(1.2, 1.9),
            between(50, 55),     between(-50, -18),   between(10, 22),      between(0, 0.05)};
  if (random() % 2 == 0) view.p[ElementView::pan] = -view.p[ElementView::pan];
  if (random() % 4 == 0) view.p[ElementView::pan] *= 0.2, view.p[ElementView::log_focal] = 0.8;
  return view;
}

}  // namespace marey::calibrate::pitch
