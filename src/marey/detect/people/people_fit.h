#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/people/people_size.h"
#include "marey/detect/silhouette.h"

namespace marey::detect::people {

/// One person placed on the foreground.
struct Located {
  Box box;              ///< px; of the size expected at its place, or of the expected person's own size
  double cover = 0;     ///< how well the body lies on foreground that no one before it explains: 1 wholly, 0 and below not
  double detected = 0;  ///< share of the body that lies on foreground, whatever else explains it, in [0, 1]
  int known = -1;       ///< which of the known people this is; −1 for a new one
};

struct FitOptions {
  double min_cover_known = 0.1;      ///< a person known to be here is trusted from this cover on
  double min_fraction_known = 0.25;  ///< or, hidden by something, when this much of the body is seen
  double min_cover_new = 0.42;       ///< a person new
  double blank_penalty = 0.6;        ///< what an empty pixel within the body costs, where a filled one is worth 1
  int cells_tall = 32;               ///< resolution: a person is this many cells tall
};

/// Prior knowledge of the scene where people are searched for.
struct FitScene {
  cv::Size image;                                                    ///< px
  std::function<std::optional<PersonSize>(double, double)> size_at;  ///< of a person with feet at (x, y); nothing if none can be
  std::function<bool(double, double)> hidden = nullptr;              ///< whether a pixel hides who is behind it; may be omitted
};

/// Explains the pixels of `runs` (in order; within the image) by people: those `known` to be about here, each near its box and
/// of its size, and new ones. People found are in the order in which they were trusted. Nothing if no size is known.
std::vector<Located> fit_people(std::span<const PixelRun> runs, std::span<const Box> known, const FitScene& scene,
                                const FitOptions& options = {});

}  // namespace marey::detect::people
