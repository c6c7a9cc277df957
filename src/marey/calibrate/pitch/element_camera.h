// A main camera from the elements of the pitch that are labelled in one image: lines, arcs and goals by name, no clicks.
//
// One image rarely decides a camera: place and focal length trade off against each other. What main cameras have in common does
// the rest: they stand behind the near touchline about the halfway line, upright, with square pixels and the principal point in
// the image's middle. So all points are fitted together with that as a prior, from the best of some two-point starts
// (element_start.h), with a loss that one wrong label cannot pull; elements that still do not fit are omitted and named.
// The labels may belong to a mirrored pitch. A camera cannot see a pitch with left and right exchanged: where the mirrored names
// fit clearly better, that is the verdict. Turned by half a turn they fit as well, with the camera on the far side: no main camera
// stands there, so that too is the verdict. Cost: some milliseconds an image.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "marey/calibrate/pitch/element_start.h"
#include "marey/geometry/camera.h"
#include "marey/geometry/pitch_elements.h"

namespace marey::calibrate::pitch {

/// Prior knowledge of main cameras before a label is seen, and how people label. Each was swept: bench/tuning.md.
struct ElementCameraOptions {
  geometry::PitchSize pitch;
  Vector<3> location = {0, -31, 15};          ///< m, z up, from the middle of the near touchline
  Vector<3> position_sigma = {2.5, 12, 4.5};  ///< m
  double roll_sigma = 0.01;                   ///< rad
  double bend = 0.025, bend_sigma = 0.02;     ///< radial term, per half image width squared
  double focal = 5, focal_sigma = 1;          ///< half image widths; of ln f
  double label_sigma = 0.005;                 ///< half image widths
  double points_of_element = 4;               ///< an element with more points weighs as much as one with these
  double outlier = 0.025;                     ///< half image widths: an element whose median point lies farther off is omitted
  double mirror_margin = 0.8;  ///< mirrored names fit clearly better where they leave less than this share of the cost
};

enum class ElementVerdict { found, too_few, no_camera, mirrored, far_side };

/// "found", "too few elements", …
std::string_view element_verdict_name(ElementVerdict verdict);

struct ElementCamera {
  ElementVerdict verdict = ElementVerdict::too_few;
  std::optional<geometry::Camera> camera;  ///< only where found
  ElementView view;                        ///< the same in numbers
  std::vector<double> error_px;            ///< for each label: the median distance of its points from where the camera sees it
  std::vector<char> used;                  ///< for each label: whether it fits
};

/// `size` of the image, px; labels in it. Two elements are the least; what they leave open the prior decides.
ElementCamera camera_from_elements(std::span<const geometry::LabelledElement> labels, cv::Size size,
                                   const ElementCameraOptions& options = {});

}  // namespace marey::calibrate::pitch
