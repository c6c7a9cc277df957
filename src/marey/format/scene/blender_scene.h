#pragma once

#include <memory>
#include <string>

#include "marey/core/sink.h"

namespace marey::format::scene {

/// Writes a recording in space as a Python script that builds it in Blender: cameras with their videos behind them, markers, and
/// skeletons; m, z up, a frame an instant. Needs all of it, so that memory grows with the length. `begin` throws Error if a
/// recording is not in space.
std::unique_ptr<Sink> create_blender_scene(const std::string& path);

}  // namespace marey::format::scene
