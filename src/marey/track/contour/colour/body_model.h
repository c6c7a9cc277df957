#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour::colour {

/// A target's appearance, learned while it is not occluded: the colours of its body from head to foot, and what places about its
/// centre it covers how often. Places are in heights of the target from its centre of area.
class BodyModel {
 public:
  BodyModel();

  /// `share` of each cell of the patch shows the target (CV_32FC1); `rate` in (0, 1] is its weight against the earlier data.
  void learn_colours(const ColourPatch& patch, const cv::Mat& fraction, const Vector<2>& centre, double height, double rate);
  void learn_coverage(const ColourPatch& patch, const cv::Mat& fraction, const Vector<2>& centre, double height, double rate);

  bool knows_colours() const { return known_; }
  /// How often the place is covered, 0 … 1; before anything is learned, by a person who stands.
  float coverage(const Vector<2>& location) const { return coverage(column_at(location.x()), row_at(location.y())); }
  /// Probability density of a colour at a place `down` heights below the centre, per level³.
  float density(double down, const cv::Vec3f& colour) const { return density(bands_at(down), bin_of(colour)); }

  /// The same in steps, for all cells of a patch: what depends on a cell's column, its row and its colour alone is found once.
  struct CoveragePosition {
    int first = 0;
    float part = 0;
    bool beyond = false;  ///< of the places that coverage is learned of
  };
  static CoveragePosition column_at(double x);
  static CoveragePosition row_at(double y);
  float coverage(const CoveragePosition& column, const CoveragePosition& row) const {
    if (column.beyond || row.beyond) return 0.01F;
    const float* at = &coverage_[static_cast<std::size_t>(row.first) * kAcross + static_cast<std::size_t>(column.first)];
    const float above = at[0] + column.part * (at[1] - at[0]);
    const float below = at[kAcross] + column.part * (at[kAcross + 1] - at[kAcross]);
    return above + row.part * (below - above);
  }
  struct Bands {
    const float *upper = nullptr, *lower = nullptr;  ///< null: no colours are known
    float part = 0;
  };
  Bands bands_at(double down) const;
  static int bin_of(const cv::Vec3f& colour);
  static float density(const Bands& bands, int bin) {
    if (bands.upper == nullptr) return kFloor;
    return ((1 - bands.part) * bands.upper[bin] + bands.part * bands.lower[bin]) / kBinVolume + kFloor;
  }

 private:
  static constexpr float kFloor = 2e-8F;                                                      // per level³: any colour may come
  static constexpr double kLumaBin = 20, kChromaBin = 9;                                      // levels
  static constexpr auto kBinVolume = static_cast<float>(kLumaBin * kChromaBin * kChromaBin);  // level³; by definition
  static constexpr int kBands = 6, kLuma = 12, kChroma = 12;
  static constexpr int kAcross = 24, kDown = 36;
  using Histogram = std::array<float, kLuma * kChroma * kChroma>;

  bool known_ = false;
  std::vector<Histogram> colours_;  // each sums to 1
  std::array<float, kAcross * kDown> coverage_{};
};

}  // namespace marey::track::contour::colour
