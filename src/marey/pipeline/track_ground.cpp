#include "marey/pipeline/track_ground.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/rig.h"
#include "marey/format/match/ground_file.h"
#include "marey/pipeline/ground_films.h"
#include "marey/pipeline/ground_offsets.h"
#include "marey/reconstruct/ground_area.h"

namespace marey::pipeline {
namespace {

namespace fs = std::filesystem;

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

std::vector<std::string> names_of(const Rig& rig) {
  std::vector<std::string> names;
  for (const RigCamera& camera : rig.cameras) names.push_back(camera.name);
  return names;
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
    recording_.cameras = names_of(rig);
    if (options.live && output.boxes_of.empty()) file_.emplace(output.tracks, recording_.cameras);
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
      times_.push_back(seconds(cameras_.time()) - cameras_.rig().cameras.front().offset_s.value_or(0));
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
    summary_.seconds = times_.back() - times_.front();
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

  GroundRecording::Sample sample_of(const Track<2>& track) const {
    return {.frame = cameras_.frame(),
            .person = 0,
            .time = times_.back(),
            .place = area_.ground(track.position),
            .velocity = area_.ground_velocity(track.velocity),
            .cameras = track.cameras,
            .observed = track.state == Track<2>::State::observed};
  }

  void write_live(std::span<const Track<2>> tracks) {
    for (const Track<2>& track : tracks) {
      if (!track.confirmed || !area_.holds(track.position)) continue;
      GroundRecording::Sample sample = sample_of(track);
      if (file_) file_->write(sample, {number(track.id), {}, {}});
      live_people_.try_emplace(track.id, static_cast<std::int32_t>(live_people_.size()));
      count(sample);
      if (!shows_) continue;
      sample.person = live_people_.at(track.id);
      if (std::cmp_equal(sample.person, recording_.people.size())) recording_.people.push_back({number(track.id), {}, {}});
      recording_.samples.push_back(sample);
    }
  }

  void count(const GroundRecording::Sample& sample) {
    ++summary_.rows;
    if (!sample.observed) ++summary_.predicted;
  }

  /// The second pass: who is whom over the whole recording, in the user's coordinates, without those who never were on the pitch.
  void join() {
    track::ground::GroundRecorder::Joined joined =
        std::move(recorder_).join(options_.join, [&](const Vector<2>& place) { return in_sight(place); });
    std::vector<std::string> names = std::move(recording_.cameras);
    recording_ = std::move(joined.recording);
    recording_.cameras = std::move(names);
    const std::vector<std::int32_t> now = keep_in_area();
    std::vector<std::optional<Appearance>> wears(recording_.people.size());
    for (std::size_t person = 0; person < now.size(); ++person) {
      if (now[person] >= 0) wears[static_cast<std::size_t>(now[person])] = joined.wears[person];
    }
    analyse::TeamOptions teams = options_.teams;
    teams.pitch = area_.pitch();
    teams_ = analyse::find_teams(recording_, wears, teams);
    analyse::note_teams(teams_, recording_);
    pieces_ = std::move(joined);
    for (ViewLog& log : logs_) {
      log.name([&](TrackId track, std::int32_t frame) -> std::optional<int> {
        const auto person = pieces_.person_of(track, frame);
        if (!person || now[static_cast<std::size_t>(*person)] < 0) return std::nullopt;
        return now[static_cast<std::size_t>(*person)];
      });
    }
    for (const GroundRecording::Sample& sample : recording_.samples) count(sample);
  }

  bool in_sight(const Vector<2>& place) const {
    if (!area_.holds(place)) return false;
    return std::any_of(cameras_.views().begin(), cameras_.views().end(), [&](const GroundView& view) {
      const auto pixel = view.pixel(place);
      return pixel && cv::Rect2d({-0.5, -0.5}, cv::Size2d(view.size())).contains({pixel->x(), pixel->y()});
    });
  }

  /// Leaves out places off the pitch and its margin, and who was nowhere else; the others are numbered anew. What each person's
  /// index became, −1 for none.
  std::vector<std::int32_t> keep_in_area() {
    auto& samples = recording_.samples;
    samples.erase(std::remove_if(samples.begin(), samples.end(),
                                 [&](const GroundRecording::Sample& sample) { return !area_.holds(sample.place); }),
                  samples.end());
    std::vector<std::int32_t> now(recording_.people.size(), -1);
    std::vector<GroundRecording::Person> people;
    for (GroundRecording::Sample& sample : samples) {
      std::int32_t& index = now[static_cast<std::size_t>(sample.person)];
      if (index < 0) {
        index = static_cast<std::int32_t>(people.size());
        people.push_back(std::move(recording_.people[static_cast<std::size_t>(sample.person)]));
        people.back().id = index + 1;
      }
      sample.person = index;
      sample.place = area_.ground(sample.place);
      sample.velocity = area_.ground_velocity(sample.velocity);
      sample.time = times_[static_cast<std::size_t>(sample.frame)];
    }
    summary_.off_pitch = std::count(now.begin(), now.end(), -1);
    recording_.people = std::move(people);
    std::sort(samples.begin(), samples.end(),
              [](const auto& a, const auto& b) { return std::pair(a.frame, a.person) < std::pair(b.frame, b.person); });
    return now;
  }

  void show() {
    if (options_.live) {
      for (ViewLog& log : logs_) {
        log.name([&](TrackId track, std::int32_t) -> std::optional<int> {
          const auto known = live_people_.find(track);
          if (known == live_people_.end()) return std::nullopt;
          return known->second;
        });
      }
    }
    const GroundShow all{recording_, area_, cameras_, colours(), hooks_};
    const auto& cameras = cameras_.rig().cameras;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      if (cameras[i].name == output_.boxes_of) write_view_boxes(all, i, logs_[i], output_.tracks);
      if (!output_.overlays.empty() && !cameras[i].source.empty())
        summary_.stopped |= film_view(all, i, logs_[i], (fs::path(output_.overlays) / (cameras[i].name + ".mp4")).string());
    }
    if (!output_.pitch_view.empty()) summary_.stopped |= film_ground(all, times_, output_.pitch_view);
  }

  std::vector<draw::Colour> colours() const {
    std::vector<draw::Colour> colours;
    for (std::size_t i = 0; i < recording_.people.size(); ++i) {
      const auto team = i < teams_.members.size() ? teams_.members[i].team : std::nullopt;
      const bool alone = !team || teams_.members[i].role != analyse::Teams::Role::player;
      colours.push_back(alone ? draw::colour_of(recording_.people[i].id)
                              : draw::colour_of(teams_.teams[static_cast<std::size_t>(*team)].colour));
    }
    return colours;
  }

  void tell() {
    summary_.people = std::ssize(recording_.people);
    if (options_.live) summary_.people = std::ssize(live_people_);
    summary_.warnings = cameras_.warnings();
    summary_.teams = teams_.teams;
    for (std::string& sentence : contradicted_offsets(cameras_.rig(), paths_)) summary_.warnings.push_back(std::move(sentence));
    for (std::size_t i = 0; i < recording_.cameras.size(); ++i) {
      const GroundCameras::Counts counts = cameras_.counts(i);
      if (counts.frames == 0) {
        summary_.warnings.push_back(
            fmt::format("camera \"{}\" has no frame within the time of camera \"{}\"; is its offset_s right?",
                        recording_.cameras[i], recording_.cameras.front()));
      }
      summary_.cameras.push_back({recording_.cameras[i], counts});
    }
  }

  GroundOutput output_;
  TrackGroundOptions options_;
  RunHooks hooks_;
  reconstruct::GroundArea area_;
  GroundCameras cameras_;
  std::unique_ptr<track::ground::GroundTracker> tracker_;
  std::deque<KeptLooks> waiting_;
  track::ground::GroundRecorder recorder_;
  GroundPathLog paths_;
  track::ground::GroundRecorder::Joined pieces_;
  GroundRecording recording_;
  analyse::Teams teams_;
  std::vector<double> times_;  // s, of each instant by the first camera's clock
  std::vector<ViewLog> logs_;  // of each camera, where something is to be shown
  bool shows_;
  std::optional<format::match::GroundWriter> file_;
  std::map<TrackId, std::int32_t> live_people_;
  GroundSummary summary_;
};

void check(const Rig& rig, const GroundOutput& output, const TrackGroundOptions& options) {
  if (options.rate_hz && !(*options.rate_hz > 0))
    throw Error("the rate is {} frames a second; it must be positive", *options.rate_hz);
  if (!(options.margin >= 0)) throw Error("the margin is {} m; it must not be negative", options.margin);
  if (!output.boxes_of.empty()) {
    Rig copy = rig;
    camera_named(copy, output.boxes_of);
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
    offsets = find_rig_offsets(rig, reconstruct::GroundArea(rig.ground_from_world, options.pitch, options.margin), how, hooks);
    enter_offsets(timed, offsets);
  }
  GroundSummary summary = Run(timed, output, options, hooks)();
  summary.notes = offsets.notes;
  summary.warnings.insert(summary.warnings.begin(), offsets.warnings.begin(), offsets.warnings.end());
  return summary;
}

}  // namespace marey::pipeline
