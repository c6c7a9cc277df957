#include "live_outputs.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "page_commands.h"
#include "view_options.h"

namespace marey::cli {
namespace {

constexpr double kNewsShown_s = 15;

std::function<void(bool on)> switching(const std::shared_ptr<pipeline::corridor::RecordSwitch>& recording,
                                       const std::string& take) {
  if (recording == nullptr || take.empty()) return {};
  return [recording](bool on) { recording->set(on); };
}

std::function<void(const viewer::PageCommand&)> changing(const LiveOutputOptions& options, const LiveHandles& handles) {
  if (!is_for_this_computer(options.web.listen) && !options.streams.allow_control) return {};
  return page_changes(handles.camera_settings, handles.naming, options.rig);
}

}  // namespace

void add_live_outputs(Command& command, LiveOutputOptions& options) {
  command.group("To be watched");
  command.flag("--view", options.view, "a page that shows the cameras and what is found in them; its address is printed");
  add_listen_address(command, options.web);
  command.group("");
  add_stream_options(command, options.streams, "; a page that others can open (--listen) may change cameras and names");
}

LiveOutputs::LiveOutputs(const LiveOutputOptions& options, LiveHandles handles, bool finds_markers, viewer::LiveGround ground,
                         bool quiet)
    : take_(options.take),
      handles_(std::move(handles)),
      finds_markers_(finds_markers),
      streams_(open_streams(options.streams, quiet, [record = switching(handles_.recording, options.take)](bool on) {
        if (record) record(on);
        return bool{record};
      })) {
  streams_.clock().set(handles_.time->now(), stream::steady_now_ns());
  if (!options.view) return;
  viewer_ = std::make_unique<viewer::LiveViewer>(viewer::LiveViewOptions{.location = options.web,
                                                                         .record = switching(handles_.recording, options.take),
                                                                         .change = changing(options, handles_),
                                                                         .rig_file = options.rig,
                                                                         .now = [time = handles_.time] { return time->now(); },
                                                                         .ground_area = std::move(ground)});
  fmt::print(stderr, "marey: open {} in a browser\n", viewer_->address());
}

std::vector<std::unique_ptr<Sink>> LiveOutputs::sinks() {
  std::vector<std::unique_ptr<Sink>> sinks = streams_.sinks();
  if (viewer_) sinks.push_back(viewer_->make_sink());
  return sinks;
}

viewer::LiveReport::Camera LiveOutputs::camera_of(const CameraHealth& camera, std::size_t index) const {
  viewer::LiveReport::Camera reported{.health = camera, .finds_markers = finds_markers_};
  report_changeable(reported, handles_.camera_settings->camera(index));
  return reported;
}

void LiveOutputs::take_news(const pipeline::corridor::LiveStatus& status) {
  const std::int64_t fresh = std::min<std::int64_t>(status.news_count - news_count_, std::ssize(status.news));
  for (auto one = status.news.end() - fresh; one != status.news.end(); ++one) news_.emplace_back(status.seconds, *one);
  news_count_ = status.news_count;
  while (!news_.empty() && status.seconds - news_.front().first > kNewsShown_s) news_.pop_front();
}

void LiveOutputs::report(const pipeline::corridor::LiveStatus& status) {
  if (!viewer_) return;
  take_news(status);
  viewer::LiveReport report{.cameras = {},
                            .superseded = status.drops.superseded,
                            .steps = {},
                            .unsaved = handles_.camera_settings->has_changed(),
                            .notes = status.troubles};
  for (const auto& [when, sentence] : news_) report.notes.push_back(sentence);
  for (const CameraHealth& camera : status.cameras) {
    report.cameras.push_back(camera_of(camera, report.cameras.size()));
    if (!camera.trouble.empty()) report.notes.push_back(camera.trouble);
  }
  if (status.latency_median_s && status.latency_p99_s)
    report.steps.push_back({.name = "capture to instant", .median = *status.latency_median_s, .p99 = *status.latency_p99_s});
  viewer_->report(report);
  viewer_->recording(status.recording, take_);
}

}  // namespace marey::cli
