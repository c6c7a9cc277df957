#include "marey/pipeline/people/picture_rows.h"

#include <utility>

#include "marey/core/track_sample.h"
#include "marey/track/offline/rows_by_frame.h"

namespace marey::pipeline::people {
namespace {

/// What the second pass made of the recording, frame by frame.
class JoinedRows final : public corridor::InstantSource {
 public:
  JoinedRows(std::vector<track::offline::TrackRow> rows, std::vector<Recording::Moment> moments,
             track::offline::OutlineLog* outlines, bool seen_only)
      : rows_(std::move(rows)), moments_(std::move(moments)), by_number_(rows_, {}, outlines), seen_only_(seen_only) {}

  std::optional<Instant> next() override {
    if (next_ == moments_.size()) return std::nullopt;
    Instant instant;
    instant.index = moments_[next_].index;
    instant.time = moments_[next_].time;
    for (const Track<2>& track : by_number_.at(static_cast<std::int64_t>(next_++))) instant.samples.push_back(sample_of(track));
    for (Sample& sample : instant.samples) sample.covariance.reset();  // rows do not keep it
    if (seen_only_) leave_out_unseen(instant);
    return instant;
  }

 private:
  std::vector<track::offline::TrackRow> rows_;
  std::vector<Recording::Moment> moments_;  // frames may be missing between them: rows count these
  track::offline::RowsByFrame by_number_;
  bool seen_only_;
  std::size_t next_ = 0;
};

/// What a live run still waited with when the recording ended.
class LiveRest final : public corridor::InstantSource {
 public:
  LiveRest(track::image::LiveTracks& live, bool seen_only) : live_(live), seen_only_(seen_only) {}

  std::optional<Instant> next() override {
    std::optional<Instant> instant = live_.next(true);
    if (instant && seen_only_) leave_out_unseen(*instant);
    return instant;
  }

 private:
  track::image::LiveTracks& live_;
  bool seen_only_;
};

}  // namespace

void leave_out_unseen(Instant& instant) {
  std::erase_if(instant.samples, [](const Sample& sample) { return !sample.measured(); });
}

std::unique_ptr<corridor::InstantSource> instants_of(std::vector<track::offline::TrackRow> rows,
                                                     std::vector<Recording::Moment> moments, track::offline::OutlineLog* outlines,
                                                     bool seen_only) {
  return std::make_unique<JoinedRows>(std::move(rows), std::move(moments), outlines, seen_only);
}

std::unique_ptr<corridor::InstantSource> rest_of(track::image::LiveTracks& live, bool seen_only) {
  return std::make_unique<LiveRest>(live, seen_only);
}

}  // namespace marey::pipeline::people
