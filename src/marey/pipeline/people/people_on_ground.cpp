#include "marey/pipeline/people/people_on_ground.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/draw/canvas.h"
#include "marey/pipeline/people/camera_contradictions.h"
#include "marey/pipeline/people/ground_offsets.h"
#include "marey/pipeline/people/live_teams.h"
#include "marey/pipeline/people/nobody_found.h"
#include "marey/track/image/view_log.h"

namespace marey::pipeline::people {
namespace {

using track::ground::CameraObservations;
using track::ground::GroundInstant;
using track::ground::ObservationMatch;

constexpr std::size_t kMostCameras = 64;
constexpr double kPatientFrames = 1.6;  // at few frames a second, a newcomer may be missed in one
constexpr double kLongEnough = 10;      // s, in which cameras that share ground share people
constexpr double kSure = 0.9;           // that a track which was lost is rightly joined: else the join is counted as doubtful

std::vector<double> offsets_of(const Rig& rig) {
  std::vector<double> offsets;
  for (const RigCamera& camera : rig.cameras) offsets.push_back(camera.offset_s.value_or(0));
  return offsets;
}

Rig as_fed(const Rig& rig, const std::vector<corridor::Feed>& feeds) {
  Rig fed = rig;
  for (std::size_t i = 0; i < feeds.size(); ++i) fed.cameras[i] = feeds[i].camera();
  return fed;
}

std::array<std::uint8_t, 3> bytes_of(const draw::Colour& colour) {
  return {static_cast<std::uint8_t>(colour.red), static_cast<std::uint8_t>(colour.green), static_cast<std::uint8_t>(colour.blue)};
}

/// BraMBLe has no detections, and so nothing to learn of them.
PeopleOnGroundOptions suited(PeopleOnGroundOptions options) {
  if (options.tracker.associate != track::ground::GroundAssociation::bramble) return options;
  options.detector = detect::blobs::BlobDetectorOptions{};
  options.learn = {.agreement = false, .walk = false, .teams = false, .association = false};
  return options;
}

class GroundStage final : public PeopleOnGround {
 public:
  GroundStage(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : options_(suited(options)),
        rig_(as_fed(rig, feeds)),
        area_(area_of(rig, options)),
        paths_(offsets_of(rig)),
        logs_(feeds.size()),
        observations_(feeds.size()) {
    open_cameras(feeds);
    track::ground::GroundTrackerOptions tracker = options.tracker;
    tracker.evidence.tentative_patience = std::max(tracker.evidence.tentative_patience, kPatientFrames / feeds.front().rate_hz());
    if (options.live) {
      tracker_ = track::ground::make_ground_tracker(tracker, views_);
      analyse::TeamOptions teams = options.teams;
      teams.pitch = area_.pitch();
      if (!teams.names.empty()) live_teams_.emplace(teams);
    } else {
      run_.emplace(tracker, options_.join, options_.learn, views_,
                   [this](const GroundInstant& instant, std::span<const ObservationMatch> matches) { note(instant, matches); });
    }
    header_.name = "people on the ground";
    header_.frame.kind = FrameOfReference::Kind::user_ground;
    header_.time_base = {.kind = TimeBase::Kind::camera, .camera = CameraId{0}};
    header_.track_kind = TrackKind::person;
    header_.made_by.program = "marey track";
    header_.rate_hz = feeds.front().rate_hz();
    header_.rig = rig_;
    header_.smoothed = !options.live;
  }

  RecordingHeader header() const override { return header_; }
  void want_boxes() override { wants_boxes_ = true; }
  const std::vector<analyse::Teams::Team>& teams() const override { return teams_.teams; }

  std::vector<std::shared_ptr<StandingPeople>> standing() const override {
    std::vector<std::shared_ptr<StandingPeople>> all;
    for (const GroundCamera& camera : cameras_) all.push_back(camera.standing());
    return all;
  }

  std::vector<std::string> news() override {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      for (std::string& sentence : cameras_[i].news()) all.push_back(std::move(sentence));
      if (!options_.live || cameras_[i].standing() == nullptr) continue;
      for (const std::string& sentence : cameras_[i].standing()->news())
        all.push_back(corridor::said_of(rig_.cameras[i], sentence));
    }
    return all;
  }

  std::span<const Instant> step(const FrameSet& frames) override {
    const auto seen = observe(frames, run_ ? run_->expected(frames.time) : tracker_->expected(frames.time));
    for (std::size_t i = 0; i < logs_.size() && wants_boxes_; ++i) {
      if (frames.cameras[i])
        logs_[i].add_frame(static_cast<std::int32_t>(frames.index), static_cast<std::int32_t>(frames.cameras[i]->frame.index));
    }
    moments_.push_back({frames.index, frames.time - rig_time_offset(header_.time_base, rig_)});
    if (options_.ball) note_ball(frames);
    if (!options_.live) {
      run_->step(static_cast<std::int32_t>(frames.index), frames.time, seen);
      return {};
    }
    const auto tracks = tracker_->step(frames.time, seen);
    paths_.add(seen, tracker_->matches());
    live_ = live(frames, tracks, seen);
    return {&live_, 1};
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    if (options_.live) return nullptr;
    const auto begin = std::chrono::steady_clock::now();
    join();
    if (options_.ball) ball_ = follow_ball(std::move(ball_moments_), views_, area_, *options_.ball, hooks, recording_);
    joining_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::make_unique<Joined>(*this);
  }

  void report(corridor::Summary& summary) const override {
    if (!options_.live) summary.left_out["off_pitch"] = off_pitch_;
    if (!options_.live) summary.figures["joining_s"] = joining_s_;
    if (options_.ball) report_ball(summary);
    if (!options_.live) summary.figures["joins"] = static_cast<double>(joins_);
    if (!options_.live) summary.figures["doubtful_joins"] = static_cast<double>(doubtful_joins_);
    for (const GroundCamera& camera : cameras_) camera.report(summary);
    if (const auto why = why_nobody(summary)) summary.warnings.push_back(*why);
    if (run_ && options_.learn.agreement) {
      for (std::string& sentence : contradicting_cameras(rig_, run_->compared())) summary.warnings.push_back(std::move(sentence));
      const bool is_long = !moments_.empty() && seconds(moments_.back().time - moments_.front().time) >= kLongEnough;
      for (std::string& sentence : uncompared_cameras(rig_, run_->compared())) {
        if (is_long) summary.notes.push_back(std::move(sentence));
      }
    }
    for (std::string& sentence : contradicted_offsets(rig_, paths_)) summary.warnings.push_back(std::move(sentence));
    for (const corridor::Summary::Camera& camera : summary.cameras) {
      if (camera.frames > 0) continue;
      summary.warnings.push_back(fmt::format("camera \"{}\" has no frame within the time of camera \"{}\"; is its offset_s right?",
                                             camera.name, rig_.cameras.front().name));
    }
  }

 private:
  /// The joined recording, instant by instant, with the boxes in the cameras' views where they are wanted.
  class Joined final : public corridor::InstantSource {
   public:
    explicit Joined(const GroundStage& stage) : stage_(stage), instants_(stage.recording_) {}

    std::optional<Instant> next() override {
      if (next_ == stage_.moments_.size()) return std::nullopt;
      const Recording::Moment& moment = stage_.moments_[next_++];
      if (!ahead_) ahead_ = instants_.next();
      Instant instant;
      if (ahead_ && ahead_->index == moment.index) instant = std::move(*std::exchange(ahead_, std::nullopt));
      instant.index = moment.index;
      instant.time = moment.time;
      for (TrackName& name : instant.named) name.colour = stage_.colour_of(name.id);
      name_ball(instant);
      name_unnamed(instant);
      if (stage_.wants_boxes_) stage_.add_boxes(instant);
      return instant;
    }

   private:
    /// At once, so that whoever writes knows that there is one.
    void name_ball(Instant& instant) {
      std::erase_if(instant.named, [this](const TrackName& name) { return name.id == stage_.ball_; });
      if (next_ == 1 && stage_.ball_)
        instant.named.push_back(
            {*stage_.ball_, std::string(kBallLabel), {}, std::array<std::uint8_t, 3>{255, 255, 255}, TrackKind::ball});
    }

    /// Who has neither label nor team still has a colour.
    void name_unnamed(Instant& instant) {
      for (const TrackName& name : instant.named) named_.insert(name.id);
      for (const Sample& sample : instant.samples) {
        if (!named_.insert(sample.track).second) continue;
        instant.named.push_back({sample.track, {}, {}, stage_.colour_of(sample.track)});
      }
    }

    const GroundStage& stage_;
    InstantsOf instants_;
    std::optional<Instant> ahead_;
    std::set<TrackId> named_;
    std::size_t next_ = 0;
  };

  void open_cameras(const std::vector<corridor::Feed>& feeds) {
    if (feeds.empty()) throw Error("{}", "the rig has no camera");
    if (feeds.size() > kMostCameras) throw Error("the rig has {} cameras; {} is the most", feeds.size(), kMostCameras);
    std::vector<GroundView> views;
    for (std::size_t i = 0; i < feeds.size(); ++i) {
      const auto turning = turning_of(options_.turning, feeds[i].id());
      views.push_back(turning ? first_view(rig_.cameras[i], *turning, rig_.ground) : ground_view_of(rig_.cameras[i], rig_.ground));
    }
    views_ = ground_views(std::move(views));
    for (std::size_t i = 0; i < feeds.size(); ++i) {
      if (const auto turning = turning_of(options_.turning, feeds[i].id()))
        enter_turns(*views_, feeds[i].id(), rig_.cameras[i], *turning, rig_.ground);
    }
    std::vector<std::optional<GroundCamera>> opened(feeds.size());
    tbb::parallel_for(std::size_t{0}, feeds.size(), [&](std::size_t i) {
      const GroundCameraOptions how{.detector = options_.detector,
                                    .prime = !options_.live,
                                    .steadied = options_.steady,
                                    .turning = turning_of(options_.turning, feeds[i].id()),
                                    .without = i < options_.without.size() ? options_.without[i] : nullptr,
                                    .ball = options_.ball ? std::optional(options_.ball->detector) : std::nullopt};
      opened[i].emplace(feeds[i], views_, area_, how);
    });
    for (auto& camera : opened) cameras_.push_back(std::move(*camera));
  }

  /// What each camera that has a frame sees of the ground, side by side.
  std::span<const CameraObservations> observe(const FrameSet& frames, std::span<const Track<2>> expected) {
    tbb::parallel_for(std::size_t{0}, cameras_.size(), [&](std::size_t i) {
      if (frames.cameras[i]) observations_[i] = cameras_[i].observe(*frames.cameras[i], expected);
    });
    seen_.clear();
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      if (frames.cameras[i]) seen_.push_back(observations_[i]);
    }
    return seen_;
  }

  void report_ball(corridor::Summary& summary) const {
    const TrackColumns* ball = ball_ ? recording_.find(*ball_) : nullptr;
    summary.figures["ball_samples"] = ball == nullptr ? 0.0 : static_cast<double>(ball->size());
    const bool looked =
        std::any_of(cameras_.begin(), cameras_.end(), [](const GroundCamera& camera) { return camera.ball().has_value(); });
    if (!looked)
      summary.warnings.push_back(
          "the ball was not looked for: that needs pictures of a camera that stands and is calibrated (marey calibrate pitch)");
    else if (ball == nullptr)
      summary.warnings.push_back("the ball was not found");
  }

  void note_ball(const FrameSet& frames) {
    track::ball::BallMoment& moment = ball_moments_.emplace_back();
    moment.index = frames.index;
    moment.time = frames.time;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      if (frames.cameras[i] && cameras_[i].ball()) moment.views.push_back(*cameras_[i].ball());
    }
  }

  /// What is decided of an instant.
  void note(const GroundInstant& instant, std::span<const ObservationMatch> matches) {
    paths_.add(instant.cameras, matches);
    if (wants_boxes_) log_boxes(instant, matches);
  }

  void log_boxes(const GroundInstant& instant, std::span<const ObservationMatch> matches) {
    for (const ObservationMatch& match : matches) {
      const CameraObservations& camera = instant.cameras[static_cast<std::size_t>(match.view)];
      const Observation<2>& seen = camera.seen[static_cast<std::size_t>(match.observation)];
      if (!seen.box || seen.shared) continue;
      logs_[static_cast<std::size_t>(number(camera.camera))].add_box(instant.frame, match.track, *seen.box);
    }
  }

  Instant live(const FrameSet& frames, std::span<const Track<2>> tracks, std::span<const CameraObservations> seen) {
    Instant instant;
    instant.index = frames.index;
    instant.time = moments_.back().time;
    moments_.clear();
    for (const Track<2>& track : tracks) {
      if (!track.confirmed || !area_.holds(track.position)) continue;
      Sample& sample = instant.samples.emplace_back();
      sample.track = track.id;
      sample.position.head<2>() = area_.ground(track.position);
      sample.velocity.emplace(Vector<3>::Zero()).head<2>() = area_.ground_velocity(track.velocity);
      sample.provenance = track.provenance;
      sample.cameras = track.cameras;
    }
    if (live_teams_) instant.named = live_teams_->step(instant, appearances(seen));
    if (!wants_boxes_) return instant;
    logs_ = std::vector<track::image::ViewLog>(cameras_.size());
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      if (frames.cameras[i])
        logs_[i].add_frame(static_cast<std::int32_t>(frames.index), static_cast<std::int32_t>(frames.cameras[i]->frame.index));
    }
    log_boxes(GroundInstant(static_cast<std::int32_t>(frames.index), frames.time, seen), tracker_->matches());
    for (track::image::ViewLog& log : logs_) log.name([](TrackId track, std::int32_t) { return track; });
    add_boxes(instant);
    return instant;
  }

  /// What was observed of each track at this instant.
  std::map<TrackId, Appearance> appearances(std::span<const CameraObservations> seen) const {
    std::map<TrackId, Appearance> appearances;
    for (const ObservationMatch& match : tracker_->matches()) {
      const auto& observation = seen[static_cast<std::size_t>(match.view)].seen[static_cast<std::size_t>(match.observation)];
      if (observation.appearance && !observation.shared) appearances.insert_or_assign(match.track, *observation.appearance);
    }
    return appearances;
  }

  /// The second pass: the tracks of the whole recording, in the user's coordinates, without those who never were in the area.
  void join() {
    auto joined = run_->finish([&](const Vector<2>& place, Timestamp time) { return in_sight(place, time); });
    joins_ = std::ssize(joined.joins);
    doubtful_joins_ =
        std::count_if(joined.joins.begin(), joined.joins.end(), [](const auto& one) { return one.probability < kSure; });
    const std::size_t all = joined.recording.tracks().size();
    joined.recording.header.rig = rig_;
    joined.recording.header.time_base = {.kind = TimeBase::Kind::rig};
    reconstruct::KeptPeople people = reconstruct::people_in(area_, with_time_base(std::move(joined.recording), header_.time_base));
    recording_ = std::move(people.recording);
    recording_.header = header_;
    off_pitch_ = static_cast<std::int64_t>(all - people.now.size());
    std::vector<std::optional<Appearance>> appearances(people.now.size());
    for (const auto& [before, now] : people.now)
      appearances[static_cast<std::size_t>(number(now)) - 1] = joined.wears[static_cast<std::size_t>(number(before)) - 1];
    analyse::TeamOptions teams = options_.teams;
    teams.pitch = area_.pitch();
    teams_ = analyse::find_teams(recording_, appearances, teams);
    analyse::note_teams(teams_, recording_);
    for (track::image::ViewLog& log : logs_) {
      log.name([&](TrackId track, std::int32_t instant) -> std::optional<TrackId> {
        const auto person = joined.person_of(track, instant);
        const auto now = person ? people.now.find(*person) : people.now.end();
        if (now == people.now.end()) return std::nullopt;
        return now->second;
      });
    }
  }

  bool in_sight(const Vector<2>& place, Timestamp time) const {
    if (!area_.holds(place)) return false;
    return std::any_of(cameras_.begin(), cameras_.end(), [&](const GroundCamera& camera) {
      const GroundView& view = camera.view_at(time);
      const auto pixel = view.pixel(place);
      return pixel && cv::Rect2d({-0.5, -0.5}, cv::Size2d(view.size())).contains({pixel->x(), pixel->y()});
    });
  }

  /// A player's is the team's, anybody else's is left to the number.
  std::optional<std::array<std::uint8_t, 3>> colour_of(TrackId track) const {
    const auto i = static_cast<std::size_t>(number(track)) - 1;
    if (i >= teams_.members.size() || !teams_.members[i].team || teams_.members[i].role != analyse::Teams::Role::player)
      return std::nullopt;
    return bytes_of(draw::colour_of(teams_.teams[static_cast<std::size_t>(*teams_.members[i].team)].colour));
  }

  /// Where everybody is in each camera's picture: as it saw them, else as somebody who stands there would be seen.
  void add_boxes(Instant& instant) const {
    const Timestamp time = instant.time + rig_time_offset(header_.time_base, rig_);
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const auto own = logs_[i].frame_at(instant.index);
      if (!own) continue;
      const GroundView& view = cameras_[i].view_at(time);
      const Box picture{0, 0, static_cast<double>(view.size().width), static_cast<double>(view.size().height)};
      for (const Sample& sample : instant.samples) {
        const Vector<2> place = area_.world(sample.position.head<2>());
        const bool is_ball = sample.track == ball_;
        std::optional<Box> box = is_ball ? ball_box(view, place, sample.position.z()) : logs_[i].box(instant.index, sample.track);
        if (!box) {
          if (is_ball) continue;
          const auto whole = cameras_[i].box_at(place, time);
          if (!whole) continue;
          box = geometry::intersection(*whole, picture);
          if (box->empty()) continue;
        }
        const CameraId camera{static_cast<int>(i)};
        instant.boxes.push_back({.camera = camera,
                                 .frame = *own,
                                 .track = sample.track,
                                 .box = *box,
                                 .foot = is_ball ? box->centre() : view.pixel(place),
                                 .seen = (sample.cameras & mask_of(camera)) != 0});
      }
    }
  }

  PeopleOnGroundOptions options_;
  Rig rig_;
  reconstruct::GroundArea area_;
  RecordingHeader header_;
  std::shared_ptr<GroundViews> views_;
  std::vector<GroundCamera> cameras_;
  std::unique_ptr<track::ground::GroundTracker> tracker_;  // where `live`
  std::optional<track::ground::GroundRun> run_;            // else
  GroundPathLog paths_;
  std::vector<track::image::ViewLog> logs_;  // of each camera, where boxes are wanted
  bool wants_boxes_ = false;
  std::vector<CameraObservations> observations_, seen_;
  std::int64_t joins_ = 0, doubtful_joins_ = 0;
  std::vector<Recording::Moment> moments_;  // by the header's clock; where `live`, of this step alone
  Recording recording_;
  std::vector<track::ball::BallMoment> ball_moments_;
  std::optional<TrackId> ball_;
  std::optional<LiveTeams> live_teams_;  // where `live`, of teams that are named
  analyse::Teams teams_;
  std::int64_t off_pitch_ = 0;
  double joining_s_ = 0;
  Instant live_;
};

}  // namespace

reconstruct::GroundArea area_of(const Rig& rig, const PeopleOnGroundOptions& options) {
  if (!options.area.empty()) return {rig.ground_from_world, options.area, options.margin};
  return {rig.ground_from_world, options.pitch, options.margin};
}

std::unique_ptr<PeopleOnGround> people_on_ground(const std::vector<corridor::Feed>& feeds, const Rig& rig,
                                                 const PeopleOnGroundOptions& options) {
  return std::make_unique<GroundStage>(feeds, rig, options);
}

}  // namespace marey::pipeline::people
