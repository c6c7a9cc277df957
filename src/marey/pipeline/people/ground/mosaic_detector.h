// People before a PTZ camera: what differs from the mosaic of its empty scene, as tall and as wide as people are there.
#pragma once

#include <memory>

#include "marey/core/ground_views.h"
#include "marey/core/ptz_camera.h"
#include "marey/core/rig.h"
#include "marey/detect/detector.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/reconstruct/ground_area.h"

namespace marey::pipeline::people::ground {

struct MosaicDetectorOptions {
  int frames = 120;               ///< that the empty scene is learned from, evenly over the video's beginning,
  double seconds = 300;           ///< which is as long
  int max_frames = 3000;          ///< that are read for it
  double contrast = 18;           ///< grey levels that a person differs by,
  int slack_px = 1;               ///< px at 1280: from everything so far about in the empty scene
  double low = 0.45, high = 1.6;  ///< of a person's height: a region is as tall
  double filled = 0.2;            ///< of a region's box differs, at least
  double aside = 1.7;             ///< of a person's width: a wider region holds several
};

/// Reads the video's beginning ahead to learn the empty scene. Throws Error if it cannot be read twice; Stopped.
std::unique_ptr<detect::Detector> mosaic_detector(const corridor::Feed& feed, std::shared_ptr<const PtzCamera> camera,
                                                  std::shared_ptr<const GroundViews> views, const reconstruct::GroundArea& area,
                                                  const MosaicDetectorOptions& options = {});

}  // namespace marey::pipeline::people::ground
