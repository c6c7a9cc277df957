// The job from a rig's cameras, or what another program saw in them, to markers in space.
#pragma once

#include <string>

#include "marey/core/rig.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/markers/markers_in_space.h"

namespace marey::pipeline::markers {

/// Places and follows the markers that a calibrated rig sees, and writes them to `out`: NAME.marey is a take, written as it grows;
/// other endings that format/motion.h knows (.c3d, .trc, .csv) are written at the end, out of a take that is then removed.
/// `observations` names what another program saw, in place of the rig's sources; empty for none. A take's own names are kept where
/// `options` bring none. Memory does not grow with the
/// recording. Throws Error if an input cannot be read or the take cannot be written.
corridor::Summary reconstruct(const Rig& rig, const std::string& observations, const std::string& out,
                              const MarkersInSpaceOptions& options = {}, const Hooks& hooks = {});
/// The same, into sinks of the caller's.
corridor::Summary reconstruct(const Rig& rig, const std::string& observations, corridor::Sinks& sinks,
                              const MarkersInSpaceOptions& options = {}, const Hooks& hooks = {});

}  // namespace marey::pipeline::markers
