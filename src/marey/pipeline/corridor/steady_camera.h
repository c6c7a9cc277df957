#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "marey/core/frame.h"
#include "marey/core/rig.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/source/steady/steadier.h"

namespace marey::pipeline::corridor {

/// A camera that ought to stand and shakes: its feed gives pictures as the camera at rest would have taken them
/// (source/steady/standing_scene.h). Those that cannot be steadied are left out, and their time passes.
class SteadyCamera {
 public:
  /// The scene is learned from the beginning first, unless `live` or the pictures cannot be read twice: where few of those pictures
  /// can be steadied, none are. Throws Error where they show nothing that could be held on to, or cannot be read.
  SteadyCamera(const RigCamera& camera, const FeedOptions& options, bool live);

  /// Whether the pictures are steadied.
  bool steadies() const;
  /// What the camera's feed is opened with.
  FeedOptions feed_options() const;
  /// How far the camera moved goes among the notes; what was lost, and whether it was turned for good, among the warnings.
  void report(Summary& summary) const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  RigCamera camera_;
  FeedOptions options_;
  bool opens_again_;
};

/// px root mean square, from which on people are lost to a camera's shaking (docs/tuning.md).
inline constexpr double kShakes = 1.5;
/// What the user should know of a camera that shakes so much.
std::string shaking_warning(double px);

/// What the user should know where `samples` of a camera that is not steadied show that it shakes; else nothing.
std::optional<std::string> shaking(std::span<const Frame> samples);

}  // namespace marey::pipeline::corridor
