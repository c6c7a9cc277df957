#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/ids.h"
#include "marey/core/sink.h"
#include "marey/core/track_names.h"
#include "marey/draw/heads.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/overlay.h"

namespace marey::draw {

/// A video of one camera with its targets drawn into the images: positions in the image themselves, others by their boxes in the
/// camera's view. With `blur_faces` frames wait for those of the next 0.4 s, in which a person may first be found.
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
  void finish() override;

 private:
  struct Waiting {
    Image image;
    Timestamp time{};
    std::vector<Sample> samples;
    std::vector<TrackName> named;
  };

  std::vector<Sample> in_view(const Instant& instant) const;
  void write_ready(bool at_end);
  void write_frame(const Waiting& frame, std::span<const cv::Rect2f> blurred);

  std::string path_;
  View view_;
  bool by_boxes_ = false;
  MovieWriter movie_;
  OverlayOptions options_;
  Overlay overlay_;
  TrackNames names_;
  HeadsOverTime heads_;
  std::deque<Waiting> waiting_;  // for the heads of later frames
};

}  // namespace marey::draw
