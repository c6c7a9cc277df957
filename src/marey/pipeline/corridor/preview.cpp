#include "marey/pipeline/corridor/preview.h"

#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

namespace marey::pipeline::corridor {
namespace {

class Preview final : public Stage {
 public:
  Preview(const std::vector<Feed>& feeds, const Rig& rig, double rate_hz, const detect::DetectorOptions& detector) {
    header_.name = "preview";
    header_.frame.kind = FrameOfReference::Kind::space;
    header_.time_base.kind = TimeBase::Kind::rig;
    header_.made_by.program = "marey live";
    header_.rate_hz = rate_hz;
    header_.rig = rig_as_fed(rig, feeds);
    for (std::size_t i = 0; i < feeds.size(); ++i) {
      detectors_.push_back(feeds[i].detector() == nullptr ? detect::make_detector(detector) : nullptr);
      counts_.emplace_back().name = rig.cameras[i].name;
    }
    found_.resize(feeds.size());
  }

  RecordingHeader header() const override { return header_; }

  std::span<const Instant> step(const FrameSet& frames) override {
    tbb::parallel_for(std::size_t{0}, frames.cameras.size(), [&](std::size_t i) { inspect(frames, i); });
    instant_ = {};
    instant_.index = frames.index;
    instant_.time = frames.time;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      counts_[i].frames += frames.cameras[i] ? 1 : 0;
      counts_[i].missed += frames.cameras[i] ? 0 : 1;
      counts_[i].detections += std::ssize(found_[i]);
      for (const Detection& detection : found_[i]) {
        ImageObservation& detected = instant_.detected.emplace_back();
        detected.camera = CameraId{static_cast<int>(i)};
        detected.pixel = detection.centre;
        detected.sigma = detection.sigma();
        if (detection.area > 0) detected.area = detection.area;
      }
    }
    return {&instant_, 1};
  }

  void report(Summary& summary) const override {
    summary.cameras = counts_;
    for (const Summary::Camera& camera : counts_) summary.detections += camera.detections;
  }

 private:
  void inspect(const FrameSet& frames, std::size_t i) {
    found_[i].clear();
    if (!frames.cameras[i]) return;
    const CameraFrame& given = *frames.cameras[i];
    found_[i] = given.detections ? *given.detections : detectors_[i]->detect(given.frame, {}).detections;
  }

  RecordingHeader header_;
  std::vector<std::unique_ptr<detect::Detector>> detectors_;  // none where the feed detects itself
  std::vector<std::vector<Detection>> found_;
  std::vector<Summary::Camera> counts_;
  Instant instant_;
};

}  // namespace

std::unique_ptr<Stage> preview(const std::vector<Feed>& feeds, const Rig& rig, double rate_hz,
                               const detect::DetectorOptions& detector) {
  return std::make_unique<Preview>(feeds, rig, rate_hz, detector);
}

}  // namespace marey::pipeline::corridor
