#pragma once

#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/detect/markers/marker_runs.h"

namespace marey::detect::markers {

inline constexpr double kDefaultBlur = 0.65;  ///< px; a sharp lens, and the pixel

/// A marker as fitted: a disc with a blurred edge.
struct MarkerShape {
  Vector<2> centre = Vector<2>::Zero();          ///< px
  Matrix<2> covariance = Matrix<2>::Identity();  ///< of the centre, px²
  double radius = 1;                             ///< px
  double blur = 0.65;                            ///< standard deviation of the edge, px; the pixel's own width included
  double contrast = 0;                           ///< grey levels above the background, or below it where markers are dark
  double misfit = 0;                             ///< root mean square of what the model leaves, as a share of the contrast
  bool part = false;                             ///< one of several in its blob
  bool fitted = false;                           ///< false: the disc did not fit, and the centre is the weighted centroid
};

/// Prior knowledge around a blob before the fit.
struct MarkerSurroundings {
  double background = 0;  ///< grey levels
  double noise = 1;       ///< grey levels
  double white = 255;     ///< pixels at or above are saturated
  bool dark = false;
  std::optional<double> blur;  ///< what other markers of the clip have, px
};

/// A blob close by, whose light is to be omitted.
struct MarkerNeighbour {
  Vector<2> centre = Vector<2>::Zero();
  double radius = 0;  ///< px
};

/// The pixels round one blob, in units of its rough contrast: 0 is the background, 1 the marker. Kept from blob to blob.
struct MarkerWindow {
  std::vector<float> x, y, value, weight;  ///< x and y from `origin`, px; padded to eights with weight 0
  int count = 0;                           ///< before padding
  Vector<2> origin = Vector<2>::Zero();
  double scale = 1;                        ///< grey levels a unit
  double background = 0;                   ///< grey levels
  Vector<2> centroid = Vector<2>::Zero();  ///< weighted, from `origin`
  Matrix<2> centroid_covariance = Matrix<2>::Identity();
  double half_area = 0;  ///< pixels above half the contrast
  double reach = 0;      ///< radius of the window, px

  MarkerSamples samples() const { return {x.data(), y.data(), value.data(), weight.data(), static_cast<int>(x.size())}; }
};

/// Collects the pixels round a blob out to 2.5 px beyond it, less those nearer to a neighbour. `neighbours` is used up.
void collect_window(const cv::Mat& image, const MarkerBlob& blob, const MarkerSurroundings& around,
                    std::vector<MarkerNeighbour>& neighbours, MarkerWindow& window);

/// Fits a disc to the window; falls back on the weighted centroid where that fails.
MarkerShape fit_disc(const MarkerWindow& window, const MarkerBlob& blob, const MarkerSurroundings& around,
                     const MarkerKernels& kernels = marker_kernels());

}  // namespace marey::detect::markers
