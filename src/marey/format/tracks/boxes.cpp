#include "marey/format/tracks/boxes.h"

#include "marey/core/error.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"

namespace marey::format::tracks {

MotTable read_boxes(const std::string& path, MotKind kind) {
  const Format* format = path == "-" ? nullptr : format_of_content(path);
  // What is not a format at all is reported by the reader of MOT text, which says what it wants.
  if (format == nullptr || format->name == "mot" || !format->holds.any_of(kRecordings)) return read_mot(path, kind);
  match::GroundMatch match = read_whole(path, *format);
  if (match.recording.header.frame.metric())
    throw Error("{}: its positions are {}, not px of an image; --distance judges places", path,
                to_string(match.recording.header.frame));
  MotTable table{.boxes = {}, .warnings = std::move(match.warnings)};
  InstantRows rows(match.recording);
  for (std::size_t instant = 0; instant < match.recording.instants().size(); ++instant) {
    for (const auto& [index, row] : rows.at(instant)) {
      const Sample sample = match.recording.tracks()[index].sample(row);
      if (!sample.box) continue;
      table.boxes.push_back({.frame = static_cast<std::int32_t>(match.recording.instants()[instant].index),
                             .id = number(sample.track),
                             .box = *sample.box,
                             .score = sample.score.value_or(1)});
    }
  }
  if (table.boxes.empty() && match.recording.samples() > 0) throw Error("{}: holds positions alone, without boxes", path);
  return table;
}

}  // namespace marey::format::tracks
