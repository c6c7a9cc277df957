#pragma once

#include <optional>
#include <vector>

#include "marey/calibrate/wand/wand.h"
#include "marey/calibrate/wand/wand_table.h"

namespace marey::calibrate::wand {

/// The last steps of a wand's calibration: every view inspected again, and everything adjusted.
class WandFit {
 public:
  /// `start` has the cameras where the growth left them. Offsets found are added to the tracks'.
  WandFit(const WandInput& input, std::vector<MarkTrack>& tracks, const bundle::Bundle& start, double noise_px);

  /// Holds the lenses that were given, or frees them; those that were not are always estimated.
  void free_lenses(bool given_too);

  /// Searches where the wand must be, in every frame of every camera, and makes the bundle of it.
  void match_blobs();

  /// Adjusts by nine tenths of the instants, with the cameras' time offsets where `find_offsets`, and evaluates the others;
  /// where the wand is long enough known for that. Samples are taken again where an offset is found.
  void adjust_held_out(bool find_offsets, std::optional<HeldOutReport>& report);

  /// px, each axis, by a part of the observations.
  struct Noise {
    double held = 0, refined = 0;
  };
  Noise noise_held_and_refined() const;

  bundle::BundleResult adjust_all();

  bundle::Bundle& bundle() { return bundle_; }

 private:
  void gather();
  bool take_over_offsets(const bundle::BundleResult& fit);

  const WandInput& in_;
  std::vector<MarkTrack>& tracks_;
  bundle::Bundle bundle_;
  double noise_px_;
  std::vector<double> instants_;
  std::vector<std::optional<bundle::Body>> bodies_;
};

}  // namespace marey::calibrate::wand
