#include "marey/pipeline/markers/detect_markers.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/time.h"
#include "marey/draw/blob_drawing.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/picture_file.h"
#include "marey/format/tracks/blob_file.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::markers {
namespace {

/// Draws into the pictures as they come; the first alone where that is what was asked for.
class BlobOverlay {
 public:
  BlobOverlay(const std::string& path, const SourceInfo& info) : path_(path) {
    if (path.ends_with(".mp4")) film_.emplace(path, info.size, info.rate_hz);
  }

  void draw(const CameraFrame& seen) {
    if (film_) return film_->write(draw::draw_blobs(seen.frame.picture, *seen.detections), seen.frame.time);
    if (!std::exchange(drawn_, true)) draw::write_picture(path_, draw::draw_blobs(seen.frame.picture, *seen.detections));
  }

  void finish() {
    if (film_) film_->finish();
  }

 private:
  std::string path_;
  std::optional<draw::MovieWriter> film_;
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
  while (const auto seen = feed.next()) {
    ++summary.frames;
    summary.blobs += std::ssize(*seen->detections);
    summary.most = std::max<std::int64_t>(summary.most, std::ssize(*seen->detections));
    summary.seconds = seconds(seen->frame.time);
    summary.detect_s += seen->detect_s;
    if (blobs) blobs->write(seen->frame, *seen->detections);
    if (overlay) overlay->draw(*seen);
    summary.stopped = hooks.report({"looking for markers", summary.frames, feed.info().frame_count}) == Continue::no;
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
