#include "marey/pipeline/people/number_sink.h"

#include <algorithm>

#include <fmt/format.h>

namespace marey::pipeline::people {
namespace {

using detect::shirts::ShirtRegion;
using detect::shirts::ShirtView;

constexpr double kMinStature = 60;                               // px; digits of 9 px and more
constexpr Duration kReadEvery = std::chrono::milliseconds(500);  // physical: one group of NumberVotes

/// A person in one camera's image.
struct VisiblePerson {
  TrackId track{};
  Box box;
  std::optional<ShirtRegion> shirt;  // nothing: too small, filled, or not upright
};

/// Whether another person, who stands nearer to the camera, covers a part of the shirt.
bool is_covered(const VisiblePerson& person, const std::vector<VisiblePerson>& people) {
  const double half = person.shirt->part.side / 4, x = person.shirt->part.centre.x(), y = person.shirt->part.centre.y();
  const double foot = person.box.top + person.box.height;
  return std::any_of(people.begin(), people.end(), [&](const VisiblePerson& other) {
    const Box& box = other.box;
    return other.track != person.track && box.top + box.height > foot && box.left < x + half && box.left + box.width > x - half &&
           box.top < y + half && box.top + box.height > y - half;
  });
}

}  // namespace

NumberSink::NumberSink(const std::string& path) : path_(path), file_(path), network_(detect::shirts::shirt_network_file()) {}

Sink::SinkRequirements NumberSink::begin(const RecordingHeader& header) {
  by_boxes_ = header.frame.metric();
  keypoints_ = header.keypoints;
  return {.images = true, .boxes = by_boxes_};
}

bool NumberSink::is_due(TrackId track, CameraId camera, Timestamp time) {
  const auto [read_at, first] = tracks_[track].read_at.try_emplace(camera, time);
  if (!first && time - read_at->second < kReadEvery) return false;
  read_at->second = time;
  return true;
}

void NumberSink::collect(const Frame& frame, const Instant& instant, std::vector<TrackId>& tracks, std::vector<ShirtView>& views) {
  std::vector<VisiblePerson> people;
  if (by_boxes_) {
    for (const BoxInView& one : instant.boxes) {
      if (one.camera != frame.camera) continue;
      people.push_back({one.track, one.box, one.detected ? detect::shirts::shirt_region(one.box) : std::nullopt});
    }
  } else {
    for (const Sample& sample : instant.samples) {
      if (!sample.box) continue;
      people.push_back(
          {sample.track, *sample.box, sample.measured() ? detect::shirts::shirt_region(sample, keypoints_) : std::nullopt});
    }
  }
  for (const VisiblePerson& person : people) {
    if (!person.shirt || person.shirt->stature < kMinStature || is_covered(person, people)) continue;
    if (!is_due(person.track, frame.camera, instant.time)) continue;
    tracks.push_back(person.track);
    views.push_back({frame.image, *person.shirt});
  }
}

void NumberSink::write(const Instant& instant) {
  std::vector<TrackId> tracks;
  std::vector<ShirtView> views;
  for (const Frame& frame : instant.frames) collect(frame, instant, tracks, views);
  const auto readings = network_.read(views);
  for (std::size_t i = 0; i < readings.size(); ++i) tracks_[tracks[i]].votes.add(instant.time, readings[i]);
}

void NumberSink::finish() {
  std::string text = "id,number,probability,readings,time\n";
  for (const auto& [id, track] : tracks_) {
    const auto found = track.votes.result();
    if (!found) continue;
    text += fmt::format("{},{},{:.4f},{},{:.3f}\n", marey::number(id), found->number, found->probability, found->readings,
                        seconds(found->clearest));
  }
  file_.write(text);
  file_.finish();
}

}  // namespace marey::pipeline::people
