#include "page_changes.h"

#include <utility>
#include <variant>

#include "marey/core/error.h"

namespace marey::cli {
namespace {

/// Camera numbers come from a page.
std::size_t within(CameraId camera, const pipeline::live::CameraDesk& desk) {
  const auto index = static_cast<std::size_t>(number(camera));
  if (index >= desk.size()) throw Error("there is no camera {}", index + 1);
  return index;
}

struct Changes {
  std::shared_ptr<pipeline::live::CameraDesk> desk;
  std::shared_ptr<pipeline::markers::TrackNaming> naming;
  std::string rig_file;

  void operator()(const viewer::TurnDial& wanted) const {
    using source::live::Control;
    const Control control = wanted.name == "gain" ? Control::gain : Control::exposure;
    desk->controls(within(wanted.camera, *desk))->ask(control, wanted.value);
  }
  void operator()(const viewer::SetThreshold& wanted) const { desk->set_threshold(within(wanted.camera, *desk), wanted.level); }
  void operator()(const viewer::ChangeMasks& wanted) const {
    using What = viewer::ChangeMasks::What;
    pipeline::corridor::MarkerTuning& tuning = *desk->tuning(within(wanted.camera, *desk));
    if (wanted.what == What::add) tuning.mask(*wanted.part);
    if (wanted.what == What::remove) tuning.unmask(*wanted.part);
    if (wanted.what == What::remove_all) tuning.set_masks({});
    if (wanted.what == What::learn_lit) tuning.mask_lit();
  }
  void operator()(const viewer::NameTrack& wanted) const {
    if (naming != nullptr) naming->name(wanted.track, wanted.label);
  }
  void operator()(const viewer::SaveRig& /*wanted*/) const {
    if (rig_file.empty()) throw Error("{}", "there is no rig file to save in; begin with one: marey cameras -o rig.toml writes it");
    desk->save(rig_file);
  }
};

}  // namespace

std::function<void(const viewer::PageCommand&)> page_changes(std::shared_ptr<pipeline::live::CameraDesk> desk,
                                                             std::shared_ptr<pipeline::markers::TrackNaming> naming,
                                                             std::string rig_file) {
  return [changes = Changes{std::move(desk), std::move(naming), std::move(rig_file)}](const viewer::PageCommand& command) {
    std::visit(changes, command);
  };
}

bool is_for_this_computer(const std::string& listen) {
  return listen.starts_with("127.") || listen == "::1" || listen == "localhost";
}

void tell_changeable(viewer::LiveReport::Camera& told, const pipeline::live::CameraDesk::Camera& set) {
  using source::live::Control;
  told.threshold = set.markers.threshold;
  told.masks = set.markers.masks;
  told.learning = set.markers.learning;
  told.refused = set.refused;
  for (const source::live::ControlRange& range : set.controls) {
    if (range.control == Control::threshold) {  // of who finds the markers in its place; the page has one for it
      told.threshold = range.now > 0 ? std::optional(range.now) : std::nullopt;
      continue;
    }
    const char* unit = range.control == Control::exposure ? "ms" : "";
    told.dials.push_back({std::string(to_string(range.control)), unit, range.least, range.most, range.now});
  }
}

}  // namespace marey::cli
