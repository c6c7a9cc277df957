#include "marey/pipeline/reconstruct.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/motion/motion.h"
#include "marey/format/take/take_file.h"
#include "marey/pipeline/blob_feed.h"
#include "marey/pipeline/instants.h"
#include "marey/pipeline/set_labels.h"
#include "marey/reconstruct/learned_noise.h"
#include "marey/track/gap_filler.h"

namespace marey::pipeline {
namespace {

constexpr double kSurePrediction = 0.06;  // m; who is expected no better claims no blobs

constexpr double kVaguest = 1;  // px; a blob whose centre is known no better would widen every gate

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

class Reconstruction {
 public:
  Reconstruction(Rig rig, const std::string& observations, const std::string& out, const ReconstructOptions& options,
                 const RunHooks& hooks)
      : rig_(std::move(rig)),
        options_(options),
        hooks_(hooks),
        instants_(observations.empty() ? open_videos(rig_, options.markers, options.rate_hz)
                                       : open_observations(observations, rig_, options.rate_hz),
                  std::nullopt),
        noise_(options.noise_px),
        labels_(options.set),
        filler_(frames_in(options.fill_s), frames_in(std::min(options.predict_s, options.fill_s))) {
    if (instants_.rate_hz() <= 0) throw Error("not one frame could be read from any camera");
    choose_cameras();
    track::RosterTrackerOptions tracker = options.tracker;
    if (!options.set.has_places()) tracker.labels = options.set.labels;
    tracker_ = track::make_roster_tracker<3>(tracker);
    writer_ = std::make_unique<format::take::TakeWriter>(
        out,
        TakeHeader{.name = out, .made_by = "marey reconstruct", .recorded_at = {}, .rate_hz = instants_.rate_hz(), .rig = rig_});
  }

  ReconstructSummary operator()() {
    while (const Instant* instant = instants_.next()) {
      step(*instant);
      summary_.stopped = hooks_.tell({TrackProgress::Step::tracking, summary_.frames, std::nullopt});
      if (summary_.stopped) break;
    }
    if (summary_.frames == 0) throw Error("not one frame could be read from any camera");
    filler_.finish();
    drain();
    writer_->finish();
    return finish();
  }

 private:
  int frames_in(double duration) const { return static_cast<int>(std::lround(duration * instants_.rate_hz())); }

  /// The cameras whose calibration is known, and their numbers among those.
  void choose_cameras() {
    std::vector<Camera> cameras;
    for (const RigCamera& camera : rig_.cameras) {
      const auto whole = camera.camera();
      number_of_.push_back(whole ? static_cast<int>(cameras.size()) : -1);
      if (whole) {
        rig_number_.push_back(static_cast<int>(number_of_.size()) - 1);
        cameras.push_back(*whole);
      } else {
        summary_.warnings.push_back(fmt::format("camera \"{}\" has no calibration and is left out", camera.name));
      }
    }
    reconstruct::CorrespondOptions correspond = options_.correspond;
    correspond.noise_px = noise_.px();
    if (cameras.size() == 2) correspond.fewest_rays = 2;
    corresponder_.emplace(std::move(cameras), correspond);
  }

  void step(const Instant& instant) {
    seen_.clear();
    for (Observation<2> blob : instant.seen) {
      const int number = number_of_[static_cast<std::size_t>(marey::number(blob.camera))];
      if (number < 0 || blob.covariance.trace() > 2 * kVaguest * kVaguest) continue;
      blob.camera = CameraId{number};
      seen_.push_back(blob);
    }
    const auto begin = Clock::now();
    expect(instant.time);
    const reconstruct::Correspondences* found = &corresponder_->match(seen_, expected_);
    if (noise_.learn(*found)) {
      corresponder_->set_noise(noise_.px());
      if (summary_.frames == 0) found = &corresponder_->match(seen_, expected_);
    }
    const auto matched = Clock::now();
    corresponding_.add(std::chrono::duration<double>(matched - begin).count());
    points_.clear();
    for (const reconstruct::Placed& placed : found->points) {
      Observation<3> point;
      point.value = placed.point.position;
      point.covariance = placed.point.covariance;
      points_.push_back(point);
    }
    const auto tracks = tracker_->step(instant.time, points_);
    labels_.give(tracks);
    tracking_.add(since(matched));
    record(instant, *found, tracks);
    drain();
    ++summary_.frames;
    summary_.seconds = seconds(instant.time);
    chain_.add(since(begin));
  }

  void expect(Timestamp now) {
    expected_.clear();
    for (const Track<3>& track : tracker_->expected(now)) {
      if (track.covariance.trace() < 3 * kSurePrediction * kSurePrediction) expected_.push_back(track);
    }
  }

  void record(const Instant& instant, const reconstruct::Correspondences& found, std::span<const Track<3>> tracks) {
    TakeFrame frame{.index = instant.index, .time = instant.time, .observations = {}, .points = {}};
    for (const Observation<2>& blob : seen_) {
      frame.observations.push_back({.camera = CameraId{rig_number_[static_cast<std::size_t>(number(blob.camera))]},
                                    .pixel = blob.value,
                                    .sigma = std::sqrt(std::max(0.0, blob.covariance.trace() / 2)),
                                    .area = blob.box ? blob.box->area() : 0,
                                    .track = {}});
    }
    for (const Track<3>& track : tracks) {
      if (!track.confirmed) continue;
      name(track);
      if (!track.observation) continue;
      const reconstruct::Placed& placed = found.points[static_cast<std::size_t>(*track.observation)];
      TakePoint point;
      point.track = track.id;
      point.position = placed.point.position;
      point.covariance = placed.point.covariance;
      point.residual_px = placed.point.residual_px;
      for (const int i : placed.seen) {
        TakeObservation& blob = frame.observations[static_cast<std::size_t>(i)];
        blob.track = track.id;
        point.cameras |= CameraMask{1} << number(blob.camera);
      }
      squares_ += placed.point.residual_px * placed.point.residual_px;
      ++summary_.measured;
      frame.points.push_back(point);
    }
    summary_.observations += std::ssize(seen_);
    summary_.unexplained += found.unexplained;
    filler_.add(std::move(frame), tracks);
  }

  void name(const Track<3>& track) {
    const std::string& label = track.label.empty() ? labels_.of(track.id) : track.label;
    std::string& known = names_[track.id];
    if (known == label) return;
    known = label;
    writer_->set_label(track.id, label);
  }

  void drain() {
    const auto begin = Clock::now();
    while (const auto frame = filler_.next()) {
      for (const TakePoint& point : frame->points) {
        summary_.filled += point.provenance == Provenance::filled;
        summary_.predicted += point.provenance == Provenance::predicted;
      }
      writer_->write(*frame);
    }
    writing_.add(since(begin));
  }

  ReconstructSummary finish() {
    summary_.rate_hz = instants_.rate_hz();
    summary_.markers = std::ssize(names_);
    for (const auto& [id, label] : names_) summary_.labelled += !label.empty();
    summary_.noise_px = noise_.px();
    if (summary_.measured > 0) summary_.residual_px = std::sqrt(squares_ / static_cast<double>(summary_.measured));
    for (std::size_t c = 0; c < rig_.cameras.size(); ++c) {
      summary_.cameras.push_back({rig_.cameras[c].name, instants_.frames(c), instants_.missed(c)});
      if (number_of_[c] >= 0 && instants_.frames(c) == 0) {
        summary_.warnings.push_back(fmt::format("camera \"{}\" gave not one frame", rig_.cameras[c].name));
      } else if (instants_.missed(c) > 0) {
        summary_.warnings.push_back(fmt::format("camera \"{}\" has no frame for {} of {} instants; the others went on without it",
                                                rig_.cameras[c].name, instants_.missed(c), summary_.frames));
      }
    }
    const auto tell = [&](const char* stage, const StageTimes& times) {
      summary_.stages.push_back({stage, times.count(), times.quantile(0.5), times.quantile(0.99)});
    };
    tell("decode", instants_.decoding());
    tell("detect", instants_.detecting());
    tell("correspond", corresponding_);
    tell("track", tracking_);
    tell("write", writing_);
    tell("blobs to take", chain_);
    for (const std::string& warning : instants_.warnings()) summary_.warnings.push_back(warning);
    if (summary_.measured == 0) {
      summary_.warnings.push_back("no marker could be placed: are the cameras of this rig the ones that recorded, and in step?");
    }
    return std::move(summary_);
  }

  Rig rig_;
  ReconstructOptions options_;
  RunHooks hooks_;
  Instants instants_;
  reconstruct::LearnedNoise noise_;
  SetLabels labels_;
  track::GapFiller filler_;
  std::optional<reconstruct::Corresponder> corresponder_;
  std::unique_ptr<track::Tracker<3>> tracker_;
  std::unique_ptr<format::take::TakeWriter> writer_;
  ReconstructSummary summary_;
  StageTimes corresponding_, tracking_, writing_, chain_;
  double squares_ = 0;
  std::map<TrackId, std::string> names_;
  std::vector<int> number_of_, rig_number_;  // rig's cameras to calibrated ones, and back
  std::vector<Observation<2>> seen_;
  std::vector<Track<3>> expected_;
  std::vector<Observation<3>> points_;
};

/// A file that is gone with its owner.
struct ForAWhile {
  std::string path;
  ~ForAWhile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

/// Most formats begin with what is known only at the end: the take is read twice.
void rewrite(const std::string& take, const std::string& out, format::motion::MotionFormat format) {
  const format::motion::MotionPlan plan =
      format::motion::plan_of(*format::motion::open_motion(take, format::motion::MotionFormat::take), take);
  const auto reader = format::motion::open_motion(take, format::motion::MotionFormat::take);
  const auto writer = format::motion::create_motion(out, format, plan);
  while (const auto frame = reader->next()) writer->write(*frame);
  writer->finish();
}

}  // namespace

track::RosterTrackerOptions space_tracker_options() {
  return {.filter = filter::KalmanOptions{.acceleration_noise = 3, .initial_speed = 1.5, .gate_sigmas = 4},
          .labels = {},
          .max_speed = 15,
          .marker_width = 0.02,
          .place_noise = 1e-4,
          .companions = true};
}

ReconstructSummary reconstruct(Rig rig, const std::string& observations, const std::string& out, const ReconstructOptions& options,
                               const RunHooks& hooks) {
  const auto format = format::motion::motion_format_of_name(out);
  if (!format) throw Error("{}: its ending is of no format; .marey is a take, {} are others", out, ".c3d, .trc and .csv");
  if (*format == format::motion::MotionFormat::take) return Reconstruction(std::move(rig), observations, out, options, hooks)();
  const ForAWhile take{out + ".part.marey"};
  ReconstructSummary summary = Reconstruction(std::move(rig), observations, take.path, options, hooks)();
  rewrite(take.path, out, *format);
  return summary;
}

}  // namespace marey::pipeline
