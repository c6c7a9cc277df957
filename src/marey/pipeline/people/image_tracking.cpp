#include "marey/pipeline/people/image_tracking.h"

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/detect/appearance.h"
#include "marey/detect/keypoints/landmark_network.h"
#include "marey/detect/keypoints/model_folder.h"

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

/// Whether only images of a static camera can be searched.
bool needs_static_camera(const detect::DetectorOptions& detector) {
  const auto* network = std::get_if<detect::network::NetworkDetectorOptions>(&detector);
  return network == nullptr || network->background;
}

/// Background subtraction needs a static camera; of another program's detections, and of what a network alone searches, nothing is
/// known.
track::TrackerOptions image_tracker_options(const corridor::Feed& feed, const ImagePeopleOptions& options) {
  track::TrackerOptions tracker = feed.has_images() ? options.tracker : track::box_tracker_options(options.tracker);
  tracker.stabilised_camera = feed.has_images() && needs_static_camera(options.detector);
  tracker.reidentify = tracker.stabilised_camera && options.live;
  tracker.learn_clutter = tracker.learn_noise && options.live;
  return tracker;
}

/// Masks of people by a landmark network; none of one that it does not see.
track::contour::colour::FindBodyMasks masks_by(const std::string& model) {
  const auto network = std::make_shared<detect::keypoints::LandmarkNetwork>(detect::keypoints::landmark_model(model));
  return [network](const Image& image, std::span<const Box> boxes) {
    constexpr double kPresent = 0.5;  // by definition: more likely than not
    std::vector<detect::keypoints::ImageRegion> searched;
    for (const Box& box : boxes) searched.push_back({image, detect::keypoints::region_of(box)});
    std::vector<track::contour::colour::BodyMask> masks;
    for (detect::keypoints::BodyPixels& one : network->pixels(searched)) {
      if (one.presence < kPresent) one.chance.release();
      masks.push_back(
          {.chance = std::move(one.chance), .corner = one.region.in_image(Vector<2>::Zero()), .scale = one.region.scale()});
    }
    return masks;
  };
}

}  // namespace

ObservedFrame observed_in(const Frame& frame, const detect::Detections& found) {
  ObservedFrame observed{.observations = observations_of(found.detections, frame.camera), .clothes = {}};
  if (!frame.image.is_colour() || found.foreground.mask.empty()) return observed;
  for (std::size_t i = 0; i < found.detections.size(); ++i) {
    observed.clothes.push_back({detect::upper_body(frame.image, found.foreground, found.detections, i),
                                detect::lower_body(frame.image, found.foreground, found.detections, i),
                                detect::shanks(frame.image, found.foreground, found.detections, i)});
  }
  return observed;
}

ImageTracking::ImageTracking(const corridor::Feed& feed, const ImagePeopleOptions& options)
    : detector_options_(options.detector),
      tracker_options_(image_tracker_options(feed, options)),
      contour_options_(options.outlines),
      tracker_(track::make_tracker(tracker_options_)) {
  if (feed.has_images() && feed.detector() == nullptr) detector_ = detect::make_detector(options.detector);
  if (!contour_options_) return;
  if (!feed.has_images()) throw Error("{}: outlines are searched in images; give those", feed.info().name);
  contour_model_ = options.contour_model;
  if (!contour_model_.empty()) find_masks_ = masks_by(contour_model_);
  begin_contours();
}

void ImageTracking::begin_contours() {
  contours_.emplace(*contour_options_);
  if (find_masks_) contours_->use_masks(find_masks_);
}

detect::Detections ImageTracking::detect(const CameraFrame& given) {
  if (given.detections) {
    for (const Detection& one : *given.detections) border_.observe_frame(one.box);
    return {.detections = *given.detections, .foreground = {}};
  }
  if (!detector_) return {.detections = {}, .foreground = {}, .searched = false};
  detect::Detections found = detector_->detect(given.frame, expected_of(tracker_->expected(given.frame.time)));
  if (give_)
    give_({.camera = given.frame.camera,
           .frame = given.frame.index,
           .size = given.frame.image.size(),
           .foreground = {.mask = found.foreground.mask.clone(), .covered = found.foreground.covered.clone()}});
  return found;
}

/// Contours are searched before and corrected after, so that each informs the other.
std::span<const Track<2>> ImageTracking::track(const Frame& frame, const detect::Detections& found) {
  std::vector<Observation<2>> observations = observations_of(found.detections, frame.camera);
  if (!contours_) return count(tracker_->step(frame.time, observations), found.detections.size());
  const auto hints = contours_->observe(frame, found.foreground, found.detections);
  observations.insert(observations.end(), hints.begin(), hints.end());
  return count(contours_->attach(tracker_->step(frame.time, observations), found.detections), found.detections.size());
}

std::span<const Track<2>> ImageTracking::track(Timestamp now, const ObservedFrame& observed) {
  return count(tracker_->step(now, observed.observations), observed.observations.size());
}

std::span<const Track<2>> ImageTracking::count(std::span<const Track<2>> tracks, std::size_t detections) {
  for (const Track<2>& track : tracks) (track.confirmed ? counts_.confirmed : counts_.begun).insert(track.id);
  counts_.detections += static_cast<std::int64_t>(detections);
  return tracks;
}

void ImageTracking::restart(std::span<const Frame> samples) {
  counts_ = {};
  tracker_ = track::make_tracker(tracker_options_);
  if (contours_) begin_contours();
  detector_ = detect::make_detector(detector_options_);
  detector_->prime(samples);
}

void ImageTracking::report(corridor::Summary& summary) const {
  summary.detections = counts_.detections;
  std::int64_t too_short = 0;
  for (const TrackId id : counts_.begun) too_short += !counts_.confirmed.contains(id);
  summary.dropped.too_short = too_short;
  if (contours_) {
    summary.notes.push_back(find_masks_ ? fmt::format("contours: the masks of the network {} count as evidence", contour_model_)
                                        : "contours: by colour, motion and shape, without a network");
  }
}

}  // namespace marey::pipeline::people
