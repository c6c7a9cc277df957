#include "marey/core/recording_reader.h"

#include <map>
#include <utility>

#include "marey/core/stop.h"

namespace marey {

std::vector<TrackName> MemoryReader::tracks() const {
  std::vector<TrackName> names;
  for (const TrackColumns& track : recording_->tracks()) names.push_back(track.name);
  return names;
}

std::optional<std::int64_t> MemoryReader::instant_count() const {
  const auto& instants = recording_->instants();
  return instants.empty() ? 0 : instants.back().index - instants.front().index + 1;
}

std::optional<Instant> MemoryReader::next() {
  auto instant = instants_.next();
  if (instant) instant->named.clear();
  return instant;
}

void RecordingSummary::TrackCount::add(std::int64_t index, Provenance provenance) {
  if (!first_index) first_index = index;
  last_index = index;
  ++by_provenance[static_cast<std::size_t>(provenance)];
}

RecordingSummary summary_of(RecordingReader& reader) {
  RecordingSummary summary;
  summary.complete = true;
  std::map<TrackId, RecordingSummary::TrackCount> counts;
  for (const TrackName& name : reader.tracks()) counts[name.id].name = name;
  while (const auto instant = reader.next()) {
    if (summary.instants++ == 0) {
      summary.first_index = instant->index;
      summary.first_time = instant->time;
    }
    summary.last_index = instant->index;
    summary.last_time = instant->time;
    summary.detected += static_cast<std::int64_t>(instant->detected.size());
    summary.samples += static_cast<std::int64_t>(instant->samples.size());
    for (const TrackName& name : instant->named) counts[name.id].name = name;
    for (const Sample& sample : instant->samples) {
      RecordingSummary::TrackCount& count = counts[sample.track];
      count.name.id = sample.track;
      count.add(instant->index, sample.provenance);
    }
  }
  for (auto& [id, count] : counts) summary.tracks.push_back(std::move(count));
  return summary;
}

Recording read_all(RecordingReader& reader) {
  Recording recording(reader.header());
  for (const TrackName& name : reader.tracks()) recording.set_name(name);
  while (const auto instant = reader.next()) {
    stop_point();
    recording.add(*instant);
  }
  recording.edits = reader.edits();
  recording.head = reader.head();
  return recording;
}

bool replay(RecordingReader& reader, Sink& sink, const std::function<bool(std::int64_t)>& goes_on) {
  sink.begin(reader.header());
  std::int64_t instants = 0;
  while (auto instant = reader.next()) {
    stop_point();
    if (instants++ == 0) {
      const std::vector<TrackName> names = reader.tracks();
      instant->named.insert(instant->named.begin(), names.begin(), names.end());
    }
    sink.write(*instant);
    if (goes_on && !goes_on(instants)) return false;
  }
  sink.finish();
  return true;
}

}  // namespace marey
