#pragma once

#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "marey/core/image.h"
#include "marey/core/time.h"

namespace marey::draw {

/// Writes a video that browsers play: H.264, 4:2:0, in an MP4 whose index comes first. Until `finish` it is an MP4 of fragments, so
/// that what a killed program wrote can be read.
class MovieWriter {
 public:
  enum class Quality {
    to_view,     ///< sharp enough to read numbers
    to_measure,  ///< markers keep their place to a few hundredths of a pixel
    to_record,   ///< the same in less than half the time, in larger files: while cameras are live
  };

  enum class Keep {
    when_finished,  ///< it is written beside its name and gets it in `finish`: atomically, unless the program is killed
    always,         ///< under its name from the first frame on, in place of an older file: of what cannot be recorded again
  };

  /// `rate_hz` is what most frames follow each other at; each is shown at its own time all the same.
  /// `sound_of` is a video whose sound goes along unchanged, from its first image on; where it has none that an MP4 holds, or none
  /// is named, the video is silent.
  /// Throws Error if the file cannot be written or no H.264 encoder is installed.
  MovieWriter(const std::string& path, cv::Size size, std::optional<double> rate_hz, Quality quality = Quality::to_view,
              Keep keep = Keep::when_finished, const std::string& sound_of = {});
  /// Without `finish`, nothing is left behind, or with Keep::always the output so far.
  ~MovieWriter();
  MovieWriter(const MovieWriter&) = delete;
  MovieWriter& operator=(const MovieWriter&) = delete;

  /// One image of the size given above, in limited range, as Canvas makes them. `time` grows from call to call; a time that does
  /// not is moved to just after the last. Throws Error if the place is full.
  void write(const Image& image, Timestamp time);

  /// Throws Error if the place is full.
  void finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::draw
