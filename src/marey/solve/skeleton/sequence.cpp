#include "marey/solve/skeleton/sequence.h"

#include "marey/solve/skeleton/smooth.h"
#include "marey/solve/skeleton/whole.h"

namespace marey::solve::skeleton {

SolvedSequence solve_sequence(const Skeleton& skeleton, std::span<const ObservedMarkers> frames, double rate_hz,
                              const SequenceOptions& options) {
  SolvedSequence solved;
  PoseSolver solver(skeleton, options.pose);
  for (const ObservedMarkers& detected : frames) {
    const SolvedPose& pose = solver.step(1 / rate_hz, detected);
    solved.rows.push_back(pose.coordinates);
    solved.observed.push_back(pose.observed);
    solved.rms_m.push_back(pose.rms_m);
  }
  if (!options.whole && !options.smooth) return solved;
  if (options.whole) settle_folds(skeleton, solved.rows, frames, rate_hz, options.pose);
  if (options.smooth) solved.rows = smooth(skeleton, solved.rows, frames, rate_hz);
  solver.learn_noise_of(solved.rows, frames);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const SolvedPose& pose = solver.inspect_at(solved.rows[f], frames[f]);
    solved.observed[f] = pose.observed;
    solved.rms_m[f] = pose.rms_m;
  }
  return solved;
}

}  // namespace marey::solve::skeleton
