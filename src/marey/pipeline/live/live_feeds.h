// Cameras that are live, from their names to their feeds.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/live/camera_settings.h"
#include "marey/source/live/kinds.h"

namespace marey::pipeline::live {

/// Every kind of live source that this build knows: the register of all that a rig or a command line may name.
std::vector<source::live::Kind> live_kinds();

/// A rig of sources as a command line names them, SOURCE or NAME=SOURCE: what is not named, and has no name of its own, is cam1,
/// cam2, …; a path is a video, or a folder of images, that is played. A name that stands for several cameras brings them all, with
/// their calibration and their ground where they are known. Throws Error for what names nothing, for a name given twice, and where
/// two bring grounds that differ.
Rig rig_of_sources(std::span<const std::string> sources);

/// The rig's cameras, each read on a thread of its own and connected again, without end, whenever it is not there. Returns when all
/// are there, or after `patience_s`: those that are not yet are *connecting*. A camera without a source gives nothing. Throws Error
/// where no camera has a source, a source cannot be meant, or a camera's images do not fit its calibration. `desk` is what of
/// them can be changed while they run; without it they are set as the rig says.
std::vector<corridor::Feed> open_live_feeds(const Rig& rig, const source::LivePolicy& policy, double patience_s,
                                            CameraSettings* camera_settings = nullptr,
                                            const std::stop_token& stop = StopScope::current());

}  // namespace marey::pipeline::live
