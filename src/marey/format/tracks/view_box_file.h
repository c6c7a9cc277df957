#pragma once

#include <cstdint>
#include <string>

#include "marey/core/sink.h"
#include "marey/files/whole_file.h"
#include "marey/format/tracks/mot.h"

namespace marey::format::tracks {

/// The boxes of every person in the view of one camera of several, as MOT text by that camera's own frames.
class ViewBoxFile final : public Sink {
 public:
  /// Throws Error if it cannot be written.
  ViewBoxFile(const std::string& path, CameraId camera) : path_(path), camera_(camera), file_(path) {}

  std::string name() const override { return path_; }
  SinkRequirements begin(const RecordingHeader& /*header*/) override { return {.boxes = true}; }
  void write(const Instant& instant) override {
    std::string text;
    for (const BoxInView& detected : instant.boxes) {
      if (detected.camera == camera_)
        append_mot(text, {static_cast<std::int32_t>(detected.frame), number(detected.track), detected.box, 1});
    }
    file_.write(text);
  }
  void finish() override { file_.finish(); }

 private:
  std::string path_;
  CameraId camera_;
  WholeFile file_;
};

}  // namespace marey::format::tracks
