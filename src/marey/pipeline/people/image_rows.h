// The rest to write of people in one camera's images when the recording has ended.
#pragma once

#include <memory>
#include <vector>

#include "marey/core/recording.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/track/image/live_tracks.h"
#include "marey/track/offline/outline_log.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::pipeline::people {

void exclude_unobserved(Instant& instant);

/// What the second pass made of the recording, frame by frame: `rows` count `moments`. With outlines where there are some (null for
/// none; they must outlive the result); without those not observed in a frame where `measured_only`.
std::unique_ptr<corridor::InstantSource> instants_of(std::vector<track::offline::TrackRow> rows,
                                                     std::vector<Recording::TimeStep> time_steps,
                                                     track::offline::OutlineLog* outlines, bool observed_only);

/// What a live run still waited with when the recording ended. `live` must outlive the result.
std::unique_ptr<corridor::InstantSource> rest_of(track::image::LiveTracks& live, bool observed_only);

}  // namespace marey::pipeline::people
