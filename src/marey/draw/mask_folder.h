#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace marey::draw {

/// A folder of foreground masks, one PNG a frame: bin000001.png is that of frame 0, grey, 255 where something is seen that does
/// not belong to the scene, else 0. Public benchmarks of background models (changedetection.net) call and count them so.
class MaskFolder {
 public:
  /// Throws Error if `folder` is there and holds something, or is not one.
  static void require_free(const std::string& folder);
  /// Makes the folder, of files that are called PREFIX000001.png. Throws Error if that cannot be, or it holds something already.
  explicit MaskFolder(std::string folder, std::string prefix = "bin");
  /// Without `finish` the masks go away again.
  ~MaskFolder();
  MaskFolder(const MaskFolder&) = delete;
  MaskFolder& operator=(const MaskFolder&) = delete;

  /// The mask (CV_8UC1, or numbers of targets as CV_16UC1) of frame `index`; an empty one is black, of `size` px. Throws Error if
  /// it cannot be written.
  void add(std::int64_t index, const cv::Mat& mask, cv::Size size);
  void finish() { finished_ = true; }

 private:
  std::string path_of(std::int64_t index) const;

  std::string folder_, prefix_;
  bool made_ = false;  // it was not there before
  std::vector<std::int64_t> written_;
  bool finished_ = false;
};

}  // namespace marey::draw
