// How people on the ground appear in one camera's image.
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/ground_views.h"
#include "marey/detect/people/person_size_map.h"
#include "marey/reconstruct/ground_area.h"

namespace marey::pipeline::people::ground {

constexpr double kMinBodyHeight = 12;  // px; a smaller body has no shape
constexpr double kBeyondArea = 5;      // m; a person who stands so far outside is tracked until it is clear whether they come in

/// The box of a person who stands at `place` (m, world), in the view of a calibrated camera.
std::optional<Box> person_at(const GroundView& view, const Vector<2>& location);

/// The size of people at each position of a calibrated camera's image, where they count or nearly so.
detect::people::PersonSizeMap sizes_over(const GroundView& view, const reconstruct::GroundArea& area, const cv::Rect& part);

/// The part of a calibrated camera's image, even-sided, in which a person who counts may appear.
cv::Rect part_with_people(const GroundView& view, const reconstruct::GroundArea& area);

Box moved(const Box& box, const cv::Point& by);

}  // namespace marey::pipeline::people::ground
