// How much of people who walk cameras have seen so far, while they still walk: whether it is enough, and where to walk yet.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/image_coverage.h"
#include "marey/core/keypoints.h"

namespace marey::calibrate::people {

class PeopleCoverage {
 public:
  explicit PeopleCoverage(std::size_t cameras) : images_(cameras, criteria()), counted_(cameras) {}

  /// What a camera shows at an instant.
  struct View {
    std::span<const Keypoints<2>> people;
    cv::Size size;  ///< px; empty if it is not known yet: nothing is counted then
  };
  /// One instant, by camera. A camera's view counts where a person in it has moved by a tenth of the body since the last that
  /// counted: people who stand still show nothing new, however often.
  void add(std::span<const View> seen);

  const ImageCoverage& images() const { return images_; }
  /// What is to be done yet, a sentence for each camera; none where it is enough. `names` by camera.
  std::vector<std::string> missing(std::span<const std::string> names) const;

  static constexpr ImageCoverage::Criteria criteria() {
    return {.fraction = 0.3, .min_fraction = 0.15, .nothing_new = 400, .shared = 100};  // bench/sweep/people_enough.cpp
  }

 private:
  using Points = std::vector<std::optional<Vector<2>>>;

  ImageCoverage images_;
  std::vector<std::vector<Points>> counted_;  // by camera: the people of the last view that counted
};

}  // namespace marey::calibrate::people
