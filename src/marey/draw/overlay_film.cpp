#include "marey/draw/overlay_film.h"

#include "marey/core/error.h"

namespace marey::draw {

OverlayFilm::OverlayFilm(const std::string& path, CameraId camera, cv::Size size, std::optional<double> rate_hz,
                         const OverlayOptions& options)
    : path_(path), camera_(camera), movie_(path, size, rate_hz), overlay_(options) {}

Sink::Wants OverlayFilm::begin(const RecordingHeader& header) {
  if (header.frame.metric()) throw Error("{}: positions in a picture are drawn into it, and these are {}", path_, to_string(header.frame));
  return {.pictures = true};
}

void OverlayFilm::write(const Instant& instant) {
  names_.add(instant.named);
  for (const Frame& frame : instant.frames) {
    if (frame.camera == camera_) movie_.write(overlay_.draw(frame.picture, instant.time, instant.samples, names_), instant.time);
  }
}

}  // namespace marey::draw
