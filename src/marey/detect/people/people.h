#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "marey/assign/disjoint_sets.h"
#include "marey/detect/background/background.h"
#include "marey/detect/detector.h"
#include "marey/detect/people/people_ends.h"
#include "marey/detect/people/people_fit.h"
#include "marey/detect/people/people_hidden.h"
#include "marey/detect/people/people_size.h"
#include "marey/detect/people/person_size_map.h"

namespace marey::detect::people {

struct PeopleOptions {
  FitOptions fit;
  double min_fraction = 0.04;  ///< of a person's box; smaller regions are noise
  double min_area = 12;        ///< px²; smaller regions are noise, while the size of people is not known
  /// The size of people at each place, from a camera that is calibrated; nothing: learned from the recording.
  std::shared_ptr<const PersonSizeMap> sizes = nullptr;
};

/// The detector as the register of detectors knows it (detect/detectors.h).
struct PeopleDetectorOptions {
  static constexpr std::string_view name = "people";

  background::BackgroundOptions background = {};
  PeopleOptions people = {};
};

/// People who move, or moved, before a fixed camera: foreground of a background model, cut into people by the size that they
/// have at each place, which is learned from the recording itself. Boxes hold whole bodies, also where a part is hidden, and end
/// at the image's border.
class PeopleDetector final : public Detector {
 public:
  /// Observations that were not reported, or are uncertain, since the beginning.
  struct Counts {
    std::int64_t noise = 0;      ///< regions too small to be a part of a person
    std::int64_t misfits = 0;    ///< regions that no person-sized body explains: cars, swaying trees, lights
    std::int64_t shared = 0;     ///< people found in a region with others
    std::int64_t completed = 0;  ///< people with one part seen
  };

  explicit PeopleDetector(std::unique_ptr<background::Background> background, const PeopleOptions& options = {});

  void prime(std::span<const Frame> samples) override;
  Detections detect(const Frame& frame, std::span<const Expected> expected) override;

  /// Silhouettes end at the tip of the foot.
  DetectorTraits traits() const override { return {.toe_m = 0.1, .has_foreground = true, .knows_body_size = true}; }
  DetectionCounts detection_counts() const override { return {counts_.noise, counts_.misfits}; }
  std::optional<Box> body_at(const Vector<2>& foot) const override;
  Image scene() const override { return background_->scene(); }
  void trust(const Image& image, const cv::Mat& mask, cv::Point corner) override { background_->trust(image, mask, corner); }

  const Counts& counts() const { return counts_; }
  /// How large a person is whose feet are at (x, y), px: as it was given, or as it was learned so far.
  std::optional<PersonSize> size_at(double x, double y) const {
    return options_.sizes ? options_.sizes->at(x, y) : sizes_.at(x, y);
  }

 private:
  struct Cluster {
    std::vector<PixelRun> runs;
    Box box;
    Box body;  ///< the box without what sticks out at the sides
    double area = 0;
    int regions = 0;
    std::vector<int> expected;  ///< whose box lies on it
  };

  bool size_known() const { return options_.sizes != nullptr || sizes_.known(); }
  double min_area(const Region& region) const;
  assign::DisjointSets pieces_that_lie_together(const std::vector<Region>& regions, std::span<const Expected> expected) const;
  std::vector<Region> without_noise(std::vector<Region> regions);
  std::vector<Cluster> clusters_of(std::vector<Region> regions, std::span<const Expected> expected) const;
  void learn(const std::vector<Region>& regions, std::span<const Expected> expected, cv::Size image);
  bool appearance_whole(const Cluster& cluster, cv::Size image, double widest) const;
  static Box completed(const Cluster& cluster, std::span<const Expected> expected, cv::Size image);
  Box without_halo(const Box& box, std::span<const PixelRun> runs);
  Detection whole(const Cluster& cluster, std::span<const Expected> expected, const Foreground& foreground);
  void explain(const Cluster& cluster, std::span<const Expected> expected, const Foreground& foreground,
               std::vector<Detection>& found);

  std::unique_ptr<background::Background> background_;
  PeopleOptions options_;
  PersonSizeModel sizes_;
  StaticOccluders hidden_;
  SilhouetteExcess excess_;
  Image image_;  ///< the frame's
  Counts counts_;
  int groups_ = 0;  ///< numbers given to shared regions in this frame
};

}  // namespace marey::detect::people
