#pragma once

#include <string>
#include <vector>

#include "batch_plan.h"

namespace marey::cli {

/// One table of every person in every recording, and why there is less than planned.
struct Season {
  struct Failure {
    int number = 0;
    std::string name, why;
  };
  std::vector<std::string> columns;            ///< "recording" first; those of `marey measure`, else what a recording counts
  std::vector<std::vector<std::string>> rows;  ///< a row a person and recording
  std::vector<Failure> failures;               ///< failed, not run, or with a result that cannot be read
  int done = 0;
  double seconds = 0;  ///< of all tasks that are done
  int peak_mb = 0;     ///< the most that one of them took
  int planned_mb = 0;  ///< the expectation for that one
};

/// Throws Stopped.
Season reduce(const BatchPlan& plan);

std::string season_csv(const Season& season);

}  // namespace marey::cli
