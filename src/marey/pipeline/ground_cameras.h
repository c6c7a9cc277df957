// Many cameras over one ground, on one clock. Instants are the frames of the rig's first camera; every other contributes its frame
// that lies nearest by time + offset_s, where that is less than half a frame away. What a camera gives is looked at by a detector
// of its own, told where people are expected, and placed on the ground; cameras are looked at side by side, and what comes out does
// not depend on the threads. A camera is pictures, or what another program detected in them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/pipeline/people_eyes.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::pipeline {

struct GroundCamerasOptions {
  DetectionStageOptions eyes;
  std::optional<double> rate_hz;  ///< of cameras of which the rig does not say it
};

class GroundCameras {
 public:
  /// Opens every camera. Throws Error, with the camera's name, where one has neither pictures nor detections, cannot be read, or
  /// does not know how it sees the ground.
  GroundCameras(const Rig& rig, const reconstruct::GroundArea& area, const GroundCamerasOptions& options);
  ~GroundCameras();

  /// The rig as its pictures are: calibrations scaled to their size.
  const Rig& rig() const { return rig_; }
  const std::vector<GroundView>& views() const { return views_; }
  std::optional<double> rate_hz() const;            ///< of the first camera
  std::optional<std::int64_t> frame_count() const;  ///< of the first camera, an estimate

  /// Reads on to the next instant; false when the first camera has ended.
  bool next();
  std::int32_t frame() const { return frame_; }  ///< of the first camera
  Timestamp time() const { return time_; }       ///< by the rig's clock

  /// Finds people in what `next` has read, where `expected` are (m, world), and places them. One look a camera that has a frame for
  /// this instant. Valid until the next call.
  std::span<const track::ground::CameraObservations> look(std::span<const Track<2>> expected);

  /// The frame that camera `number` gave to this instant, by its own count.
  std::optional<std::int32_t> frame_of(std::size_t number) const;
  /// The box of a person at `ground` (m, world) in the picture of camera `number`, px; nothing where that is not known.
  std::optional<Box> box_at(std::size_t number, const Vector<2>& ground) const;

  /// Lets go of detections that were kept in memory: nothing is looked at any more.
  void close();

  struct Counts {
    std::int64_t frames = 0;      ///< looked at
    std::int64_t missed = 0;      ///< instants without a frame
    std::int64_t detections = 0;  ///< placed on the ground
    std::int64_t outside = 0;     ///< detections where nobody counts, or above the horizon
    std::int64_t noise = 0;       ///< regions too small to be a part of a person
    std::int64_t misfits = 0;     ///< regions that no body explains
  };
  Counts counts(std::size_t number) const;
  std::vector<std::string> warnings() const;

 private:
  struct Lane;

  Rig rig_;
  reconstruct::GroundArea area_;
  std::vector<GroundView> views_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::vector<track::ground::CameraObservations> looks_;
  std::int32_t frame_ = -1;
  Timestamp time_{};
};

}  // namespace marey::pipeline
