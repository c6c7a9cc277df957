#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/frame.h"
#include "marey/simulate/people/people_renderer.h"
#include "marey/track/contour/contour_tracker.h"

#include "experiments/published_outline.h"

namespace marey::experiments {

/// Where a method says that a person is.
struct TrackedShape {
  std::string name;
  Vector<2> centre = Vector<2>::Zero();  ///< px
  std::vector<Vector<2>> polygon;        ///< px
  std::vector<std::string> behind;       ///< names of those that hide a part of it, as far as the method reports
  bool is_curve = false;                 ///< a followed outline, not a silhouette or a box
  double box_width = 0, box_height = 0;  ///< px; of its target, where the method knows
};

/// One method of tracking outlines, for `marey experiment outlines`.
class OutlineMethod {
 public:
  virtual ~OutlineMethod() = default;

  /// Images of the scene from before the first frame: what a detector is primed with.
  virtual void prime(std::span<const Frame> /*samples*/) {}

  /// What the method says of a frame. `detections` are those of the first method, for methods that have no detector of their own;
  /// `truth` serves to begin those that have no birth.
  virtual std::vector<TrackedShape> step(const Frame& frame, std::span<const Detection> detections,
                                         std::span<const simulate::people::TrueFigure> truth) = 0;

  /// Of the last frame, where the method has a detector of its own.
  virtual std::span<const Detection> detections() const { return {}; }

  double seconds() const { return seconds_; }        ///< spent on following, detection and association omitted
  std::int64_t targets() const { return targets_; }  ///< times frames that it was spent on

 protected:
  double seconds_ = 0;
  std::int64_t targets_ = 0;
};

/// Marey's detector and tracker, with the detector's own silhouettes as outlines.
std::unique_ptr<OutlineMethod> silhouette_method();
/// The same with followed outlines.
std::unique_ptr<OutlineMethod> marey_method(const track::contour::OutlineOptions& options);
std::unique_ptr<OutlineMethod> published_method(const PublishedOptions& options);
std::unique_ptr<OutlineMethod> box_method();

}  // namespace marey::experiments
