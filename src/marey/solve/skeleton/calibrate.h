// Fits a skeleton to a person: how large its segments are and where its markers sit, from frames of a motion, poses and all at
// once.
//
// Minimises Σ |p(x_f, s, o) − m|² / σ² over frames f, with priors: segments' scales s (along each of a segment's axes; left and
// right tied) near the person's overall size, markers' offsets o near where the skeleton has them. Poses are eliminated frame by
// frame (Schur's complement), as points are in bundle adjustment, so that the cost is linear in the frames. Method: Reinbolt et al.
// 2005; Andersen et al. 2010.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/skeleton.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace marey::solve::skeleton {

using ObservedMarkers = std::vector<std::optional<Vector<3>>>;  ///< one place for each of the skeleton's markers

struct CalibrateOptions {
  double marker_sigma_m = 0.005;
  /// Beside it, of all markers in the frames of a motion: what lasts through them (skin, a model of other joints), so that more
  /// frames of one motion do not determine it better. Not of the static trial, which the markers are referred to.
  double lasting_sigma_m = 0;
  double scale_sigma = 0.05;     ///< of a segment's scale along one of its axes, against the person's; 0: scales stay
  double offset_sigma_m = 0.01;  ///< of a marker's place on its segment
  /// Of each marker, in place of `offset_sigma_m`: bony landmarks sit where the skeleton has them, those of a cluster anywhere.
  /// Empty: all alike. A loose marker counts less for the person's size and the first poses.
  std::vector<double> offset_sigmas_m = {};
  double tie_sigma_m = 0;  ///< of a left marker's place against its right twin's mirror image; 0: they are free
  /// The person standing upright, and of each coordinate how far it is from 0 there, one standard deviation in rad; 0: anything.
  std::optional<ObservedMarkers> standing = {};
  std::vector<double> standing_sigmas_rad = {};
  bool overall = true;  ///< first finds the person's size as a whole
  int frames = 60;      ///< this many of those given, evenly
  int rounds = 8;
};

struct Calibration {
  Skeleton skeleton;
  double overall_scale = 1;
  double rms_before_m = 0, rms_after_m = 0;       ///< of the frames used
  std::vector<Vector<3>> scales;                  ///< by segment
  std::vector<double> standing;                   ///< the coordinates of who stands, by the markers alone; empty without
  std::vector<double> marker_moved_m;             ///< by marker
  std::vector<std::string> undetermined;          ///< segments whose scale the frames do not determine: less than the prior said
  std::vector<std::string> undetermined_markers;  ///< markers whose place they do not determine along some axis, likewise
};

/// Throws Error if there are no frames, or they do not show the skeleton.
Calibration calibrate(const Skeleton& skeleton, std::span<const ObservedMarkers> frames, const CalibrateOptions& options = {});

/// The skeleton with its segments larger along their own axes: joints that hang on them, markers, and shifts of the joints that
/// hang on them.
Skeleton scaled(const Skeleton& skeleton, std::span<const Vector<3>> scales);

}  // namespace marey::solve::skeleton
