#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/bundle/bundle.h"
#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate {

/// How well one camera, or all of them, explain the observations. Errors are 2-D distances.
struct FitQuality {
  double mean_px = 0, rms_px = 0;
  int inliers = 0, observations = 0;
};

struct CameraReport {
  std::string name;
  FitQuality fit;
  double coverage = 0;        ///< share of the image, in 10 × 8 parts, in which something was seen
  double world_error_mm = 0;  ///< mean distance of its rays from what they saw; in thousandths of the unit without a scale
  bundle::CameraDeviation deviation = {};
};

/// How sure a marker's place is, by one view of all cameras that see it: a grid over where the wand was.
struct VolumeReport {
  Vector<3> low = Vector<3>::Zero(), high = Vector<3>::Zero();  ///< m: the box, nine tenths of what the wand covered on each axis
  double median_mm = 0, worst_tenth_mm = 0;                     ///< standard deviation of the place, all axes together
  double observed_by_two = 0, observed_by_three = 0;            ///< share of the box
};

/// On frames that took no part in the fit.
struct HeldOutReport {
  int frames = 0;
  FitQuality fit;             ///< markers placed again by all who see them
  double noise_px = 0;        ///< each axis, by those errors, degrees of freedom taken off
  double length_mean_mm = 0;  ///< measured minus true
  double length_rms_mm = 0;
};

struct RigReport {
  FitQuality all;
  double noise_px = 0;  ///< each axis
  std::vector<CameraReport> cameras;
  VolumeReport volume;
  std::optional<HeldOutReport> held_out;
  std::string grade;    ///< "excellent", "good", "fair" or "poor"
  std::string meaning;  ///< one sentence: what may be expected of it, and what limits it
};

/// Of a bundle and its fit; `names` and `sizes` by camera.
RigReport report_on(const bundle::Bundle& bundle, const bundle::BundleResult& fit, const std::vector<std::string>& names,
                    const std::vector<cv::Size>& sizes);

/// Places every marker of `bundle`'s observations again, as a free point, by the bundle's cameras, and compares.
HeldOutReport evaluate_held_out(const bundle::Bundle& bundle, const std::vector<cv::Size>& sizes);

/// Sets grade and meaning: the worst of the noise (for an image of 1280 columns; `columns` of the widest one), the wand's length
/// on held-out frames (relative to `wand_m`, where there is one), the least covered camera and the share of outliers decides.
void grade(RigReport& report, int columns, double wand_m);

}  // namespace marey::calibrate
