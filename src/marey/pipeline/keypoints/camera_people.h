// The people in one live camera's images: each is searched in the region that the frame before gave, so that a person detector is
// needed only for those who are new.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/keypoints.h"
#include "marey/core/time.h"
#include "marey/detect/keypoints/landmark_network.h"
#include "marey/detect/keypoints/limb_swaps.h"

namespace marey::pipeline::keypoints {

struct CameraPeopleOptions {
  double presence = 0.5;         ///< from which on there is a person, unswept
  double unplaced_s = 2;         ///< a region whose person no other camera confirms ends after this, unswept
  double surplus_s = 0.5;        ///< and where all people who are wanted are in the image, that of another one after this, unswept
  double search_s = 2;           ///< the detector runs at least this often while people may come, unswept
  double retry_s = 0.5;          ///< and at most this often when a region has ended or is absent, unswept
  double expect_s = 0.2;         ///< between two searches for people that only other cameras see, unswept
  std::size_t max_regions = 12;  ///< of an image; further people wait, unswept
  int min_detector_runs = 2;     ///< after which a person is reported: the first region is only a box, which makes points worse
  double same_centre = 0.2;      ///< distance of the centres of regions of one person, of the larger side, unswept
  double same_points = 0.06;     ///< mean distance between the points of bodies that are the same, of the height
  double max_step = 0.5;         ///< of a region's centre from image to image, of its side, unswept
  double max_growth = 2;         ///< factor of a region's side from image to image, unswept
};

class CameraPeople {
 public:
  explicit CameraPeople(const KeypointSet& set, const CameraPeopleOptions& options = {});

  /// How urgently the detector should run in the image of `now`: seconds overdue; nothing if it need not. `full`: all people that
  /// are wanted are in the image.
  std::optional<double> search_due(Timestamp now, bool full) const;
  /// The detector ran: regions of people who are in none yet are searched from the next `regions` on.
  void searched(std::span<const Box> boxes, Timestamp now);
  /// A person that other cameras see should be here. Searched at most every `expect_s` until they are seen.
  void expect(const detect::keypoints::PersonRegion& region, Timestamp now);

  /// Where to search in the next image. Valid until the next call of anything.
  std::span<const detect::keypoints::PersonRegion> regions();
  /// What the network saw in each of them. `full`: all people that are wanted are in the image.
  void take(std::span<const detect::keypoints::Body> bodies, Timestamp now, bool full = false);

  /// The people of the last image, those that the network saw in `min_detector_runs` images at least; `placed` says which of them
  /// other cameras confirm.
  const std::vector<Keypoints<2>>& people() const { return people_; }
  void located(std::size_t index, Timestamp now);

  std::size_t size() const { return known_.size(); }
  std::int64_t ended() const { return ended_; }  ///< regions that ended, so far

 private:
  struct Known {
    Known(const detect::keypoints::PersonRegion& first, const KeypointSet& set) : region(first), swaps(set) {}

    detect::keypoints::PersonRegion region;
    detect::keypoints::LimbSwaps swaps;
    Keypoints<2> body;
    std::optional<Timestamp> detected;  // last
    Timestamp confirmed{};              // by another camera, last, or else when it began
    int appearances = 0;
    bool ended = false;
  };

  bool covered(const detect::keypoints::PersonRegion& region) const;
  void propose(const detect::keypoints::PersonRegion& region);
  void end_doubles();

  KeypointSet set_;
  CameraPeopleOptions options_;
  std::vector<Known> known_;  // the older ones first
  std::vector<detect::keypoints::PersonRegion> regions_;
  std::vector<Keypoints<2>> people_;
  std::vector<std::size_t> of_people_;  // index into `known_`
  std::optional<Timestamp> searched_, expected_;
  bool required_ = true;  // a region has ended since the detector ran
  std::int64_t ended_ = 0;
};

}  // namespace marey::pipeline::keypoints
