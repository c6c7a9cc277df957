#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "marey/core/sink.h"
#include "marey/pipeline/live/live.h"

#include "stream_options.h"
#include "viewer/live_viewer.h"

namespace marey::cli {

/// Where what runs is shown and sent to, beside the take.
struct LiveOutputOptions {
  StreamArguments streams;
  bool view = false;
  viewer::ListenAddress web;
  std::string take;  ///< what the page's record button records into; empty: it has none
  std::string rig;   ///< the rig file that the page's changes are saved in; empty: no such file
};

/// What of a live run its page may change.
struct LiveHandles {
  std::shared_ptr<source::LiveTime> time;                       ///< the run's
  std::shared_ptr<pipeline::corridor::RecordSwitch> recording;  ///< null: nothing is recorded
  std::shared_ptr<pipeline::live::CameraSettings> camera_settings;
  std::shared_ptr<pipeline::markers::TrackNaming> naming;
};

void add_live_outputs(Command& command, LiveOutputOptions& options);

/// The wires and the page of one live run. Their ports are taken, and their addresses reported, from the beginning on.
class LiveOutputs {
 public:
  /// `finds_markers`: whether cameras' images are searched for markers. `ground`: of people on it, what the page shows.
  LiveOutputs(const LiveOutputOptions& options, LiveHandles handles, bool finds_markers, viewer::LiveGround ground, bool quiet);

  std::vector<std::unique_ptr<Sink>> sinks();
  /// What the page says of cameras and losses.
  void report(const pipeline::corridor::LiveStatus& status);
  const stream::Streams& streams() const { return streams_; }

 private:
  viewer::LiveReport::Camera camera_of(const CameraHealth& camera, std::size_t index) const;
  void take_news(const pipeline::corridor::LiveStatus& status);

  std::string take_;
  LiveHandles handles_;
  bool finds_markers_;
  stream::Streams streams_;
  std::deque<std::pair<double, std::string>> news_;  // when they came, s of the run; the page shows them for a while
  std::int64_t news_count_ = 0;
  std::unique_ptr<viewer::LiveViewer> viewer_;
};

}  // namespace marey::cli
