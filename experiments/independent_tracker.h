// The tracker of the OpenMoCap paper: every target for itself. A target takes the nearest point within its own filter's search
// area, whether or not another target has taken the same point. Targets begin at the points of the first frame that has any, and
// are never lost: where nothing is found the filter coasts. This is what the global assignment of `FilterTracker` and
// `RosterTracker` is measured against; it is for experiments, not for use.
//
// Source: Queiroz, Gomide, de Albuquerque Araujo, "Evaluation of Real Time Tracking Methods for an Open Source Motion Capture
// System", §I and §IV. Cost: targets × points a step.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/filter/any_filter.h"
#include "marey/track/immediate_tracker.h"

namespace marey::experiments {

class IndependentTracker final : public track::ImmediateTracker<2> {
 public:
  explicit IndependentTracker(const filter::FilterOptions& options) : options_(options) {}

  using ImmediateTracker<2>::step;
  std::span<const Track<2>> step(Timestamp now, std::span<const track::CameraObservations<2>> views) override;
  std::span<const Track<2>> expected(Timestamp now) override;

 private:
  struct Target {
    filter::AnyFilter<2> filter;
    std::optional<int> observation = {};
  };

  static void step_target(Target& target, double dt, std::span<const Observation<2>> detected);
  std::span<const Track<2>> report(std::span<const Target> targets);

  filter::FilterOptions options_;
  std::vector<Target> targets_;
};

}  // namespace marey::experiments
