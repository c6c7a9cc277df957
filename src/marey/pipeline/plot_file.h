#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "marey/core/whole_file.h"
#include "marey/draw/trajectory_plot.h"

namespace marey::pipeline {

/// A plot of trajectories that becomes a file at the end of a run; that it can be written shows at the beginning.
class PlotFile {
 public:
  /// Throws Error where nothing can be written at `path`.
  PlotFile(const std::string& path, std::string title) : file_(path), title_(std::move(title)) {}

  void add(std::int64_t frame, std::span<const Track<2>> tracks) { plot_.add(frame, tracks); }

  /// Throws Error where the place is full.
  void finish() {
    file_.write(plot_.to_svg(title_));
    file_.finish();
  }

 private:
  WholeFile file_;
  std::string title_;
  draw::TrajectoryPlot plot_;
};

}  // namespace marey::pipeline
