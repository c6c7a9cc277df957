#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "marey/core/sink.h"
#include "marey/pipeline/live.h"

#include "stream_options.h"
#include "viewer/live_viewer.h"

namespace marey::cli {

/// Where what runs is shown and sent to, beside the take.
struct LiveOutputOptions {
  StreamArguments streams;
  bool view = false;
  viewer::WebPlace web;
  std::string take;  ///< what the page's record button records into; empty: it has none
};

void add_live_outputs(Command& command, LiveOutputOptions& options);

/// The wires and the page of one live run. Their ports are taken, and their addresses told, from the beginning on.
class LiveOutputs {
 public:
  /// `time` is the run's; `recording` may be null.
  LiveOutputs(const LiveOutputOptions& options, const std::shared_ptr<source::LiveTime>& time,
              const std::shared_ptr<pipeline::RecordSwitch>& recording, bool quiet);

  std::vector<std::unique_ptr<Sink>> sinks();
  /// What the page says of cameras and losses.
  void report(const pipeline::LiveStatus& status);
  const stream::Streams& streams() const { return streams_; }

 private:
  std::string take_;
  stream::Streams streams_;
  std::unique_ptr<viewer::LiveViewer> viewer_;
};

}  // namespace marey::cli
