#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/simulate/people/figure.h"
#include "marey/simulate/people/people_renderer.h"

namespace marey::simulate::people {

/// Darkens the ground about the shoes of a figure: what they keep of the sky's light from it, also where there is no sun.
/// `strength` is the share of light that is kept away right under a shoe on the ground. Planes in 4:2:0, limited range.
void darken_contact(std::span<const Limb> limbs, const Projection& projection, double strength, const Vector<2>& shift,
                    cv::Mat& luma, cv::Mat& cb, cv::Mat& cr);

}  // namespace marey::simulate::people
