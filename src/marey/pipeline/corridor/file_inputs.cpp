#include <cmath>
#include <deque>
#include <filesystem>
#include <mutex>
#include <utility>

#include "marey/core/stop.h"
#include "marey/format/observations.h"
#include "marey/format/tracks/blob_file.h"
#include "marey/format/tracks/detections.h"
#include "marey/pipeline/corridor/feed_input.h"
#include "marey/source/read_ahead.h"

namespace marey::pipeline::corridor {
namespace {

constexpr double kObservationRate = 100;  // Hz; of observations without a specified rate

class ImageInput final : public FeedInput {
 public:
  ImageInput(std::unique_ptr<Source> source, int ahead) : source_(std::move(source)), ahead_(ahead) {}

  const SourceInfo& info() const override { return source_->info(); }
  std::vector<std::string> warnings() const override { return source_->warnings(); }
  bool has_images() const override { return true; }
  std::optional<CameraFrame> next() override {
    if (ahead_ > 0) source_ = source::read_ahead(std::move(source_), std::exchange(ahead_, 0));
    auto frame = source_->next();
    if (!frame) return std::nullopt;
    return CameraFrame{.frame = std::move(*frame), .detections = {}};
  }

 private:
  std::unique_ptr<Source> source_;
  int ahead_;  // frames, once reading has begun; 0: done, or not wanted
};

class EmptyInput final : public FeedInput {
 public:
  const SourceInfo& info() const override { return info_; }

 private:
  SourceInfo info_;
};

/// What another program detected: boxes, or blobs.
template <typename Reader>
class DetectionInput final : public FeedInput {
 public:
  explicit DetectionInput(Reader reader) : reader_(std::move(reader)) {}

  const SourceInfo& info() const override { return reader_.info(); }
  std::vector<std::string> warnings() const override { return reader_.warnings(); }
  std::optional<CameraFrame> next() override { return reader_.next(); }

 private:
  Reader reader_;
};

/// One file of observations, dealt out to the cameras' feeds.
class ObservationDemux {
 public:
  ObservationDemux(const std::string& path, const Rig& rig) : reader_(path, rig), waiting_(rig.cameras.size()) {}

  std::optional<double> rate_hz() const { return reader_.rate_hz(); }

  /// Cameras ask side by side, each for its own.
  std::optional<format::ObservedFrame> next(std::size_t camera) {
    const std::lock_guard lock(dealing_);
    while (waiting_[camera].empty()) {
      if (stop_.stop_requested()) throw Stopped();
      const auto frame = reader_.next();
      if (!frame) return std::nullopt;
      for (std::size_t c = 0; c < waiting_.size(); ++c) {
        const auto part = frame->of(CameraId{static_cast<int>(c)});
        waiting_[c].push_back({.frame = frame->frame, .points = {part.begin(), part.end()}, .time = frame->time});
      }
    }
    format::ObservedFrame first = std::move(waiting_[camera].front());
    waiting_[camera].pop_front();
    return first;
  }

 private:
  std::stop_token stop_ = StopScope::current();
  std::mutex dealing_;
  format::ObservationReader reader_;
  std::vector<std::deque<format::ObservedFrame>> waiting_;
};

Detection blob_of(const format::ImageObservation& point) {
  Detection blob;
  blob.centre = point.pixel;
  if (point.sigma) blob.covariance = *point.sigma * *point.sigma * Matrix<2>::Identity();
  if (!point.area) return blob;
  const double side = std::sqrt(*point.area);  // of what had a shape once, the area was kept
  blob.area = *point.area;
  blob.box = {point.pixel.x() - side / 2, point.pixel.y() - side / 2, side, side};
  return blob;
}

class ObservationInput final : public FeedInput {
 public:
  /// `offset` is what is added to this camera's times afterwards.
  ObservationInput(std::shared_ptr<ObservationDemux> demux, std::size_t camera, const std::string& name, double rate_hz,
                   Duration offset)
      : demux_(std::move(demux)), camera_(camera), rate_hz_(rate_hz), offset_(offset) {
    info_.name = name;
    info_.rate_hz = rate_hz;
  }

  const SourceInfo& info() const override { return info_; }
  std::optional<CameraFrame> next() override {
    const auto detected = demux_->next(camera_);
    if (!detected) return std::nullopt;
    CameraFrame result;
    result.frame.index = detected->frame;
    result.frame.time =
        detected->time ? *detected->time - offset_ : timestamp_from_seconds(static_cast<double>(detected->frame) / rate_hz_);
    auto& detections = result.detections.emplace();
    for (const format::ImageObservation& point : detected->points) detections.push_back(blob_of(point));
    return result;
  }

 private:
  std::shared_ptr<ObservationDemux> demux_;
  std::size_t camera_;
  double rate_hz_;
  Duration offset_;
  SourceInfo info_;
};

}  // namespace

std::unique_ptr<FeedInput> image_input(std::unique_ptr<Source> source, int ahead) {
  return std::make_unique<ImageInput>(std::move(source), ahead);
}

std::unique_ptr<FeedInput> empty_input() {
  return std::make_unique<EmptyInput>();
}

std::unique_ptr<FeedInput> detection_input(const std::string& path, std::optional<double> rate_hz) {
  using namespace format::tracks;
  if (std::filesystem::is_regular_file(path) && is_blob_file(path))
    return std::make_unique<DetectionInput<BlobReader>>(BlobReader(path, rate_hz));
  return std::make_unique<DetectionInput<DetectionReader>>(DetectionReader(path, rate_hz));
}

std::vector<std::unique_ptr<FeedInput>> observation_inputs(const std::string& path, const Rig& rig, std::optional<double> rate_hz) {
  const auto demux = std::make_shared<ObservationDemux>(path, rig);
  std::vector<std::unique_ptr<FeedInput>> inputs;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const RigCamera& camera = rig.cameras[c];
    const double rate = demux->rate_hz().value_or(camera.rate_hz.value_or(rate_hz.value_or(kObservationRate)));
    const Duration offset = duration_from_seconds(camera.offset_s.value_or(0));
    inputs.push_back(std::make_unique<ObservationInput>(demux, c, path, rate, offset));
  }
  return inputs;
}

}  // namespace marey::pipeline::corridor
