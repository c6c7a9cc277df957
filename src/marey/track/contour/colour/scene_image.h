#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/track/contour/colour/chroma_shift.h"

namespace marey::track::contour::colour {

/// The image of the scene without the targets, learned from the pixels that are not foreground: what a contour's outside is
/// like.
class SceneImage {
 public:
  /// A frame and its foreground (CV_8UC1, of the image's size; other sizes are ignored). Nothing is learned within the boxes of
  /// `targets` (px): the foreground of a person who stands has holes. Every fourth row is learned per frame, all of them in the
  /// first. Cost: a pass over a quarter of the pixels.
  void observe(const Image& image, const cv::Mat& foreground, std::span<const Box> targets = {});

  /// Whether the scene has this size and has been learned from at least one frame.
  bool has(const cv::Size& size) const { return !frames_.empty() && frames_.size() == size; }

  /// Luma, Cb, Cr (CV_32FC1, levels) of `area` (px, even corners and sides), chroma at half the size; and of each pixel 1 if it was
  /// ever seen without foreground, else 0.
  cv::Mat luma(const cv::Rect& area) const;
  cv::Mat chroma(int which, const cv::Rect& half_area) const;
  cv::Mat known(const cv::Rect& area) const;

  /// px by which this camera's chroma lies to the right of its luma.
  double chroma_shift() const { return shift_.px(); }
  /// px, standard deviation, by which it smears the colour of an edge; 0 while that is not known.
  double smear() const { return shift_.smear(); }

 private:
  /// What of a row shows no scene: `taken_`.
  void note_taken(const cv::Mat& foreground, std::span<const Box> targets, int row);
  void learn_row(const Image& image, int row);
  void learn_block(const Image& image, int row, int first, int count);

  ChromaShift shift_;
  std::vector<std::uint8_t> taken_;  // of the row that is learned: not 0 where this frame shows no scene
  int next_ = -1;                    // rows of this remainder are learned next; −1: all
  cv::Mat frames_;                   // CV_8UC1: frames that a pixel was learned from, at most 255
  cv::Mat luma_, cb_, cr_;           // CV_16UC1: levels × 128
};

}  // namespace marey::track::contour::colour
