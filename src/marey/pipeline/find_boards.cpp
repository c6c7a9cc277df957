#include "marey/pipeline/find_boards.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/calibrate/board/sharpness.h"

namespace marey::pipeline {
namespace {

constexpr std::size_t kFramesAtOnce = 16;  // frames

}  // namespace

BoardSightings find_boards(Feed& feed, const calibrate::board::BoardDetector& detector, const FindBoardsOptions& options) {
  BoardSightings found;
  found.size = feed.info().size;
  std::vector<Frame> batch;
  std::vector<std::optional<BoardSighting>> seen;
  const auto look = [&] {
    seen.assign(batch.size(), std::nullopt);
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      const Picture& picture = batch[i].picture;
      auto view = detector.detect(picture);
      if (view)
        seen[i] = BoardSighting{batch[i].index, batch[i].time, calibrate::board::sharpness_of(picture, *view), std::move(*view)};
    });
    for (auto& sighting : seen) {
      if (sighting) found.sightings.push_back(std::move(*sighting));
    }
    found.frames += static_cast<std::int64_t>(batch.size());
    batch.clear();
  };
  std::int64_t count = 0;
  while (auto next = feed.next()) {
    if (count++ % options.every == 0) batch.push_back(std::move(next->frame));
    if (batch.size() < kFramesAtOnce) continue;
    look();
    if (options.progress) options.progress(count, feed.info().frame_count);
  }
  look();
  found.warnings = feed.warnings();
  return found;
}

}  // namespace marey::pipeline
