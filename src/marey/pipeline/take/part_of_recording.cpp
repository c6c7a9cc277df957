#include "marey/pipeline/take/part_of_recording.h"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"

namespace marey::pipeline::take {
namespace {

class PartReader : public format::FileReader {
 public:
  PartReader(std::unique_ptr<format::FileReader> reader, const edit::FrameRange& frames)
      : reader_(std::move(reader)), frames_(frames), info_(reader_->info()) {
    info_.frame_count.reset();
  }
  const format::FileInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return reader_->warnings(); }

  std::optional<Instant> next() override {
    while (auto instant = reader_->next()) {
      for (const TrackName& name : instant->named) named_.push_back(name);
      if (instant->index > frames_.last) return std::nullopt;
      if (instant->index < frames_.first) continue;
      instant->named = std::exchange(named_, {});
      return instant;
    }
    return std::nullopt;
  }

 private:
  std::unique_ptr<format::FileReader> reader_;
  edit::FrameRange frames_;
  format::FileInfo info_;
  std::vector<TrackName> named_;  // in frames that are not passed on
};

}  // namespace

std::unique_ptr<format::FileReader> part_of(std::unique_ptr<format::FileReader> reader, const edit::FrameRange& frames) {
  return std::make_unique<PartReader>(std::move(reader), frames);
}

Recording part_of(const Recording& recording, const edit::FrameRange& frames, const std::string& name) {
  Recording part(recording.header);
  for (const TrackColumns& track : recording.tracks()) part.set_name(track.name);
  MemoryReader reader(recording);
  while (const auto instant = reader.next()) {
    if (frames.holds(instant->index)) part.add(*instant);
  }
  part.erase_tracks_if([](const TrackColumns& track) { return track.empty(); });
  require_frames(std::ssize(part.instants()), frames, name);
  return part;
}

void require_frames(std::int64_t count, const edit::FrameRange& frames, const std::string& name) {
  if (count > 0) return;
  const std::string last = frames.last == edit::FrameRange::kToTheEnd ? "" : fmt::format("{}", frames.last);
  throw Error("{}: has none of the frames {}:{}; they are counted from 0, and `marey info` says which there are", name,
              frames.first, last);
}

}  // namespace marey::pipeline::take
