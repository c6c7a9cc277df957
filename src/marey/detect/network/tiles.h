// Where a network searches: square parts of the image so large that people fill the share of them that networks find best,
// overlapping by more than a person, so that every person lies whole in some part; and one list of people out of the detections in
// all of them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"
#include "marey/detect/network/output_layout.h"

namespace marey::detect::network {

struct TileOptions {
  double fraction = 0.28;  ///< a person's height over the tile's: SSD-MobileNet finds most at 0.2 to 0.35
  double apart = 1.6;      ///< sizes of people that differ by more get tiles of their own
  double overlap = 1.25;   ///< of neighbouring tiles, in heights of a person
  double levels = 3.2;     ///< of tiles of several sizes, each this much larger than the one before: where sizes are not known
  double margin = 0.12;    ///< that a person keeps from the edges of a tile round them, in heights
};

/// How high a person with feet at (x, y) is, px; nothing if no person can stand.
using HeightAt = std::function<std::optional<double>(double, double)>;

/// The tiles of an image, all square, of up to the image's longer side: they may reach beyond its right and lower edge. Without
/// `height_at`, tiles of several sizes: for people of `typical` px, and larger ones up to the image's height.
std::vector<cv::Rect> tiles_over(cv::Size image, const HeightAt& height_at, double typical, const TileOptions& options = {});

/// Few tiles in which every person of `people` (px of the image) lies whole, or as far as the image allows; people of like size
/// who stand together share one.
std::vector<cv::Rect> tiles_round(cv::Size image, std::span<const Box> people, const TileOptions& options = {});

/// What one tile gave; candidates in px of the whole image.
struct TileFinds {
  cv::Rect tile;
  std::vector<Candidate> found;
};

struct JoinOptions {
  double same = 0.5;      ///< intersection over union from which on two finds are one person
  double within = 0.75;   ///< of the smaller one's area, that lies in the other: likewise
  double border = 0.015;  ///< of the tile's side: a person so near an inner edge is cut off by it
  double spanned = 0.75;  ///< of its area that others' boxes cover together: it spans them
};

/// One find a person, of all tiles the surest that is shaped like one; a box that spans several people is not among them; one
/// cut off by an inner edge is left to the tile that holds it whole. The surest first.
std::vector<Candidate> join_finds(std::span<const TileFinds> tiles, cv::Size image, const JoinOptions& options = {});

}  // namespace marey::detect::network
