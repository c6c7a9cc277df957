#include "marey/pipeline/markers/markers_in_space.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/pipeline/corridor/simulation_files.h"
#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/pipeline/markers/set_stage.h"
#include "marey/pipeline/markers/skeleton_in_space.h"
#include "marey/pipeline/markers/skeleton_stage.h"
#include "marey/reconstruct/camera_watch.h"
#include "marey/reconstruct/learned_noise.h"
#include "marey/reconstruct/own_time.h"
#include "marey/reconstruct/set_labels.h"
#include "marey/track/roster/gap_filler.h"

namespace marey::pipeline::markers {
namespace {

constexpr double kSurePrediction = 0.06;  // m; who is expected no better claims no blobs
constexpr double kVaguest = 1;            // px; a blob whose centre is known no better would widen every gate
constexpr double kNamesSure = 5;          // s after which names are no more put right in a file; sweep: docs/tuning.md
constexpr double kInStep = 0.02;          // of a frame: what moves no marker by more than noise

/// What the cameras saw at a moment whose names are not sure yet.
struct Undecided {
  struct Point {
    Sample sample;          // without its track
    std::vector<int> seen;  // indices of the blobs behind it
  };
  Instant instant;  // without samples
  std::vector<Point> points;
};

/// What still waited for the end of gaps when the cameras had ended.
class Waiting final : public corridor::InstantSource {
 public:
  explicit Waiting(track::roster::GapFiller& filler) : filler_(filler) { filler_.finish(); }
  std::optional<Instant> next() override { return filler_.next(); }

 private:
  track::roster::GapFiller& filler_;
};

class MarkersInSpace final : public corridor::Stage {
  using Decision = track::Decision<3>;

 public:
  MarkersInSpace(const Rig& rig, double rate_hz, const MarkersInSpaceOptions& options)
      : options_(options),
        noise_(options.noise_px),
        labels_(options.set),
        own_time_(cameras_of(rig)),
        filler_(frames_in(options.fill_s, rate_hz), frames_in(std::min(options.predict_s, options.fill_s), rate_hz)) {
    header_.name = "the rig";
    header_.made_by.program = "marey reconstruct";
    header_.frame.kind = FrameOfReference::Kind::space;
    header_.time_base.kind = TimeBase::Kind::rig;
    header_.track_kind = TrackKind::marker;
    header_.rate_hz = rate_hz;
    header_.rig = rig;
    choose_cameras(rig);
    track::roster::RosterTrackerOptions tracker = options.tracker;
    if (!options.set.has_places()) tracker.labels = options.set.labels;
    tracker.decide_after = options.live ? 0 : kNamesSure;
    tracker_ = track::roster::make_roster_tracker<3>(tracker);
  }

  RecordingHeader header() const override { return header_; }

  std::span<const Instant> step(const FrameSet& frames) override {
    const corridor::Stopwatch chain;
    follow_moved();
    expect(frames.time);
    see(frames);
    const reconstruct::Correspondences& found = correspond(frames.time);
    corresponding_.add(chain.seconds());
    const corridor::Stopwatch tracking;
    points_.clear();
    for (const reconstruct::Placed& placed : found.points) {
      points_.push_back({.value = placed.point.position, .covariance = placed.point.covariance, .box = {}});
    }
    const auto tracks = tracker_->step(frames.time, points_);
    labels_.give(tracks);
    tracking_.add(tracking.seconds());
    undecided_.push_back(undecided_of(frames, found));
    known_.clear();
    if (options_.live) {
      Instant instant = decided_instant(tracks);
      predict(instant, tracks);
      known_.push_back(std::move(instant));
    } else {
      fill(tracker_->decided());
      while (auto waited = filler_.next()) known_.push_back(std::move(*waited));
    }
    ++frames_;
    chain_.add(chain.seconds());
    return known_;
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& /*hooks*/) override {
    if (options_.live) return nullptr;
    fill(tracker_->decide_all());
    return std::make_unique<Waiting>(filler_);
  }

  void report(corridor::Summary& summary) const override {
    summary.figures["noise_px"] = noise_.px();
    summary.figures["observations"] = static_cast<double>(observations_);
    summary.figures["unexplained"] = static_cast<double>(unexplained_);
    summary.left_out["points of two rays alone"] = by_two_rays_;
    for (const auto& [reason, count] : missed_) summary.left_out[std::string(reconstruct::meaning(reason))] = count;
    if (placed_ > 0) summary.figures["residual_px"] = std::sqrt(squares_ / static_cast<double>(placed_));
    const auto report_step = [&](const char* step, const StageTimes& times) {
      summary.steps.push_back({step, times.count(), times.quantile(0.5), times.quantile(0.99)});
    };
    report_step("correspond", corresponding_);
    report_step("track", tracking_);
    report_step("blobs to instants", chain_);
    summary.warnings.insert(summary.warnings.begin(), warnings_.begin(), warnings_.end());
    if (placed_ > 0) return;
    summary.warnings.push_back("no marker could be placed: are the cameras of this rig the ones that recorded, and in step?");
  }

 private:
  static std::vector<std::optional<Camera>> cameras_of(const Rig& rig) {
    std::vector<std::optional<Camera>> cameras;
    for (const RigCamera& camera : rig.cameras) cameras.push_back(camera.camera());
    return cameras;
  }

  static int frames_in(double duration, double rate_hz) { return static_cast<int>(std::lround(duration * rate_hz)); }

  void choose_cameras(const Rig& rig) {
    std::vector<Camera> cameras;
    std::vector<CameraId> ids;
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      const auto whole = rig.cameras[i].camera();
      calibrated_.push_back(whole.has_value());
      if (whole) {
        ids.push_back(CameraId{static_cast<int>(i)});
        cameras.push_back(*whole);
      } else {
        warnings_.push_back(fmt::format("camera \"{}\" has no calibration and is left out", rig.cameras[i].name));
      }
    }
    watch_.emplace(cameras, ids);
    ids_ = ids;
    const auto correspond = correspond_options(ids.size());
    corresponder_.emplace(std::move(cameras), correspond, std::move(ids));
  }

  reconstruct::CorrespondOptions correspond_options(std::size_t cameras) const {
    reconstruct::CorrespondOptions correspond = options_.correspond;
    correspond.noise_px = noise_.px();
    if (cameras == 2) correspond.fewest_rays = 2;
    return correspond;
  }

  /// From this moment on a camera's rays start from where it was found to stand now.
  void follow_moved() {
    if (!moved_) return;
    moved_.reset();
    corresponder_.emplace(watch_->cameras(), correspond_options(ids_.size()), ids_);
    std::vector<std::optional<Camera>> cameras(header_.rig->cameras.size());
    for (std::size_t i = 0; i < ids_.size(); ++i) cameras[static_cast<std::size_t>(number(ids_[i]))] = watch_->cameras()[i];
    own_time_ = reconstruct::OwnTime(std::move(cameras));
  }

  void warn_of(const reconstruct::MovedCamera& moved) {
    warnings_.push_back(fmt::format(
        "camera \"{}\" was moved at {:.2f} s, by {:.2f}° and {:.0f} mm; its new place was found ({} blobs within {:.2f} px) and "
        "counts from then on: calibrate the rig anew",
        header_.rig->cameras[static_cast<std::size_t>(number(moved.camera))].name, seconds(moved.since),
        moved.angle * 180 / std::numbers::pi, 1000 * moved.distance, moved.pairs, moved.rms_px));
  }

  void expect(Timestamp now) {
    expected_.clear();
    for (const Track<3>& track : tracker_->expected(now)) {
      if (track.covariance.trace() < 3 * kSurePrediction * kSurePrediction) expected_.push_back(track);
    }
  }

  void see(const FrameSet& frames) {
    seen_.clear();
    sigmas_.clear();
    for (std::size_t c = 0; c < frames.cameras.size(); ++c) {
      if (!frames.cameras[c] || !calibrated_[c]) continue;
      const auto first = std::ssize(seen_);
      for (const Detection& detection : *frames.cameras[c]->detections) {
        const std::optional<double> sigma = detection.sigma();
        if (sigma && *sigma > kVaguest) continue;
        seen_.push_back(observation_of(detection));
        seen_.back().camera = CameraId{static_cast<int>(c)};
        sigmas_.push_back(sigma);
      }
      if (options_.live)
        bring_to(frames.time, *frames.cameras[c], CameraId{static_cast<int>(c)},
                 std::span(seen_).subspan(static_cast<std::size_t>(first)));
    }
  }

  void bring_to(Timestamp now, const CameraFrame& given, CameraId camera, std::span<Observation<2>> blobs) {
    const bool in_step = std::abs(seconds(given.frame.time - now)) <= kInStep / header_.rate_hz;
    own_time_.bring(camera, in_step ? now : given.frame.time, now, blobs, expected_);
  }

  const reconstruct::Correspondences& correspond(Timestamp now) {
    const reconstruct::Correspondences* found = &corresponder_->match(seen_, expected_);
    if (noise_.learn(*found)) {
      corresponder_->set_noise(noise_.px());
      if (frames_ == 0) found = &corresponder_->match(seen_, expected_);
    }
    moved_ = watch_->see(now, seen_, *found, noise_.px());
    if (moved_) warn_of(*moved_);
    observations_ += std::ssize(seen_);
    unexplained_ += found->unexplained;
    by_two_rays_ += std::ssize(found->by_two_rays);
    for (const auto& reason : found->missed) {
      if (reason) ++missed_[*reason];
    }
    return *found;
  }

  void fill(std::span<const Decision> decisions) {
    for (const Decision& decision : decisions) filler_.add(decided_instant(decision.tracks), decision.tracks);
  }

  /// Markers that were seen a moment ago are told where they are expected.
  void predict(Instant& instant, std::span<const Track<3>> tracks) {
    for (const Track<3>& track : tracks) {
      if (!track.confirmed) continue;
      if (track.observation) {
        last_seen_[track.id] = instant.time;
        continue;
      }
      const auto seen = last_seen_.find(track.id);
      if (seen == last_seen_.end()) continue;
      if (seconds(instant.time - seen->second) > options_.predict_s) {
        last_seen_.erase(seen);
        continue;
      }
      Sample& sample = instant.samples.emplace_back();
      sample.track = track.id;
      sample.position = track.position;
      sample.covariance = track.covariance;
      sample.provenance = Provenance::predicted;
    }
    std::sort(instant.samples.begin(), instant.samples.end(), [](const Sample& a, const Sample& b) { return a.track < b.track; });
  }

  Undecided undecided_of(const FrameSet& frames, const reconstruct::Correspondences& found) const {
    Undecided moment;
    moment.instant.index = frames.index;
    moment.instant.time = frames.time;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const Observation<2>& blob = seen_[i];
      SeenPoint& seen = moment.instant.seen.emplace_back();
      seen.camera = blob.camera;
      seen.pixel = blob.value;
      seen.sigma = sigmas_[i];
      if (blob.box && blob.box->area() > 0) seen.area = blob.box->area();
    }
    for (const reconstruct::Placed& placed : found.points) {
      Undecided::Point& point = moment.points.emplace_back();
      point.sample.position = placed.point.position;
      point.sample.covariance = placed.point.covariance;
      point.sample.residual_px = placed.point.residual_px;
      point.seen.assign(placed.seen.begin(), placed.seen.end());
      for (const int i : point.seen) point.sample.cameras |= mask_of(seen_[static_cast<std::size_t>(i)].camera);
    }
    return moment;
  }

  /// The oldest moment that waits, now that it is known which track each point belongs to.
  Instant decided_instant(std::span<const Track<3>> tracks) {
    Undecided moment = std::move(undecided_.front());
    undecided_.pop_front();
    Instant instant = std::move(moment.instant);
    for (const Track<3>& track : tracks) {
      if (!track.confirmed) continue;
      name(track, instant);
      if (!track.observation) continue;
      Undecided::Point& point = moment.points[static_cast<std::size_t>(*track.observation)];
      point.sample.track = track.id;
      for (const int i : point.seen) instant.seen[static_cast<std::size_t>(i)].track = track.id;
      squares_ += *point.sample.residual_px * *point.sample.residual_px;
      ++placed_;
      instant.samples.push_back(std::move(point.sample));
    }
    return instant;
  }

  void name(const Track<3>& track, Instant& instant) {
    const std::string& label = track.label.empty() ? labels_.of(track.id) : track.label;
    const auto [known, is_new] = names_.try_emplace(track.id);
    if (!is_new && known->second == label) return;
    known->second = label;
    instant.named.push_back({track.id, label, {}});
  }

  MarkersInSpaceOptions options_;
  RecordingHeader header_;
  std::vector<bool> calibrated_;  // by camera of the rig
  reconstruct::LearnedNoise noise_;
  reconstruct::SetLabels labels_;
  reconstruct::OwnTime own_time_;
  track::roster::GapFiller filler_;
  std::optional<reconstruct::Corresponder> corresponder_;
  std::optional<reconstruct::CameraWatch> watch_;
  std::optional<reconstruct::MovedCamera> moved_;  // found in the last step
  std::vector<CameraId> ids_;                      // of the cameras that have a calibration
  std::unique_ptr<track::Tracker<3>> tracker_;
  std::deque<Undecided> undecided_;
  std::map<TrackId, std::string> names_;
  std::map<TrackId, Timestamp> last_seen_;  // where `live`
  StageTimes corresponding_, tracking_, chain_;
  std::vector<std::string> warnings_;
  std::map<reconstruct::NoPoint, std::int64_t> missed_;
  std::int64_t frames_ = 0, observations_ = 0, unexplained_ = 0, by_two_rays_ = 0, placed_ = 0;
  double squares_ = 0;
  std::vector<Observation<2>> seen_;
  std::vector<std::optional<double>> sigmas_;  // of `seen_`, px
  std::vector<Track<3>> expected_;
  std::vector<Observation<3>> points_;
  std::vector<Instant> known_;
};

}  // namespace

track::roster::RosterTrackerOptions space_tracker_options() {
  return {.filter = filter::KalmanOptions{.acceleration_noise = 3, .initial_speed = 1.5, .gate_sigmas = 4},
          .labels = {},
          .max_speed = 15,
          .marker_width = 0.02,
          .place_noise = 1e-4,
          .rigid_neighbours = true,
          .picture = {}};
}

std::unique_ptr<corridor::Stage> markers_in_space(const Rig& rig, double rate_hz, const MarkersInSpaceOptions& options) {
  std::unique_ptr<corridor::Stage> markers = std::make_unique<MarkersInSpace>(rig, rate_hz, options);
  if (options.learned_set != nullptr) {
    SetInSpaceOptions how;
    how.wait = options.waits_for_names;
    markers = with_set(std::move(markers), options.learned_set, how);
  }
  markers = with_naming(std::move(markers), options.naming);
  if (options.skeleton == nullptr) return markers;
  if (options.set.labels.empty() && options.learned_set == nullptr)
    throw Error("{}", "a skeleton is solved from markers that have names, and these have none: name them by --labels or --set");
  return with_skeleton(std::move(markers), options.skeleton, live_pose_options());
}

}  // namespace marey::pipeline::markers
