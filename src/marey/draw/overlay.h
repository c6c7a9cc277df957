#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>

#include "marey/core/ids.h"
#include "marey/core/image.h"
#include "marey/core/keypoints.h"
#include "marey/core/time.h"
#include "marey/core/track_names.h"
#include "marey/draw/canvas.h"
#include "marey/draw/fading_trails.h"

namespace marey::draw {

struct OverlayOptions {
  Duration trail = std::chrono::seconds(4);   ///< how long a trail takes to fade
  bool trail_of_centres = false;              ///< trails show where centres went, not feet
  std::optional<KeypointSet> keypoints = {};  ///< what the samples' body points are
  bool blur_faces = false;                    ///< heads are made unrecognisable (draw/heads.h)
  bool bare = false;                          ///< nothing is drawn
};

/// What a track is drawn in: its own colour, or one that is steady by its number.
Colour colour_of(const TrackName& name, TrackId id);

/// Draws the targets into the images of a recording: a box and a number for each target, thin where it is not seen but
/// predicted, and a trail of where its foot was that fades with age. A target with an outline has, in place of the box, the curve,
/// its control points, and the measurement lines across it: bright with a dot where the outline was found, faint where it was not.
/// The curve is dashed where its edge is not seen.
/// Body points are drawn with their bones, those on the left lighter, fainter where something may hide them; none where they
/// are likely outside the image. Colours are steady by number. Lines and numbers grow with the image. A name stands where it
/// covers neither another target nor another name, as near its own as there is room, and stays on that side while it can.
class Overlay {
 public:
  explicit Overlay(const OverlayOptions& options = {}) : options_(options), trails_(options.trail) {}

  /// Instants come in order; px. Keeps trails of those targets alone that were seen within `trail`.
  /// `blurred`: parts that are made unrecognisable first.
  Image draw(const Image& image, Timestamp now, std::span<const Sample> samples, const TrackNames& names,
             std::span<const cv::Rect2f> blurred = {});

 private:
  void draw_targets(Canvas& canvas, std::span<const Sample> samples, const TrackNames& names, double unit);
  Image lightened(const Image& image);
  void write_names(Canvas& canvas, std::span<const Sample> samples, const TrackNames& names, double unit);

  OverlayOptions options_;
  FadingTrails trails_;
  double white_ = 255;                    // of images of 16 bits
  std::map<TrackId, std::size_t> sides_;  // where each name stood last
};

}  // namespace marey::draw
