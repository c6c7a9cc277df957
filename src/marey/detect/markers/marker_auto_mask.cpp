#include "marey/detect/markers/marker_auto_mask.h"

#include <opencv2/imgproc.hpp>

namespace marey::detect::markers {

std::optional<MarkerMask> MarkerAutoMask::add(Timestamp time, cv::Size size, std::span<const MarkerRun> runs) {
  if (finished_) return std::nullopt;
  if (!begin_) {
    begin_ = time;
    passed_ = cv::Mat::zeros(size, CV_32SC1);
  }
  if (time - *begin_ > length_) return finish();
  for (const MarkerRun& run : runs) {
    auto* row = passed_.ptr<std::int32_t>(run.row);
    for (int x = run.begin; x < run.end; ++x) ++row[x];
  }
  ++frames_;
  return std::nullopt;
}

MarkerMask MarkerAutoMask::finish() {
  finished_ = true;
  if (frames_ == 0) return {};
  const cv::Mat often = passed_ >= 0.9 * frames_;
  cv::Mat wider;
  cv::dilate(often, wider, cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5}));
  passed_.release();
  return MarkerMask(wider);
}

}  // namespace marey::detect::markers
