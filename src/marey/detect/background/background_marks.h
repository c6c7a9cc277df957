#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_kernels.h"
#include "marey/detect/background/background_regions.h"
#include "marey/detect/background/background_shadow.h"

namespace marey::detect::background {

/// Compares frames with the bands of a scene, row by row.
class BandMarks {
 public:
  void begin(cv::Size size);

  /// The pixels outside the bands by the vote of their 3 × 3 round, into `marked`. Chroma is not read where the frame is grey.
  void find(const FramePlanes& frame, const SceneView& scene, MarkedRuns& marked);

 private:
  void mark_row(const FramePlanes& frame, const SceneView& scene, int y);

  cv::Size size_;
  const BackgroundKernels& kernels_ = background_kernels();
  std::array<std::vector<std::uint8_t>, 3> marks_;  ///< of three rows, with a zero before and after
  std::vector<std::uint8_t> chroma_mark_, vote_;
};

}  // namespace marey::detect::background
