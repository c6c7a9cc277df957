// The people in the images of several live cameras, instant by instant: each camera's are searched in the regions that its last
// image gave (camera_people.h), all cameras' regions by one pool of threads, and the person detector runs in one image of an
// instant at most.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/image.h"
#include "marey/core/keypoints.h"
#include "marey/core/stage_times.h"
#include "marey/core/time.h"
#include "marey/detect/keypoints/landmark_network.h"
#include "marey/pipeline/keypoints/camera_people.h"

namespace marey::pipeline::keypoints {

/// The boxes of the people in an image, px.
using FindPeople = std::function<std::vector<Box>(const Image& image)>;
/// Who is in each of several cameras' regions.
using FindBodies = std::function<std::vector<detect::keypoints::Body>(std::span<const detect::keypoints::ImageRegion> searched)>;

/// By networks: of the file that describes it, empty: the one that script/model makes; of lite, full, heavy, or an ONNX file.
/// Throws Error if it is not usable.
FindPeople people_finder(const std::string& detector);
FindBodies body_finder(const std::string& model);

class ImagesWithPeople {
 public:
  ImagesWithPeople(const KeypointSet& set, std::size_t cameras, FindPeople find_people, FindBodies find_bodies,
                   const CameraPeopleOptions& options = {});

  /// One image of each camera; an empty one changes nothing. `full`: whether all people that are wanted are in a camera's image;
  /// empty: never.
  void step(std::span<const Image> images, Timestamp now, const std::function<bool(std::size_t camera)>& full = {});

  CameraPeople& operator[](std::size_t camera) { return cameras_[camera]; }
  const CameraPeople& operator[](std::size_t camera) const { return cameras_[camera]; }

  std::int64_t searches() const { return searches_; }  ///< of the detector
  std::int64_t regions() const { return regions_; }    ///< that the network was given
  const StageTimes& searching() const { return searching_; }
  const StageTimes& detecting() const { return detecting_; }

 private:
  FindPeople find_people_;
  FindBodies find_bodies_;
  std::vector<CameraPeople> cameras_;
  std::int64_t searches_ = 0, regions_ = 0;
  StageTimes searching_, detecting_;
};

}  // namespace marey::pipeline::keypoints
