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

/// A film of the ground from above, a picture for each instant. Over a pitch it grows with the run; of a ground without one it is
/// drawn at the end, when it is known where people were.
class PitchViewFilm final : public Sink {
 public:
  /// Throws Error where it cannot be written.
  PitchViewFilm(const std::string& path, const ShownGround& ground, std::optional<double> rate_hz);

  std::string name() const override { return path_; }
  Wants begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override;

 private:
  struct Moment {
    Timestamp time{};
    std::vector<PitchView::Mark> marks;
  };
  std::vector<PitchView::Mark> marks_of(const Instant& instant) const;
  void open(const Vector<2>& low, const Vector<2>& high);
  void show(const Moment& moment);

  std::string path_;
  ShownGround ground_;
  std::optional<double> rate_hz_;
  TrackNames names_;
  std::optional<PitchView> view_;
  std::optional<MovieWriter> movie_;
  std::vector<Moment> waiting_;
};

}  // namespace marey::draw
