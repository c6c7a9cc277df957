#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/sink.h"
#include "marey/core/track_names.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/pitch_view.h"
#include "marey/geometry/pitch.h"

namespace marey::draw {

/// The ground that is shown, in its user's coordinates.
struct ShownGround {
  std::optional<geometry::PitchSize> pitch;
  double margin = 0;      ///< m round the pitch where people count
  bool mirrored = false;  ///< its y grows to the right of x
};

/// A video of the ground from above, an image for each instant. Over a pitch it grows with the run; of a ground without one it is
/// drawn at the end, when it is known where people were.
class PitchViewVideo final : public Sink {
 public:
  /// Throws Error if it cannot be written.
  PitchViewVideo(const std::string& path, const ShownGround& ground, std::optional<double> rate_hz);

  std::string name() const override { return path_; }
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override;

 private:
  struct TimeStep {
    Timestamp time{};
    std::vector<PitchView::Mark> marks;
  };
  std::vector<PitchView::Mark> marks_of(const Instant& instant) const;
  void open(const Vector<2>& low, const Vector<2>& high);
  void show(const TimeStep& time_step);

  std::string path_;
  ShownGround ground_;
  std::optional<double> rate_hz_;
  TrackNames names_;
  std::optional<PitchView> view_;
  std::optional<MovieWriter> movie_;
  std::vector<TimeStep> waiting_;
};

}  // namespace marey::draw
