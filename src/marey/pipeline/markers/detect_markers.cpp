#include "marey/pipeline/markers/detect_markers.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/time.h"
#include "marey/draw/blob_drawing.h"
#include "marey/draw/image_file.h"
#include "marey/draw/movie_writer.h"
#include "marey/format/tracks/blob_file.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::markers {
namespace {

/// Draws into the images as they come; the first alone if that was requested.
class BlobOverlay {
 public:
  BlobOverlay(const std::string& path, const SourceInfo& info) : path_(path) {
    if (path.ends_with(".mp4")) video_.emplace(path, info.size, info.rate_hz);
  }

  void draw(const CameraFrame& detected) {
    if (video_) return video_->write(draw::draw_blobs(detected.frame.image, *detected.detections), detected.frame.time);
    if (!std::exchange(drawn_, true)) draw::write_image(path_, draw::draw_blobs(detected.frame.image, *detected.detections));
  }

  void finish() {
    if (video_) video_->finish();
  }

 private:
  std::string path_;
  std::optional<draw::MovieWriter> video_;
  bool drawn_ = false;
};

}  // namespace

BlobSummary detect_markers(const RigCamera& camera, const BlobOutput& output, const detect::markers::MarkerOptions& options,
                           const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  corridor::Feed feed(camera, CameraId{});
  auto owned = std::make_unique<detect::markers::MarkerDetector>(corridor::markers_of(feed.camera(), options));
  const detect::markers::MarkerDetector& detector = *owned;
  owned->prime(feed.sample_beginning());
  feed.find(std::move(owned));
  std::optional<format::tracks::BlobWriter> blobs;
  const std::string name = camera.name.empty() ? "camera" : camera.name;
  if (!output.blobs.empty()) blobs.emplace(output.blobs, format::tracks::blob_text_of(output.blobs), name);
  std::optional<BlobOverlay> overlay;
  if (!output.overlay.empty()) overlay.emplace(output.overlay, feed.info());

  BlobSummary summary;
  while (const auto detected = feed.next()) {
    ++summary.frames;
    summary.blobs += std::ssize(*detected->detections);
    summary.maximum = std::max<std::int64_t>(summary.maximum, std::ssize(*detected->detections));
    summary.seconds = seconds(detected->frame.time);
    summary.detect_s += detected->detect_s;
    if (blobs) blobs->write(detected->frame, *detected->detections);
    if (overlay) overlay->draw(*detected);
    summary.stopped = hooks.report({"searching for markers", summary.frames, feed.info().frame_count}) == Continue::no;
    if (summary.stopped) break;
  }
  if (blobs) blobs->finish();
  if (overlay) overlay->finish();
  summary.counts = detector.counts();
  summary.threshold = detector.typical_threshold();
  summary.noise = detector.noise();
  summary.warnings = feed.warnings();
  return summary;
}

}  // namespace marey::pipeline::markers
