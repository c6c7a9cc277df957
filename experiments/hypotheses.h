#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/simulate/encounters.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::experiments {

struct HypothesesExperimentOptions {
  int scenes = 100;  ///< of each kind of meeting
  std::uint64_t seed = 1;
  simulate::EncounterOptions encounters;
  track::ground::GroundTrackerOptions tracker;  ///< for all methods; `associate` is not inspected
};

struct HypothesesExperiment {
  /// What one method made of the scenes of one kind.
  struct Score {
    std::int64_t switches = 0;   ///< of identity, as CLEAR counts
    std::int64_t people = 0;     ///< people times frames
    std::int64_t misses = 0;     ///< of these
    std::int64_t untrusted = 0;  ///< reported where no person is
    double step_us = 0;          ///< mean time of a tracker's step
  };
  struct Row {
    std::string method;
    std::vector<Score> scores;  ///< one a kind
  };
  int scenes = 0;
  std::uint64_t seed = 0;
  std::vector<std::string> kinds;     ///< of meetings
  std::vector<int> close_encounters;  ///< of each kind
  std::vector<Row> rows;
};

/// The same scenes of people who meet and part, distinguished by place alone, followed by each association with the same filter,
/// gates, costs, birth and death. Evaluated is what the tracker has decided (GroundTracker::decided); "mht, live" is what mht
/// guessed in the step itself. A track and a person may match within 1 m.
HypothesesExperiment run_hypotheses_experiment(const HypothesesExperimentOptions& options, const Hooks& hooks = {});

/// As text: a table of switches and one of times.
std::string to_text(const HypothesesExperiment& experiment);

/// One table in Markdown: switches, with the ratio to the first method's, and missed and false, % of people and frames.
std::string to_markdown(const HypothesesExperiment& experiment);

}  // namespace marey::experiments
