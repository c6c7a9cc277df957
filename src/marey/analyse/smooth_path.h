// A person's path over the ground, made smooth, and the velocity along it.
//
// Positions from video jump about by decimetres from frame to frame; differences of them as they are add up to a distance that can
// be 40 % too long and to impossible speeds. People change their velocity slowly: what is faster than about 1 Hz is noise.
//   lowpass  Butterworth, order 2, forwards and backwards, so that nothing lags; its cut-off is that of both passes together
//   savgol   a parabola through the second round each instant (Savitzky & Golay 1964)
//   kalman   constant velocity with noise in the acceleration, smoothed from both ends (Rauch, Tung & Striebel 1965)
//   raw      as measured; velocities are differences
// Paths are cut where a person is missing for long; short gaps are bridged straight. Each piece is brought to an even rate first.
// What no person can have done (filter/human_motion.h) is omitted before: it is bridged where one person can have gone over it,
// else the path is cut there. Places that were not measured lie straight between those that were, and speeds are trusted where
// measured places give them: not where a tracker filled a gap or ran on blindly. References: Winter, "Biomechanics and Motor
// Control of Human Movement", ch. 2 (cut-off of two passes); Barris & Button 2008.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/recording.h"

namespace marey::analyse {

struct PathOptions {
  enum class Method { lowpass, savgol, kalman, raw };

  Method method = Method::lowpass;
  double cutoff_hz = 1;          ///< lowpass
  double window_s = 1;           ///< savgol
  double position_noise = 0.3;   ///< kalman: m, of a measured place
  double acceleration = 1.5;     ///< kalman: m/s^1.5
  double longest_gap_s = 1;      ///< a person missing for longer is on another path afterwards
  double position_sigma = 0.15;  ///< m, of a measured place of which the recording does not specify it, once it is smoothed
};

/// Throws Error, naming what is valid, for a name that is not one.
PathOptions::Method parse_path_method(std::string_view name);

/// One unbroken path at an even rate.
struct Path {
  double start_s = 0;
  double step_s = 0.04;
  std::vector<Vector<2>> location;      ///< m
  std::vector<Vector<2>> velocity;      ///< m/s
  std::vector<Vector<2>> acceleration;  ///< m/s²
  std::vector<bool> detected;           ///< measured places give the speed there, to 0.75 m/s: only such speeds are trusted
  std::vector<double> speed_sigma;      ///< m/s, standard deviation of the speed

  double seconds() const { return step_s * static_cast<double>(location.empty() ? 0 : location.size() - 1); }
};

/// A period of time in which a person is reported to have done what no person can.
struct ImpossibleSegment {
  double begin_s = 0, end_s = 0;
  bool one_person = true;  ///< places are wrong; else who is there afterwards is another person
};

/// The remainder of a person's rows, and the parts not trusted.
struct PersonPaths {
  std::vector<Path> paths;
  std::vector<ImpossibleSegment> impossible;
  bool measured = false;  ///< at some instant
};

/// The path of the one who was at (x, y) m at these times, s. Rows whose time is not later than the one's before are skipped,
/// pieces of fewer than two places omitted. All are taken for measured.
std::vector<Path> smooth_paths(std::span<const double> times, std::span<const double> x, std::span<const double> y,
                               const PathOptions& options = {});

/// The same of a track of a recording in m. Where the recording is smoothed already it is not smoothed again: places and velocities
/// are those that it has (velocities that are missing are differences), so that who measures finds the speeds that were recorded.
PersonPaths paths_of(const Recording& recording, const TrackColumns& track, const PathOptions& options = {});

}  // namespace marey::analyse
