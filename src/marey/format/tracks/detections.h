#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/source.h"

namespace marey::format::tracks {

/// What another program detected, frame by frame, in the place of a camera and a detector: MOT text,
/// `frame,-1,left,top,width,height,score,…`. Scores in [0, 1] are taken as they are. Scores of another scale, or none of 0.5, are
/// ranked: the weakest quarter may continue a track, the others begin one too. A file whose frames are in order is read piece by
/// piece.
class DetectionReader {
 public:
  /// `rate_hz` frames a second; 25 where nothing is given, with a warning. Throws Error if the file cannot be read or a line is
  /// malformed.
  DetectionReader(const std::string& path, std::optional<double> rate_hz);
  ~DetectionReader();
  DetectionReader(DetectionReader&&) noexcept;

  const SourceInfo& info() const { return info_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Frames without images, from the first to the last that has a detection; nothing at the end.
  std::optional<CameraFrame> next();

 private:
  class Boxes;

  SourceInfo info_;
  std::vector<std::string> warnings_;
  std::unique_ptr<Boxes> boxes_;
  std::int64_t next_index_ = 0;
};

}  // namespace marey::format::tracks
