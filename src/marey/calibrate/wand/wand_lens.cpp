#include "marey/calibrate/wand/wand_lens.h"

#include <algorithm>

namespace marey::calibrate::wand {

geometry::Lens starting_lens(const RigCamera& camera, double guess) {
  if (camera.lens) return *camera.lens;
  geometry::BrownLens lens;
  lens.focal.setConstant(guess * std::max(camera.size->width, camera.size->height));
  lens.principal = {(camera.size->width - 1) / 2.0, (camera.size->height - 1) / 2.0};
  return lens;
}

bundle::LensFreedom growing_lens() {
  return {0.3, 0, 0, {0.1}};
}

bundle::LensFreedom estimated_lens(cv::Size size) {
  return {bundle::LensFreedom::free, 0.005, 0.04 * size.width, {0.5, 0.3, 0.001, 0.001, 0, 0, 0, 0}};
}

bundle::LensFreedom refined_lens(cv::Size size) {
  return {bundle::LensFreedom::free, 0.01, 0.04 * size.width, {0.1, 0.1, 0.002, 0.002, 0, 0, 0, 0}};
}

}  // namespace marey::calibrate::wand
