#include "marey/pipeline/markers/image_stage.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "marey/core/error.h"
#include "marey/core/track_sample.h"
#include "marey/filter/fit_noise.h"
#include "marey/pipeline/corridor/simulation_files.h"
#include "marey/track/offline/fill_gaps.h"
#include "marey/track/offline/rows_by_frame.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::pipeline::markers {
namespace {

constexpr double kFittedSeconds = 20;       // of the recording, from which noise is reported
constexpr double kUnknownDeviation = 0.25;  // px, of a blob whose source states none; as blob files have it; unswept

using Markers = std::map<TrackId, std::string>;

/// What a second pass made of the recording, frame by frame.
class FilledRows final : public corridor::InstantSource {
 public:
  FilledRows(std::vector<track::offline::TrackRow> rows, std::vector<Recording::TimeStep> time_steps, Markers labels)
      : rows_(std::move(rows)), time_steps_(std::move(time_steps)), labels_(std::move(labels)), by_number_(rows_) {}

  std::optional<Instant> next() override {
    if (next_ == time_steps_.size()) return std::nullopt;
    Instant instant;
    instant.index = time_steps_[next_].index;
    instant.time = time_steps_[next_].time;
    if (next_ == 0) {
      for (const auto& [id, label] : labels_) instant.named.push_back({id, label, {}});
    }
    for (const Track<2>& track : by_number_.at(static_cast<std::int64_t>(next_++))) instant.samples.push_back(sample_of(track));
    for (Sample& sample : instant.samples) sample.covariance.reset();  // rows do not keep it
    return instant;
  }

 private:
  std::vector<track::offline::TrackRow> rows_;
  std::vector<Recording::TimeStep> time_steps_;
  Markers labels_;
  track::offline::RowsByFrame by_number_;
  std::size_t next_ = 0;
};

class ImageMarkerStage final : public corridor::Stage {
 public:
  ImageMarkerStage(const corridor::Feed& feed, const ImageMarkerOptions& options)
      : options_(options), detector_(corridor::markers_of(feed.camera(), options.markers), options.tuning) {
    header_.name = feed.info().name;
    header_.frame.kind = FrameOfReference::Kind::image;
    header_.time_base.kind = TimeBase::Kind::rig;
    header_.track_kind = TrackKind::marker;
    header_.made_by.program = "marey track";
    header_.rate_hz = feed.rate_hz();
    header_.rig = Rig{.ground_from_world = {}, .calibration = {}, .cameras = {feed.camera()}};
    if (header_.rig->cameras.front().name.empty()) header_.rig->cameras.front().name = "camera";  // a rig's cameras have names
    const cv::Size size = feed.info().size;
    if (!size.empty()) options_.tracker.image = Box{-0.5, -0.5, static_cast<double>(size.width), static_cast<double>(size.height)};
    if (options.fit_noise && !options.live) fit(feed.again());
    tracker_ = track::roster::make_roster_tracker<2>(options_.tracker);
  }

  RecordingHeader header() const override { return header_; }

  std::span<const Instant> step(const FrameSet& frames) override {
    const CameraFrame& given = *frames.cameras.front();
    const Frame& frame = given.frame;
    const auto detected = observe(detector_, given, *tracker_);
    detections_ += std::ssize(detected);
    live_.index = frame.index;
    live_.time = frame.time;
    live_.samples.clear();
    live_.named.clear();
    confirmed_.clear();
    for (const Track<2>& track : tracker_->step(frame.time, detected)) {
      if (!track.label.empty() && std::exchange(labels_[track.id], track.label) != track.label)
        live_.named.push_back({track.id, track.label, {}});
      if (track.confirmed) confirmed_.push_back(track);
    }
    if (options_.live) {
      for (const Track<2>& track : confirmed_) live_.samples.push_back(sample_of(track));
      return {&live_, 1};
    }
    recording_.add(std::ssize(time_steps_), frame.time, confirmed_);
    time_steps_.push_back({frame.index, frame.time});
    return {};
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& /*hooks*/) override {
    if (options_.live) return nullptr;
    const int min_detections = static_cast<int>(std::min<std::size_t>(3, time_steps_.size()));  // a single image has markers too
    return std::make_unique<FilledRows>(track::offline::rows_of_points(recording_, min_detections), std::move(time_steps_),
                                        std::move(labels_));
  }

  void report(corridor::Summary& summary) const override {
    summary.detections = detections_;
    if (noise_) {
      summary.noise = {noise_->measurement_sigma, noise_->acceleration};
    } else if (options_.fit_noise && !options_.live) {
      summary.warnings.push_back(header_.name +
                                 ": too little moves in its beginning to tell the noise from; the defaults were kept");
    }
    for (const std::string& warning : detector_.warnings()) summary.warnings.push_back(header_.name + ": " + warning);
    if (detections_ > 0) return;
    summary.warnings.push_back(header_.name +
                               ": no marker was seen in any frame; are they bright on dark (else --dark or --colour), "
                               "and brighter than --threshold?");
  }

 private:
  /// A first pass over the beginning of the recording, to learn how the markers move and how well they are seen.
  void fit(corridor::Feed feed) {
    corridor::TunedMarkers detector(corridor::markers_of(feed.camera(), options_.markers), nullptr);
    const auto tracker = track::roster::make_roster_tracker<2>(options_.tracker);
    std::map<TrackId, filter::MeasuredPath<2>> paths;
    while (const auto given = feed.next()) {
      if (seconds(given->frame.time) > kFittedSeconds) break;
      const auto detected = observe(detector, *given, *tracker);
      for (const Track<2>& track : tracker->step(given->frame.time, detected)) {
        if (!track.observation || !track.confirmed) continue;
        paths[track.id].times.push_back(seconds(given->frame.time));
        paths[track.id].positions.push_back(detected[*track.observation].value);
      }
    }
    std::vector<filter::MeasuredPath<2>> list;
    for (auto& [id, path] : paths) list.push_back(std::move(path));
    noise_ = filter::fit_noise<2>(list);
    if (noise_) options_.tracker.filter = filter::with_noise(options_.tracker.filter, *noise_);
  }

  /// What is in the image, or what another program saw there.
  static std::vector<Observation<2>> observe(corridor::TunedMarkers& detector, const CameraFrame& given,
                                             track::Tracker<2>& tracker) {
    std::vector<Observation<2>> detected;
    if (given.detections) {
      for (const Detection& detection : *given.detections) {
        detected.push_back(observation_of(detection));
        if (!detected.back().covariance) detected.back().covariance = kUnknownDeviation * kUnknownDeviation * Matrix<2>::Identity();
      }
      return detected;
    }
    std::vector<Expected> expected;
    for (const Track<2>& track : tracker.expected(given.frame.time)) {
      if (track.box) expected.push_back({*track.box});
    }
    for (const Detection& detection : detector.detect(given.frame, expected).detections)
      detected.push_back(observation_of(detection));
    return detected;
  }

  ImageMarkerOptions options_;
  RecordingHeader header_;
  corridor::TunedMarkers detector_;
  std::unique_ptr<track::Tracker<2>> tracker_;
  std::optional<filter::NoiseFit> noise_;
  track::offline::TrackletLog recording_;
  std::vector<Recording::TimeStep> time_steps_;
  std::vector<Track<2>> confirmed_;
  Markers labels_;
  Instant live_;
  std::int64_t detections_ = 0;
};

}  // namespace

std::unique_ptr<corridor::Stage> markers_in_image(const corridor::Feed& feed, const ImageMarkerOptions& options) {
  return std::make_unique<ImageMarkerStage>(feed, options);
}

}  // namespace marey::pipeline::markers
