// What pages change of live cameras, and how it is reported to them: of a live run, and of a wand that is waved.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "marey/pipeline/live/camera_settings.h"
#include "marey/pipeline/markers/track_naming.h"

#include "viewer/live_viewer.h"

namespace marey::cli {

/// Does what a page asks for. Names are given where there is `naming`; `rig_file` is what Save writes, empty: nothing.
std::function<void(const viewer::PageCommand&)> page_changes(std::shared_ptr<pipeline::live::CameraSettings> camera_settings,
                                                             std::shared_ptr<pipeline::markers::TrackNaming> naming,
                                                             std::string rig_file);

/// Whether a page at this address is for who sits at this computer alone.
bool is_for_this_computer(const std::string& listen);

/// What of a camera can be changed, as a page is reported it.
void report_changeable(viewer::LiveReport::Camera& reported, const pipeline::live::CameraSettings::Camera& set);

}  // namespace marey::cli
