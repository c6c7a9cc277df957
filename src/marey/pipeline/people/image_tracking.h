// One camera's frames to tracks: detect what does not belong to the scene where people are expected, and track it, with contours if
// those are wanted.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "marey/detect/detector.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/corridor/foreground_sink.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/people/image_stage.h"
#include "marey/track/contour/contour_tracker.h"
#include "marey/track/image/clothing.h"
#include "marey/track/image/view_border.h"
#include "marey/track/tracker.h"

namespace marey::pipeline::people {

/// What the tracker is given of a frame, and the clothing of each detection, as far as images show it.
struct ObservedFrame {
  std::vector<Observation<2>> observations;
  std::vector<track::image::Clothes> clothes;
};
ObservedFrame observed_in(const Frame& frame, const detect::Detections& found);

class ImageTracking {
 public:
  /// Throws Error if contours are wanted of a feed without images.
  ImageTracking(const corridor::Feed& feed, const ImagePeopleOptions& options);

  /// Null if the feed brings detections.
  detect::Detector* detector() const { return detector_.get(); }
  void give_foregrounds(std::function<void(corridor::FrameForeground)> give) { give_ = std::move(give); }

  detect::Detections detect(const CameraFrame& given);
  /// The tracks of a frame, those not yet confirmed included. Valid until the next call.
  std::span<const Track<2>> track(const Frame& frame, const detect::Detections& found);
  /// The same of a frame that was observed before.
  std::span<const Track<2>> track(Timestamp now, const ObservedFrame& observed);

  /// Begins again, with a detector that is primed with `samples`.
  void restart(std::span<const Frame> samples);

  track::Tracker<2>& tracker() { return *tracker_; }
  /// The image as far as boxes show it.
  const track::image::ViewBorder& border() const { return border_; }

  void report(corridor::Summary& summary) const;

 private:
  struct Counts {
    std::set<TrackId> begun, confirmed;
    std::int64_t detections = 0;
  };

  void begin_contours();
  std::span<const Track<2>> count(std::span<const Track<2>> tracks, std::size_t detections);

  detect::DetectorOptions detector_options_;
  track::TrackerOptions tracker_options_;
  std::optional<track::contour::OutlineOptions> contour_options_;
  std::unique_ptr<detect::Detector> detector_;
  std::unique_ptr<track::Tracker<2>> tracker_;
  std::optional<track::contour::ContourTracker> contours_;
  std::string contour_model_;
  track::contour::colour::FindBodyMasks find_masks_;  // empty: contours go without a network
  track::image::ViewBorder border_;
  std::function<void(corridor::FrameForeground)> give_;
  Counts counts_;
};

}  // namespace marey::pipeline::people
