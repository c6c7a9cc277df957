#include "marey/pipeline/calibrate/find_boards.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/calibrate/board/choose_views.h"
#include "marey/calibrate/board/missing_board.h"
#include "marey/calibrate/board/sharpness.h"

namespace marey::pipeline::calibrate {
namespace {

constexpr std::size_t kFramesAtOnce = 16;  // frames
constexpr std::size_t kKeptImages = 24;  // numerical: to say why there is no board in them; half are dropped when there are as many

/// Images from all over a video, evenly, whatever its length.
class KeptImages {
 public:
  void add(const Image& image) {
    if (count_++ % every_ != 0) return;
    images_.push_back(image);
    if (images_.size() < kKeptImages) return;
    for (std::size_t i = 1; 2 * i < images_.size(); ++i) images_[i] = images_[2 * i];
    images_.resize((images_.size() + 1) / 2);
    every_ *= 2;
  }
  const std::vector<Image>& images() const { return images_; }

 private:
  std::vector<Image> images_;
  std::size_t count_ = 0, every_ = 1;
};

}  // namespace

BoardSightings find_boards(corridor::Feed& feed, const marey::calibrate::board::BoardDetector& detector,
                           const FindBoardsOptions& options, const Hooks& hooks) {
  BoardSightings found;
  found.size = feed.info().size;
  std::vector<Frame> batch;
  std::vector<std::optional<BoardSighting>> detected;
  KeptImages kept;
  const auto inspect = [&] {
    for (const Frame& frame : batch) {
      if (found.sightings.empty()) kept.add(frame.image);
    }
    detected.assign(batch.size(), std::nullopt);
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      const Image& image = batch[i].image;
      auto view = detector.detect(image);
      if (view)
        detected[i] =
            BoardSighting{batch[i].index, batch[i].time, marey::calibrate::board::sharpness_of(image, *view), std::move(*view)};
    });
    for (auto& sighting : detected) {
      if (sighting) found.sightings.push_back(std::move(*sighting));
    }
    found.frames += static_cast<std::int64_t>(batch.size());
    batch.clear();
  };
  std::int64_t count = 0;
  while (auto next = feed.next()) {
    if (count++ % options.every == 0) batch.push_back(std::move(next->frame));
    if (batch.size() < kFramesAtOnce) continue;
    inspect();
    hooks.advance({options.step, count, feed.info().frame_count});
  }
  if (hooks.stop.stop_requested()) throw Stopped();
  inspect();
  found.warnings = feed.warnings();
  if (found.sightings.empty()) found.why_missing = marey::calibrate::board::why_missing(detector.board(), kept.images());
  return found;
}

marey::calibrate::LensCalibration lens_by_sightings(const marey::calibrate::board::Board& board, const BoardSightings& detected,
                                                    std::size_t max_views, const marey::calibrate::LensOptions& how) {
  std::vector<marey::calibrate::board::ViewCandidate> candidates;
  for (const BoardSighting& sighting : detected.sightings) candidates.push_back({&sighting.view, sighting.sharpness});
  std::vector<marey::calibrate::LensView> views;
  for (const std::size_t i : marey::calibrate::board::choose_views(candidates, detected.size, max_views))
    views.push_back({fmt::format("frame {}", detected.sightings[i].frame), detected.sightings[i].view});
  return marey::calibrate::calibrate_lens(board, detected.size, views, how);
}

}  // namespace marey::pipeline::calibrate
