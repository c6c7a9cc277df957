#include "marey/pipeline/markers/markers_in_space.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "marey/core/error.h"
#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/pipeline/markers/set_stage.h"
#include "marey/pipeline/markers/skeleton_in_space.h"
#include "marey/pipeline/markers/skeleton_stage.h"
#include "marey/pipeline/markers/space_blobs.h"
#include "marey/pipeline/markers/space_decisions.h"
#include "marey/pipeline/markers/space_points.h"
#include "marey/track/roster/gap_filler.h"

namespace marey::pipeline::markers {
namespace {

constexpr double kMaxPredictionSigma = 0.06;  // m; a prediction that is less certain is not matched with blobs
constexpr double kDecideAfterS = 5;           // after which labels of a file are not corrected any more; sweep: bench/tuning.md

int frames_in(double duration, double rate_hz) {
  return static_cast<int>(std::lround(duration * rate_hz));
}

track::roster::RosterTrackerOptions tracker_options(const MarkersInSpaceOptions& options) {
  track::roster::RosterTrackerOptions tracker = options.tracker;
  if (!options.set.has_positions()) tracker.labels = options.set.labels;
  tracker.decide_after = options.live ? 0 : kDecideAfterS;
  return tracker;
}

/// What a live run and one over a whole recording share: from blobs to tracked points.
class MarkersInSpace : public corridor::Stage {
 public:
  MarkersInSpace(const Rig& rig, double rate_hz, const MarkersInSpaceOptions& options)
      : blobs_(rig, rate_hz, options.live),
        points_(rig, options.correspond, options.noise_px),
        tracker_(track::roster::make_roster_tracker<3>(tracker_options(options))),
        decisions_(options.set) {
    header_.name = "the rig";
    header_.made_by.program = "marey reconstruct";
    header_.frame.kind = FrameOfReference::Kind::space;
    header_.time_base.kind = TimeBase::Kind::rig;
    header_.track_kind = TrackKind::marker;
    header_.rate_hz = rate_hz;
    header_.rig = rig;
  }

  RecordingHeader header() const override { return header_; }

  std::span<const Instant> step(const FrameSet& frames) override {
    const corridor::Stopwatch all;
    if (auto moved = points_.apply_moves()) blobs_.set_cameras(std::move(*moved));
    expect(frames.time);
    blobs_.collect(frames, expected_);
    const reconstruct::Correspondences& found = points_.find(frames.time, blobs_.all(), expected_);
    times_.corresponding.add(all.seconds());
    const corridor::Stopwatch tracking;
    observations_.clear();
    for (const reconstruct::Located& located : found.points)
      observations_.push_back({.value = located.point.position, .covariance = located.point.covariance, .box = {}});
    const auto tracks = tracker_->step(frames.time, observations_);
    decisions_.add(frames, blobs_, found, tracks);
    times_.tracking.add(tracking.seconds());
    known_.clear();
    report_known(tracks, known_);
    times_.all.add(all.seconds());
    return known_;
  }

  void report(corridor::Summary& summary) const override {
    points_.report(summary);
    summary.points->residual_px = decisions_.residual();
    const auto report_step = [&](const char* step, const StageTimes& times) {
      summary.steps.push_back({step, times.count(), times.quantile(0.5), times.quantile(0.99)});
    };
    report_step("correspond", times_.corresponding);
    report_step("track", times_.tracking);
    report_step("blobs to instants", times_.all);
    summary.warnings.insert(summary.warnings.begin(), points_.warnings().begin(), points_.warnings().end());
    if (summary.points->residual_px) return;
    const bool by_people = header_.rig->calibration && header_.rig->calibration->method == "people";
    summary.warnings.push_back(
        by_people ? "no marker could be placed: this rig was calibrated by people; for people without markers add "
                    "--targets keypoints"
                  : "no marker could be placed: are the cameras of this rig the ones that recorded, and synchronised? For "
                    "people without markers add --targets keypoints");
  }

 protected:
  /// Appends the instants that nothing will be added to any more.
  virtual void report_known(std::span<const Track<3>> tracks, std::vector<Instant>& known) = 0;

  track::Tracker<3>& tracker() { return *tracker_; }
  SpaceDecisions& decisions() { return decisions_; }

 private:
  struct Times {
    StageTimes corresponding, tracking, all;
  };

  void expect(Timestamp now) {
    expected_.clear();
    for (const Track<3>& track : tracker_->expected(now)) {
      if (track.covariance.trace() < 3 * kMaxPredictionSigma * kMaxPredictionSigma) expected_.push_back(track);
    }
  }

  RecordingHeader header_;
  SpaceBlobs blobs_;
  SpacePoints points_;
  std::unique_ptr<track::Tracker<3>> tracker_;
  SpaceDecisions decisions_;
  Times times_;
  std::vector<Track<3>> expected_;
  std::vector<Observation<3>> observations_;
  std::vector<Instant> known_;
};

/// Reported in its own step; markers that are not observed are predicted for a while.
class LiveMarkers final : public MarkersInSpace {
 public:
  LiveMarkers(const Rig& rig, double rate_hz, const MarkersInSpaceOptions& options)
      : MarkersInSpace(rig, rate_hz, options), predicted_(options.predict_s) {}

 private:
  void report_known(std::span<const Track<3>> tracks, std::vector<Instant>& known) override {
    predicted_.add_to(known.emplace_back(decisions().decided(tracks)), tracks);
  }

  PredictedMarkers predicted_;
};

/// Reported once the tracker has decided and gaps have ended.
class RecordedMarkers final : public MarkersInSpace {
 public:
  RecordedMarkers(const Rig& rig, double rate_hz, const MarkersInSpaceOptions& options)
      : MarkersInSpace(rig, rate_hz, options),
        filler_(frames_in(options.fill_s, rate_hz), frames_in(std::min(options.predict_s, options.fill_s), rate_hz)) {}

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& /*hooks*/) override {
    fill(tracker().decide_all());
    filler_.finish();
    return std::make_unique<Rest>(filler_);
  }

 private:
  /// Instants that still waited for the end of gaps when the cameras had ended.
  class Rest final : public corridor::InstantSource {
   public:
    explicit Rest(track::roster::GapFiller& filler) : filler_(filler) {}
    std::optional<Instant> next() override { return filler_.next(); }

   private:
    track::roster::GapFiller& filler_;
  };

  void report_known(std::span<const Track<3>> /*tracks*/, std::vector<Instant>& known) override {
    fill(tracker().decided());
    while (auto instant = filler_.next()) known.push_back(std::move(*instant));
  }

  void fill(std::span<const track::Decision<3>> decided) {
    for (const track::Decision<3>& decision : decided) filler_.add(decisions().decided(decision.tracks), decision.tracks);
  }

  track::roster::GapFiller filler_;
};

std::unique_ptr<corridor::Stage> markers_alone(const Rig& rig, double rate_hz, const MarkersInSpaceOptions& options) {
  if (options.live) return std::make_unique<LiveMarkers>(rig, rate_hz, options);
  return std::make_unique<RecordedMarkers>(rig, rate_hz, options);
}

}  // namespace

track::roster::RosterTrackerOptions space_tracker_options() {
  return {.filter = filter::KalmanOptions{.acceleration_noise = 3, .initial_speed = 1.5, .gate_sigmas = 4},
          .labels = {},
          .max_speed = 15,
          .marker_width = 0.02,
          .position_noise = 1e-4,
          .rigid_neighbours = true,
          .image = {}};
}

std::unique_ptr<corridor::Stage> markers_in_space(const Rig& rig, double rate_hz, const MarkersInSpaceOptions& options) {
  std::unique_ptr<corridor::Stage> markers = markers_alone(rig, rate_hz, options);
  if (options.learned_set != nullptr) {
    SetInSpaceOptions how;
    how.wait = options.waits_for_names;
    markers = with_set(std::move(markers), options.learned_set, how);
  }
  markers = with_naming(std::move(markers), options.naming);
  if (options.skeleton == nullptr) return markers;
  if (options.set.labels.empty() && options.learned_set == nullptr)
    throw Error("{}",
                "a skeleton is solved from markers that have names, and these have none: name them by --labels or --marker-set");
  return with_skeleton(std::move(markers), options.skeleton, live_pose_options());
}

}  // namespace marey::pipeline::markers
