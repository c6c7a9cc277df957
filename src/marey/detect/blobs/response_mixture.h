// What responses of the filter bank look like, as a mixture of Gaussians with diagonal covariances: of what is foreground one for
// the whole image, of the background one at each point of the grid.
//
// Source: Isard, MacCormick 2001, from memory (filter_bank.h): both as mixtures, learned by k-means. Remembered: four components
// for the background and sixteen for the foreground. Ours: the background of a point is learned from thirty frames in which people
// are about, too few for four components: the median frame is the first, and what is otherwise seen there in a quarter of them is a
// second; a shadow on the first is the third, because ours are outdoors.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "marey/detect/blobs/filter_bank.h"

namespace marey::detect::blobs {

/// A Gaussian with its weight in a mixture.
struct ResponseKind {
  Response mean = Response::all(0);
  Response precision = Response::all(1);  ///< 1 / variance, of each response
  float log_scale = 0;                    ///< ln of the weight times the density at the mean

  /// A kind of this weight and these standard deviations.
  static ResponseKind of(double weight, const Response& mean, const Response& sigma);
  /// ln of weight times density at `response`.
  float log_density(const Response& response) const;
};

/// ln of the density of a mixture.
float log_density(std::span<const ResponseKind> mixture, const Response& response);

/// What is not a background, from responses that were found to be none: k-means from seeded beginnings, then one pass for the
/// deviations. A broad kind of a tenth of the weight stands for what was not seen while learning; with few responses it is all
/// there is.
std::vector<ResponseKind> learn_foreground(std::span<const Response> responses, int kinds, std::uint64_t seed);

/// The responses at one point of the grid where no person stands.
class PointBackground {
 public:
  PointBackground() = default;
  /// From the responses there in some frames, in any order. `noise`: the standard deviation of each response that a point of the
  /// image has at least.
  PointBackground(std::span<const Response> detected, const Response& noise);

  float log_density(const Response& response) const { return blobs::log_density({kinds_.data(), count_}, response); }
  /// How many standard deviations `response` is from the nearest kind, over all six, as a root of mean squares.
  float distance(const Response& response) const;

 private:
  std::array<ResponseKind, 3> kinds_;
  std::size_t count_ = 0;
};

/// The standard deviation that noise gives each response, at least: the median over the grid's points. `seen` are as many grids as
/// frames, all of one size.
Response response_noise(std::span<const cv::Mat> detected);

}  // namespace marey::detect::blobs
