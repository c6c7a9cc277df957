#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/image.h"
#include "marey/core/instant.h"
#include "marey/core/stage_times.h"
#include "marey/detect/keypoints/landmark_network.h"
#include "marey/detect/keypoints/limb_swaps.h"

namespace marey::pipeline::keypoints {

struct KeypointOptions {
  std::string model = "full";  ///< the landmark network: lite, full, heavy, or an ONNX file
  int every = 1;               ///< it processes every n-th frame
  double lag_s = 0.5;          ///< that later frames have a say in which side is left; none where `live`
  double sure = 0.5;           ///< presence from which on there is a person
  double patience_s = 2;       ///< that a person is kept after the network lost them
};

/// Keypoints of people who are tracked with boxes: a region for each from earlier points, else from the box, the network,
/// left and right corrected over time. Between the frames that the network processes points are interpolated, live carried on as
/// they moved. One that it does not see for long is not a person, and leaves the instants.
class BodyKeypoints {
 public:
  /// Throws Error if the network is not usable.
  BodyKeypoints(const KeypointOptions& options, bool live);

  /// The next instant, px, and the image that it is of.
  void add(Instant instant, const Image& image);
  /// The next one that is due, with keypoints; all that wait where it is `ended`.
  std::optional<Instant> next(bool ended = false);

  std::int64_t excluded() const { return excluded_; }  ///< samples of those who are not people
  const StageTimes& times() const { return times_; }   ///< of the network, an image each

 private:
  /// What the network saw at one time.
  struct Detected {
    Timestamp time{};
    std::shared_ptr<const Keypoints<2>> keypoints;
  };
  struct Person {
    explicit Person(const KeypointSet& set) : swaps(set) {}

    Timestamp first{}, last_present{}, last_sample{};
    std::optional<detect::keypoints::PersonRegion> region;  // where they are to be searched for next, if they were found last
    Box box;                                                // where they were then
    detect::keypoints::LimbSwaps swaps;
    std::deque<Timestamp> waiting;  // the times of those in `swaps`
    std::deque<Detected> detected;  // with their sides right; the last before what is due, and those after it
  };
  struct Waiting {
    Instant instant;
    bool inspected = false;
  };

  Person& person_of(const Sample& sample, Timestamp now);
  void inspect(const Instant& instant, const Image& image);
  void take_in(std::span<const Sample* const> samples, std::span<const detect::keypoints::Body> bodies, Timestamp now);
  std::shared_ptr<const Keypoints<2>> at(Person& person, Timestamp time, bool inspected) const;

  KeypointOptions options_;
  bool live_;
  detect::keypoints::LandmarkNetwork network_;
  std::map<TrackId, Person> people_;
  std::deque<Waiting> waiting_;
  std::int64_t frames_ = 0, excluded_ = 0;
  StageTimes times_;
};

}  // namespace marey::pipeline::keypoints
