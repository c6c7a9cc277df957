#include "marey/pipeline/people_in_picture.h"

#include <algorithm>
#include <set>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/track_sample.h"
#include "marey/detect/appearance.h"
#include "marey/draw/mask_folder.h"
#include "marey/pipeline/steady_camera.h"
#include "marey/track/live_tracks.h"
#include "marey/track/outline_log.h"
#include "marey/track/rows_by_frame.h"
#include "marey/track/tracklet_log.h"

namespace marey::pipeline {
namespace {

std::vector<Expected> expected_of(std::span<const Track<2>> tracks) {
  std::vector<Expected> result;
  for (const Track<2>& track : tracks) {
    if (track.box) result.push_back({*track.box});
  }
  return result;
}

std::vector<Observation<2>> observations_of(const std::vector<Detection>& detections, CameraId camera) {
  std::vector<Observation<2>> result;
  result.reserve(detections.size());
  for (const Detection& detection : detections) {
    result.push_back({.value = detection.box.centre(),
                      .covariance = detection.covariance,
                      .camera = camera,
                      .score = detection.score,
                      .box = detection.box,
                      .shared = detection.group.has_value()});
  }
  return result;
}

/// What each of those seen wears, as far as pictures tell.
std::vector<track::Clothes> clothes_of(const Frame& frame, const detect::Detections& seen) {
  std::vector<track::Clothes> clothes;
  if (!frame.picture.is_colour() || seen.foreground.mask.empty()) return clothes;
  for (std::size_t i = 0; i < seen.detections.size(); ++i) {
    clothes.push_back({detect::upper_body(frame.picture, seen.foreground, seen.detections, i),
                       detect::lower_body(frame.picture, seen.foreground, seen.detections, i)});
  }
  return clothes;
}

/// Background subtraction works before a camera that stands still; of another program's detections nothing is known.
track::TrackerOptions tracker_options(const Feed& feed, const PeopleInPictureOptions& options) {
  track::TrackerOptions tracker = feed.has_pictures() ? options.tracker : track::box_tracker_options(options.tracker);
  tracker.steady_camera = feed.has_pictures();
  tracker.reidentify = tracker.steady_camera && options.live;
  return tracker;
}

/// A network without a background model is shown only the frames that it searches.
detect::DetectorOptions searching_every_frame(detect::DetectorOptions options) {
  auto* network = std::get_if<detect::network::NetworkDetectorOptions>(&options);
  if (network != nullptr && !network->background) network->every = 1;
  return options;
}

void leave_out_unseen(Instant& instant) {
  std::erase_if(instant.samples, [](const Sample& sample) { return !sample.measured(); });
}

/// What the second pass made of the recording, frame by frame.
class JoinedRows final : public InstantSource {
 public:
  JoinedRows(std::vector<track::TrackRow> rows, std::vector<Recording::Moment> moments, track::OutlineLog* outlines, bool seen_only)
      : rows_(std::move(rows)), moments_(std::move(moments)), by_number_(rows_, {}, outlines), seen_only_(seen_only) {}

  std::optional<Instant> next() override {
    if (next_ == moments_.size()) return std::nullopt;
    Instant instant;
    instant.index = moments_[next_].index;
    instant.time = moments_[next_].time;
    for (const Track<2>& track : by_number_.at(static_cast<std::int64_t>(next_++))) instant.samples.push_back(sample_of(track));
    for (Sample& sample : instant.samples) sample.covariance.reset();  // rows do not keep it
    if (seen_only_) leave_out_unseen(instant);
    return instant;
  }

 private:
  std::vector<track::TrackRow> rows_;
  std::vector<Recording::Moment> moments_;  // frames may be missing between them: rows count these
  track::RowsByFrame by_number_;
  bool seen_only_;
  std::size_t next_ = 0;
};

/// What a live run still waited with when the recording ended.
class LiveRest final : public InstantSource {
 public:
  LiveRest(track::LiveTracks& live, bool seen_only) : live_(live), seen_only_(seen_only) {}

  std::optional<Instant> next() override {
    std::optional<Instant> instant = live_.next(true);
    if (instant && seen_only_) leave_out_unseen(*instant);
    return instant;
  }

 private:
  track::LiveTracks& live_;
  bool seen_only_;
};

class PeopleInPicture final : public Stage {
 public:
  PeopleInPicture(const Feed& feed, const PeopleInPictureOptions& options)
      : options_(options), tracker_(track::make_tracker(tracker_options(feed, options))) {
    header_.name = feed.info().name;
    header_.frame.kind = FrameOfReference::Kind::image;
    header_.made_by.program = "marey track";
    header_.rate_hz = feed.rate_hz();
    header_.smoothed = !options.live;
    header_.rig = Rig{.ground_from_world = {}, .calibration = {}, .cameras = {feed.camera()}};
    if (header_.rig->cameras.front().name.empty()) header_.rig->cameras.front().name = "camera";  // a rig's cameras have names
    if (feed.has_pictures() && feed.detector() == nullptr) {
      detector_ = detect::make_detector(searching_every_frame(options.detector));
      if (!options.live) prime(feed);
    }
    if (!options.masks.empty()) {
      if (!detector_) throw Error("{}: masks are of the background model, and detections are given", options.masks);
      masks_.emplace(options.masks);
    }
    if (options.live) live_.emplace(options.delay);
    if (!options.outlines) return;
    if (!feed.has_pictures()) throw Error("{}: outlines are searched in pictures; give those", feed.info().name);
    follower_.emplace(*options.outlines);
    if (!options.live) outlines_.emplace(options.beside, options.with_lines);
  }

  RecordingHeader header() const override { return header_; }

  std::span<const Instant> step(const FrameSet& frames) override {
    const CameraFrame& given = *frames.cameras.front();
    if (skips_frame(given)) return pass_over(given.frame);
    const detect::Detections seen = detect(given);
    if (masks_) masks_->add(given.frame.index, seen.foreground.mask, given.frame.picture.size());
    const auto tracks = follow(given.frame, seen);
    for (const Track<2>& track : tracks) (track.confirmed ? believed_ : begun_).insert(track.id);
    detections_ += std::ssize(seen.detections);
    if (live_) return told(given.frame, tracks);
    if (!given.frame.picture.empty()) {
      const cv::Size size = given.frame.picture.size();
      options_.join.view = Box{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
    }
    const auto number = std::ssize(moments_);
    recording_.add(number, given.frame.time, tracks, clothes_of(given.frame, seen));
    moments_.push_back({given.frame.index, given.frame.time});
    if (outlines_) outlines_->add(number, tracks);
    return {};
  }

  std::unique_ptr<InstantSource> finish(const Hooks& /*hooks*/) override {
    if (masks_) masks_->finish();
    if (live_) {
      if (live_->empty()) return nullptr;
      return std::make_unique<LiveRest>(*live_, options_.seen_only);
    }
    return std::make_unique<JoinedRows>(track::join(recording_, options_.join), std::move(moments_),
                                        outlines_ ? &*outlines_ : nullptr, options_.seen_only);
  }

  void report(Summary& summary) const override {
    summary.detections = detections_;
    std::int64_t too_brief = 0;
    for (const TrackId id : begun_) too_brief += !believed_.contains(id);
    summary.left_out["too_brief"] = too_brief;
    if (shaking_) summary.warnings.push_back(*shaking_);
    if (detector_ == nullptr) return;
    const detect::DetectionCounts counts = detector_->detection_counts();
    if (counts.noise) summary.left_out["noise"] = *counts.noise;
    if (counts.misfits) summary.left_out["misfits"] = *counts.misfits;
  }

 private:
  void prime(const Feed& feed) {
    const std::vector<Frame> samples = feed.sample_beginning();
    detector_->prime(samples);
    shaking_ = shaking(feed.camera(), samples);
  }

  detect::Detections detect(const CameraFrame& given) {
    if (given.detections) return {.detections = *given.detections, .foreground = {}};
    return detector_->detect(given.frame, expected_of(tracker_->expected(given.frame.time)));
  }

  /// Whether this is a frame between those that a network without a background model searches.
  bool skips_frame(const CameraFrame& given) {
    const auto* network = std::get_if<detect::network::NetworkDetectorOptions>(&options_.detector);
    return detector_ != nullptr && !given.detections && network != nullptr && !network->background &&
           frames_++ % network->every != 0;
  }

  /// A frame that was not searched: targets are where they are expected, and what nobody saw counts against none of them.
  std::span<const Instant> pass_over(const Frame& frame) {
    if (live_) return told(frame, tracker_->expected(frame.time));
    recording_.add(std::ssize(moments_), frame.time, {});
    if (outlines_) outlines_->add(std::ssize(moments_), {});
    moments_.push_back({frame.index, frame.time});
    return {};
  }

  /// What is seen makes tracks; outlines are searched before and put right after, so that each tells the other what it found.
  std::span<const Track<2>> follow(const Frame& frame, const detect::Detections& seen) {
    std::vector<Observation<2>> observations = observations_of(seen.detections, frame.camera);
    if (!follower_) return tracker_->step(frame.time, observations);
    const auto hints = follower_->observe(frame, seen.foreground, seen.detections);
    observations.insert(observations.end(), hints.begin(), hints.end());
    return follower_->attach(tracker_->step(frame.time, observations), seen.detections);
  }

  /// What is due by now. Who waits keeps the pictures too: they are gone from the feed by then.
  std::span<const Instant> told(const Frame& frame, std::span<const Track<2>> tracks) {
    const bool keep = options_.delay > 0 && !frame.picture.empty();
    live_->add(frame.index, frame.time, tracks, keep ? std::vector{frame} : std::vector<Frame>{});
    due_.clear();
    while (auto instant = live_->next()) {
      if (options_.seen_only) leave_out_unseen(*instant);
      due_.push_back(std::move(*instant));
    }
    return due_;
  }

  PeopleInPictureOptions options_;
  RecordingHeader header_;
  std::unique_ptr<detect::Detector> detector_;  // none where the feed brings detections
  std::unique_ptr<track::Tracker<2>> tracker_;
  std::optional<track::contour::OutlineFollower> follower_;
  std::optional<track::OutlineLog> outlines_;
  std::optional<draw::MaskFolder> masks_;
  track::TrackletLog recording_;
  std::vector<Recording::Moment> moments_;
  std::optional<track::LiveTracks> live_;
  std::vector<Instant> due_;
  std::set<TrackId> begun_, believed_;
  std::int64_t detections_ = 0, frames_ = 0;
  std::optional<std::string> shaking_;  // what to say of a camera that was not steadied
};

}  // namespace

std::unique_ptr<Stage> people_in_picture(const Feed& feed, const PeopleInPictureOptions& options) {
  return std::make_unique<PeopleInPicture>(feed, options);
}

}  // namespace marey::pipeline
