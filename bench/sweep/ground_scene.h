#pragma once

// What the sweeps over people on the ground share: a naive tracker to compare with, and a run of ours over a folder.

#include <string>
#include <vector>

#include "marey/evaluate/ground_evaluation.h"
#include "marey/pipeline/people/ground/people_on_ground.h"

namespace marey::sweep {

struct GroundScores {
  double mota = 0, idf1 = 0, hota = 0;
  int people = 0, tracks = 0;
  std::int64_t switches = 0;
  double median_error = 0;  ///< m
};

/// Tracks of a folder with rig.toml, truth.csv and each camera's boxes, evaluated at `farthest` m.
GroundScores run_ours(const std::string& folder, const pipeline::people::ground::PeopleOnGroundOptions& options,
                      double farthest = 1);

/// A tracker as one writes in an afternoon: boxes' feet through the calibration, places of one instant within 0.8 m from other
/// cameras are one if two at least see it, the nearest continues at constant velocity (assignment of least distance, at most 1.2
/// m), 1 s of patience.
GroundScores run_naive(const std::string& folder, double farthest = 1);

/// A table in Markdown: its titles, and a row.
void print_titles();
void print_scores(int seed, const std::string& name, const GroundScores& scores);

/// A fresh folder that goes with the object.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace marey::sweep
