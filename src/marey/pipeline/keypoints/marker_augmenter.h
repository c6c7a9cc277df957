// OpenCap's marker augmenter: of a person's keypoints, height and mass 43 markers on bony landmarks and clusters, by two networks
// that learned from 108 hours of markers (Uhlrich, Falisse et al. 2023, "OpenCap", PLoS Computational Biology 19; Falisse et al.
// 2024, IEEE Transactions on Biomedical Engineering). The keypoints are taken from the middle of the hips and divided by the
// height. Their answer depends on where a person faces, by 3 mm (RMS, walks): it is asked with the same motion turned in steps of
// 45°, and averaged, so that the same walk in another direction gives the same markers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "marey/core/geometry.h"
#include "marey/detect/network/lstm_network.h"
#include "marey/pipeline/keypoints/augmenter_input.h"

namespace marey::pipeline::keypoints {

inline constexpr std::size_t kAugmentedMarkers = 43, kLegMarkers = 35;  // format: of the networks

struct AugmentedMarker {
  std::string_view label;     ///< as OpenCap calls it: "r.ASIS_study"
  std::string_view landmark;  ///< of analyse/gait/anatomical_pose.h; empty for clusters and the neck
};
/// In the networks' order; the first 35 need no arms.
std::span<const AugmentedMarker> augmented_markers();

/// One step as the networks have it: without errors, and drawn with the keypoints' errors.
struct AugmentedStep {
  using Markers = std::array<Vector<3>, kAugmentedMarkers>;
  using Shoulders = std::array<Vector<3>, 2>;  ///< the keypoints: right, left

  Markers mean;
  Shoulders shoulders;
  std::vector<Markers> draws;  ///< empty if the keypoints have no covariance
  std::vector<Shoulders> drawn_shoulders;
};

struct AugmenterPerson {
  double height_m = 0, mass_kg = 0;
};

class MarkerAugmenter {
 public:
  /// Throws Error if a file cannot be read, or is another network.
  MarkerAugmenter(const std::string& lower, const std::string& upper);

  /// Each step of a run in its order. With `covariances` the keypoints are drawn 16 times; the same seed gives the same draws.
  void augment(const AugmenterRun& run, const AugmenterPerson& person, bool arms, bool covariances, std::uint64_t seed,
               const std::function<void(std::size_t step, const AugmentedStep& made)>& take) const;

 private:
  detect::network::LstmNetwork lower_, upper_;
};

}  // namespace marey::pipeline::keypoints
