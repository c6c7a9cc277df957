#pragma once

#include <optional>
#include <string>

#include "marey/core/sink.h"
#include "marey/core/track_names.h"
#include "marey/files/whole_file.h"

namespace marey::format::tracks {

/// How tracks in the image are written, one line for each target in each frame:
///   mot    MOTChallenge text: frame,id,left,top,width,height,conf,-1,-1,-1; frames and pixels count from 1
///   csv    with a header: frame,time,id,label,x,y,vx,vy,left,top,width,height,state; frames and pixels count from 0, s, px, px/s
///          of a recording with keypoints: frame,time,id,point,x,y,sd,visibility,presence, a row for each point
///   jsonl  one JSON object a line with the same names; absent values are omitted; with "outline" where there is one
///          (outline_json.h) and "keypoints" where there are some (keypoints_json.h)
enum class TrackText { mot, csv, jsonl };

/// Writes tracks as text as they come; the file is there atomically.
class TrackFile final : public Sink {
 public:
  /// Throws Error if nothing can be written there.
  TrackFile(const std::string& path, TrackText format);

  std::string name() const override { return path_; }
  /// Throws Error for positions that are not of an image.
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override { file_.finish(); }

 private:
  std::string path_;
  WholeFile file_;
  TrackText text_;
  TrackNames names_;
  std::optional<KeypointSet> keypoints_;
  std::string lines_;
};

}  // namespace marey::format::tracks
