#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/ids.h"
#include "marey/core/sink.h"
#include "marey/core/track_names.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/overlay.h"

namespace marey::draw {

/// A video of one camera with its targets drawn into the images: positions in the image themselves, others by their boxes in the
/// camera's view.
class OverlayVideo final : public Sink {
 public:
  struct View {
    CameraId camera{};
    cv::Size size;                  ///< px
    std::optional<double> rate_hz;  ///< of its images
    std::string sound_of;           ///< the video whose sound goes along; empty: none
    Duration offset{};              ///< between its own clock, by which the video runs, and the recording's
  };

  /// Throws Error if the file cannot be written.
  OverlayVideo(const std::string& path, const View& view, const OverlayOptions& options = {});

  std::string name() const override { return path_; }
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override { movie_.finish(); }

 private:
  std::vector<Sample> in_view(const Instant& instant) const;

  std::string path_;
  View view_;
  bool by_boxes_ = false;
  MovieWriter movie_;
  OverlayOptions options_;
  Overlay overlay_;
  TrackNames names_;
};

}  // namespace marey::draw
