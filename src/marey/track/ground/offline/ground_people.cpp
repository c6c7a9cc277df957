#include "marey/track/ground/offline/ground_people.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "marey/track/ground/offline/ground_join.h"
#include "marey/track/ground/offline/ground_smooth.h"

namespace marey::track::ground::offline {
namespace {

using GroundBridge = filter::Bridge<GroundMotion, 2>;

GroundBridge::State state_of(const GroundTimeStep& time_step) {
  GroundBridge::State state;
  state << time_step.location.transpose(), time_step.velocity.transpose(), time_step.acceleration.transpose();
  return state;
}

class Writer {
 public:
  Writer(const GroundInstants& instants, const GroundJoinOptions& options)
      : times_(instants.times), camera_begins_(instants.camera_begins), options_(options), motion_(options.motion) {}

  /// Too brief, or seen too rarely, to be a person.
  bool is_false_alarm(const std::vector<GroundTracklet>& tracklets, const std::vector<int>& chain) const {
    std::int64_t detected = 0;
    std::int64_t reported = 0;
    const GroundSample* last = nullptr;
    for (const int member : chain) {
      for (const GroundSample& sample : tracklets[member].samples) {
        ++detected;
        reported += last == nullptr || !fills(*last, sample) ? 1 : sample.instant - last->instant;
        last = &sample;
      }
    }
    const std::vector<GroundSample>& first = tracklets[chain.front()].samples;
    const double lasted = seconds(times_[last->instant] - times_[first.front().instant]);
    const double recorded = seconds(times_.back() - times_.front());
    return lasted < std::min(options_.shortest, recorded / 2) ||
           static_cast<double>(detected) < options_.rarest * static_cast<double>(reported);
  }

  /// One person's rows. Its gaps that are not too long are filled.
  TrackColumns columns(const std::vector<GroundSample>& samples, TrackId person) const {
    const std::vector<GroundTimeStep> time_steps = smooth_ground(samples, times_, motion_);
    TrackColumns track({.id = person, .label = {}, .team = {}, .kind = TrackKind::person}, 2);
    track.reserve(count(samples));
    if (!samples.empty() && began_with_cameras(samples.front())) predict_back(samples.front().instant, time_steps.front(), track);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i > 0 && fills(samples[i - 1], samples[i])) fill(samples, time_steps, i, track);
      add(samples[i].instant, time_steps[i], samples[i].cameras, track);
    }
    return track;
  }

 private:
  /// Whether no camera that saw this had given a frame before, but for one or two, and the recording had begun.
  bool began_with_cameras(const GroundSample& first) const {
    constexpr std::int32_t unnoticed = 2;  // instants in which a newcomer may be missed
    if (first.instant == 0 || seconds(times_[first.instant] - times_.front()) > options_.longest_begun) return false;
    for (std::size_t camera = 0; camera < camera_begins_.size(); ++camera) {
      const bool observed = (first.cameras & mask_of(CameraId{static_cast<int>(camera)})) != 0;
      if (observed && (camera_begins_[camera] == 0 || first.instant - camera_begins_[camera] > unnoticed)) return false;
    }
    return true;
  }

  /// Straight back to the recording's beginning.
  void predict_back(std::int32_t until, const GroundTimeStep& first, TrackColumns& track) const {
    for (std::int32_t k = 0; k < until; ++k) {
      Sample sample;
      sample.position.head<2>() = first.location - seconds(times_[until] - times_[k]) * first.velocity;
      sample.velocity = Vector<3>(first.velocity.x(), first.velocity.y(), 0);
      sample.provenance = Provenance::predicted;
      track.add(k, sample);
    }
  }

  bool fills(const GroundSample& before, const GroundSample& after) const {
    return seconds(times_[after.instant] - times_[before.instant]) <= options_.longest_filled;
  }

  std::size_t count(const std::vector<GroundSample>& samples) const {
    std::size_t rows = samples.size();
    for (std::size_t i = 1; i < samples.size(); ++i) {
      if (fills(samples[i - 1], samples[i])) rows += static_cast<std::size_t>(samples[i].instant - samples[i - 1].instant - 1);
    }
    return rows;
  }

  /// What lies between samples i − 1 and i.
  void fill(const std::vector<GroundSample>& samples, const std::vector<GroundTimeStep>& time_steps, std::size_t i,
            TrackColumns& track) const {
    const Timestamp before = times_[samples[i - 1].instant];
    const auto time_of = [&](std::int32_t instant) { return seconds(times_[instant] - before); };
    const GroundBridge gap(state_of(time_steps[i - 1]), 0, state_of(time_steps[i]), time_of(samples[i].instant), motion_);
    for (std::int32_t k = samples[i - 1].instant + 1; k < samples[i].instant; ++k) {
      const GroundBridge::State state = gap.at(time_of(k));
      add(k, {.location = state.row(0), .velocity = state.row(1), .acceleration = state.row(2)}, 0, track);
    }
  }

  static void add(std::int32_t instant, const GroundTimeStep& time_step, CameraMask cameras, TrackColumns& track) {
    Sample sample;
    sample.position.head<2>() = time_step.location;
    sample.velocity = Vector<3>(time_step.velocity.x(), time_step.velocity.y(), 0);
    sample.provenance = cameras != 0 ? Provenance::measured : Provenance::filled;
    if (cameras != 0) sample.covariance.emplace(Matrix<3>::Zero()).topLeftCorner<2, 2>() = time_step.spread;
    sample.cameras = cameras;
    track.add(instant, sample);
  }

  std::span<const Timestamp> times_;
  std::span<const std::int32_t> camera_begins_;
  const GroundJoinOptions& options_;
  GroundMotion motion_;
};

RecordingHeader header_of(std::span<const Recording::TimeStep> time_steps) {
  RecordingHeader header;
  header.name = "people on the ground";
  header.frame.kind = FrameOfReference::Kind::ground;
  header.rate_hz = median_rate_hz(time_steps).value_or(0);
  header.smoothed = true;
  return header;
}

/// Where pieces that the tracker had not taken for one person follow each other.
void note_joins(const GroundChain& chain, TrackId person, const std::vector<GroundTracklet>& tracklets,
                std::span<const std::int32_t> frames, GroundRecorder::Joined& joined) {
  for (std::size_t i = 1; i < chain.members.size(); ++i) {
    const int before = chain.members[i - 1], after = chain.members[i];
    const GroundTracklet& tail = tracklets[static_cast<std::size_t>(before)];
    const GroundTracklet& head = tracklets[static_cast<std::size_t>(after)];
    if (tail.goes_on && after == before + 1) continue;
    joined.joins.push_back({person, frames[static_cast<std::size_t>(tail.samples.back().instant)],
                            frames[static_cast<std::size_t>(head.samples.front().instant)], chain.probabilities[i - 1]});
  }
}

}  // namespace

GroundRecorder::Joined people_from_chains(std::vector<GroundTracklet> tracklets, const std::vector<GroundChain>& chains,
                                          const GroundInstants& instants, const GroundJoinOptions& options) {
  const std::span<const std::int32_t> frames = instants.frames;
  const std::span<const Timestamp> times = instants.times;
  std::vector<Recording::TimeStep> time_steps;
  for (std::size_t i = 0; i < frames.size(); ++i) time_steps.push_back({frames[i], times[i]});
  GroundRecorder::Joined joined;
  joined.recording.header = header_of(time_steps);
  for (const Recording::TimeStep& time_step : time_steps) joined.recording.add_time_step(time_step);
  const Writer writer(instants, options);
  std::vector<const GroundChain*> kept;
  for (const GroundChain& chain : chains) {
    if (!writer.is_false_alarm(tracklets, chain.members)) kept.push_back(&chain);
  }
  for (const GroundChain* chain : kept) {
    const TrackId person{static_cast<int>(joined.recording.tracks().size()) + 1};
    note_joins(*chain, person, tracklets, frames, joined);
    std::vector<GroundSample> samples;
    for (const int member : chain->members) {
      const GroundTracklet piece = std::move(tracklets[member]);
      for (std::size_t r = 0; r < piece.runs.size(); ++r) {
        const std::size_t end = r + 1 < piece.runs.size() ? piece.runs[r + 1].first : piece.samples.size();
        joined.pieces.push_back({piece.runs[r].track, frames[piece.samples[piece.runs[r].first].instant],
                                 frames[piece.samples[end - 1].instant], person});
      }
      samples.insert(samples.end(), piece.samples.begin(), piece.samples.end());
    }
    joined.clothing.push_back(appearance_of(samples));
    joined.recording.put(writer.columns(samples, person));
  }
  std::sort(joined.pieces.begin(), joined.pieces.end(), [](const GroundRecorder::Piece& a, const GroundRecorder::Piece& b) {
    return std::tie(a.track, a.first) < std::tie(b.track, b.first);
  });
  return joined;
}

}  // namespace marey::track::ground::offline
