// What is made of people on the ground for the eye: the ground from above as a film, and the boxes in one camera's view.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/sink.h"
#include "marey/core/track_names.h"
#include "marey/core/whole_file.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/pitch_view.h"
#include "marey/reconstruct/ground_area.h"

namespace marey::pipeline {

/// The boxes of everybody in the view of one camera, as MOT text by that camera's own frames.
class ViewBoxFile final : public Sink {
 public:
  /// Throws Error where it cannot be written.
  ViewBoxFile(const std::string& path, CameraId camera) : path_(path), camera_(camera), file_(path) {}

  std::string name() const override { return path_; }
  Wants begin(const RecordingHeader& /*header*/) override { return {.boxes = true}; }
  void write(const Instant& instant) override;
  void finish() override { file_.finish(); }

 private:
  std::string path_;
  CameraId camera_;
  WholeFile file_;
};

/// A film of the ground from above, a picture for each instant. Over a pitch it grows with the run; of a ground without one it is
/// drawn at the end, when it is known where people were.
class PitchViewFilm final : public Sink {
 public:
  /// Throws Error where it cannot be written.
  PitchViewFilm(const std::string& path, const reconstruct::GroundArea& area, std::optional<double> rate_hz);

  std::string name() const override { return path_; }
  Wants begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override;

 private:
  struct Moment {
    Timestamp time{};
    std::vector<draw::PitchView::Mark> marks;
  };
  std::vector<draw::PitchView::Mark> marks_of(const Instant& instant) const;
  void open(const Vector<2>& low, const Vector<2>& high);
  void draw(const Moment& moment);

  std::string path_;
  reconstruct::GroundArea area_;
  std::optional<double> rate_hz_;
  TrackNames names_;
  std::optional<draw::PitchView> view_;
  std::optional<draw::MovieWriter> movie_;
  std::vector<Moment> waiting_;
};

}  // namespace marey::pipeline
