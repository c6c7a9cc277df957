#include "marey/draw/overlay_film.h"

namespace marey::draw {

OverlayFilm::OverlayFilm(const std::string& path, const View& view, const OverlayOptions& options)
    : path_(path),
      view_(view),
      movie_(path, view.size, view.rate_hz, MovieWriter::Quality::to_view, MovieWriter::Keep::when_finished, view.sound_of),
      overlay_(options) {}

Sink::Wants OverlayFilm::begin(const RecordingHeader& header) {
  by_boxes_ = header.frame.metric();
  return {.pictures = true, .boxes = by_boxes_};
}

/// The camera's boxes as samples in its picture.
std::vector<Sample> OverlayFilm::in_view(const Instant& instant) const {
  std::vector<Sample> samples;
  for (const BoxInView& seen : instant.boxes) {
    if (seen.camera != view_.camera || !seen.foot) continue;
    Sample& sample = samples.emplace_back();
    sample.track = seen.track;
    sample.position.head<2>() = *seen.foot;
    sample.box = seen.box;
    sample.provenance = seen.seen ? Provenance::measured : Provenance::predicted;
  }
  return samples;
}

void OverlayFilm::write(const Instant& instant) {
  names_.add(instant.named);
  for (const Frame& frame : instant.frames) {
    if (frame.camera != view_.camera) continue;
    const Timestamp own = frame.time - view_.offset;
    movie_.write(overlay_.draw(frame.picture, own, by_boxes_ ? in_view(instant) : instant.samples, names_), own);
  }
}

}  // namespace marey::draw
