#include "marey/pipeline/people/people_in_picture.h"

#include <algorithm>
#include <functional>
#include <set>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/detect/appearance.h"
#include "marey/draw/mask_folder.h"
#include "marey/pipeline/corridor/beside.h"
#include "marey/pipeline/keypoints/keypoint_stage.h"
#include "marey/pipeline/people/camera_span.h"
#include "marey/pipeline/people/nobody_found.h"
#include "marey/pipeline/people/picture_doubts.h"
#include "marey/pipeline/people/picture_rows.h"
#include "marey/pipeline/people/standing_people.h"
#include "marey/track/image/live_tracks.h"
#include "marey/track/image/view_border.h"
#include "marey/track/offline/fill_gaps.h"
#include "marey/track/offline/outline_log.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::pipeline::people {
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
                      .covariance = detection.covariance.value_or(Matrix<2>::Identity()),
                      .camera = camera,
                      .score = detection.score,
                      .box = detection.box,
                      .shared = detection.group.has_value()});
  }
  return result;
}

/// What each of those seen wears, as far as pictures tell.
std::vector<track::image::Clothes> clothes_of(const Frame& frame, const detect::Detections& seen) {
  std::vector<track::image::Clothes> clothes;
  if (!frame.picture.is_colour() || seen.foreground.mask.empty()) return clothes;
  for (std::size_t i = 0; i < seen.detections.size(); ++i) {
    clothes.push_back({detect::upper_body(frame.picture, seen.foreground, seen.detections, i),
                       detect::lower_body(frame.picture, seen.foreground, seen.detections, i),
                       detect::shanks(frame.picture, seen.foreground, seen.detections, i)});
  }
  return clothes;
}

/// Whether nothing but pictures of a camera that stands still can be searched.
bool needs_still_camera(const detect::DetectorOptions& detector) {
  const auto* network = std::get_if<detect::network::NetworkDetectorOptions>(&detector);
  return network == nullptr || network->background;
}

/// Background subtraction works before a camera that stands still; of another program's detections, and of what a network alone
/// searches, nothing is known.
track::TrackerOptions tracker_options(const corridor::Feed& feed, const PeopleInPictureOptions& options) {
  track::TrackerOptions tracker = feed.has_pictures() ? options.tracker : track::box_tracker_options(options.tracker);
  tracker.steady_camera = feed.has_pictures() && needs_still_camera(options.detector);
  tracker.reidentify = tracker.steady_camera && options.live;
  tracker.learn_clutter = tracker.learn_noise && options.live;
  return tracker;
}

std::vector<Timestamp> times_of(std::span<const Recording::Moment> moments) {
  std::vector<Timestamp> times;
  times.reserve(moments.size());
  for (const Recording::Moment& moment : moments) times.push_back(moment.time);
  return times;
}

class PeopleInPicture final : public corridor::Stage {
 public:
  PeopleInPicture(const corridor::Feed& feed, const PeopleInPictureOptions& options)
      : options_(options),
        camera_(feed.camera()),
        tracking_(tracker_options(feed, options)),
        tracker_(track::make_tracker(tracking_)) {
    header_.name = feed.info().name;
    header_.frame.kind = FrameOfReference::Kind::image;
    header_.time_base.kind = TimeBase::Kind::rig;
    header_.track_kind = TrackKind::person;
    header_.made_by.program = "marey track";
    header_.rate_hz = feed.rate_hz();
    header_.smoothed = !options.live;
    header_.rig = Rig{.ground_from_world = {}, .calibration = {}, .cameras = {feed.camera()}};
    if (header_.rig->cameras.front().name.empty()) header_.rig->cameras.front().name = "camera";  // a rig's cameras have names
    if (feed.has_pictures() && feed.detector() == nullptr) {
      detector_ = detect::make_detector(options.detector);
      if (!options.live) prime(feed);
      standing_.emplace(options.live ? Picture() : detector_->scene());
    }
    if (!options.masks.empty()) {
      if (!detector_) throw Error("{}: masks are of the background model, and detections are given", options.masks);
      masks_.emplace(options.masks);
    }
    if (options.live) live_.emplace(options.delay);
    if (!options.outlines) return;
    if (!feed.has_pictures()) throw Error("{}: outlines are searched in pictures; give those", feed.info().name);
    follower_.emplace(*options.outlines);
    if (!options.live) outlines_ = std::make_unique<track::offline::OutlineLog>(options.beside, options.with_lines);
  }

  RecordingHeader header() const override { return header_; }

  std::span<const Instant> step(const FrameSet& frames) override {
    const CameraFrame& given = *frames.cameras.front();
    corridor::Beside beside;
    look_beside(given.frame, beside);
    const detect::Detections seen = detect(given);
    if (detector_) doubts_.add(seen);
    if (!seen.searched) {
      beside.wait();
      return pass_over(given.frame);
    }
    const auto tracks = follow(given.frame, seen);
    beside.wait();
    if (given.detections) camera_span_.see(given.frame.time, tracks);
    const bool stood = standing_ && standing_->see(given.frame, tracks, *detector_);
    if (live_) {
      count(tracks, seen.detections.size());
      return told(given.frame, tracks);
    }
    if (!given.frame.picture.empty()) {
      const cv::Size size = given.frame.picture.size();
      options_.join.view = Box{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
    }
    const auto number = std::ssize(searched_);
    searched_.push_back(static_cast<std::int32_t>(moments_.size()));
    moments_.push_back({given.frame.index, given.frame.time});
    const std::vector<track::image::Clothes> clothes = clothes_of(given.frame, seen);
    log(number, tracks, clothes, seen.detections.size());
    if (!open_again_) return {};
    if (stood) {
      looked_at_again_ = number + 1;
      after_.clear();
    } else if (looked_at_again_ > 0 && !outlines_) {  // outlines need the pictures, to the end
      after_.push_back({observations_of(seen.detections, given.frame.camera), clothes});
    }
    return {};
  }

  std::vector<std::string> news() override {
    std::vector<std::string> all;
    if (detector_) all = doubts_.news();
    if (!standing_ || !options_.live) return all;
    for (std::string& sentence : standing_->news()) all.push_back(std::move(sentence));
    return all;
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    if (looked_at_again_ > 0 && !hooks.stop.stop_requested()) look_again(hooks);
    if (masks_) masks_->finish();
    if (live_) {
      if (live_->empty()) return nullptr;
      return rest_of(*live_, options_.seen_only);
    }
    if (const auto noise = tracker_->learned_noise()) options_.join = track::offline::adapted(options_.join, *noise);
    if (!options_.join.view) options_.join.view = border_.view();
    std::vector<track::offline::TrackRow> rows = track::offline::join(recording_, options_.join, &joined_);
    if (searched_.size() < moments_.size()) rows = track::offline::fill_between_searches(rows, searched_, times_of(moments_));
    return instants_of(std::move(rows), std::move(moments_), outlines_.get(), options_.seen_only);
  }

  void report(corridor::Summary& summary) const override {
    summary.detections = detections_;
    std::int64_t too_brief = 0;
    for (const TrackId id : begun_) too_brief += !believed_.contains(id);
    summary.left_out["too_brief"] = too_brief;
    report_standing(summary);
    report_returned(summary);
    report_counts(summary);
    report_camera(summary);
    if (auto why = why_nobody(summary)) {
      if (options_.keypoints && std::holds_alternative<detect::people::PeopleDetectorOptions>(options_.detector))
        *why += "; --without-background finds people who fill the picture or stand there from the beginning, by a network";
      summary.warnings.push_back(std::move(*why));
    }
  }

 private:
  /// What the tracker is told of a frame.
  struct Observed {
    std::vector<Observation<2>> seen;
    std::vector<track::image::Clothes> clothes;
  };

  /// What can be told of a frame without knowing who is in it.
  void look_beside(const Frame& frame, corridor::Beside& beside) {
    if (detector_) beside.run([this, &frame] { doubts_.watch(frame); });
    if (standing_) beside.run([this, &frame] { standing_->look(frame); });
  }

  /// A frame in which nobody was searched for: the second pass interpolates, a live run predicts.
  std::span<const Instant> pass_over(const Frame& frame) {
    if (live_) return told(frame, tracker_->expected(frame.time), false);
    moments_.push_back({frame.index, frame.time});
    return {};
  }

  void report_counts(corridor::Summary& summary) const {
    if (detector_ == nullptr) return;
    for (std::string& doubt : doubts_.warnings()) summary.warnings.push_back(std::move(doubt));
    const detect::DetectionCounts counts = detector_->detection_counts();
    if (counts.noise) summary.left_out["noise"] = *counts.noise;
    if (counts.misfits) summary.left_out["misfits"] = *counts.misfits;
  }

  void report_standing(corridor::Summary& summary) const {
    if (!standing_) return;
    if (!open_again_) {
      for (std::string& sentence : standing_->said()) summary.notes.push_back(std::move(sentence));
    } else if (added_ > 0) {
      summary.notes.push_back(
          fmt::format("{} stood in the scene from the beginning and left it later: {} tracked from the first frame on, which was "
                      "looked at again",
                      added_ == 1 ? "one person" : fmt::format("{} people", added_), added_ == 1 ? "that one is" : "they are"));
    }
  }

  void report_returned(corridor::Summary& summary) const {
    if (joined_.returned.empty()) return;
    double least = 1;
    for (const track::offline::Returned& one : joined_.returned) least = std::min(least, one.probability);
    const auto count = std::ssize(joined_.returned);
    summary.notes.push_back(
        fmt::format("{} who left the picture came back with the same number, by clothes, place and time: {} sure by {:.2f}{}",
                    count == 1 ? "one" : fmt::format("{} times somebody", count), count == 1 ? "that is" : "each is", least,
                    count == 1 ? "" : " at least"));
  }

  /// The camera's motion as boxes alone show it; of pictures other warnings tell.
  void report_camera(corridor::Summary& summary) const {
    if (detector_ || !camera_span_.moved()) return;
    summary.warnings.push_back(fmt::format(
        "the camera moves, or everybody goes one way (by up to {:.0f} px in a second): people are followed all the same, "
        "but where the camera moves, speeds and paths are in pixels of pictures that move",
        camera_span_.farthest()));
  }

  void count(std::span<const Track<2>> tracks, std::size_t detections) {
    for (const Track<2>& track : tracks) (track.confirmed ? believed_ : begun_).insert(track.id);
    detections_ += static_cast<std::int64_t>(detections);
  }

  /// What is known of one frame, for the second pass.
  void log(std::int64_t number, std::span<const Track<2>> tracks, std::span<const track::image::Clothes> clothes,
           std::size_t detections) {
    count(tracks, detections);
    recording_.add(number, moments_[static_cast<std::size_t>(searched_[static_cast<std::size_t>(number)])].time, tracks, clothes,
                   tracker_->view_from_scene());
    if (outlines_) outlines_->add(number, tracks);
  }

  /// Begins anew with a scene in which those who left it are not. What was seen after the last of them had left is as it was seen
  /// then. Where this is stopped, what was found at first counts.
  void look_again(const Hooks& hooks) {
    track::offline::TrackletLog first = std::exchange(recording_, {});
    std::unique_ptr<track::offline::OutlineLog> first_outlines = std::move(outlines_);
    if (first_outlines) outlines_ = std::make_unique<track::offline::OutlineLog>(options_.beside, options_.with_lines);
    if (follower_) follower_.emplace(*options_.outlines);
    bool done = false;
    try {
      done = look_without_them(hooks);
    } catch (const Stopped&) {  // while the feed was read
    }
    if (done) {
      added_ = standing_->since_beginning();
      return;
    }
    recording_ = std::move(first);
    outlines_ = std::move(first_outlines);
  }

  /// False where it is asked to stop.
  bool look_without_them(const Hooks& hooks) {
    believed_.clear();
    begun_.clear();
    detections_ = 0;
    tracker_ = track::make_tracker(tracking_);
    corridor::Feed feed = open_again_();
    std::vector<Frame> samples = feed.sample_beginning();
    for (Frame& sample : samples) sample.picture = standing_->without_them(sample.picture);
    detector_ = detect::make_detector(options_.detector);
    detector_->prime(samples);
    const std::int64_t count = outlines_ ? std::ssize(moments_) : looked_at_again_;
    std::int64_t number = 0;
    for (; number < count; ++number) {
      const std::optional<CameraFrame> given = feed.next();
      if (!given || hooks.report({"looking again", number, count}) == Continue::no) return false;
      const detect::Detections seen = detect(*given);
      log(number, follow(given->frame, seen), clothes_of(given->frame, seen), seen.detections.size());
    }
    for (const Observed& later : after_) {
      log(number, tracker_->step(moments_[static_cast<std::size_t>(number)].time, later.seen), later.clothes, later.seen.size());
      ++number;
    }
    return true;
  }

  void prime(const corridor::Feed& feed) {
    const std::vector<Frame> samples = feed.sample_beginning();
    corridor::Beside beside;
    beside.run([&] { doubts_.look_at_beginning(samples); });
    detector_->prime(samples);
    if (!samples.empty()) open_again_ = feed.opener();
    beside.wait();
  }

  detect::Detections detect(const CameraFrame& given) {
    if (given.detections) {
      for (const Detection& one : *given.detections) border_.see(one.box);
      return {.detections = *given.detections, .foreground = {}};
    }
    if (!detector_) return {.detections = {}, .foreground = {}, .searched = false};
    detect::Detections seen = detector_->detect(given.frame, expected_of(tracker_->expected(given.frame.time)));
    if (masks_) {
      const Foreground& all = seen.foreground;
      masks_->add(given.frame.index, all.covered.empty() ? all.mask : all.covered, given.frame.picture.size());
    }
    return seen;
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
  std::span<const Instant> told(const Frame& frame, std::span<const Track<2>> tracks, bool searched = true) {
    const bool keep = options_.delay > 0 && !frame.picture.empty();
    std::vector<Frame> frames = keep ? std::vector{frame} : std::vector<Frame>{};
    if (searched) {
      live_->add(frame.index, frame.time, tracks, std::move(frames));
    } else {
      live_->add_unsearched(frame.index, frame.time, tracks, std::move(frames));
    }
    due_.clear();
    while (auto instant = live_->next()) {
      if (options_.seen_only) leave_out_unseen(*instant);
      due_.push_back(std::move(*instant));
    }
    return due_;
  }

  PeopleInPictureOptions options_;
  RigCamera camera_;
  track::TrackerOptions tracking_;
  RecordingHeader header_;
  std::unique_ptr<detect::Detector> detector_;  // none where the feed brings detections
  std::unique_ptr<track::Tracker<2>> tracker_;
  std::optional<track::contour::OutlineFollower> follower_;
  std::unique_ptr<track::offline::OutlineLog> outlines_;
  std::optional<draw::MaskFolder> masks_;
  track::offline::TrackletLog recording_;
  track::offline::JoinReport joined_;
  CameraSpan camera_span_;
  track::image::ViewBorder border_;  // of the image, as far as boxes tell
  std::vector<Recording::Moment> moments_;
  std::vector<std::int32_t> searched_;  // indices into `moments_`: the log counts these
  std::optional<track::image::LiveTracks> live_;
  std::vector<Instant> due_;
  std::optional<StandingPeople> standing_;      // where a background model may have taken them for the scene
  std::function<corridor::Feed()> open_again_;  // empty where that is not to be
  std::int64_t looked_at_again_ = 0;            // frames, once somebody is known to be missing from them
  std::vector<Observed> after_;                 // of the frames that follow those
  int added_ = 0;                               // people who are in the results because of that
  std::set<TrackId> begun_, believed_;
  std::int64_t detections_ = 0;
  PictureDoubts doubts_{camera_, options_.steady};
};

}  // namespace

std::unique_ptr<corridor::Stage> people_in_picture(const corridor::Feed& feed, const PeopleInPictureOptions& options) {
  auto people = std::make_unique<PeopleInPicture>(feed, options);
  if (!options.keypoints) return people;
  return keypoints::with_keypoints(std::move(people), feed, *options.keypoints, options.live);
}

}  // namespace marey::pipeline::people
