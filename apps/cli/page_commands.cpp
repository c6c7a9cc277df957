#include "page_commands.h"

#include <utility>
#include <variant>

#include "marey/core/error.h"

namespace marey::cli {
namespace {

/// Camera numbers come from a page.
std::size_t within(CameraId camera, const pipeline::live::CameraSettings& camera_settings) {
  const auto index = static_cast<std::size_t>(number(camera));
  if (index >= camera_settings.size()) throw Error("there is no camera {}", index + 1);
  return index;
}

struct Changes {
  std::shared_ptr<pipeline::live::CameraSettings> camera_settings;
  std::shared_ptr<pipeline::markers::TrackNaming> naming;
  std::string rig_file;

  void operator()(const viewer::SetCameraControl& required) const {
    using source::live::Control;
    const Control control = required.name == "gain" ? Control::gain : Control::exposure;
    camera_settings->controls(within(required.camera, *camera_settings))->request(control, required.value);
  }
  void operator()(const viewer::SetThreshold& required) const {
    camera_settings->set_threshold(within(required.camera, *camera_settings), required.level);
  }
  void operator()(const viewer::ChangeMasks& required) const {
    using What = viewer::ChangeMasks::What;
    pipeline::corridor::MarkerTuning& tuning = *camera_settings->tuning(within(required.camera, *camera_settings));
    if (required.what == What::add) tuning.mask(*required.part);
    if (required.what == What::remove) tuning.unmask(*required.part);
    if (required.what == What::remove_all) tuning.set_masks({});
    if (required.what == What::learn_lit) tuning.mask_lit();
  }
  void operator()(const viewer::NameTrack& required) const {
    if (naming != nullptr) naming->name(required.track, required.label);
  }
  void operator()(const viewer::SaveRig& /*wanted*/) const {
    if (rig_file.empty()) throw Error("{}", "there is no rig file to save in; begin with one: marey cameras -o rig.toml writes it");
    camera_settings->save(rig_file);
  }
};

}  // namespace

std::function<void(const viewer::PageCommand&)> page_changes(std::shared_ptr<pipeline::live::CameraSettings> camera_settings,
                                                             std::shared_ptr<pipeline::markers::TrackNaming> naming,
                                                             std::string rig_file) {
  return [changes = Changes{std::move(camera_settings), std::move(naming), std::move(rig_file)}](
             const viewer::PageCommand& command) { std::visit(changes, command); };
}

bool is_for_this_computer(const std::string& listen) {
  return listen.starts_with("127.") || listen == "::1" || listen == "localhost";
}

void report_changeable(viewer::LiveReport::Camera& reported, const pipeline::live::CameraSettings::Camera& set) {
  using source::live::Control;
  reported.threshold = set.markers.threshold;
  reported.masks = set.markers.masks;
  reported.learning = set.markers.learning;
  reported.refused = set.refused;
  for (const source::live::ControlRange& range : set.controls) {
    if (range.control == Control::threshold) {  // of who finds the markers in its place; the page has one for it
      reported.threshold = range.now > 0 ? std::optional(range.now) : std::nullopt;
      continue;
    }
    const char* unit = range.control == Control::exposure ? "ms" : "";
    reported.controls.push_back({std::string(to_string(range.control)), unit, range.minimum, range.maximum, range.now});
  }
}

}  // namespace marey::cli
