#include "marey/pipeline/find_boards.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/calibrate/board/sharpness.h"
#include "marey/core/error.h"

namespace marey::pipeline {
namespace {

constexpr std::size_t kAtOnce = 16;  // frames

Picture cut_out(const Picture& whole, const std::optional<cv::Rect>& region) {
  return region ? Picture(whole.luma()(*region)) : whole;
}

}  // namespace

BoardSightings find_boards(Source& source, const calibrate::board::BoardDetector& detector, const FindBoardsOptions& options) {
  const SourceInfo& info = source.info();
  BoardSightings found;
  found.size = options.region ? options.region->size() : info.size;
  if (options.region && (*options.region & cv::Rect({}, info.size)) != *options.region)
    throw Error("{}: the region {}x{} at ({}, {}) is not within its pictures of {}x{} px", info.name, options.region->width,
                options.region->height, options.region->x, options.region->y, info.size.width, info.size.height);
  std::vector<Frame> batch;
  std::vector<std::optional<BoardSighting>> seen;
  const auto look = [&] {
    seen.assign(batch.size(), std::nullopt);
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      const Picture picture = cut_out(batch[i].picture, options.region);
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
  while (auto frame = source.next()) {
    if (count++ % options.every == 0) batch.push_back(std::move(*frame));
    if (batch.size() < kAtOnce) continue;
    look();
    if (options.progress) options.progress(count, info.frame_count);
  }
  look();
  found.warnings = source.warnings();
  return found;
}

}  // namespace marey::pipeline
