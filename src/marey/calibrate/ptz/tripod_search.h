// Where the tripod of a main camera stands, from images alone: no clicks.
//
// Main cameras stand behind the near touchline about the halfway line. Places all over where they stand are tried, and headings
// from each of them, on the images that show most lines: every try is a hypothesis of which lines of the pitch are seen
// (heading_search.h). The best are moved to the top of the score, place and heading together, and refined on the paint with what
// main cameras have in common as a prior. Each is then tested on the other images: its tripod has to explain them as well, by some
// heading, and all that it explains are solved together. A hypothesis counts where it explains most of the images, lines without
// paint and paint without lines, and no other explains nearly as many.
//
// A pitch turned by half a turn has the same image: the camera is taken to stand before y = 0. Cost: some 5 s of a processor.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/calibrate/ptz/relocalise.h"
#include "marey/calibrate/ptz/tripod_solve.h"
#include "marey/core/image.h"

namespace marey::calibrate::ptz {

/// Where main cameras stand, in the world: the pitch begins at its origin. The deviations were swept for element_camera.h.
LocationPrior main_camera_prior(const geometry::PitchSize& pitch);

struct SearchImage {
  std::int64_t frame = 0;
  Image image;
  int lines = 0;  ///< distinct straight ones (paint_mask.h)
};

/// What is enough to explain an image where the tripod is not known: the image may show fewer lines, as others have to agree.
inline FindAgainOptions searched_evidence() {
  FindAgainOptions again;
  again.lines = 2;
  return again;
}

struct TripodSearchOptions {
  FindAgainOptions again = searched_evidence();  ///< what is enough to explain an image
  double max_log_focal = 1.9;                    ///< of an image's heading: closer shots are left to the tracker
  std::size_t start_images = 2;                  ///< that hypotheses are drawn from, those with most lines
  std::size_t climbed = 30;                      ///< hypotheses of an image that are moved to the top of their score,
  std::size_t tested = 3;                        ///< and tested on the other images
  std::size_t lowest_images = 3;                 ///< that have to be explained,
  double fraction = 0.5;                         ///< and this share of those that show `many_lines` or more
  int many_lines = 4;
  int lines = 3;              ///< of the model that are seen in one image or another; the centre circle counts as two
  double line_present = 0.2;  ///< of a line in view is paint, at least: without a whole line the pitch is another one
  double rival = 0.75;        ///< another hypothesis may explain at most this share of as much
};

/// An image that the tripod explains.
struct SearchedView {
  std::int64_t frame = 0;
  geometry::Heading heading;
  double both = 0;  ///< ImageEvidence::both
};

enum class TripodVerdict {
  found,
  no_lines,   ///< too few images show lines of a pitch
  none,       ///< no hypothesis explains them
  ambiguous,  ///< two explain them nearly alike
};

struct SearchedTripod {
  TripodVerdict verdict = TripodVerdict::none;
  geometry::Tripod tripod;
  Matrix<geometry::Tripod::numbers> covariance = Matrix<geometry::Tripod::numbers>::Zero();
  std::vector<SearchedView> views;  ///< those that it explains
  double merit = 0, rival = 0;      ///< sums over the images, of the best hypothesis and the next
};

/// `images` of one size, in any order.
SearchedTripod search_tripod(std::span<const SearchImage> images, const geometry::PitchSize& pitch,
                             const TripodSolveOptions& solve = {}, const TripodSearchOptions& options = {});

}  // namespace marey::calibrate::ptz
