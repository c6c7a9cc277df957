#include "marey/calibrate/pitch/element_score.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marey::calibrate::pitch {
namespace {

constexpr double kProjectedEvery = 0.2;  // m, between the places projected

using Polyline = std::vector<Vector<2>>;

bool inside(const Vector<2>& pixel, cv::Size size) {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < size.width && pixel.y() < size.height;
}

/// Where the line from `in` to `out` leaves the image.
Vector<2> leaving(const Vector<2>& in, const Vector<2>& out, cv::Size size) {
  const Vector<2> direction = out - in, last(size.width - 1, size.height - 1);
  double t = 1;
  for (int axis = 0; axis < 2; ++axis) {
    if (direction(axis) > 0) t = std::min(t, std::max(0.0, last(axis) - in(axis)) / direction(axis));
    if (direction(axis) < 0) t = std::min(t, in(axis) / -direction(axis));
  }
  return in + t * direction;
}

Polyline projected(const geometry::Camera& camera, const geometry::PitchElement& element) {
  Polyline line;
  std::optional<Vector<2>> before;
  bool in = false;
  for (const Vector<3>& location : geometry::sampled(element, kProjectedEvery)) {
    const std::optional<Vector<2>> pixel = camera.project(location);
    if (!pixel) continue;
    if (inside(*pixel, camera.size())) {
      if (!in && before) line.push_back(leaving(*pixel, *before, camera.size()));
      line.push_back(*pixel);
      in = true;
    } else if (in) {
      line.push_back(leaving(*before, *pixel, camera.size()));
      in = false;
    }
    before = pixel;
  }
  return line;
}

double distance(const Vector<2>& point, const Polyline& line) {
  double nearest = (point - line[0]).norm();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector<2> segment = line[i] - line[i - 1];
    const double t =
        segment.squaredNorm() > 0 ? std::clamp((point - line[i - 1]).dot(segment) / segment.squaredNorm(), 0.0, 1.0) : 0;
    nearest = std::min(nearest, (point - line[i - 1] - t * segment).norm());
  }
  return nearest;
}

ElementScore score_as_named(const std::array<Polyline, geometry::kPitchElements>& lines,
                            std::span<const geometry::LabelledElement> labels, geometry::PitchMirror mirror, double tolerance) {
  ElementScore score;
  std::array<bool, geometry::kPitchElements> labelled{};
  for (const geometry::LabelledElement& label : labels) {
    const auto element = static_cast<std::size_t>(geometry::mirrored_element(label.element, mirror));
    labelled[element] = true;
    if (lines[element].empty()) {
      ++score.missed;
      continue;
    }
    const bool near = std::all_of(label.points.begin(), label.points.end(),
                                  [&](const Vector<2>& point) { return distance(point, lines[element]) < tolerance; });
    near ? ++score.right : ++score.wrong;
  }
  for (std::size_t i = 0; i < lines.size(); ++i) score.wrong += !labelled[i] && !lines[i].empty() ? 1 : 0;
  return score;
}

}  // namespace

std::vector<std::optional<double>> element_distances(const geometry::Camera& camera, const geometry::LabelledElement& label,
                                                     const geometry::PitchSize& pitch) {
  const Polyline line = projected(camera, geometry::pitch_elements(pitch)[static_cast<std::size_t>(label.element)]);
  std::vector<std::optional<double>> result;
  for (const Vector<2>& point : label.points) {
    result.push_back(line.empty() ? std::nullopt : std::optional<double>(distance(point, line)));
  }
  return result;
}

ElementScore score_elements(const geometry::Camera& camera, std::span<const geometry::LabelledElement> labels,
                            const geometry::PitchSize& pitch, double tolerance) {
  std::array<Polyline, geometry::kPitchElements> lines;
  const auto elements = geometry::pitch_elements(pitch);
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i] = projected(camera, elements[i]);
  const ElementScore as_named = score_as_named(lines, labels, {}, tolerance);
  const ElementScore rotated = score_as_named(lines, labels, {.left_right = true, .near_far = true}, tolerance);
  return rotated.jaccard() > as_named.jaccard() ? rotated : as_named;
}

}  // namespace marey::calibrate::pitch
