#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "marey/core/detection.h"
#include "marey/core/image.h"
#include "marey/core/track.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/body_mask.h"
#include "marey/track/contour/colour/colour_patch.h"
#include "marey/track/contour/contour_target.h"

namespace marey::track::contour {

/// Whether an outline reaches from a silhouette's top to its foot, and not far beyond its box (px): colours that cut off a head or
/// legs, or found the ground's shadow alike, are mistaken. Not where there is no outline.
bool is_whole(const std::optional<geometry::ClosedSpline>& outline, const Box& silhouette);

/// Takes outlines from silhouettes of one target alone, and learns from them their targets' appearance. Several threads may do so
/// for distinct targets.
class LoneSilhouettes {
 public:
  /// `fit` says how the first silhouette of a target is fitted; later ones get as many control points or more.
  explicit LoneSilhouettes(const geometry::SplineFitOptions& fit) : fit_(fit) {}

  /// The frame that silhouettes are of: `mask` is its foreground, CV_8UC1; either may be empty.
  /// `scene` stays with its owner; it may be null.
  void inspect_at(const Image& image, const cv::Mat& mask, const colour::SceneImage* scene = nullptr);
  bool has_colours() const;  ///< whether the frame's image shows where a body ends

  /// The outline of a silhouette: where its body ends, by its colours; without them, its edge of light.
  /// `target`, if its colours are known, says what to expect.
  std::optional<geometry::ClosedSpline> fitted(const Detection& detected, const geometry::SplineFitOptions& options,
                                               const ContourTarget* target = nullptr,
                                               const colour::BodyMask* mask = nullptr) const {
    return inspected(detected, options, target, mask).spline;
  }

  /// The tracker says that `seen` is this target: its whole edge shows more than the lines, which a leg that swings leaves behind.
  /// False, and nothing is changed, where the silhouette is unlike the target (cut, or grown by something else).
  /// `mask`, which may be null, is a network's of it.
  bool take(ContourTarget& target, const Detection& detected, const Track<2>& track, const colour::BodyMask* mask = nullptr) const;

 private:
  /// A silhouette's outline, and the patch that it was found in with what of it is body; `fraction` is empty if colours were not
  /// used.
  struct Inspected {
    std::optional<geometry::ClosedSpline> spline = {};
    colour::ColourPatch patch = {};
    cv::Mat fraction = {};
  };
  Inspected inspected(const Detection& detected, const geometry::SplineFitOptions& options, const ContourTarget* target,
                      const colour::BodyMask* mask) const;
  bool is_smeared(double height) const;
  /// What share of each of the patch's cells shows the target, by its learned colours and the scene's.
  static cv::Mat known_fraction(const colour::ColourPatch& patch, const ContourTarget& target, const Detection& detected,
                                const colour::BodyMask* mask);
  void set_shape(ContourTarget& target, const Inspected& found) const;
  static void learn(ContourTarget& target, const Inspected& found, const Vector<2>& centre, const Track<2>& track);

  geometry::SplineFitOptions fit_;
  Image image_;
  cv::Mat mask_;
  const colour::SceneImage* scene_ = nullptr;
};

}  // namespace marey::track::contour
