// How much of each camera's image has been seen filled so far by what calibrates cameras, a wand or people, and by which cameras
// together, while it still continues: whether it is enough, and for which not.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"

namespace marey::calibrate {

class ImageCoverage {
 public:
  struct Criteria {
    double fraction = 0;           ///< of a camera's image
    double min_fraction = 0;       ///< the same in a volume that is small in it: where more shows nothing new
    std::int64_t nothing_new = 0;  ///< views without a new part of the image, that say so
    std::int64_t shared = 0;       ///< views of two cameras, that determine how they stand to each other
  };
  ImageCoverage(std::size_t cameras, const Criteria& criteria) : criteria_(criteria), cameras_(cameras) {}

  /// What one image shows, px.
  void add_view(std::size_t camera, std::span<const Vector<2>> pixels, cv::Size size);
  void add_shared(std::size_t a, std::size_t b, std::int64_t views);

  const Criteria& criteria() const { return criteria_; }
  std::size_t cameras() const { return cameras_.size(); }
  /// Fraction of the camera's image, in 10 × 8 parts, in which something was.
  double coverage(std::size_t camera) const;
  /// Those parts, row by row, each a number below `kPartsAcross` × `kPartsDown`.
  const std::set<int>& parts(std::size_t camera) const { return cameras_[camera].parts; }
  std::int64_t views(std::size_t camera) const { return cameras_[camera].views; }
  std::int64_t shared(std::size_t a, std::size_t b) const;
  bool is_covered(std::size_t camera) const;
  bool are_related(std::size_t a, std::size_t b) const { return shared(a, b) >= criteria_.shared; }
  /// The first camera to which each is chained by enough views that two share: itself where it is the first.
  std::vector<std::size_t> chained_to() const;
  /// Whether every camera is covered, and all are chained.
  bool is_enough() const;

  static constexpr int kPartsAcross = 10, kPartsDown = 8;

 private:
  struct Camera {
    std::set<int> parts;
    std::int64_t views = 0, views_at_growth = 0;  ///< all; and when a new part was last filled
  };

  Criteria criteria_;
  std::vector<Camera> cameras_;
  std::map<std::pair<std::size_t, std::size_t>, std::int64_t> shared_;
};

}  // namespace marey::calibrate
