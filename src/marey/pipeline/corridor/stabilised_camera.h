#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "marey/core/frame.h"
#include "marey/core/rig.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/source/stabilise/stabiliser.h"

namespace marey::pipeline::corridor {

/// A camera that ought to stand and shakes: its feed gives images as the camera at rest would have taken them
/// (source/stabilise/reference_scene.h). Those that cannot be stabilised are omitted, and their time passes.
class StabilisedCamera {
 public:
  /// The scene is learned from the beginning first, unless `live` or the images cannot be read twice: where few of those images
  /// can be stabilised, none are. Throws Error if they show nothing that could be held on to, or cannot be read.
  StabilisedCamera(const RigCamera& camera, const FeedOptions& options, bool live);

  /// Whether the images are stabilised.
  bool steadies() const;
  /// What the camera's feed is opened with.
  FeedOptions feed_options() const;
  /// How far the camera moved goes among the notes; the losses, and whether it was turned permanently, among the warnings.
  void report(Summary& summary) const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  RigCamera camera_;
  FeedOptions options_;
  bool opens_again_;
};

/// px root mean square, from which on people are lost to a camera's shaking (bench/tuning.md).
inline constexpr double kShakes = 1.5;
/// What the user should know of a shaking camera this much.
std::string shaking_warning(double px);

/// What the user should know where `samples` of a camera that is not stabilised show that it shakes; else nothing.
std::optional<std::string> shaking(std::span<const Frame> samples);

}  // namespace marey::pipeline::corridor
