#include "marey/pipeline/people/ground/people_on_ground.h"

#include <algorithm>
#include <map>
#include <utility>

#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/pipeline/people/ground/bramble_on_ground.h"
#include "marey/pipeline/people/ground/camera_contradictions.h"
#include "marey/pipeline/people/ground/ground_cameras.h"
#include "marey/pipeline/people/ground/ground_second_pass.h"
#include "marey/pipeline/people/ground/ground_stage.h"
#include "marey/pipeline/people/ground/live_teams.h"
#include "marey/track/ground/ground_run.h"

namespace marey::pipeline::people::ground {
namespace {

using track::ground::CameraObservations;
using track::ground::GroundInstant;
using track::ground::ObservationMatch;

constexpr double kTentativeFrames = 1.6;  // at low frame rates, a new track may be missed in one frame
constexpr double kMinComparedS = 10;      // in which cameras that share ground share people

/// The rate, below which a new track is confirmed late, counts.
track::ground::GroundTrackerOptions tracker_options(track::ground::GroundTrackerOptions tracker, double rate_hz) {
  tracker.evidence.tentative_patience = std::max(tracker.evidence.tentative_patience, kTentativeFrames / rate_hz);
  return tracker;
}

GroundScene scene_of(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options) {
  Rig fed = ground_rig(rig, feeds);
  auto views = views_of(fed, options.ptz);
  return {.rig = std::move(fed), .views = std::move(views), .area = area_of(rig, options), .box_at = {}};
}

/// Cameras whose detections are tracked.
class DetectedGround : public GroundStage {
 public:
  DetectedGround(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : GroundStage(feeds, options, scene_of(feeds, rig, options)), cameras_(feeds, scene_.views, scene_.area, options) {
    scene_.box_at = [this](CameraId camera, const Vector<2>& position, Timestamp time) {
      return cameras_[static_cast<std::size_t>(number(camera))].box_at(position, time);
    };
  }

  std::vector<std::shared_ptr<StandingPeople>> standing() const override { return cameras_.standing(); }

 protected:
  GroundCameras cameras_;
};

/// The whole recording: tracked with the models learned from it, then linked, smoothed and divided into teams.
class RecordedGround final : public DetectedGround {
 public:
  RecordedGround(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : DetectedGround(feeds, rig, options),
        tracking_(tracker_options(options.tracker, header_.rate_hz), options.join, options.learn, scene_.views,
                  [this](const GroundInstant& instant, std::span<const ObservationMatch> matches) { note(instant, matches); }) {}

  const std::vector<analyse::Teams::Team>& teams() const override { return people_.teams.teams; }
  std::vector<std::string> news() override { return cameras_.news(); }

  std::span<const Instant> step(const FrameSet& frames) override {
    const auto observed = cameras_.observe(frames, tracking_.expected(frames.time));
    boxes_.add_frames(frames);
    time_steps_.push_back({frames.index, own_time(frames.time)});
    if (options_.ball) ball_candidates_.push_back(cameras_.ball_candidates(frames));
    tracking_.step(static_cast<std::int32_t>(frames.index), frames.time, observed);
    return {};
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    const corridor::Stopwatch taken;
    auto joined = tracking_.finish([this](const Vector<2>& position, Timestamp time) { return scene_.in_view(position, time); });
    people_ = second_pass(std::move(joined), scene_, header_, boxes_, std::move(ball_candidates_), options_, hooks);
    people_.linking_s = taken.seconds();
    return ground_instants(people_, scene_, boxes_, time_steps_);
  }

  void report(corridor::Summary& summary) const override {
    report_people(people_, options_.ball.has_value(), cameras_.search_ball(), summary);
    cameras_.report(summary);
    explain_empty_result(summary);
    if (options_.learn.agreement) report_agreement(summary);
    report_times(summary);
  }

 private:
  void report_agreement(corridor::Summary& summary) const {
    for (std::string& message_text : contradicting_cameras(scene_.rig, tracking_.compared()))
      summary.warnings.push_back(std::move(message_text));
    if (time_steps_.empty() || seconds(time_steps_.back().time - time_steps_.front().time) < kMinComparedS) return;
    for (std::string& message_text : uncompared_cameras(scene_.rig, tracking_.compared()))
      summary.notes.push_back(std::move(message_text));
  }

  track::ground::GroundRun tracking_;
  std::vector<Recording::TimeStep> time_steps_;  // by the header's clock
  std::vector<track::ball::BallObservations> ball_candidates_;
  GroundPeople people_;
};

/// Each instant reported in its own step: nothing read ahead, nothing improved afterwards.
class LiveGround final : public DetectedGround {
 public:
  LiveGround(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : DetectedGround(feeds, rig, options),
        tracker_(track::ground::make_ground_tracker(tracker_options(options.tracker, header_.rate_hz), scene_.views)) {
    analyse::TeamOptions teams = options.teams;
    teams.pitch = scene_.area.pitch();
    if (!teams.names.empty()) live_teams_.emplace(teams);
  }

  const std::vector<analyse::Teams::Team>& teams() const override { return teams_; }

  std::span<const Instant> step(const FrameSet& frames) override {
    const auto observed = cameras_.observe(frames, tracker_->expected(frames.time));
    const auto tracks = tracker_->step(frames.time, observed);
    paths_.add(observed, tracker_->matches());
    instant_ = live_instant(frames, tracks);
    if (live_teams_) instant_.named = live_teams_->step(instant_, appearances(observed));
    add_live_boxes(frames, observed, tracker_->matches(), instant_);
    return {&instant_, 1};
  }

  std::vector<std::string> news() override {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      for (std::string& message_text : cameras_.news_of(i)) all.push_back(std::move(message_text));
      if (cameras_[i].standing() == nullptr) continue;
      for (const std::string& message_text : cameras_[i].standing()->news())
        all.push_back(corridor::stated_of(scene_.rig.cameras[i], message_text));
    }
    return all;
  }

  void report(corridor::Summary& summary) const override {
    cameras_.report(summary);
    explain_empty_result(summary);
    report_times(summary);
  }

 private:
  /// Of each track that was observed at this instant, by any camera.
  std::map<TrackId, Appearance> appearances(std::span<const CameraObservations> observed) const {
    std::map<TrackId, Appearance> appearances;
    for (const ObservationMatch& match : tracker_->matches()) {
      const auto& observation =
          observed[static_cast<std::size_t>(match.view)].detected[static_cast<std::size_t>(match.observation)];
      if (observation.appearance && !observation.shared) appearances.insert_or_assign(match.track, *observation.appearance);
    }
    return appearances;
  }

  std::unique_ptr<track::ground::GroundTracker> tracker_;
  std::optional<LiveTeams> live_teams_;  // if the user named the teams
  std::vector<analyse::Teams::Team> teams_;
  Instant instant_;
};

}  // namespace

reconstruct::GroundArea area_of(const Rig& rig, const PeopleOnGroundOptions& options) {
  if (!options.area.empty()) return {rig.ground_from_world, options.area, options.margin};
  return {rig.ground_from_world, options.pitch, options.margin};
}

std::unique_ptr<PeopleOnGround> people_on_ground(const std::vector<corridor::Feed>& feeds, const Rig& rig,
                                                 const PeopleOnGroundOptions& options) {
  if (options.bramble) return bramble_on_ground(feeds, rig, options);
  if (options.live) return std::make_unique<LiveGround>(feeds, rig, options);
  return std::make_unique<RecordedGround>(feeds, rig, options);
}

}  // namespace marey::pipeline::people::ground
