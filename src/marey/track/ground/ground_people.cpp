#include "marey/track/ground/ground_people.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "marey/track/ground/ground_join.h"
#include "marey/track/ground/ground_smooth.h"

namespace marey::track::ground {
namespace {

class Writer {
 public:
  Writer(std::span<const std::int32_t> frames, std::span<const Timestamp> times, const GroundJoinOptions& options)
      : frames_(frames), times_(times), options_(options), motion_(options.motion) {}

  /// Too brief, or seen too seldom, to be somebody.
  bool is_false_alarm(const std::vector<GroundTracklet>& tracklets, const std::vector<int>& chain) const {
    std::int64_t seen = 0;
    std::int64_t told = 0;
    const GroundSample* last = nullptr;
    for (const int member : chain) {
      for (const GroundSample& sample : tracklets[member].samples) {
        ++seen;
        told += last == nullptr || !fills(*last, sample) ? 1 : sample.instant - last->instant;
        last = &sample;
      }
    }
    const std::vector<GroundSample>& first = tracklets[chain.front()].samples;
    const double lasted = seconds(times_[last->instant] - times_[first.front().instant]);
    const double recorded = seconds(times_.back() - times_.front());
    return lasted < std::min(options_.shortest, recorded / 2) ||
           static_cast<double>(seen) < options_.rarest * static_cast<double>(told);
  }

  /// Counts the rows of one person, so that all can be put in their places at once.
  void count(const std::vector<GroundTracklet>& tracklets, const std::vector<int>& chain) {
    rows_.resize(frames_.size() + 1, 0);
    const GroundSample* last = nullptr;
    for (const int member : chain) {
      for (const GroundSample& sample : tracklets[member].samples) {
        for (std::int32_t k = last != nullptr && fills(*last, sample) ? last->instant + 1 : sample.instant; k <= sample.instant;
             ++k) {
          ++rows_[static_cast<std::size_t>(k) + 1];
        }
        last = &sample;
      }
    }
  }

  void begin_rows(GroundRecording& recording) {
    rows_.resize(frames_.size() + 1, 0);
    for (std::size_t k = 1; k < rows_.size(); ++k) rows_[k] += rows_[k - 1];
    recording.samples.resize(rows_.back());
  }

  /// Rows of one person, in the place that counting found; called in the order of people.
  void write(const std::vector<GroundSample>& samples, std::int32_t person, GroundRecording& recording) {
    const std::vector<GroundMoment> moments = smooth_ground(samples, times_, motion_);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i > 0 && fills(samples[i - 1], samples[i])) fill(samples, moments, i, person, recording);
      put(samples[i].instant, moments[i], person, samples[i].cameras, recording);
    }
  }

 private:
  bool fills(const GroundSample& before, const GroundSample& after) const {
    return seconds(times_[after.instant] - times_[before.instant]) <= options_.longest_filled;
  }

  /// What lies between samples i − 1 and i.
  void fill(const std::vector<GroundSample>& samples, const std::vector<GroundMoment>& moments, std::size_t i, std::int32_t person,
            GroundRecording& recording) {
    const Timestamp before = times_[samples[i - 1].instant];
    const Timestamp after = times_[samples[i].instant];
    for (std::int32_t k = samples[i - 1].instant + 1; k < samples[i].instant; ++k) {
      const GroundMoment moment =
          between(moments[i - 1], seconds(times_[k] - before), moments[i], seconds(after - times_[k]), motion_);
      put(k, moment, person, 0, recording);
    }
  }

  void put(std::int32_t instant, const GroundMoment& moment, std::int32_t person, CameraMask cameras, GroundRecording& recording) {
    GroundRecording::Sample& row = recording.samples[rows_[instant]++];
    row.frame = frames_[instant];
    row.person = person;
    row.time = seconds(times_[instant]);
    row.place = moment.place;
    row.velocity = moment.velocity;
    row.cameras = cameras;
    row.observed = cameras != 0;
  }

  std::span<const std::int32_t> frames_;
  std::span<const Timestamp> times_;
  const GroundJoinOptions& options_;
  GroundMotion motion_;
  std::vector<std::size_t> rows_;  // first of each instant, once counted
};

}  // namespace

GroundRecorder::Joined people_from_chains(std::vector<GroundTracklet> tracklets, const std::vector<std::vector<int>>& chains,
                                          std::span<const std::int32_t> frames, std::span<const Timestamp> times,
                                          const GroundJoinOptions& options) {
  GroundRecorder::Joined joined;
  Writer writer(frames, times, options);
  std::vector<const std::vector<int>*> kept;
  for (const std::vector<int>& chain : chains) {
    if (writer.is_false_alarm(tracklets, chain)) continue;
    kept.push_back(&chain);
    writer.count(tracklets, chain);
  }
  writer.begin_rows(joined.recording);
  for (const std::vector<int>* chain : kept) {
    const auto person = static_cast<std::int32_t>(joined.recording.people.size());
    std::vector<GroundSample> samples;
    for (const int member : *chain) {
      const GroundTracklet piece = std::move(tracklets[member]);
      for (std::size_t r = 0; r < piece.runs.size(); ++r) {
        const std::size_t end = r + 1 < piece.runs.size() ? piece.runs[r + 1].first : piece.samples.size();
        joined.pieces.push_back({piece.runs[r].track, frames[piece.samples[piece.runs[r].first].instant],
                                 frames[piece.samples[end - 1].instant], person});
      }
      samples.insert(samples.end(), piece.samples.begin(), piece.samples.end());
    }
    joined.recording.people.push_back({.id = person + 1, .label = {}, .team = {}});
    joined.wears.push_back(appearance_of(samples));
    writer.write(samples, person, joined.recording);
  }
  std::sort(joined.pieces.begin(), joined.pieces.end(), [](const GroundRecorder::Piece& a, const GroundRecorder::Piece& b) {
    return std::tie(a.track, a.first) < std::tie(b.track, b.first);
  });
  return joined;
}

}  // namespace marey::track::ground
