#include "marey/pipeline/people/image_rows.h"

#include <utility>

#include "marey/core/track_sample.h"
#include "marey/track/offline/rows_by_frame.h"

namespace marey::pipeline::people {
namespace {

/// What the second pass made of the recording, frame by frame.
class JoinedRows final : public corridor::InstantSource {
 public:
  JoinedRows(std::vector<track::offline::TrackRow> rows, std::vector<Recording::TimeStep> time_steps,
             track::offline::OutlineLog* outlines, bool observed_only)
      : rows_(std::move(rows)),
        time_steps_(std::move(time_steps)),
        by_number_(rows_, {}, outlines),
        observed_only_(observed_only) {}

  std::optional<Instant> next() override {
    if (next_ == time_steps_.size()) return std::nullopt;
    Instant instant;
    instant.index = time_steps_[next_].index;
    instant.time = time_steps_[next_].time;
    for (const Track<2>& track : by_number_.at(static_cast<std::int64_t>(next_++))) instant.samples.push_back(sample_of(track));
    for (Sample& sample : instant.samples) sample.covariance.reset();  // rows do not keep it
    if (observed_only_) exclude_unobserved(instant);
    return instant;
  }

 private:
  std::vector<track::offline::TrackRow> rows_;
  std::vector<Recording::TimeStep> time_steps_;  // frames may be missing between them: rows count these
  track::offline::RowsByFrame by_number_;
  bool observed_only_;
  std::size_t next_ = 0;
};

/// What a live run still waited with when the recording ended.
class LiveRest final : public corridor::InstantSource {
 public:
  LiveRest(track::image::LiveTracks& live, bool observed_only) : live_(live), observed_only_(observed_only) {}

  std::optional<Instant> next() override {
    std::optional<Instant> instant = live_.next(true);
    if (instant && observed_only_) exclude_unobserved(*instant);
    return instant;
  }

 private:
  track::image::LiveTracks& live_;
  bool observed_only_;
};

}  // namespace

void exclude_unobserved(Instant& instant) {
  std::erase_if(instant.samples, [](const Sample& sample) { return !sample.measured(); });
}

std::unique_ptr<corridor::InstantSource> instants_of(std::vector<track::offline::TrackRow> rows,
                                                     std::vector<Recording::TimeStep> time_steps,
                                                     track::offline::OutlineLog* outlines, bool observed_only) {
  return std::make_unique<JoinedRows>(std::move(rows), std::move(time_steps), outlines, observed_only);
}

std::unique_ptr<corridor::InstantSource> rest_of(track::image::LiveTracks& live, bool observed_only) {
  return std::make_unique<LiveRest>(live, observed_only);
}

}  // namespace marey::pipeline::people
