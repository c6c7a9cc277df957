#include "experiments/naive_contours.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

#include "marey/core/geometry.h"
#include "marey/detect/people/people.h"
#include "marey/detect/silhouette.h"
#include "marey/track/tracker.h"

namespace marey::experiments {
namespace {

constexpr int kHistory = 500;          // frames, the default of MOG2
constexpr double kLearnOnce = -1;      // the default rate of MOG2
constexpr std::uint8_t kShadow = 127;  // as MOG2 marks it
constexpr int kMinPixels = 6;

/// Tracks with Marey's detector, shapes with MOG2.
class NaiveMethod final : public OutlineMethod {
 public:
  NaiveMethod() : tracked_(silhouette_method()), background_(cv::createBackgroundSubtractorMOG2(kHistory, 16, true)) {}

  void prime(std::span<const Frame> samples) override {
    tracked_->prime(samples);
    cv::Mat mask;
    for (const Frame& sample : samples) background_->apply(sample.image.bgr(), mask, kLearnOnce);
  }

  std::vector<TrackedShape> step(const Frame& frame, std::span<const Detection> detections,
                                 std::span<const simulate::people::TrueFigure> truth) override {
    cv::Mat mask;
    background_->apply(frame.image.bgr(), mask, kLearnOnce);
    mask = mask > kShadow;
    const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
    cv::morphologyEx(mask, mask, cv::MORPH_OPEN, kernel);
    cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, kernel);
    std::vector<TrackedShape> shapes;
    for (const TrackedShape& tracked : tracked_->step(frame, detections, truth)) {
      if (auto shape = cut(tracked, mask)) shapes.push_back(std::move(*shape));
    }
    return shapes;
  }

 private:
  static std::optional<TrackedShape> cut(const TrackedShape& tracked, const cv::Mat& mask) {
    Vector<2> low = tracked.polygon[0], high = tracked.polygon[0];
    for (const Vector<2>& corner : tracked.polygon) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    const cv::Point from(static_cast<int>(std::lround(low.x() + 0.5)), static_cast<int>(std::lround(low.y() + 0.5)));
    const cv::Point to(static_cast<int>(std::lround(high.x() + 0.5)), static_cast<int>(std::lround(high.y() + 0.5)));
    const cv::Rect box = cv::Rect(from, to) & cv::Rect({0, 0}, mask.size());
    if (box.empty()) return std::nullopt;
    const cv::Mat part = mask(box).clone();
    const std::vector<detect::Region> regions = detect::find_regions(part, {.min_area = kMinPixels});
    const auto largest =
        std::max_element(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.area < b.area; });
    if (largest == regions.end()) return std::nullopt;
    TrackedShape shape;
    shape.name = tracked.name;
    shape.polygon = detect::outline_of(largest->runs);
    for (Vector<2>& corner : shape.polygon) corner += Vector<2>(box.x, box.y);
    if (shape.polygon.size() < 3) return std::nullopt;
    shape.centre = geometry::polygon_centroid(shape.polygon).value_or(tracked.centre);
    shape.is_curve = true;
    return shape;
  }

  std::unique_ptr<OutlineMethod> tracked_;
  cv::Ptr<cv::BackgroundSubtractorMOG2> background_;
};

}  // namespace

std::unique_ptr<OutlineMethod> naive_method() {
  return std::make_unique<NaiveMethod>();
}

}  // namespace marey::experiments
