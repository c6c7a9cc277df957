#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"
#include "marey/core/mask.h"
#include "marey/geometry/camera.h"
#include "marey/geometry/ground_surface.h"
#include "marey/geometry/ground_view.h"

namespace marey {

/// One camera of a rig: where its images come from, and as much of its calibration as is known so far.
struct RigCamera {
  std::string name;                            ///< unique within the rig, not empty
  std::string source;                          ///< a path as `open_source` takes it; empty if absent
  std::string detections;                      ///< in place of images, what another program detected; empty if absent
  std::optional<cv::Rect> region;              ///< px: the camera's part of a larger image; pixels count from its corner
  std::optional<double> rate_hz;               ///< in place of what the source's header says
  std::optional<double> offset_s;              ///< added to this camera's times gives the rig's, s; nothing if not specified
  std::optional<cv::Size> size;                ///< px
  std::optional<geometry::Lens> lens;          ///< valid for `size`
  std::optional<Rigid3> camera_from_world;     ///< m
  std::optional<Matrix<3>> ground_from_image;  ///< px to m, for a camera known only by its ground
  std::optional<double> rms_px;                ///< 2-D reprojection error of its calibration
  std::optional<double> exposure_ms = {};      ///< of a live camera; nothing: as its source or the camera itself has it
  std::optional<double> gain = {};             ///< likewise, in the camera's own unit
  std::optional<double> threshold = {};        ///< grey level that a marker's pixels pass; nothing: from the image's noise
  std::vector<Mask> masks = {};                ///< px: parts of its image in which there is no marker: lamps, reflections

  /// Everything that projecting needs; nothing if lens, pose or size is missing.
  std::optional<Camera> camera() const;

  /// How it sees the ground, `surface` being its rig's: by its camera, else by its homography, else not at all.
  std::optional<GroundView> ground_view(const geometry::GroundSurface& surface) const;
};

/// The cameras of one setup. The world is right-handed, z up, in m (a file with y up is turned when it is read); CameraId i is
/// cameras[i].
struct Rig {
  /// How it was calibrated, and how well: a 2-D reprojection error over all cameras.
  struct Calibration {
    std::string method;  ///< "wand", "board", "pitch", …; free text
    std::optional<double> mean_px, rms_px;
    std::optional<int> inliers, observations;
    std::optional<std::string> grade;
  };

  /// Ground coordinates as the user has them from the world's (x, y, 1): a reflection where the user's frame is left-handed.
  std::optional<Matrix<3>> ground_from_world;
  geometry::GroundSurface ground = {};  ///< in the world; level if not specified
  std::optional<Calibration> calibration;
  std::vector<RigCamera> cameras;
};

/// Whether no camera may have this character in its name, which names files and stands in tables: / \ , = " and control characters.
bool unfit_for_camera_name(char c);

/// The names of all cameras, for messages: "left, right".
std::string camera_names(const Rig& rig);

/// The camera of that name. Throws Error, with the existing names, if it does not exist.
RigCamera& camera_named(Rig& rig, const std::string& name);

/// Makes a camera's calibration hold for images of `found` px: it is scaled, and its masks with it, where the shapes agree within
/// a pixel. A camera without a size gets this one; so does one whose size is this one filled up to multiples of 16 px, as codecs do
/// at the right and at the bottom. Throws Error if the shapes differ: then the camera has to be calibrated at that size.
void fit_to_size(RigCamera& camera, cv::Size found);

}  // namespace marey
