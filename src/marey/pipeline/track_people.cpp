#include "marey/pipeline/track_people.h"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "marey/core/error.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/overlay.h"
#include "marey/pipeline/plot_file.h"
#include "marey/pipeline/read_ahead.h"
#include "marey/pipeline/rows_by_frame.h"
#include "marey/track/contour/outline_follower.h"
#include "marey/track/outline_recording.h"
#include "marey/track/recording.h"

namespace marey::pipeline {
namespace {

std::vector<Expected> expected_of(std::span<const Track<2>> tracks) {
  std::vector<Expected> result;
  for (const Track<2>& track : tracks) {
    if (track.box) result.push_back({*track.box});
  }
  return result;
}

std::vector<Observation<2>> observations_of(const std::vector<Detection>& detections, CameraId camera) {
  std::vector<Observation<2>> result;
  result.reserve(detections.size());
  for (const Detection& detection : detections) {
    result.push_back({.value = detection.box.centre(),
                      .covariance = detection.covariance,
                      .camera = camera,
                      .score = detection.score,
                      .box = detection.box,
                      .shared = detection.group.has_value()});
  }
  return result;
}

/// Background subtraction works before a camera that stands still; of another program's detections nothing is known.
track::TrackerOptions tracker_options(const PeopleInput& input, const TrackPeopleOptions& options) {
  track::TrackerOptions tracker = options.tracker;
  tracker.steady_camera = !input.pictures.empty();
  tracker.reclaim = tracker.steady_camera && options.live;
  return tracker;
}

class Run {
 public:
  Run(const PeopleInput& input, const TrackOutput& output, const TrackPeopleOptions& options, const RunHooks& hooks)
      : input_(input),
        options_(options),
        hooks_(hooks),
        eyes_(open_detection_stage(input, {options.background, options.people, !options.live})),
        tracker_(track::make_tracker<2>(tracker_options(input, options))),
        file_(output.tracks, output.format),
        overlay_({.trail_of_centres = options.outlines.has_value()}) {
    const SourceInfo& info = eyes_.source->info();
    if (options.outlines) {
      follower_.emplace(*options.outlines);
      if (!options.live) outlines_.emplace(output.tracks, !output.overlay.empty());
    }
    if (!output.plot.empty()) plot_.emplace(output.plot, "Trajectories in " + info.name);
    if (!output.overlay.empty()) movie_.emplace(output.overlay, info.size, info.rate_hz);
  }

  TrackSummary operator()() {
    follow();
    if (!options_.live) {
      const std::vector<track::TrackRow> rows = track::join(recording_, options_.join);
      write(rows);
      file_.finish();
      if (movie_) draw(rows);
    } else {
      file_.finish();
    }
    if (movie_) movie_->finish();
    if (plot_) plot_->finish();
    summary_.people = static_cast<std::int64_t>(people_.size());
    return std::move(summary_);
  }

 private:
  /// The first pass: everything that is said of a frame knows only what came before it.
  void follow() {
    std::set<TrackId> begun, believed;
    while (auto frame = eyes_.source->next()) {
      const std::vector<Expected> expected = expected_of(tracker_->expected(frame->time));
      const detect::Detections seen = eyes_.detector->detect(*frame, expected);
      const auto tracks = follow(*frame, seen);
      for (const Track<2>& track : tracks) (track.confirmed ? believed : begun).insert(track.id);
      if (options_.live) {
        tell(*frame, tracks);
      } else {
        recording_.add(frame->index, frame->time, tracks);
        if (outlines_) outlines_->add(frame->index, tracks);
      }
      summary_.detections += static_cast<std::int64_t>(seen.detections.size());
      summary_.frames = frame->index + 1;
      summary_.seconds = seconds(frame->time);
      summary_.stopped = hooks_.tell({TrackProgress::Step::tracking, summary_.frames, eyes_.source->info().frame_count});
      if (summary_.stopped) break;
    }
    summary_.warnings = eyes_.source->warnings();
    if (summary_.frames == 0) throw Error("{}: not one frame could be read", eyes_.source->info().name);
    begun.merge(believed);
    summary_.too_brief = static_cast<std::int64_t>(begun.size()) - static_cast<std::int64_t>(believed.size());
    if (eyes_.people != nullptr) {
      summary_.noise = eyes_.people->counts().noise;
      summary_.misfits = eyes_.people->counts().misfits;
    }
  }

  /// What is seen makes tracks; outlines are searched before and put right after, so that each tells the other what it found.
  std::span<const Track<2>> follow(const Frame& frame, const detect::Detections& seen) {
    std::vector<Observation<2>> observations = observations_of(seen.detections, frame.camera);
    if (!follower_) return tracker_->step(frame.time, observations);
    const auto hints = follower_->look(frame, seen.foreground, seen.detections);
    observations.insert(observations.end(), hints.begin(), hints.end());
    return follower_->attach(tracker_->step(frame.time, observations), seen.detections);
  }

  void tell(const Frame& frame, std::span<const Track<2>> tracks) {
    std::vector<Track<2>> confirmed;
    std::copy_if(tracks.begin(), tracks.end(), std::back_inserter(confirmed),
                 [](const Track<2>& track) { return track.confirmed; });
    tell_confirmed(frame.index, frame.time, confirmed);
    if (movie_) movie_->write(overlay_.draw(frame.picture, frame.time, confirmed), frame.time);
  }

  void tell_confirmed(std::int64_t frame, Timestamp time, std::span<const Track<2>> tracks) {
    file_.write(frame, time, tracks);
    summary_.rows += static_cast<std::int64_t>(tracks.size());
    for (const Track<2>& track : tracks) {
      people_.insert(track.id);
      if (!track.outline) continue;
      ++summary_.outlines;
      if (track.outline->state == Outline::State::held) ++summary_.held;
    }
    if (plot_) plot_->add(frame, tracks);
  }

  void write(const std::vector<track::TrackRow>& rows) {
    RowsByFrame by_frame = rows_by_frame(rows);
    for (std::int32_t frame = 0; frame < summary_.frames; ++frame)
      tell_confirmed(frame, recording_.time_of(frame), by_frame.at(frame));
  }

  RowsByFrame rows_by_frame(const std::vector<track::TrackRow>& rows) {
    return RowsByFrame(rows, {}, outlines_ ? &*outlines_ : nullptr);
  }

  /// A second look at the pictures, because the tracks of a frame are known only after the last one.
  void draw(const std::vector<track::TrackRow>& rows) {
    const auto source = read_ahead(open_pictures(input_));
    RowsByFrame by_frame = rows_by_frame(rows);
    const bool stopped_before = summary_.stopped;  // then the film shows what was tracked until then
    for (std::int64_t done = 0; done < summary_.frames;) {
      const auto frame = source->next();
      if (!frame) break;
      movie_->write(overlay_.draw(frame->picture, frame->time, by_frame.at(frame->index)), frame->time);
      if (!hooks_.tell({TrackProgress::Step::drawing, ++done, summary_.frames}) || stopped_before) continue;
      summary_.stopped = true;
      break;
    }
  }

  PeopleInput input_;
  TrackPeopleOptions options_;
  RunHooks hooks_;
  DetectionStage eyes_;
  std::unique_ptr<track::Tracker<2>> tracker_;
  std::optional<track::contour::OutlineFollower> follower_;
  std::optional<track::OutlineRecording> outlines_;
  format::tracks::TrackFile file_;
  std::optional<PlotFile> plot_;
  std::optional<draw::MovieWriter> movie_;
  draw::Overlay overlay_;
  track::Recording recording_;
  std::set<TrackId> people_;
  TrackSummary summary_;
};

}  // namespace

TrackSummary track_people(const PeopleInput& input, const TrackOutput& output, const TrackPeopleOptions& options,
                          const RunHooks& hooks) {
  if (input.pictures.empty() == input.detections.empty()) throw Error("give either pictures or detections to track");
  if (input.rate_hz && !(*input.rate_hz > 0)) throw Error("the rate is {} frames a second; it must be positive", *input.rate_hz);
  if (input.pictures.empty() && !output.overlay.empty()) throw Error("{}: an overlay needs pictures to draw into", output.overlay);
  if (input.pictures.empty() && options.outlines)
    throw Error("{}: outlines are searched in pictures; give those", input.detections);
  return Run(input, output, options, hooks)();
}

}  // namespace marey::pipeline
