#include "marey/pipeline/people/people_on_ground.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "marey/pipeline/people/camera_contradictions.h"
#include "marey/pipeline/people/ground_boxes.h"
#include "marey/pipeline/people/ground_cameras.h"
#include "marey/pipeline/people/ground_offsets.h"
#include "marey/pipeline/people/ground_second_pass.h"
#include "marey/pipeline/people/live_teams.h"
#include "marey/pipeline/people/nobody_found.h"

namespace marey::pipeline::people {
namespace {

using track::ground::CameraObservations;
using track::ground::GroundInstant;
using track::ground::ObservationMatch;

constexpr double kTentativeFrames = 1.6;  // at low frame rates, a new track may be missed in one frame
constexpr double kMinComparedS = 10;      // in which cameras that share ground share people

std::vector<double> offsets_of(const Rig& rig) {
  std::vector<double> offsets;
  for (const RigCamera& camera : rig.cameras) offsets.push_back(camera.offset_s.value_or(0));
  return offsets;
}

/// BraMBLe has no detections, and so nothing to learn of them.
PeopleOnGroundOptions suited(PeopleOnGroundOptions options) {
  if (options.tracker.associate != track::ground::GroundAssociation::bramble) return options;
  options.detector = detect::blobs::BlobDetectorOptions{};
  options.learn = {.agreement = false, .walk = false, .teams = false, .association = false};
  return options;
}

/// The rate, below which a new track is confirmed late, counts.
track::ground::GroundTrackerOptions tracker_options(track::ground::GroundTrackerOptions tracker, double rate_hz) {
  tracker.evidence.tentative_patience = std::max(tracker.evidence.tentative_patience, kTentativeFrames / rate_hz);
  return tracker;
}

/// What a live run and one over a whole recording share: cameras, and whose observations were whose.
class GroundStage : public PeopleOnGround {
 public:
  GroundStage(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : options_(suited(options)),
        area_(area_of(rig, options)),
        cameras_(feeds, rig, area_, options_),
        paths_(offsets_of(rig)),
        boxes_(feeds.size()) {
    header_.name = "people on the ground";
    header_.frame.kind = FrameOfReference::Kind::user_ground;
    header_.time_base = {.kind = TimeBase::Kind::camera, .camera = CameraId{0}};
    header_.track_kind = TrackKind::person;
    header_.made_by.program = "marey track";
    header_.rate_hz = feeds.front().rate_hz();
    header_.rig = cameras_.rig();
    header_.smoothed = !options.live;
  }

  RecordingHeader header() const override { return header_; }
  void want_boxes() override { boxes_.want(); }
  std::vector<std::shared_ptr<StandingPeople>> standing() const override { return cameras_.standing(); }
  std::vector<std::string> news() override { return cameras_.news(); }

 protected:
  /// By the header's clock.
  Timestamp own_time(Timestamp rig_time) const { return rig_time - rig_time_offset(header_.time_base, cameras_.rig()); }

  void report_cameras(corridor::Summary& summary) const {
    cameras_.report(summary);
    if (const auto why = why_nobody(summary)) summary.warnings.push_back(*why);
  }

  void report_times(corridor::Summary& summary) const {
    for (std::string& sentence : contradicted_offsets(cameras_.rig(), paths_)) summary.warnings.push_back(std::move(sentence));
    for (const corridor::Summary::Camera& camera : summary.cameras) {
      if (camera.frames > 0) continue;
      summary.warnings.push_back(fmt::format("camera \"{}\" has no frame within the time of camera \"{}\"; is its offset_s right?",
                                             camera.name, cameras_.rig().cameras.front().name));
    }
  }

  PeopleOnGroundOptions options_;
  reconstruct::GroundArea area_;
  GroundCameras cameras_;
  RecordingHeader header_;
  GroundPathLog paths_;
  GroundBoxes boxes_;
};

/// The whole recording: tracked with what is learned of it, then linked, smoothed and divided into teams.
class RecordedGround final : public GroundStage {
 public:
  RecordedGround(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : GroundStage(feeds, rig, options),
        tracking_(tracker_options(options.tracker, header_.rate_hz), options_.join, options_.learn, cameras_.views(),
                  [this](const GroundInstant& instant, std::span<const ObservationMatch> matches) {
                    paths_.add(instant.cameras, matches);
                    boxes_.add(instant, matches);
                  }) {}

  const std::vector<analyse::Teams::Team>& teams() const override { return people_.teams.teams; }

  std::span<const Instant> step(const FrameSet& frames) override {
    const auto observed = cameras_.observe(frames, tracking_.expected(frames.time));
    boxes_.add_frames(frames);
    moments_.push_back({frames.index, own_time(frames.time)});
    if (options_.ball) ball_candidates_.push_back(cameras_.ball_candidates(frames));
    tracking_.step(static_cast<std::int32_t>(frames.index), frames.time, observed);
    return {};
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    const GroundTracked tracked{cameras_, area_, header_};
    people_ = second_pass(tracking_, tracked, boxes_, std::move(ball_candidates_), options_, hooks);
    return ground_instants(people_, tracked, boxes_, moments_);
  }

  void report(corridor::Summary& summary) const override {
    summary.left_out["off_pitch"] = people_.outside;
    summary.figures["joining_s"] = people_.seconds;
    if (options_.ball) report_ball(summary);
    summary.figures["joins"] = static_cast<double>(people_.links);
    summary.figures["doubtful_joins"] = static_cast<double>(people_.uncertain_links);
    report_cameras(summary);
    if (options_.learn.agreement) report_agreement(summary);
    report_times(summary);
  }

 private:
  void report_ball(corridor::Summary& summary) const {
    const TrackColumns* ball = people_.ball ? people_.recording.find(*people_.ball) : nullptr;
    summary.figures["ball_samples"] = ball == nullptr ? 0.0 : static_cast<double>(ball->size());
    if (!cameras_.search_ball())
      summary.warnings.push_back(
          "the ball was not looked for: that needs pictures of a camera that stands and is calibrated (marey calibrate pitch)");
    else if (ball == nullptr)
      summary.warnings.push_back("the ball was not found");
  }

  void report_agreement(corridor::Summary& summary) const {
    for (std::string& sentence : contradicting_cameras(cameras_.rig(), tracking_.compared()))
      summary.warnings.push_back(std::move(sentence));
    if (moments_.empty() || seconds(moments_.back().time - moments_.front().time) < kMinComparedS) return;
    for (std::string& sentence : uncompared_cameras(cameras_.rig(), tracking_.compared()))
      summary.notes.push_back(std::move(sentence));
  }

  track::ground::GroundRun tracking_;
  std::vector<Recording::Moment> moments_;  // by the header's clock
  std::vector<track::ball::BallMoment> ball_candidates_;
  GroundPeople people_;
};

/// Each instant reported in its own step: nothing read ahead, nothing improved afterwards.
class LiveGround final : public GroundStage {
 public:
  LiveGround(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : GroundStage(feeds, rig, options),
        tracker_(track::ground::make_ground_tracker(tracker_options(options.tracker, header_.rate_hz), cameras_.views())) {
    analyse::TeamOptions teams = options.teams;
    teams.pitch = area_.pitch();
    if (!teams.names.empty()) live_teams_.emplace(teams);
  }

  const std::vector<analyse::Teams::Team>& teams() const override { return teams_; }

  std::span<const Instant> step(const FrameSet& frames) override {
    const auto observed = cameras_.observe(frames, tracker_->expected(frames.time));
    const auto tracks = tracker_->step(frames.time, observed);
    paths_.add(observed, tracker_->matches());
    instant_ = reported(frames, tracks);
    if (live_teams_) instant_.named = live_teams_->step(instant_, appearances(observed));
    if (boxes_.wanted()) add_boxes(frames, observed);
    return {&instant_, 1};
  }

  std::vector<std::string> news() override {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      for (std::string& sentence : cameras_.news_of(i)) all.push_back(std::move(sentence));
      if (cameras_[i].standing() == nullptr) continue;
      for (const std::string& sentence : cameras_[i].standing()->news())
        all.push_back(corridor::said_of(cameras_.rig().cameras[i], sentence));
    }
    return all;
  }

  void report(corridor::Summary& summary) const override {
    report_cameras(summary);
    report_times(summary);
  }

 private:
  /// The confirmed tracks within the area, in the user's coordinates.
  Instant reported(const FrameSet& frames, std::span<const Track<2>> tracks) const {
    Instant instant;
    instant.index = frames.index;
    instant.time = own_time(frames.time);
    for (const Track<2>& track : tracks) {
      if (!track.confirmed || !area_.holds(track.position)) continue;
      Sample& sample = instant.samples.emplace_back();
      sample.track = track.id;
      sample.position.head<2>() = area_.ground(track.position);
      sample.velocity.emplace(Vector<3>::Zero()).head<2>() = area_.ground_velocity(track.velocity);
      sample.provenance = track.provenance;
      sample.cameras = track.cameras;
    }
    return instant;
  }

  /// Of each track that was observed at this instant, by any camera.
  std::map<TrackId, Appearance> appearances(std::span<const CameraObservations> observed) const {
    std::map<TrackId, Appearance> appearances;
    for (const ObservationMatch& match : tracker_->matches()) {
      const auto& observation = observed[static_cast<std::size_t>(match.view)].seen[static_cast<std::size_t>(match.observation)];
      if (observation.appearance && !observation.shared) appearances.insert_or_assign(match.track, *observation.appearance);
    }
    return appearances;
  }

  void add_boxes(const FrameSet& frames, std::span<const CameraObservations> observed) {
    boxes_.clear();
    boxes_.add_frames(frames);
    boxes_.add(GroundInstant(static_cast<std::int32_t>(frames.index), frames.time, observed), tracker_->matches());
    boxes_.rename([](TrackId track, std::int32_t) { return track; });
    const Timestamp rig_time = instant_.time + rig_time_offset(header_.time_base, cameras_.rig());
    boxes_.add_to(instant_, rig_time, cameras_, area_, std::nullopt);
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
  if (options.live) return std::make_unique<LiveGround>(feeds, rig, options);
  return std::make_unique<RecordedGround>(feeds, rig, options);
}

}  // namespace marey::pipeline::people
