#pragma once

#include <string>
#include <vector>

#include "marey/calibrate/pitch/element_camera.h"
#include "marey/calibrate/pitch/element_score.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"

namespace marey::pipeline::calibrate {

struct ElementRunOptions {
  marey::calibrate::pitch::ElementCameraOptions camera;
  cv::Size size{960, 540};  ///< of the images, px: labels are shares of it
};

/// One labelled image and the camera that was found for it.
struct ElementImage {
  std::string name;
  std::vector<geometry::LabelledElement> labels;
  marey::calibrate::pitch::ElementCamera found;
  marey::calibrate::pitch::ElementScore score;  ///< at 5 px of an image 960 px wide; of nothing if there is no camera
};

struct ElementRun {
  std::vector<ElementImage> images;
  Rig rig;                            ///< a camera for each image that has one, by its name, in a world with the pitch's corner
  double jaccard = 0;                 ///< JaC@5: the mean over the images with a camera; 0 if no image has one
  std::vector<std::string> warnings;  ///< one sentence for each image without a camera, and for labels that do not fit
};

/// A camera for each image whose elements of the pitch are labelled in these files (format/pitch_labels.h). Throws Error if a
/// file cannot be read, where two images have one name, and where none gives a camera, with the first's reason; Stopped.
ElementRun calibrate_elements(const std::vector<std::string>& files, const ElementRunOptions& options = {},
                              const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
