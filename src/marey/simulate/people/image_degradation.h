#pragma once

#include <opencv2/core.hpp>

namespace marey::simulate::people {

/// What a lens, a camera's own processing and a codec make of a sharp image. Nothing by itself.
struct ImageDegradation {
  double blur = 0;     ///< px, standard deviation of the lens and of motion, luma and chroma
  double halo = 0;     ///< sharpening: share of a step of light that is added beyond it, bright beside dark and dark beside bright
  double halo_px = 2;  ///< how far the halo reaches, standard deviation
  double chroma_bleed = 0;  ///< px of luma, standard deviation: colour runs over the edge
  double chroma_shift = 0;  ///< px of luma to the right: a fringe of colour on one side
  double quantizer = 0;     ///< step of the cosine coefficients of blocks of 8 × 8 pixels, levels: ringing about every edge

  /// As the two cameras of a match are seen through a broadcast chain: 2 to 3 px of halo and of fringe.
  static ImageDegradation recorded() { return {0.8, 0.45, 2, 2.2, 1, 14}; }

  bool plain() const { return blur <= 0 && halo <= 0 && chroma_bleed <= 0 && chroma_shift == 0 && quantizer <= 0; }
};

/// Changes the planes of an image in 4:2:0 (CV_8UC1).
void apply(const ImageDegradation& degradation, cv::Mat& luma, cv::Mat& cb, cv::Mat& cr);

}  // namespace marey::simulate::people
