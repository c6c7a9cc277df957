#include "marey/pipeline/track_ground.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/rig/rig_sources.h"
#include "marey/pipeline/ground_area.h"
#include "marey/pipeline/ground_films.h"
#include "marey/pipeline/ground_offsets.h"

namespace marey::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr double kUsualRate = 25;  // Hz, of live pictures of which nobody says it

double since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// What the cameras saw at an instant, kept until the tracker is sure of it.
struct KeptLooks {
  KeptLooks(std::int32_t number, std::span<const track::ground::CameraObservations> all)
      : frame(number), looks(all.begin(), all.end()) {
    seen.reserve(looks.size());
    for (track::ground::CameraObservations& look : looks) look.seen = seen.emplace_back(look.seen.begin(), look.seen.end());
  }

  std::int32_t frame;
  std::vector<track::ground::CameraObservations> looks;
  std::vector<std::vector<Observation<2>>> seen;
};

std::vector<double> offsets_of(const Rig& rig) {
  std::vector<double> offsets;
  for (const RigCamera& camera : rig.cameras) offsets.push_back(camera.offset_s.value_or(0));
  return offsets;
}

/// The same, its times by the clock of the first camera, which was started `offset` s after the rig's.
Recording by_first_camera(Recording recording, double offset) {
  Recording result(recording.header);
  for (const Recording::Moment& moment : recording.instants())
    result.add_moment({moment.index, moment.time - duration_from_seconds(offset)});
  for (TrackColumns& track : recording.take_tracks()) result.put(std::move(track));
  return result;
}

class Run {
 public:
  Run(const Rig& rig, const GroundOutput& output, const TrackGroundOptions& options, const RunHooks& hooks)
      : output_(output),
        options_(options),
        hooks_(hooks),
        area_(rig.ground_from_world, options.pitch, options.margin),
        cameras_(rig, area_, {with_read_ahead(options.eyes, !options.live), options.rate_hz}),
        tracker_(track::ground::make_ground_tracker(options.tracker, cameras_.views())),
        paths_(offsets_of(rig)),
        logs_(rig.cameras.size()),
        shows_(!output.boxes_of.empty() || !output.overlays.empty() || !output.pitch_view.empty()) {
    recording_.header = header();
    if (options.live && output.boxes_of.empty()) file_.emplace(output.tracks).begin(recording_.header);
    if (output.overlays.empty()) return;
    const auto has_pictures = [](const RigCamera& camera) { return !camera.source.empty(); };
    if (std::none_of(rig.cameras.begin(), rig.cameras.end(), has_pictures))
      throw Error("{}: no camera has pictures to draw into; ask for a pitch view instead", output.overlays);
    fs::create_directories(output.overlays);
  }

  GroundSummary operator()() {
    const auto begin = std::chrono::steady_clock::now();
    follow();
    cameras_.close();
    summary_.tracking_s = since(begin);
    if (!options_.live) {
      const auto between = std::chrono::steady_clock::now();
      join();
      summary_.joining_s = since(between);
    }
    if (file_) {
      file_->finish();
    } else if (output_.boxes_of.empty()) {
      format::match::write_ground(recording_, output_.tracks);
    }
    if (shows_) show();
    tell();
    return std::move(summary_);
  }

 private:
  static DetectionStageOptions with_read_ahead(DetectionStageOptions eyes, bool read_ahead) {
    eyes.read_ahead = read_ahead;
    return eyes;
  }

  /// The first pass: everything that is said of an instant knows only what came before it, and a little after.
  void follow() {
    while (cameras_.next()) {
      const auto looks = cameras_.look(tracker_->expected(cameras_.time()));
      const auto tracks = tracker_->step(cameras_.time(), looks);
      now_ = cameras_.time() - duration_from_seconds(first_offset());
      if (!first_) first_ = now_;
      paths_.add(looks, tracker_->claims());
      log_frames();
      if (options_.live) {
        write_live(tracks);
        log_boxes(cameras_.frame(), looks, tracker_->claims());
      } else {
        waiting_.emplace_back(cameras_.frame(), looks);
        record(tracker_->decided());
      }
      summary_.stopped = hooks_.tell({TrackProgress::Step::tracking, cameras_.frame() + 1, cameras_.frame_count()});
      if (summary_.stopped) break;
    }
    if (!options_.live) record(tracker_->decide_all());
    summary_.frames = cameras_.frame() + 1;
    if (summary_.frames == 0) throw Error("camera \"{}\": not one frame could be read", cameras_.rig().cameras.front().name);
    summary_.seconds = seconds(now_) - seconds(*first_);
  }

  /// What the tracker is sure of, of instants that waited for it.
  void record(std::span<const track::ground::GroundDecision> decisions) {
    for (const track::ground::GroundDecision& decision : decisions) {
      const KeptLooks& kept = waiting_.front();
      recorder_.add(kept.frame, decision.now, decision.tracks, kept.looks, decision.claims);
      log_boxes(kept.frame, kept.looks, decision.claims);
      waiting_.pop_front();
    }
  }

  void log_frames() {
    if (!shows_) return;
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      if (const auto own = cameras_.frame_of(i)) logs_[i].add_frame(cameras_.frame(), *own);
    }
  }

  void log_boxes(std::int32_t frame, std::span<const track::ground::CameraObservations> looks,
                 std::span<const track::ground::ObservationMatch> claims) {
    if (!shows_) return;
    for (const track::ground::ObservationMatch& claim : claims) {
      const track::ground::CameraObservations& look = looks[static_cast<std::size_t>(claim.look)];
      const Observation<2>& seen = look.seen[static_cast<std::size_t>(claim.observation)];
      if (seen.box && !seen.shared) logs_[static_cast<std::size_t>(number(look.camera))].add_box(frame, claim.track, *seen.box);
    }
  }

  double first_offset() const { return cameras_.rig().cameras.front().offset_s.value_or(0); }

  RecordingHeader header() const {
    RecordingHeader header;
    header.name = "people on the ground";
    header.frame.kind = FrameOfReference::Kind::user_ground;
    header.rate_hz = cameras_.rate_hz().value_or(kUsualRate);
    header.rig = cameras_.rig();
    return header;
  }

  Sample sample_of(const Track<2>& track) const {
    Sample sample;
    sample.track = track.id;
    sample.position.head<2>() = area_.ground(track.position);
    sample.velocity.emplace(Vector<3>::Zero()).head<2>() = area_.ground_velocity(track.velocity);
    sample.provenance = track.state == Track<2>::State::observed ? Provenance::measured : Provenance::predicted;
    sample.cameras = track.cameras;
    return sample;
  }

  void write_live(std::span<const Track<2>> tracks) {
    Instant instant;
    instant.index = cameras_.frame();
    instant.time = now_;
    for (const Track<2>& track : tracks) {
      if (!track.confirmed || !area_.holds(track.position)) continue;
      instant.samples.push_back(sample_of(track));
      live_people_.insert(track.id);
      count(instant.samples.back().measured());
    }
    if (file_) file_->write(instant);
    if (shows_) recording_.add(instant);
  }

  void count(bool measured) {
    ++summary_.rows;
    if (!measured) ++summary_.predicted;
  }

  /// The second pass: who is whom over the whole recording, in the user's coordinates, without those who never were on the pitch.
  void join() {
    pieces_ = std::move(recorder_).join(options_.join, [&](const Vector<2>& place) { return in_sight(place); });
    const std::size_t all = pieces_.recording.tracks().size();
    KeptPeople people = people_in(area_, by_first_camera(std::move(pieces_.recording), first_offset()));
    recording_ = std::move(people.recording);
    recording_.header.rig = cameras_.rig();
    if (const auto rate = cameras_.rate_hz()) recording_.header.rate_hz = *rate;
    summary_.off_pitch = static_cast<std::int64_t>(all - people.now.size());
    std::vector<std::optional<Appearance>> wears(people.now.size());
    for (const auto& [before, now] : people.now)
      wears[static_cast<std::size_t>(number(now)) - 1] = pieces_.wears[static_cast<std::size_t>(number(before)) - 1];
    analyse::TeamOptions teams = options_.teams;
    teams.pitch = area_.pitch();
    teams_ = analyse::find_teams(recording_, wears, teams);
    analyse::note_teams(teams_, recording_);
    for (ViewLog& log : logs_) {
      log.name([&](TrackId track, std::int32_t frame) -> std::optional<TrackId> {
        const auto person = pieces_.person_of(track, frame);
        const auto now = person ? people.now.find(*person) : people.now.end();
        if (now == people.now.end()) return std::nullopt;
        return now->second;
      });
    }
    for (const TrackColumns& track : recording_.tracks()) {
      for (std::size_t row = 0; row < track.size(); ++row) count(track.measured(row));
    }
  }

  bool in_sight(const Vector<2>& place) const {
    if (!area_.holds(place)) return false;
    return std::any_of(cameras_.views().begin(), cameras_.views().end(), [&](const GroundView& view) {
      const auto pixel = view.pixel(place);
      return pixel && cv::Rect2d({-0.5, -0.5}, cv::Size2d(view.size())).contains({pixel->x(), pixel->y()});
    });
  }

  void show() {
    if (options_.live) {
      for (ViewLog& log : logs_) {
        log.name([&](TrackId track, std::int32_t) { return live_people_.contains(track) ? std::optional(track) : std::nullopt; });
      }
    }
    const GroundShow all{recording_, area_, cameras_, colours(), hooks_};
    const auto& cameras = cameras_.rig().cameras;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      if (cameras[i].name == output_.boxes_of) write_view_boxes(all, i, logs_[i], output_.tracks);
      if (!output_.overlays.empty() && !cameras[i].source.empty())
        summary_.stopped |= film_view(all, i, logs_[i], (fs::path(output_.overlays) / (cameras[i].name + ".mp4")).string());
    }
    if (!output_.pitch_view.empty()) summary_.stopped |= film_ground(all, output_.pitch_view);
  }

  std::vector<draw::Colour> colours() const {
    std::vector<draw::Colour> colours;
    for (std::size_t i = 0; i < recording_.tracks().size(); ++i) {
      const auto team = i < teams_.members.size() ? teams_.members[i].team : std::nullopt;
      const bool alone = !team || teams_.members[i].role != analyse::Teams::Role::player;
      colours.push_back(alone ? draw::colour_of(number(recording_.tracks()[i].id()))
                              : draw::colour_of(teams_.teams[static_cast<std::size_t>(*team)].colour));
    }
    return colours;
  }

  void tell() {
    summary_.people = std::ssize(recording_.tracks());
    if (options_.live) summary_.people = std::ssize(live_people_);
    summary_.warnings = cameras_.warnings();
    summary_.teams = teams_.teams;
    for (std::string& sentence : contradicted_offsets(cameras_.rig(), paths_)) summary_.warnings.push_back(std::move(sentence));
    const auto& cameras = cameras_.rig().cameras;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const GroundCameras::Counts counts = cameras_.counts(i);
      if (counts.frames == 0) {
        summary_.warnings.push_back(
            fmt::format("camera \"{}\" has no frame within the time of camera \"{}\"; is its offset_s right?",
                        cameras[i].name, cameras.front().name));
      }
      summary_.cameras.push_back({cameras[i].name, counts});
    }
  }

  GroundOutput output_;
  TrackGroundOptions options_;
  RunHooks hooks_;
  GroundArea area_;
  GroundCameras cameras_;
  std::unique_ptr<track::ground::GroundTracker> tracker_;
  std::deque<KeptLooks> waiting_;
  track::ground::GroundRecorder recorder_;
  GroundPathLog paths_;
  track::ground::GroundRecorder::Joined pieces_;
  Recording recording_;
  analyse::Teams teams_;
  Timestamp now_{};  // by the first camera's clock
  std::optional<Timestamp> first_;
  std::vector<ViewLog> logs_;  // of each camera, where something is to be shown
  bool shows_;
  std::optional<format::match::GroundWriter> file_;
  std::set<TrackId> live_people_;
  GroundSummary summary_;
};

void check(const Rig& rig, const GroundOutput& output, const TrackGroundOptions& options) {
  if (options.rate_hz && !(*options.rate_hz > 0))
    throw Error("the rate is {} frames a second; it must be positive", *options.rate_hz);
  if (!(options.margin >= 0)) throw Error("the margin is {} m; it must not be negative", options.margin);
  if (!output.boxes_of.empty()) {
    Rig copy = rig;
    format::rig::camera_named(copy, output.boxes_of);
  }
}

}  // namespace

GroundSummary track_ground(const Rig& rig, const GroundOutput& output, const TrackGroundOptions& options, const RunHooks& hooks) {
  check(rig, output, options);
  if (!lacks_offsets(rig)) return Run(rig, output, options, hooks)();
  Rig timed = rig;
  RigOffsets offsets;
  if (options.live) {
    offsets.warnings.push_back(
        "when cameras were started is not known, and live it cannot be looked for: 0 is taken; give each camera's offset_s in the "
        "rig");
  } else {
    RigOffsetsOptions how;
    how.eyes = options.eyes;
    how.rate_hz = options.rate_hz;
    offsets = find_rig_offsets(rig, GroundArea(rig.ground_from_world, options.pitch, options.margin), how, hooks);
    enter_offsets(timed, offsets);
  }
  GroundSummary summary = Run(timed, output, options, hooks)();
  summary.notes = offsets.notes;
  summary.warnings.insert(summary.warnings.begin(), offsets.warnings.begin(), offsets.warnings.end());
  return summary;
}

}  // namespace marey::pipeline
