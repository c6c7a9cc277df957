// What is made of ground tracks when they are known: films of each camera and from above, and the boxes in a camera's view. While
// tracking goes on, ViewLog notes whose box was seen where; afterwards boxes are those that were seen, and where nobody was seen,
// those that a person standing there would have.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/ground_recording.h"
#include "marey/draw/canvas.h"
#include "marey/pipeline/ground_cameras.h"
#include "marey/pipeline/run.h"
#include "marey/reconstruct/ground_area.h"
#include "marey/track/ground/ground_recorder.h"

namespace marey::pipeline {

/// Whose box was where in one camera's pictures; 24 bytes a person and frame.
class ViewLog {
 public:
  /// The camera gave its frame `own` to the instant `frame`.
  void add_frame(std::int32_t frame, std::int32_t own) { frames_.push_back({frame, own}); }
  void add_box(std::int32_t frame, TrackId track, const Box& box);

  struct FramePair {
    std::int32_t instant = 0, own = 0;
  };
  std::span<const FramePair> frames() const { return frames_; }

  /// Puts persons (index into the recording's people) in the place of tracks; boxes of nobody are forgotten.
  void name(const std::function<std::optional<int>(TrackId, std::int32_t frame)>& person_of);
  /// The box of this person at this instant, where the camera saw it. After `name`.
  std::optional<Box> box(std::int32_t frame, std::int32_t person) const;

 private:
  struct Row {
    std::int32_t frame = 0, who = 0;
    float left = 0, top = 0, width = 0, height = 0;
  };
  std::vector<FramePair> frames_;
  std::vector<Row> rows_;  // by frame, then by who once named
};

/// All that the films show. `recording` is in the user's coordinates.
struct GroundShow {
  const GroundRecording& recording;
  const reconstruct::GroundArea& area;
  const GroundCameras& cameras;
  std::vector<draw::Colour> colours;  ///< of each person
  const RunHooks& hooks;
};

/// The box of each person who may be seen in the view of camera `number`, as MOT text by that camera's own frames. Throws Error
/// where it cannot be written.
void write_view_boxes(const GroundShow& show, std::size_t number, const ViewLog& log, const std::string& path);

/// A film of camera `number` with boxes, numbers and ways on the ground. Whether it was stopped. Throws Error where it cannot be
/// written.
bool film_view(const GroundShow& show, std::size_t number, const ViewLog& log, const std::string& path);

/// A film of the ground from above, a picture for each instant from the first to the last of `times` (s, by instant).
bool film_ground(const GroundShow& show, std::span<const double> times, const std::string& path);

}  // namespace marey::pipeline
