#pragma once

#include <functional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/people_size.h"
#include "marey/detect/silhouette.h"

namespace marey {

/// One person placed on the foreground.
struct Placed {
  Box box;           ///< px; of the size expected at its place, or of the expected person's own size
  double cover = 0;  ///< how well the body lies on foreground that no one before it explains: 1 wholly, 0 and below not
  double seen = 0;   ///< share of the body that lies on foreground, whoever else explains it, in [0, 1]
  int known = -1;    ///< which of the known people this is; −1 for a new one
};

struct FitOptions {
  double min_cover_known = 0.1;  ///< someone known to be here is believed from this cover on
  double min_cover_new = 0.42;   ///< someone new
  double blank_penalty = 0.6;    ///< what an empty pixel within the body costs, where a filled one is worth 1
  int cells_tall = 32;           ///< resolution: a person is this many cells tall
};

using SizeAt = std::function<std::optional<PersonSize>(double x, double y)>;

/// Explains the pixels of `runs` (in order; within a picture of size `image`) by people: those `known` to be about here first,
/// each near its box and of its size, then new ones. People found are in the order in which they were believed.
std::vector<Placed> fit_people(std::span<const PixelRun> runs, cv::Size image, std::span<const Box> known, const SizeAt& size_at,
                               const FitOptions& options = {});

}  // namespace marey
