#include "marey/draw/overlay_video.h"

namespace marey::draw {
namespace {

constexpr Duration kHoldHeads = std::chrono::milliseconds(400);  // unswept: before and after a track

}  // namespace

OverlayVideo::OverlayVideo(const std::string& path, const View& view, const OverlayOptions& options)
    : path_(path),
      view_(view),
      movie_(path, view.size, view.rate_hz, MovieWriter::Quality::to_view, MovieWriter::Keep::when_finished, view.sound_of),
      options_(options),
      overlay_(options),
      heads_(kHoldHeads) {}

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
  std::vector<TrackName> named = instant.named;
  for (const Frame& frame : instant.frames) {
    if (frame.camera != view_.camera) continue;
    const Timestamp own = frame.time - view_.offset;
    Waiting now{
        .image = frame.image, .time = own, .samples = by_boxes_ ? in_view(instant) : instant.samples, .named = std::move(named)};
    named.clear();
    if (options_.blur_faces) {
      heads_.add(own, now.samples, options_.keypoints);
      waiting_.push_back(std::move(now));
      write_ready(false);
    } else {
      write_frame(now, {});
    }
  }
  names_.add(named);  // of an instant without an image
}

void OverlayVideo::write_ready(bool at_end) {
  while (!waiting_.empty()) {
    const auto heads = heads_.next(at_end);
    if (!heads) return;
    write_frame(waiting_.front(), *heads);
    waiting_.pop_front();
  }
}

void OverlayVideo::write_frame(const Waiting& frame, std::span<const cv::Rect2f> blurred) {
  names_.add(frame.named);
  movie_.write(overlay_.draw(frame.image, frame.time, frame.samples, names_, blurred), frame.time);
}

void OverlayVideo::finish() {
  write_ready(true);
  movie_.finish();
}

}  // namespace marey::draw
