#pragma once

#include <optional>
#include <vector>

#include "marey/calibrate/wand.h"
#include "marey/calibrate/wand_table.h"

namespace marey {

/// The last steps of a wand's calibration: every view looked at again, and everything adjusted.
class WandFit {
 public:
  /// `start` has the cameras where the growth left them. Offsets found are added to the tracks'.
  WandFit(const WandInput& input, std::vector<MarkTrack>& tracks, const Bundle& start, double noise_px);

  /// Holds the lenses that were given, or frees them; those that were not are always estimated.
  void free_lenses(bool given_too);

  /// Looks where the wand must be, in every frame of every camera, and makes the bundle of it.
  void claim();

  /// Adjusts by nine tenths of the instants, with the cameras' time offsets where `find_offsets`, and judges the others;
  /// where the wand is long enough known for that. Samples are taken anew where an offset is found.
  void adjust_held_out(bool find_offsets, std::optional<HeldOutReport>& report);

  /// px, each axis, by a part of what was seen.
  struct Noise {
    double held = 0, refined = 0;
  };
  Noise noise_held_and_refined() const;

  BundleResult adjust_all();

  Bundle& bundle() { return bundle_; }

 private:
  void gather();
  bool take_over_offsets(const BundleResult& fit);

  const WandInput& in_;
  std::vector<MarkTrack>& tracks_;
  Bundle bundle_;
  double noise_px_;
  std::vector<double> instants_;
  std::vector<std::optional<Body>> bodies_;
};

}  // namespace marey
