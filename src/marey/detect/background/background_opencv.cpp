#include "marey/detect/background/background_opencv.h"

#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

namespace marey::detect::background {
namespace {

/// OpenCV's models mark foreground 255 and shadow 127; they take BGR, which costs them a conversion here.
class OpenCvBackground final : public Background {
 public:
  explicit OpenCvBackground(cv::Ptr<cv::BackgroundSubtractor> model) : model_(std::move(model)) {}

  void prime(std::span<const Frame> samples) override {
    for (const Frame& sample : samples) model_->apply(sample.image.bgr(), marked_);
  }

  Foreground apply(const Frame& frame, std::span<const Box> /*held*/) override {
    model_->apply(frame.image.bgr(), marked_);
    cv::threshold(marked_, mask_, 200, 255, cv::THRESH_BINARY);
    cv::medianBlur(mask_, smooth_, 3);
    return {smooth_};
  }

 private:
  cv::Ptr<cv::BackgroundSubtractor> model_;
  cv::Mat marked_, mask_, smooth_;
};

}  // namespace

std::unique_ptr<Background> make_mog2(const Mog2Options& options) {
  return std::make_unique<OpenCvBackground>(
      cv::createBackgroundSubtractorMOG2(options.history, options.variance_gate, options.detect_shadows));
}

std::unique_ptr<Background> make_knn(const KnnOptions& options) {
  return std::make_unique<OpenCvBackground>(
      cv::createBackgroundSubtractorKNN(options.history, options.squared_distance, options.detect_shadows));
}

}  // namespace marey::detect::background
