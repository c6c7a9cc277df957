#pragma once

// For tests and measurements of names: a simulated person, the recording that teaches a set, and what a tracker makes of the
// points.

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "marey/core/learned_markers.h"
#include "marey/core/recording.h"
#include "marey/pipeline/markers/set_in_space.h"
#include "marey/simulate/random.h"
#include "marey/simulate/room/room.h"
#include "marey/solve/labels/learn_markers.h"

namespace marey::labelled {

using simulate::room::RoomMotion;
using simulate::room::RoomOptions;
using simulate::room::RoomScene;

constexpr double kTestedRate = 100;

inline RoomScene person(RoomMotion motion, int markers, std::uint64_t seed, std::int64_t frames) {
  RoomOptions room;
  room.motion = motion;
  room.markers = markers;
  room.rate_hz = kTestedRate;
  room.frames = frames;
  room.seed = seed;
  return RoomScene(room);
}

/// The true points with their names, half a millimetre of noise along each axis.
inline Recording taught_by(const RoomScene& scene, double from_s, std::int64_t frames) {
  simulate::Random noise(77);
  Recording taught;
  taught.header.name = "taught";
  taught.header.rate_hz = kTestedRate;
  for (std::int64_t i = 0; i < frames; ++i) {
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(static_cast<double>(i) / kTestedRate);
    const auto points = scene.points(from_s + static_cast<double>(i) / kTestedRate);
    for (std::size_t m = 0; m < points.size(); ++m) {
      Sample& sample = instant.samples.emplace_back();
      sample.track = TrackId{static_cast<int>(m) + 1};
      sample.position = points[m] + Vector<3>(noise.gaussian(0, 5e-4), noise.gaussian(0, 5e-4), noise.gaussian(0, 5e-4));
    }
    taught.add(instant);
  }
  for (std::size_t m = 0; m < scene.labels().size(); ++m)
    taught.set_name({TrackId{static_cast<int>(m) + 1}, scene.labels()[m], {}});
  return taught;
}

inline std::shared_ptr<const LearnedMarkers> set_of(const std::vector<Recording>& taught) {
  return std::make_shared<const LearnedMarkers>(solve::labels::learn_markers(taught, {}));
}

/// What a tracker makes of the points: each marker's track ends where it is hidden, 5 % of the time, and another begins; now and
/// then two that are near exchange their tracks; ghosts come and go. `truth` has the marker of each point, −1 of a ghost.
struct Detected {
  std::vector<Instant> instants;
  std::vector<std::vector<int>> truth;  // by instant and sample
};

class Spoiler {
 public:
  Spoiler(const RoomScene& scene, std::uint64_t seed, double hidden = 0.05, int swaps = 0)
      : scene_(scene), random_(seed), hidden_(hidden), swaps_(swaps) {}

  Detected detected(std::int64_t frames) {
    const auto count = static_cast<int>(scene_.labels().size());
    for (int m = 0; m < count; ++m) track_of_.push_back(next_++), hidden_for_.push_back(0);
    Detected detected;
    for (std::int64_t i = 0; i < frames; ++i) add(detected, i, frames);
    return detected;
  }

 private:
  void add(Detected& detected, std::int64_t i, std::int64_t frames) {
    Instant& instant = detected.instants.emplace_back();
    auto& truth = detected.truth.emplace_back();
    instant.index = i;
    instant.time = timestamp_from_seconds(static_cast<double>(i) / kTestedRate);
    const auto points = scene_.points(seconds(instant.time));
    if (swaps_ > 0 && i % (frames / (swaps_ + 1)) == frames / (swaps_ + 1) / 2) interchange(points);
    std::vector<std::pair<Sample, int>> samples;
    for (std::size_t m = 0; m < points.size(); ++m) {
      if (hidden_for_[m] == 0 && random_.uniform() < hidden_ / 10) {
        hidden_for_[m] = 1 + static_cast<int>(19 * random_.uniform());
        track_of_[m] = next_++;
      }
      if (hidden_for_[m] > 0 && hidden_for_[m]-- > 0) continue;
      Sample sample;
      sample.track = TrackId{track_of_[m]};
      sample.position = points[m] + Vector<3>(random_.gaussian(0, 5e-4), random_.gaussian(0, 5e-4), random_.gaussian(0, 5e-4));
      samples.emplace_back(sample, static_cast<int>(m));
    }
    add_ghosts(points, samples);
    std::sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.first.track < b.first.track; });
    for (auto& [sample, marker] : samples) instant.samples.push_back(sample), truth.push_back(marker);
  }

  void add_ghosts(const std::vector<Vector<3>>& points, std::vector<std::pair<Sample, int>>& samples) {
    if (random_.uniform() < 0.4) {
      const Vector<3>& near = points[static_cast<std::size_t>(random_.uniform() * static_cast<double>(points.size()))];
      ghosts_.push_back(
          {next_++, near + Vector<3>(random_.gaussian(0, 0.3), random_.gaussian(0, 0.3), random_.gaussian(0, 0.3)), 5});
    }
    for (auto& ghost : ghosts_) {
      Sample sample;
      sample.track = TrackId{ghost.track};
      sample.position = ghost.location;
      samples.emplace_back(sample, -1);
      --ghost.left;
    }
    std::erase_if(ghosts_, [](const Ghost& ghost) { return ghost.left == 0; });
  }

  /// A marker that is seen, and the nearest other one.
  void interchange(const std::vector<Vector<3>>& points) {
    const auto one = static_cast<std::size_t>(random_.uniform() * static_cast<double>(points.size()));
    std::size_t other = one == 0 ? 1 : 0;
    for (std::size_t m = 0; m < points.size(); ++m) {
      if (m != one && (points[m] - points[one]).norm() < (points[other] - points[one]).norm()) other = m;
    }
    std::swap(track_of_[one], track_of_[other]);
  }

  struct Ghost {
    int track = 0;
    Vector<3> location = Vector<3>::Zero();
    int left = 0;
  };
  const RoomScene& scene_;
  simulate::Random random_;
  double hidden_;
  int swaps_;
  int next_ = 1;
  std::vector<int> track_of_, hidden_for_;
  std::vector<Ghost> ghosts_;
};

/// Of the markers' points since the first names counted.
struct NamedFraction {
  std::int64_t points = 0, right = 0, wrong = 0;
  bool is_consistent = true;  // each sample stays, and no track is there twice at an instant
  double found_at_s = -1;
  std::vector<std::string> news;
};

inline NamedFraction named_in(const RoomScene& scene, const Detected& detected, const std::shared_ptr<const LearnedMarkers>& set,
                              std::vector<std::string>* warnings = nullptr) {
  pipeline::markers::SetInSpaceOptions options;
  options.wait = true;
  pipeline::markers::LiveLabelling named(set, kTestedRate, options);
  NamedFraction fraction;
  std::map<TrackId, std::string> labels;
  for (std::size_t i = 0; i < detected.instants.size(); ++i) {
    Instant instant = detected.instants[i];
    const std::vector<Sample> before = instant.samples;
    named.add_to(instant);
    for (std::string& message_text : named.news()) fraction.news.push_back(std::move(message_text));
    for (const TrackName& name : instant.named) labels[name.id] = name.label;
    if (!named.found_at_s()) continue;
    fraction.is_consistent = fraction.is_consistent && instant.samples.size() == before.size();
    std::map<double, int> marker_at;  // by x: samples come in another order
    for (std::size_t p = 0; p < before.size(); ++p) marker_at[before[p].position.x()] = detected.truth[i][p];
    std::set<TrackId> reported;
    for (const Sample& sample : instant.samples) {
      fraction.is_consistent = fraction.is_consistent && reported.insert(sample.track).second;
      const int marker = marker_at.at(sample.position.x());
      const std::string& label = labels[sample.track];
      fraction.points += marker >= 0;
      if (label.empty()) continue;
      ++(marker >= 0 && label == scene.labels()[static_cast<std::size_t>(marker)] ? fraction.right : fraction.wrong);
    }
  }
  fraction.found_at_s = named.found_at_s().value_or(-1);
  if (warnings != nullptr) *warnings = named.warnings();
  return fraction;
}

}  // namespace marey::labelled
