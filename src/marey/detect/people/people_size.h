#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::detect::people {

/// How large an upright person appears at one place, px.
struct PersonSize {
  double height = 0;
  double width = 0;

  /// The box of a person whose feet stand at (x, y) in continuous image coordinates.
  Box box_at(double x, double y) const { return {x - (width - 1) / 2, y + 0.5 - height, width, height}; }
};

/// The size of people at each place of one camera's image, learned from observations.
class PersonSizeModel {
 public:
  /// Takes in a region that may be one whole person, well apart from others and off the image's border. What is not shaped
  /// like a person at all is omitted. `image` is the size of the image, the same in every call.
  void observe_frame(const Box& region, cv::Size image);

  /// Takes in a region that the image's upper or lower border cuts off: a person seen there is at least as tall.
  void observe_cut(const Box& region, cv::Size image);

  /// Learns from all that is remembered. Cheap enough for every few hundred regions, not for every frame.
  void fit();

  /// Whether `see` took in enough since the last `fit` that another is worth its cost.
  bool needs_fit() const { return fresh_ >= 24 && fresh_ * 4 >= fitted_from_; }

  /// Whether enough was seen to say anything.
  bool known() const { return coefficients_.has_value(); }

  /// px: the tallest of what was taken in so far; 0 of nothing.
  double tallest_observed() const { return tallest_observed_; }

  /// The size of a person whose feet are at (x, y), px; at most twice the largest seen. Nothing while too little was seen, and
  /// nothing if people would be this much smaller than any that were seen that none can stand there: towards the horizon.
  std::optional<PersonSize> at(double x, double y) const;

  /// Relative standard deviation of a person's height round the model's; meaningful where `at` gives a value.
  double spread() const { return spread_; }

 private:
  using Features = Eigen::Vector4d;
  struct Sample {
    Features features;
    double height = 0;
    double aspect = 0;  ///< width over height
    double weight = 0;
    bool cut = false;  ///< the person is at least so tall
  };
  struct Remembered {
    Box box;
    bool cut = false;
  };

  void remember(const Box& region, cv::Size image, bool cut);
  Features features_of(double x, double y) const;
  std::vector<Sample> weighted_samples() const;
  static double support_of(const Features& guess, const std::vector<Sample>& samples);
  std::optional<Features> consensus(const std::vector<Sample>& samples) const;
  Features refined(Features start, const std::vector<Sample>& samples) const;
  void take_over(const Features& solution, const std::vector<Sample>& samples);

  cv::Size image_;
  std::vector<std::vector<Remembered>> cells_;  ///< a bounded memory for each part of the image, the oldest overwritten
  std::vector<std::size_t> next_;               ///< where each of them is overwritten next
  std::size_t fresh_ = 0;                       ///< boxes taken in since the last fit
  std::size_t fitted_from_ = 0;                 ///< boxes remembered at the last fit
  std::optional<Features> coefficients_;        ///< height = coefficients · features
  double tallest_observed_ = 0;
  double aspect_ = 0;
  double spread_ = 0;
  double smallest_ = 0;
  double largest_ = 0;
};

}  // namespace marey::detect::people
