#pragma once

#include <string>
#include <utility>

#include "marey/core/sink.h"
#include "marey/draw/trajectory_plot.h"
#include "marey/files/whole_file.h"

namespace marey::draw {

/// A plot of trajectories that becomes a file at the end of a run; that it can be written shows at the beginning.
class PlotFile final : public Sink {
 public:
  /// Throws Error if nothing can be written at `path`.
  explicit PlotFile(const std::string& path) : path_(path), file_(path) {}

  std::string name() const override { return path_; }
  SinkRequirements begin(const RecordingHeader& header) override {
    title_ = "Trajectories in " + header.name;
    return {};
  }
  void write(const Instant& instant) override { plot_.add(instant); }
  void finish() override {
    file_.write(plot_.to_svg(title_));
    file_.finish();
  }

 private:
  std::string path_;
  WholeFile file_;
  std::string title_;
  TrajectoryPlot plot_;
};

}  // namespace marey::draw
