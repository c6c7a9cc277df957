#include "marey/pipeline/people/image_stage.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "marey/pipeline/corridor/parallel_tasks.h"
#include "marey/pipeline/keypoints/keypoint_stage.h"
#include "marey/pipeline/people/camera_span.h"
#include "marey/pipeline/people/image_ambiguities.h"
#include "marey/pipeline/people/image_log.h"
#include "marey/pipeline/people/image_rows.h"
#include "marey/pipeline/people/image_tracking.h"
#include "marey/pipeline/people/no_people_found.h"
#include "marey/pipeline/people/standing_people.h"
#include "marey/track/image/live_tracks.h"

namespace marey::pipeline::people {
namespace {

/// What a live run and one over a whole recording share: each frame is searched and tracked, and what its images show beside that.
class ImageStage : public corridor::Stage {
 public:
  ImageStage(const corridor::Feed& feed, const ImagePeopleOptions& options)
      : options_(options), tracking_(feed, options), image_ambiguities_(feed.camera(), options.stabilise) {
    header_.name = feed.info().name;
    header_.frame.kind = FrameOfReference::Kind::image;
    header_.time_base.kind = TimeBase::Kind::rig;
    header_.track_kind = TrackKind::person;
    header_.made_by.program = "marey track";
    header_.rate_hz = feed.rate_hz();
    header_.smoothed = !options.live;
    header_.rig = Rig{.ground_from_world = {}, .calibration = {}, .cameras = {feed.camera()}};
    if (header_.rig->cameras.front().name.empty()) header_.rig->cameras.front().name = "camera";  // a rig's cameras have names
  }

  RecordingHeader header() const override { return header_; }
  void need_foregrounds(std::function<void(corridor::FrameForeground)> give) override {
    tracking_.give_foregrounds(std::move(give));
  }

  std::span<const Instant> step(const FrameSet& frames) override {
    const CameraFrame& given = *frames.cameras.front();
    corridor::ParallelTasks parallel;
    watch(given.frame, parallel);
    const detect::Detections found = tracking_.detect(given);
    if (tracking_.detector() != nullptr) image_ambiguities_.add(found);
    if (!found.searched) {
      parallel.wait();
      return unsearched(given.frame);
    }
    const auto tracks = tracking_.track(given.frame, found);
    parallel.wait();
    if (given.detections) camera_span_.observe_frame(given.frame.time, tracks);
    const bool stood = standing_ && standing_->observe_frame(given.frame, tracks, *tracking_.detector());
    return tracked(given.frame, found, tracks, stood);
  }

  std::vector<std::string> news() override {
    return tracking_.detector() != nullptr ? image_ambiguities_.news() : std::vector<std::string>{};
  }

  void report(corridor::Summary& summary) const override {
    tracking_.report(summary);
    report_recording(summary);
    report_search(summary);
    report_camera(summary);
    if (auto why = why_none(summary)) {
      if (options_.keypoints && std::holds_alternative<detect::people::PeopleDetectorOptions>(options_.detector))
        *why += "; --no-background finds people who fill the image or stand there from the beginning, by a network";
      summary.warnings.push_back(std::move(*why));
    }
  }

 protected:
  /// A frame in which no person was searched.
  virtual std::span<const Instant> unsearched(const Frame& frame) = 0;
  /// A frame with its tracks; `stood`: a person has left the scene who had been in it since the beginning.
  virtual std::span<const Instant> tracked(const Frame& frame, const detect::Detections& found, std::span<const Track<2>> tracks,
                                           bool stood) = 0;
  /// Who left the scene, and what the second pass decided.
  virtual void report_recording(corridor::Summary& summary) const = 0;

  void report_standing(corridor::Summary& summary) const {
    if (!standing_) return;
    for (std::string& message_text : standing_->stated()) summary.notes.push_back(std::move(message_text));
  }

  ImagePeopleOptions options_;
  RecordingHeader header_;
  ImageTracking tracking_;
  ImageAmbiguities image_ambiguities_;
  std::optional<StandingPeople> standing_;  // where a background model may have taken them for the scene

 private:
  /// What images show that does not depend on who is in them.
  void watch(const Frame& frame, corridor::ParallelTasks& parallel) {
    if (tracking_.detector() != nullptr) parallel.run([this, &frame] { image_ambiguities_.watch(frame); });
    if (standing_) parallel.run([this, &frame] { standing_->inspect(frame); });
  }

  void report_search(corridor::Summary& summary) const {
    if (tracking_.detector() == nullptr) return;
    for (std::string& warning : image_ambiguities_.warnings()) summary.warnings.push_back(std::move(warning));
    const detect::DetectionCounts counts = tracking_.detector()->detection_counts();
    summary.dropped.noise = counts.noise;
    summary.dropped.unexplained_regions = counts.misfits;
  }

  /// The camera's motion as boxes alone show it; for images there are other warnings.
  void report_camera(corridor::Summary& summary) const {
    if (tracking_.detector() != nullptr || !camera_span_.moved()) return;
    summary.warnings.push_back(fmt::format(
        "the camera moves, or every person goes one way (by up to {:.0f} px in a second): people are followed all the same, "
        "but where the camera moves, speeds and paths are in pixels of images that move",
        camera_span_.farthest()));
  }

  CameraSpan camera_span_;
};

/// Each frame's tracks, at once or after a delay: nothing read ahead, nothing improved afterwards.
class LiveImage final : public ImageStage {
 public:
  LiveImage(const corridor::Feed& feed, const ImagePeopleOptions& options) : ImageStage(feed, options), live_(options.delay) {
    if (tracking_.detector() != nullptr) standing_.emplace(Image());
  }

  std::vector<std::string> news() override {
    std::vector<std::string> all = ImageStage::news();
    if (!standing_) return all;
    for (std::string& message_text : standing_->news()) all.push_back(std::move(message_text));
    return all;
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& /*hooks*/) override {
    if (live_.empty()) return nullptr;
    return rest_of(live_, options_.observed_only);
  }

 private:
  std::span<const Instant> tracked(const Frame& frame, const detect::Detections& /*found*/, std::span<const Track<2>> tracks,
                                   bool /*stood*/) override {
    live_.add(frame.index, frame.time, tracks, kept(frame));
    return due();
  }

  std::span<const Instant> unsearched(const Frame& frame) override {
    live_.add_unsearched(frame.index, frame.time, tracking_.tracker().expected(frame.time), kept(frame));
    return due();
  }

  /// With a delay the images wait too: the feed does not have them any more when they are due.
  std::vector<Frame> kept(const Frame& frame) const {
    return options_.delay > 0 && !frame.image.empty() ? std::vector{frame} : std::vector<Frame>{};
  }

  std::span<const Instant> due() {
    due_.clear();
    while (auto instant = live_.next()) {
      if (options_.observed_only) exclude_unobserved(*instant);
      due_.push_back(std::move(*instant));
    }
    return due_;
  }

  void report_recording(corridor::Summary& summary) const override { report_standing(summary); }

  track::image::LiveTracks live_;
  std::vector<Instant> due_;
};

/// The whole recording, which a second pass links, fills and smooths. If a person has left the scene who had been taken for a part
/// of it, the frames until then are searched again with a scene without them.
class RecordedImage final : public ImageStage {
 public:
  RecordedImage(const corridor::Feed& feed, const ImagePeopleOptions& options)
      : ImageStage(feed, options), log_(options.outlines.has_value(), options.spill_path, options.with_lines) {
    if (tracking_.detector() == nullptr) return;
    prime(feed);
    standing_.emplace(tracking_.detector()->scene());
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    if (again_.frames > 0 && !hooks.stop.stop_requested()) search_again(hooks);
    if (const auto noise = tracking_.tracker().learned_noise()) options_.join = track::offline::adapted(options_.join, *noise);
    if (!options_.join.view) options_.join.view = tracking_.border().view();
    return log_.finish(options_.join, joined_, options_.observed_only);
  }

 private:
  /// Frames that are searched a second time, and those that follow, as they were observed the first time.
  struct Again {
    std::int64_t frames = 0;  // from the beginning
    std::vector<ObservedFrame> after;
    int added = 0;  // people who are in the results because of it
  };

  void prime(const corridor::Feed& feed) {
    const std::vector<Frame> samples = feed.sample_beginning();
    corridor::ParallelTasks parallel;
    parallel.run([&] { image_ambiguities_.inspect_at_beginning(samples); });
    tracking_.detector()->prime(samples);
    if (!samples.empty()) open_again_ = feed.opener();
    parallel.wait();
  }

  std::span<const Instant> unsearched(const Frame& frame) override {
    log_.add_unsearched(frame);
    return {};
  }

  std::span<const Instant> tracked(const Frame& frame, const detect::Detections& found, std::span<const Track<2>> tracks,
                                   bool stood) override {
    if (!frame.image.empty()) {
      const cv::Size size = frame.image.size();
      options_.join.view = Box{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
    }
    log_.add_searched(frame);
    ObservedFrame observed = observed_in(frame, found);
    log_.add(log_.searched() - 1, tracks, observed.clothes, tracking_.tracker().view_from_scene());
    if (!open_again_) return {};
    if (stood) {
      again_.frames = log_.searched();
      again_.after.clear();
    } else if (again_.frames > 0 && !log_.has_contours()) {  // contours need the images, to the end
      again_.after.push_back(std::move(observed));
    }
    return {};
  }

  /// If this is stopped, the first result counts.
  void search_again(const Hooks& hooks) {
    ImageLog::Tracked first = log_.begin_again();
    bool done = false;
    try {
      done = search_without_them(hooks);
    } catch (const Stopped&) {  // while the feed was read
    }
    if (done) {
      again_.added = standing_->since_beginning();
    } else {
      log_.restore(std::move(first));
    }
  }

  /// False if it is asked to stop.
  bool search_without_them(const Hooks& hooks) {
    corridor::Feed feed = open_again_();
    std::vector<Frame> samples = feed.sample_beginning();
    for (Frame& sample : samples) sample.image = standing_->without_them(sample.image);
    tracking_.restart(samples);
    const std::int64_t count = log_.has_contours() ? log_.frames() : again_.frames;
    std::int64_t number = 0;
    for (; number < count; ++number) {
      const std::optional<CameraFrame> given = feed.next();
      if (!given || hooks.report({"looking again", number, count}) == Continue::no) return false;
      const detect::Detections found = tracking_.detect(*given);
      const auto tracks = tracking_.track(given->frame, found);
      log_.add(number, tracks, observed_in(given->frame, found).clothes, tracking_.tracker().view_from_scene());
    }
    for (const ObservedFrame& later : again_.after) {
      log_.add(number, tracking_.track(log_.time_of(number), later), later.clothes, tracking_.tracker().view_from_scene());
      ++number;
    }
    return true;
  }

  void report_recording(corridor::Summary& summary) const override {
    if (!open_again_) {
      report_standing(summary);
    } else if (again_.added > 0) {
      summary.notes.push_back(
          fmt::format("{} still from the first frame on and left later: tracked from the first frame on, in a second "
                      "pass over the video",
                      again_.added == 1 ? "1 person stood" : fmt::format("{} people stood", again_.added)));
    }
    report_returned(summary);
  }

  void report_returned(corridor::Summary& summary) const {
    if (joined_.returned.empty()) return;
    double minimum = 1;
    for (const track::offline::Returned& one : joined_.returned) minimum = std::min(minimum, one.probability);
    const auto count = std::ssize(joined_.returned);
    summary.notes.push_back(
        fmt::format("{} came back after leaving the image and kept the number, by clothes, place and time "
                    "(probability {}{:.2f})",
                    count == 1 ? "1 person" : fmt::format("{} times a person", count), count == 1 ? "" : "at least ", minimum));
  }

  ImageLog log_;
  std::function<corridor::Feed()> open_again_;  // empty if the feed cannot be read again
  Again again_;
  track::offline::JoinReport joined_;
};

std::unique_ptr<corridor::Stage> people_alone(const corridor::Feed& feed, const ImagePeopleOptions& options) {
  if (options.live) return std::make_unique<LiveImage>(feed, options);
  return std::make_unique<RecordedImage>(feed, options);
}

}  // namespace

std::unique_ptr<corridor::Stage> people_in_image(const corridor::Feed& feed, const ImagePeopleOptions& options) {
  auto people = people_alone(feed, options);
  if (!options.keypoints) return people;
  return keypoints::with_keypoints(std::move(people), feed, *options.keypoints, options.live);
}

}  // namespace marey::pipeline::people
