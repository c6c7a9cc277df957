#include "marey/draw/overlay_video.h"

namespace marey::draw {

OverlayVideo::OverlayVideo(const std::string& path, const View& view, const OverlayOptions& options)
    : path_(path),
      view_(view),
      movie_(path, view.size, view.rate_hz, MovieWriter::Quality::to_view, MovieWriter::Keep::when_finished, view.sound_of),
      options_(options),
      overlay_(options) {}

Sink::SinkRequirements OverlayVideo::begin(const RecordingHeader& header) {
  by_boxes_ = header.frame.metric();
  options_.keypoints = header.keypoints;
  overlay_ = Overlay(options_);
  return {.images = true, .boxes = by_boxes_};
}

/// The camera's boxes as samples in its image.
std::vector<Sample> OverlayVideo::in_view(const Instant& instant) const {
  std::vector<Sample> samples;
  for (const BoxInView& detected : instant.boxes) {
    if (detected.camera != view_.camera || !detected.foot) continue;
    Sample& sample = samples.emplace_back();
    sample.track = detected.track;
    sample.position.head<2>() = *detected.foot;
    sample.box = detected.box;
    sample.provenance = detected.detected ? Provenance::measured : Provenance::predicted;
  }
  return samples;
}

void OverlayVideo::write(const Instant& instant) {
  names_.add(instant.named);
  for (const Frame& frame : instant.frames) {
    if (frame.camera != view_.camera) continue;
    const Timestamp own = frame.time - view_.offset;
    movie_.write(overlay_.draw(frame.image, own, by_boxes_ ? in_view(instant) : instant.samples, names_), own);
  }
}

}  // namespace marey::draw
