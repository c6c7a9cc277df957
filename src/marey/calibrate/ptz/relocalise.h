// Where a camera on a known tripod is aimed, from one image alone: at the beginning, and after a cut.
//
// Bright ridges on green are a mask of what may be paint. Headings all over the pitch are tried, coarse first: of each, the model's
// lines are laid over the distances to the mask, and what lies near counts, by its length in the image, what lies far counts
// against it. The best few are refined on the paint itself and evaluated both ways: by the lines that they promise and are there,
// and by the paint that lies on no line of theirs. A heading counts only where no other one explains the image nearly as well: an
// image of another place, or a goal mouth alone, gives none. Headings about the last known one come first. Cost: some 50 ms.
// Reference: Thomas 2007 (a search over the possible views starts the tracker).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/calibrate/ptz/heading_search.h"
#include "marey/calibrate/ptz/paint_mask.h"
#include "marey/calibrate/ptz/ptz_fit.h"
#include "marey/core/image.h"
#include "marey/geometry/pitch.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::ptz {

/// Where the camera was aimed when it was last known, carried on by the flow, and how many frames ago that was.
struct NearHeading {
  geometry::Heading heading;
  int frames = 0;
};

struct FindAgainOptions {
  std::optional<NearHeading> near;  ///< headings about it are tried first, and preferred
  double min_log_focal = 0.3, max_log_focal = 2.4;
  double fraction = 0.55;      ///< of the samples of the lines in view that have to be paint,
  int min_agreeing = 35;       ///< and this many of them,
  int lines = 3;               ///< on this many lines
  double both = 0.4;           ///< √(fraction of the lines that is paint · fraction of the paint that is lines), at least
  bool everywhere = true;      ///< not about the last heading alone
  std::size_t near_count = 3;  ///< headings about the last one that are refined
  double near_angle = 0.06, near_zoom = 0.15;             ///< rad, ln f about the last heading,
  double near_angle_rate = 0.008, near_zoom_rate = 0.02;  ///< and as much more for every frame since,
  double max_near_angle = 0.35, max_near_zoom = 0.6;      ///< but no more than this
  PaintMaskOptions mask;
  double explained_px = 3.5;      ///< of the shrunk image: paint so near a line belongs to it
  double beyond = 1.5;            ///< m beyond the lines paint belongs to no pitch,
  double off_pitch_weight = 0.3;  ///< and weighs as much there
  double rival = 0.8;             ///< another heading may agree with at most this share of as many
};

/// How well a heading explains an image, evaluated both ways.
struct ImageEvidence {
  AimFit fit;
  std::vector<PaintSighting> paint;  ///< found where its lines are expected
  int expected = 0;                  ///< samples of lines in the image
  double explained = 0;              ///< fraction of the paint mask that lies on a line
  double merit() const;
  double both() const;  ///< √(fraction of the lines that is paint · fraction of the paint that is lines)
  bool enough(const FindAgainOptions& options) const;
};

/// The heading refined on the paint itself, from `start`; `seen` is the image's mask, `lines` in the world.
ImageEvidence evidence_of(const Image& image, const PaintMask& seen, const geometry::Tripod& tripod,
                          const geometry::PitchSize& pitch, std::span<const geometry::PitchLine> lines,
                          const geometry::Heading& start, const FindAgainOptions& options);

/// Whether two headings are about the same.
bool alike(const geometry::Heading& a, const geometry::Heading& b);

/// The closest of the best headings in a range, those that explain more first.
std::vector<ImageEvidence> headings_by_evidence(const Image& image, const PaintMask& seen, const geometry::Tripod& tripod,
                                                const geometry::PitchSize& pitch, std::span<const geometry::PitchLine> lines,
                                                const SearchLines& search, const std::vector<geometry::Heading>& headings,
                                                std::size_t count, const FindAgainOptions& options);

/// `lines` in the world, `search` the same prepared. The covariance is that of the paint alone.
std::optional<AimFit> find_again(const Image& image, const geometry::Tripod& tripod, const geometry::PitchSize& pitch,
                                 std::span<const geometry::PitchLine> lines, const SearchLines& search,
                                 const FindAgainOptions& options = {});

}  // namespace marey::calibrate::ptz
