#pragma once

#include <optional>
#include <string>

#include <opencv2/core/types.hpp>

#include "marey/core/ids.h"
#include "marey/core/sink.h"
#include "marey/core/track_names.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/overlay.h"

namespace marey::draw {

/// A film of one camera with its targets drawn into the pictures.
class OverlayFilm final : public Sink {
 public:
  /// `size` (px) and `rate_hz` of the camera's pictures. Throws Error where the file cannot be written.
  OverlayFilm(const std::string& path, CameraId camera, cv::Size size, std::optional<double> rate_hz,
              const OverlayOptions& options = {});

  std::string name() const override { return path_; }
  Wants begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override { movie_.finish(); }

 private:
  std::string path_;
  CameraId camera_;
  MovieWriter movie_;
  Overlay overlay_;
  TrackNames names_;
};

}  // namespace marey::draw
