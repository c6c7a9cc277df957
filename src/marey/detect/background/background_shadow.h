#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/image.h"
#include "marey/detect/background/background_plane.h"
#include "marey/detect/silhouette.h"

namespace marey::detect::background {

/// The scene as the planes of an image; chroma is not read where the image is grey.
struct SceneView {
  const ScenePlane& luma;
  const ScenePlane& cb;
  const ScenePlane& cr;
  int black;  ///< the level of luma's black
};

/// 8-bit planes of a frame; chroma empty for grey.
struct FramePlanes {
  cv::Mat luma, cb, cr;
};

/// Distinguishes cast shadows from objects, in cells of 4 × 4 pixels.
class ShadowFinder {
 public:
  void begin(cv::Size size);

  /// Evaluates the pixels of `runs`, which are in order.
  void assess(std::span<const PixelRun> runs, const FramePlanes& frame, const SceneView& scene);

  /// Whether a pixel of the runs evaluated last lies in shadow, given its levels in frame and scene, over black.
  bool is_shadow(int row, int column, int frame, int scene) const {
    return 1024 * frame >= scene * lightest_[cell_at(row, column)] && frame < scene;
  }

  /// The same by the pixel's own colour, where the ground has enough of it: a shadow leaves it in proportion to the light. `cb` and
  /// `cr` are frame and scene, less grey, in levels.
  static bool is_coloured_shadow(int frame, int scene, int frame_cb, int frame_cr, int scene_cb, int scene_cr);

  static constexpr int kCell = 4;

 private:
  enum class Label : std::uint8_t { none, unsure, thing, shadow };
  struct Cell {
    int count = 0, darker = 0;
    int ratio = 0;  ///< the light left, in 1/1024, where the cell is shadow by its own appearance
    int frame = 0, scene = 0, frame2 = 0, scene2 = 0, both = 0;  ///< sums over pixels, of levels over black
  };

  static constexpr int kNever = 1 << 20;  // by definition: above any value

  std::size_t cell_at(int row, int column) const {
    return static_cast<std::size_t>(row / kCell + 1) * stride_ + static_cast<std::size_t>(column / kCell + 1);
  }
  void gather(std::span<const PixelRun> runs, const FramePlanes& frame, const SceneView& scene);
  Label label_of(std::size_t index, const FramePlanes& frame, const SceneView& scene);
  bool same_colour(std::size_t index, double ratio, const FramePlanes& frame, const SceneView& scene) const;
  void settle_by_neighbours();
  void set_limits();
  bool is_within_body(std::size_t index) const;
  bool is_default(double ratio) const;

  cv::Size size_;
  std::size_t stride_ = 0;
  std::vector<Cell> cells_;  ///< with an empty border
  std::vector<Label> labels_;
  std::vector<int> lightest_;  ///< of each cell: its pixels with at least this part of the scene's light, in 1/1024, are shadow
  std::vector<std::size_t> touched_;
  std::vector<std::size_t> changed_;  ///< room for one pass
  static constexpr int kBins = 20;
  std::array<double, kBins> evidence_{};  ///< how often textured ground was seen through a shadow of this depth, lately
};

}  // namespace marey::detect::background
