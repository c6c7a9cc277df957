#include "marey/pipeline/blob_feed.h"

#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/observation.h"
#include "marey/core/rig.h"
#include "marey/format/observations.h"
#include "marey/pipeline/read_ahead.h"
#include "marey/source/open_source.h"
#include "marey/source/region_source.h"

namespace marey::pipeline {
namespace {

constexpr double kDefaultRate = 100;  // Hz
constexpr double kJitter = 0.25;      // of a frame, by which times of files are rounded

double since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

class VideoFeed final : public BlobFeed {
 public:
  VideoFeed(std::unique_ptr<Source> source, CameraId camera, double offset_s, const detect::markers::MarkerOptions& markers)
      : source_(read_ahead(std::move(source), 4)), camera_(camera), offset_s_(offset_s), detector_(markers) {
    rate_hz_ = source_->info().rate_hz.value_or(25);
  }

  std::optional<SeenBlobs> next() override {
    const auto begin = std::chrono::steady_clock::now();
    const auto frame = source_->next();
    if (!frame) return std::nullopt;
    SeenBlobs result;
    result.decode_s = since(begin);
    const auto decoded = std::chrono::steady_clock::now();
    result.time = timestamp_from_seconds(steady(seconds(frame->time)) + offset_s_);
    for (const Detection& detection : detector_.detect(*frame, {}).detections) {
      result.blobs.push_back(observation_of(detection));
      result.blobs.back().camera = camera_;
    }
    result.detect_s = since(decoded);
    return result;
  }

  double rate_hz() const override { return rate_hz_; }

  std::vector<std::string> warnings() const override {
    auto all = source_->warnings();
    for (const std::string& warning : marey::detect::markers::warnings(detector_.counts()))
      all.push_back(source_->info().name + ": " + warning);
    return all;
  }

 private:
  /// A file rounds its times, to milliseconds often: a camera that keeps its rate is believed more.
  double steady(double time) {
    if (!first_) first_ = time;
    const double frames = (time - *first_) * rate_hz_;
    return std::abs(frames - std::round(frames)) < kJitter ? *first_ + std::round(frames) / rate_hz_ : time;
  }

  std::unique_ptr<Source> source_;
  CameraId camera_;
  double offset_s_;
  double rate_hz_;
  std::optional<double> first_;
  detect::markers::MarkerDetector detector_;
};

/// The file of observations, dealt out to the cameras' feeds.
class ObservationDeal {
 public:
  ObservationDeal(const std::string& path, const Rig& rig) : reader_(path, rig), waiting_(rig.cameras.size()) {}

  /// Cameras ask side by side, each for its own.
  std::optional<format::SeenFrame> next(std::size_t camera) {
    const std::lock_guard lock(dealing_);
    while (waiting_[camera].empty()) {
      const auto frame = reader_.next();
      if (!frame) return std::nullopt;
      for (std::size_t c = 0; c < waiting_.size(); ++c) {
        const auto part = frame->of(CameraId{static_cast<int>(c)});
        waiting_[c].push_back({frame->frame, {part.begin(), part.end()}});
      }
    }
    format::SeenFrame first = std::move(waiting_[camera].front());
    waiting_[camera].pop_front();
    return first;
  }

 private:
  std::mutex dealing_;
  format::ObservationReader reader_;
  std::vector<std::deque<format::SeenFrame>> waiting_;
};

class ObservationFeed final : public BlobFeed {
 public:
  ObservationFeed(std::shared_ptr<ObservationDeal> deal, std::size_t camera, double rate_hz, double offset_s)
      : deal_(std::move(deal)), camera_(camera), rate_hz_(rate_hz), offset_s_(offset_s) {}

  std::optional<SeenBlobs> next() override {
    const auto begin = std::chrono::steady_clock::now();
    const auto seen = deal_->next(camera_);
    if (!seen) return std::nullopt;
    SeenBlobs result;
    result.time = timestamp_from_seconds(static_cast<double>(seen->frame) / rate_hz_ + offset_s_);
    for (const format::SeenPoint& point : seen->points) {
      Observation<2> blob;
      blob.value = point.pixel;
      blob.covariance.setZero();
      blob.camera = CameraId{static_cast<int>(camera_)};
      result.blobs.push_back(blob);
    }
    result.decode_s = since(begin);
    return result;
  }

  double rate_hz() const override { return rate_hz_; }

 private:
  std::shared_ptr<ObservationDeal> deal_;
  std::size_t camera_;
  double rate_hz_, offset_s_;
};

/// The camera's part of pictures of that size. Throws Error where it is not within them.
cv::Rect region_within(const RigCamera& camera, cv::Size picture) {
  const cv::Rect& region = *camera.region;
  if ((region & cv::Rect({}, picture)) == region) return region;
  throw Error("camera \"{}\": its region {}x{} at ({}, {}) is not within the pictures of {}x{} px of {}", camera.name, region.width,
              region.height, region.x, region.y, picture.width, picture.height, camera.source);
}

class NoFeed final : public BlobFeed {
 public:
  std::optional<SeenBlobs> next() override { return std::nullopt; }
  double rate_hz() const override { return 0; }
};

}  // namespace

std::vector<std::unique_ptr<BlobFeed>> open_videos(Rig& rig, const detect::markers::MarkerOptions& markers,
                                                   std::optional<double> rate_hz) {
  std::vector<std::unique_ptr<BlobFeed>> feeds;
  int number = 0, found = 0;
  for (RigCamera& camera : rig.cameras) {
    const CameraId id{number++};
    if (camera.source.empty()) {
      feeds.push_back(std::make_unique<NoFeed>());
      continue;
    }
    auto source = source::open_source(camera.source, camera.rate_hz ? camera.rate_hz : rate_hz);
    if (camera.region) source = source::crop(std::move(source), region_within(camera, source->info().size));
    fit_to_size(camera, source->info().size);
    feeds.push_back(std::make_unique<VideoFeed>(std::move(source), id, camera.offset_s.value_or(0), markers));
    ++found;
  }
  if (found == 0) throw Error("no camera of the rig has a source; name them in the rig, or give CAMERA=VIDEO or --observations");
  return feeds;
}

std::vector<std::unique_ptr<BlobFeed>> open_observations(const std::string& path, const Rig& rig, std::optional<double> rate_hz) {
  const auto deal = std::make_shared<ObservationDeal>(path, rig);
  std::vector<std::unique_ptr<BlobFeed>> feeds;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const double rate = rig.cameras[c].rate_hz ? *rig.cameras[c].rate_hz : rate_hz.value_or(kDefaultRate);
    feeds.push_back(std::make_unique<ObservationFeed>(deal, c, rate, rig.cameras[c].offset_s.value_or(0)));
  }
  return feeds;
}

}  // namespace marey::pipeline
