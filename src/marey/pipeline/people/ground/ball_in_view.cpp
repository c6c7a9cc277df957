#include "marey/pipeline/people/ground/ball_in_view.h"

#include <algorithm>
#include <cmath>

#include "marey/track/ball/ball_motion.h"

namespace marey::pipeline::people::ground {
namespace {

/// The radius in px of a ball on the ground that is seen at a pixel; behind the area that of one at its far end, for whatever is
/// seen there flies before it.
detect::ball::BallSize ball_sizes(const GroundView& view, const reconstruct::GroundArea& area) {
  const auto radius_at = [view](const Vector<2>& pixel) -> std::optional<double> {
    const auto location = view.location(pixel);
    if (!location) return std::nullopt;
    const auto detected = view.camera()->project_with_jacobian(
        {location->ground.x(), location->ground.y(), view.surface().height(location->ground) + track::ball::kBallRadius});
    if (!detected) return std::nullopt;
    return track::ball::kBallRadius * std::pow((detected->by_world * detected->by_world.transpose()).determinant(), 0.25);
  };
  double minimum = 1e9;
  constexpr int kGrid = 16;
  for (int y = 0; y < view.size().height; y += kGrid) {
    for (int x = 0; x < view.size().width; x += kGrid) {
      const auto location = view.location({static_cast<double>(x), static_cast<double>(y)});
      if (!location || !area.holds(location->ground)) continue;
      minimum = std::min(minimum, radius_at({static_cast<double>(x), static_cast<double>(y)}).value_or(minimum));
    }
  }
  return [radius_at, minimum](const Vector<2>& pixel) -> std::optional<double> {
    const auto radius = radius_at(pixel);
    if (!radius) return std::nullopt;
    return std::max(*radius, minimum);
  };
}

}  // namespace

BallInView::BallInView(CameraId id, const GroundView& view, const reconstruct::GroundArea& area,
                       const detect::ball::BallDetectorOptions& options)
    : id_(id), detector_(ball_sizes(view, area), options) {}

void BallInView::search(const Frame& frame, const std::vector<Detection>& people) {
  track::ball::BallView& view = candidates_.emplace();
  view.camera = id_;
  view.time = frame.time;
  for (const Detection& person : people) view.people.push_back(person.box);
  for (const detect::ball::BallCandidate& candidate : detector_.detect(frame))
    view.detected.push_back({candidate.centre, candidate.sigma, candidate.score, candidate.local_clutter, {}, false});
}

}  // namespace marey::pipeline::people::ground
