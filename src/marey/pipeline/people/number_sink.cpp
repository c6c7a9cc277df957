#include "marey/pipeline/people/number_sink.h"

#include <algorithm>
#include <utility>

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

NumberSink::NumberSink(const std::string& path, std::vector<std::unique_ptr<Sink>> drawn)
    : name_(path), file_(path), network_(detect::shirts::shirt_network_file()) {
  for (std::unique_ptr<Sink>& sink : drawn) {
    name_ += ", " + sink->name();
    drawn_.add(std::move(sink));
  }
}

Sink::SinkRequirements NumberSink::begin(const RecordingHeader& header) {
  by_boxes_ = header.frame.metric();
  keypoints_ = header.keypoints;
  drawn_.begin(header);
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

/// The tracks whose shown number has changed.
std::vector<TrackId> NumberSink::read(const Instant& instant) {
  std::vector<TrackId> tracks;
  std::vector<ShirtView> views;
  for (const Frame& frame : instant.frames) collect(frame, instant, tracks, views);
  const auto readings = network_.read(views);
  std::vector<TrackId> changed;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    Track& track = tracks_[tracks[i]];
    track.votes.add(instant.time, readings[i]);
    const auto found = track.votes.result();
    std::string shown = found && found->probability >= detect::shirts::kDecisiveNumber ? std::to_string(found->number) : "";
    if (shown == track.shown) continue;
    track.shown = std::move(shown);
    if (std::find(changed.begin(), changed.end(), tracks[i]) == changed.end()) changed.push_back(tracks[i]);
  }
  return changed;
}

/// The label, or else the track's ID, with the shirt's number behind it, if it is known and not in the label ("10 Kane").
std::string NumberSink::label_with_number(const TrackName& name) const {
  const auto track = tracks_.find(name.id);
  if (track == tracks_.end() || track->second.shown.empty()) return name.label;
  const std::string& number = track->second.shown;
  if (name.label.starts_with(number + " ")) return name.label;
  return fmt::format("{} no. {}", name.label.empty() ? std::to_string(marey::number(name.id)) : name.label, number);
}

/// The instant for sinks that draw: its new names with their numbers, and the names of tracks whose number is new.
Instant NumberSink::with_numbers(const Instant& instant, const std::vector<TrackId>& changed) {
  Instant shown = instant;
  names_.add(instant.named);
  for (const TrackId id : changed) {
    TrackName name = names_.of(id);
    name.id = id;
    shown.named.push_back(std::move(name));
  }
  for (TrackName& name : shown.named) name.label = label_with_number(name);
  return shown;
}

void NumberSink::write(const Instant& instant) {
  const std::vector<TrackId> changed = read(instant);
  if (!drawn_.write(with_numbers(instant, changed))) drawn_.finish();  // which throws what failed
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
  drawn_.finish();
  file_.finish();
}

}  // namespace marey::pipeline::people
