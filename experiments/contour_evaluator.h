#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/simulate/people/people_renderer.h"

#include "experiments/outline_methods.h"

namespace marey::experiments {

/// A sum of values and their number.
struct Mean {
  double sum = 0;
  std::int64_t count = 0;

  void add(double value) {
    sum += value;
    ++count;
  }
  void add(const Mean& other) {
    sum += other.sum;
    count += other.count;
  }
  std::optional<double> value() const { return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt; }
};

/// What one method made of one or more videos. IoU is of areas within the image, on the lattice of the true silhouettes.
struct ContourTally {
  Mean whole;               ///< IoU with the whole body, of people who are half visible or more
  Mean alone;               ///< IoU of people who touch no other
  Mean front, behind;       ///< IoU of the visible part of two who overlap by 20 to 70 %: the nearer and the farther one
  Mean found;               ///< 1 where the IoU of the visible part is 0.5 or more, else 0; of all people in the last three
  Mean bias;                ///< px by which the contour of a person alone is wider than the true edge, on average along it
  Mean back;                ///< IoU of the visible part in the first frame in which half of a hidden person is visible again
  Mean swapped;             ///< 1 where that person has another name then, or within a second, else 0
  Mean hidden;              ///< frames of a full occlusion
  Mean taken_over;          ///< 1 where that name was another person's before an occlusion, else 0
  std::int64_t curves = 0;  ///< contours reported
  std::int64_t crossed = 0, oversized = 0;  ///< of these: that cross themselves; that exceed 1.5 × their person's size
  Mean step_s, processor_s;                 ///< s per frame, where that is measured: of time, and of all processors together
  std::array<Mean, 3> bends;                ///< squares of second differences: centre (px²), root of the area (px²), width (px²)

  void add(const ContourTally& other);
};

/// Evaluates one method on one video. In `whole`, `alone`, `front`, `behind` and `bias` a person has the contour that overlaps
/// their visible part most, whatever its name; a contour serves one person.
class ContourEvaluator {
 public:
  explicit ContourEvaluator(cv::Size image) : image_(image) {}

  void observe(int frame, std::span<const simulate::people::TrueFigure> truth, std::span<const TrackedShape> shapes);
  const ContourTally& tally() const { return tally_; }

 private:
  struct Person {
    std::string name;        ///< of the contour on the person when they were last visible
    int hidden = 0;          ///< frames in a row without a visible part
    int watched_until = -1;  ///< frame up to which the name must be the one before
    std::string before;      ///< the name before the occlusion
    int last = -2, run = 0;  ///< frames for the second differences
    std::array<std::array<double, 4>, 2> path{};
  };

  void match(std::span<const simulate::people::TrueFigure> truth, std::span<const TrackedShape> shapes);
  void score(std::span<const simulate::people::TrueFigure> truth, std::size_t index, const TrackedShape* shape);
  void update_occlusion(int frame, const simulate::people::TrueFigure& person, const TrackedShape* shape, double iou);
  void update_motion(int frame, const simulate::people::TrueFigure& person, const TrackedShape* shape);

  cv::Size image_;
  std::map<int, Person> people_;
  std::vector<int> matched_;  ///< by person: index of the shape, −1 without
  std::vector<double> visible_iou_;
  ContourTally tally_;
};

}  // namespace marey::experiments
