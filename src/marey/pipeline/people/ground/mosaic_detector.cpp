#include "marey/pipeline/people/ground/mosaic_detector.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/pipeline/people/ground/mosaic.h"
#include "marey/pipeline/people/ground/people_in_view.h"
#include "marey/pipeline/people/ground/ptz_views.h"

namespace marey::pipeline::people::ground {
namespace {

cv::Mat luma_in_bytes(const Image& image) {
  if (image.luma().type() == CV_8UC1) return image.luma();
  cv::Mat bytes;
  image.luma().convertTo(bytes, CV_8U, 1.0 / 257);
  return bytes;
}

class MosaicDetector : public detect::Detector {
 public:
  MosaicDetector(Mosaic mosaic, const RigCamera& camera, CameraId id, std::shared_ptr<const PtzCamera> ptz,
                 std::shared_ptr<const GroundViews> views, const reconstruct::GroundArea& area,
                 const MosaicDetectorOptions& options)
      : mosaic_(std::move(mosaic)),
        camera_(camera),
        id_(id),
        ptz_(std::move(ptz)),
        views_(std::move(views)),
        area_(area),
        options_(options) {}

  detect::DetectorTraits traits() const override { return {.toe_m = 0.1, .has_foreground = true, .knows_body_size = false}; }
  detect::DetectionCounts detection_counts() const override { return {noise_, misfits_}; }

  detect::Detections detect(const Frame& frame, std::span<const Expected> /*expected*/) override {
    detect::Detections found;
    const auto heading = heading_at(camera_, *ptz_, frame.time);
    if (!heading) return found;
    groups_ = 0;
    const GroundView& view = views_->view_at(id_, frame.time);
    found.foreground.mask = different(luma_in_bytes(frame.image), mosaic_.scene(*heading));
    cv::Mat labels, boxes, middles;
    const int count = cv::connectedComponentsWithStats(found.foreground.mask, labels, boxes, middles, 8, CV_32S);
    for (int i = 1; i < count; ++i) {
      const cv::Rect box(boxes.at<int>(i, cv::CC_STAT_LEFT), boxes.at<int>(i, cv::CC_STAT_TOP), boxes.at<int>(i, cv::CC_STAT_WIDTH),
                         boxes.at<int>(i, cv::CC_STAT_HEIGHT));
      enter(box, boxes.at<int>(i, cv::CC_STAT_AREA), view, found.detections);
    }
    return found;
  }

 private:
  /// Where an image differs from the scene and all that is next to it there.
  cv::Mat different(const cv::Mat& luma, const cv::Mat& scene) const {
    cv::Mat smooth, low, high, above, below, mask;
    cv::GaussianBlur(luma, smooth, {3, 3}, 0.8);
    const int wide = 2 * std::max(1, cvRound(options_.slack_px * luma.cols / 1280.0)) + 1;
    const cv::Mat near = cv::Mat::ones(wide, wide, CV_8U);
    cv::erode(scene, low, near), cv::dilate(scene, high, near);
    cv::subtract(smooth, high, above), cv::subtract(low, smooth, below);
    mask = (cv::max(above, below) > options_.contrast) & (low > 0);
    const int gap = std::max(2, luma.cols / 320);
    cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, cv::Mat::ones(2 * gap + 1, gap | 1, CV_8U));
    return mask;
  }

  /// A region as one person, or as several side by side.
  void enter(const cv::Rect& box, int pixels, const GroundView& view, std::vector<Detection>& detections) {
    const auto location = view.location({box.x + box.width / 2.0, box.y + box.height - 0.5});
    if (!location || !area_.holds(location->ground, kBeyondArea)) return;
    const auto person = person_at(view, location->ground);
    if (!person) return;
    if (box.height < options_.low * person->height || pixels < options_.filled * options_.low * person->area()) {
      ++noise_;
      return;
    }
    if (box.height > options_.high * person->height || pixels < options_.filled * box.area()) {
      ++misfits_;
      return;
    }
    const int people = std::max(1, static_cast<int>(std::lround(box.width / (options_.aside * person->width))));
    for (int k = 0; k < people; ++k) {
      Detection& one = detections.emplace_back();
      const double width = static_cast<double>(box.width) / people;
      one.box = {box.x + k * width, static_cast<double>(box.y), width, static_cast<double>(box.height)};
      one.centre = {one.box.left + width / 2 - 0.5, one.box.top + box.height / 2.0 - 0.5};
      one.area = static_cast<double>(pixels) / people;
      if (people > 1) one.group = groups_;
    }
    groups_ += people > 1 ? 1 : 0;
  }

  Mosaic mosaic_;
  RigCamera camera_;
  CameraId id_;
  std::shared_ptr<const PtzCamera> ptz_;
  std::shared_ptr<const GroundViews> views_;
  reconstruct::GroundArea area_;
  MosaicDetectorOptions options_;
  std::int64_t noise_ = 0, misfits_ = 0;
  int groups_ = 0;
};

}  // namespace

std::unique_ptr<detect::Detector> mosaic_detector(const corridor::Feed& feed, std::shared_ptr<const PtzCamera> camera,
                                                  std::shared_ptr<const GroundViews> views, const reconstruct::GroundArea& area,
                                                  const MosaicDetectorOptions& options) {
  const std::vector<Frame> frames = feed.sample(options.frames, options.seconds, options.max_frames);
  if (frames.empty())
    throw Error(
        "camera \"{0}\" is a PTZ camera whose images cannot be read twice, so that its empty scene cannot be learned; give a "
        "network "
        "with --detector MODEL.toml (docs/network.md), or what another program detected: {0}=boxes.txt",
        feed.camera().name);
  Mosaic mosaic(*camera, *feed.camera().size);
  for (const Frame& frame : frames) {
    stop_point();
    if (const auto heading = heading_at(feed.camera(), *camera, frame.time)) mosaic.add(luma_in_bytes(frame.image), *heading);
  }
  mosaic.finish();
  return std::make_unique<MosaicDetector>(std::move(mosaic), feed.camera(), feed.id(), std::move(camera), std::move(views), area,
                                          options);
}

}  // namespace marey::pipeline::people::ground
