// A source's frames as a video.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "marey/core/source.h"
#include "marey/draw/canvas.h"
#include "marey/draw/movie_writer.h"

namespace marey::pipeline::corridor {

class VideoFile {
 public:
  /// Throws Error if it cannot be written.
  VideoFile(std::unique_ptr<Source> source, const std::string& path)
      : source_(std::move(source)),
        movie_(path, source_->info().size, source_->info().rate_hz, draw::MovieWriter::Quality::to_measure) {}

  /// False at the end.
  bool write_next() {
    const auto frame = source_->next();
    if (frame) movie_.write(draw::Canvas(frame->image).take(), frame->time);
    return frame.has_value();
  }
  void finish() { movie_.finish(); }

 private:
  std::unique_ptr<Source> source_;
  draw::MovieWriter movie_;
};

}  // namespace marey::pipeline::corridor
