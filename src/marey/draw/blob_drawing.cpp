#include "marey/draw/blob_drawing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "marey/draw/canvas.h"

namespace marey::draw {
namespace {

constexpr Colour kSure{60, 230, 80}, kAmbiguous{255, 150, 40};
constexpr int kRingCorners = 24;

void add_ring(std::vector<Canvas::Stroke>& strokes, const Vector<2>& centre, double radius) {
  const auto corner = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / kRingCorners;
    return cv::Point2f(static_cast<float>(centre.x() + radius * std::cos(angle)),
                       static_cast<float>(centre.y() + radius * std::sin(angle)));
  };
  for (int i = 0; i < kRingCorners; ++i) strokes.push_back({corner(i), corner(i + 1)});
}

}  // namespace

Image draw_blobs(const Image& image, std::span<const Detection> blobs) {
  // Cameras of 12 bits fill a sixteenth of the range of 16.
  Canvas canvas(with_white(image, lightest(image)));
  const double unit = std::max(1.0, image.size().height / 720.0);
  for (const bool sure : {false, true}) {
    std::vector<cv::Point2f> centres;
    for (const Detection& blob : blobs) {
      if ((blob.score >= 0.5) != sure) continue;
      std::vector<Canvas::Stroke> ring;
      add_ring(ring, blob.centre, std::sqrt(std::max(0.0, blob.area) / std::numbers::pi) + 3 * unit);
      canvas.strokes(ring, sure ? kSure : kAmbiguous, 1.2 * unit);
      centres.emplace_back(static_cast<float>(blob.centre.x()), static_cast<float>(blob.centre.y()));
    }
    canvas.discs(centres, 0.8 * unit, sure ? kSure : kAmbiguous);
  }
  return canvas.take();
}

}  // namespace marey::draw
