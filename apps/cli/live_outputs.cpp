#include "live_outputs.h"

#include <utility>

#include <fmt/core.h>

#include "view_options.h"

namespace marey::cli {
namespace {

std::function<void(bool on)> switching(const std::shared_ptr<pipeline::RecordSwitch>& recording, const std::string& take) {
  if (recording == nullptr || take.empty()) return {};
  return [recording](bool on) { recording->set(on); };
}

viewer::LiveReport::Camera camera_of(const pipeline::LiveStatus::Camera& camera) {
  return {.state = camera.state,
          .rate_hz = camera.rate_hz > 0 ? std::optional(camera.rate_hz) : std::nullopt,
          .frames = camera.frames,
          .dropped = camera.lost + camera.damaged + camera.overrun};
}

}  // namespace

void add_live_outputs(Command& command, LiveOutputOptions& options) {
  command.group("To be watched");
  command.flag("--view", options.view, "a page that shows the cameras and what is found in them; its address is printed");
  add_web_place(command, options.web);
  command.group("");
  add_stream_options(command, options.streams);
}

LiveOutputs::LiveOutputs(const LiveOutputOptions& options, const std::shared_ptr<source::LiveTime>& time,
                         const std::shared_ptr<pipeline::RecordSwitch>& recording, bool quiet)
    : take_(options.take), streams_(open_streams(options.streams, quiet, [record = switching(recording, options.take)](bool on) {
        if (record) record(on);
        return bool{record};
      })) {
  streams_.clock().set(time->now(), stream::steady_now_ns());
  if (!options.view) return;
  viewer_ = std::make_unique<viewer::LiveViewer>(viewer::LiveViewOptions{
      .place = options.web, .record = switching(recording, options.take), .now = [time] { return time->now(); }});
  fmt::print(stderr, "marey: open {} in a browser\n", viewer_->address());
}

std::vector<std::unique_ptr<Sink>> LiveOutputs::sinks() {
  std::vector<std::unique_ptr<Sink>> sinks = streams_.sinks();
  if (viewer_) sinks.push_back(viewer_->make_sink());
  return sinks;
}

void LiveOutputs::report(const pipeline::LiveStatus& status) {
  if (!viewer_) return;
  viewer::LiveReport report{.cameras = {}, .overtaken = status.drops.overtaken, .steps = {}, .notes = status.troubles};
  for (const pipeline::LiveStatus::Camera& camera : status.cameras) {
    report.cameras.push_back(camera_of(camera));
    if (!camera.trouble.empty()) report.notes.push_back(camera.trouble);
  }
  if (status.latency_median_s && status.latency_p99_s)
    report.steps.push_back({.name = "capture to instant", .median = *status.latency_median_s, .p99 = *status.latency_p99_s});
  viewer_->report(report);
  viewer_->recording(status.recording, take_);
}

}  // namespace marey::cli
