#include "live_outputs.h"

#include <string>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "marey/core/error.h"

#include "view_options.h"

namespace marey::cli {
namespace {

std::function<void(bool on)> switching(const std::shared_ptr<pipeline::RecordSwitch>& recording, const std::string& take) {
  if (recording == nullptr || take.empty()) return {};
  return [recording](bool on) { recording->set(on); };
}

bool is_loopback(const std::string& listen) {
  return listen.starts_with("127.") || listen == "::1" || listen == "localhost";
}

/// Camera numbers come from a page.
std::size_t within(CameraId camera, const pipeline::CameraDesk& desk) {
  const auto index = static_cast<std::size_t>(number(camera));
  if (index >= desk.size()) throw Error("there is no camera {}", index + 1);
  return index;
}

/// Does what a page asks for.
struct Changes {
  LiveHandles handles;
  std::string rig;

  void operator()(const viewer::TurnDial& wanted) const {
    using source::live::Control;
    const Control control = wanted.name == "gain" ? Control::gain : Control::exposure;
    handles.desk->controls(within(wanted.camera, *handles.desk))->ask(control, wanted.value);
  }
  void operator()(const viewer::SetThreshold& wanted) const {
    handles.desk->set_threshold(within(wanted.camera, *handles.desk), wanted.level);
  }
  void operator()(const viewer::ChangeMasks& wanted) const {
    using What = viewer::ChangeMasks::What;
    pipeline::MarkerTuning& tuning = *handles.desk->tuning(within(wanted.camera, *handles.desk));
    if (wanted.what == What::add) tuning.mask(wanted.part);
    if (wanted.what == What::remove) tuning.unmask(wanted.part);
    if (wanted.what == What::remove_all) tuning.set_masks({});
    if (wanted.what == What::learn_lit) tuning.mask_lit();
  }
  void operator()(const viewer::NameTrack& wanted) const { handles.naming->name(wanted.track, wanted.label); }
  void operator()(const viewer::SaveRig& /*wanted*/) const {
    if (rig.empty()) throw Error("{}", "there is no rig file to save in; begin with one: marey cameras -o rig.toml writes it");
    handles.desk->save(rig);
  }
};

std::function<void(const viewer::PageCommand&)> changing(const LiveOutputOptions& options, const LiveHandles& handles) {
  if (!is_loopback(options.web.listen) && !options.streams.allow_control) return {};
  return [changes = Changes{handles, options.rig}](const viewer::PageCommand& command) { std::visit(changes, command); };
}

}  // namespace

void add_live_outputs(Command& command, LiveOutputOptions& options) {
  command.group("To be watched");
  command.flag("--view", options.view, "a page that shows the cameras and what is found in them; its address is printed");
  add_web_place(command, options.web);
  command.group("");
  add_stream_options(command, options.streams, "; a page that others can open (--listen) may change cameras and names");
}

LiveOutputs::LiveOutputs(const LiveOutputOptions& options, LiveHandles handles, bool finds_markers, bool quiet)
    : take_(options.take),
      handles_(std::move(handles)),
      finds_markers_(finds_markers),
      streams_(open_streams(options.streams, quiet, [record = switching(handles_.recording, options.take)](bool on) {
        if (record) record(on);
        return bool{record};
      })) {
  streams_.clock().set(handles_.time->now(), stream::steady_now_ns());
  if (!options.view) return;
  viewer_ = std::make_unique<viewer::LiveViewer>(viewer::LiveViewOptions{.place = options.web,
                                                                         .record = switching(handles_.recording, options.take),
                                                                         .change = changing(options, handles_),
                                                                         .rig_file = options.rig,
                                                                         .now = [time = handles_.time] { return time->now(); }});
  fmt::print(stderr, "marey: open {} in a browser\n", viewer_->address());
}

std::vector<std::unique_ptr<Sink>> LiveOutputs::sinks() {
  std::vector<std::unique_ptr<Sink>> sinks = streams_.sinks();
  if (viewer_) sinks.push_back(viewer_->make_sink());
  return sinks;
}

viewer::LiveReport::Camera LiveOutputs::camera_of(const pipeline::LiveStatus::Camera& camera, std::size_t index) const {
  const pipeline::CameraDesk::Camera set = handles_.desk->camera(index);
  viewer::LiveReport::Camera told{.state = camera.state,
                                  .rate_hz = camera.rate_hz > 0 ? std::optional(camera.rate_hz) : std::nullopt,
                                  .frames = camera.frames,
                                  .dropped = camera.lost + camera.damaged + camera.overrun,
                                  .finds_markers = finds_markers_,
                                  .threshold = set.markers.threshold,
                                  .masks = set.markers.masks,
                                  .learning = set.markers.learning,
                                  .refused = set.refused};
  for (const source::live::ControlRange& range : set.controls) {
    const char* unit = range.control == source::live::Control::exposure ? "ms" : "";
    told.dials.push_back({std::string(to_string(range.control)), unit, range.least, range.most, range.now});
  }
  return told;
}

void LiveOutputs::report(const pipeline::LiveStatus& status) {
  if (!viewer_) return;
  viewer::LiveReport report{.cameras = {},
                            .overtaken = status.drops.overtaken,
                            .steps = {},
                            .unsaved = handles_.desk->has_changed(),
                            .notes = status.troubles};
  for (const pipeline::LiveStatus::Camera& camera : status.cameras) {
    report.cameras.push_back(camera_of(camera, report.cameras.size()));
    if (!camera.trouble.empty()) report.notes.push_back(camera.trouble);
  }
  if (status.latency_median_s && status.latency_p99_s)
    report.steps.push_back({.name = "capture to instant", .median = *status.latency_median_s, .p99 = *status.latency_p99_s});
  viewer_->report(report);
  viewer_->recording(status.recording, take_);
}

}  // namespace marey::cli
