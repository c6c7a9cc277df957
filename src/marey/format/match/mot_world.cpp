// MOTChallenge text with world coordinates: frame,id,left,top,width,height,score,X,Y[,Z], frames from 1, m. Where only the ground
// is known the box is -1, as in the benchmark's 3D part.
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/match/ground_match.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {

namespace {

/// (-1, -1), and -1 or nothing behind it, says that there is no place. With a height of 0, as we write it, a person stands there.
bool is_no_position(const std::vector<std::string_view>& fields) {
  return number_of(fields[7]) == -1 && number_of(fields[8]) == -1 && (fields.size() < 10 || number_of(fields[9]) == -1);
}

}  // namespace

GroundMatch parse_mot_world(std::string_view text, const std::string& name, double rate_hz) {
  constexpr std::array needed = {0, 1, 7, 8};  // frame, id, X, Y
  constexpr std::array<std::string_view, 4> names = {"frame", "id", "X", "Y"};
  GroundMatch match;
  match.recording.header.rate_hz = rate_hz;
  GroundBuilder builder(name);
  TextLines lines(text);
  std::string_view line;
  std::vector<std::string_view> fields;
  while (lines.next(line)) {
    if (line.empty()) continue;
    const std::string where = fmt::format("{}:{}", name, lines.number());
    split_fields(line, line.find(',') == std::string_view::npos ? ' ' : ',', fields);
    if (fields.size() < 9) throw Error("{}: has {} columns; world coordinates are in the eighth and ninth", where, fields.size());
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < needed.size(); ++i) {
      const std::string_view field = fields[static_cast<std::size_t>(needed[i])];
      const auto value = number_of(field);
      if (!value) throw Error("{}: {} is {}; it must be a number", where, names[i], shown(field));
      values[i] = *value;
    }
    if (values[0] < 1 || values[0] > 1e9 || values[0] != std::floor(values[0]))
      throw Error("{}: frame is {:g}; frames are whole numbers from 1", where, values[0]);
    if (values[1] < 0 || values[1] > 1e9 || values[1] != std::floor(values[1]))
      throw Error("{}: id is {:g}; ids are whole numbers from 0", where, values[1]);
    if (is_no_position(fields))
      throw Error("{}: has no world coordinates (-1, -1); such boxes are placed on the ground by `marey track --ground`", where);
    const auto frame = static_cast<std::int32_t>(values[0]) - 1;
    const int id = static_cast<int>(values[1]);
    builder.add(frame, frame / rate_hz, builder.person(std::to_string(id), id, {}, {}), values[2], values[3], where);
  }
  match.order = builder.finish(match.recording);
  return match;
}

namespace {

std::vector<std::string> write_mot_world(const GroundMatch& match, const std::string& path) {
  WholeFile file(path);
  std::string text;
  InstantRows rows(match.recording);
  for (std::size_t instant = 0; instant < match.recording.instants().size(); ++instant) {
    for (const auto& [index, row] : rows.at(instant)) {
      const TrackColumns& track = match.recording.tracks()[index];
      if (track.name.kind == TrackKind::ball) continue;  // nothing would distinguish it from people
      fmt::format_to(std::back_inserter(text), "{},{},-1,-1,-1,-1,1,{:.3f},{:.3f},0\n",
                     match.recording.instants()[instant].index + 1, number(track.id()), track.x()[row], track.y()[row]);
    }
    if (text.size() < (std::size_t{1} << 20)) continue;
    file.write(text);
    text.clear();
  }
  file.write(text);
  file.finish();
  return {};
}

/// MOTChallenge's truth has nine columns too: behind the box come its class, a whole number, and its visibility, in [0, 1].
bool is_truth_of_boxes(const std::vector<std::string_view>& fields) {
  const double width = *number_of(fields[4]), height = *number_of(fields[5]);
  const double kind = *number_of(fields[7]), visibility = *number_of(fields[8]);
  return fields.size() == 9 && width > 0 && height > 0 && kind >= 1 && kind == std::floor(kind) && visibility >= 0 &&
         visibility <= 1;
}

/// Ten numbers, or the nine that are needed; the place is one.
bool is_mot_world(const Beginning& file) {
  std::vector<std::string_view> fields;
  const std::string_view line = file.first_line();
  split_fields(line, line.find(',') == std::string_view::npos ? ' ' : ',', fields);
  if (fields.size() < 9 || !all_numbers(fields) || is_truth_of_boxes(fields)) return false;
  return !is_no_position(fields);
}

GroundMatch read_mot_world(const std::string& path, const ReadOptions& options) {
  GroundMatch match = parse_mot_world(read_file(path), path, options.rate_hz);
  match.pitch = options.pitch;
  return match;
}

}  // namespace

Format world_mot_format() {
  return {.name = "mot",
          .title = "MOTChallenge text with world coordinates",
          .endings = ".txt",
          .holds = Content::ground,
          .detail =
              "yours, m; MOTChallenge text, frames from 1, the place in columns 8 and 9; boxes are −1 when written. It has no "
              "time: `--rate`",
          .is = match::is_mot_world,
          .read = match::read_mot_world,
          .write = match::write_mot_world};
}

}  // namespace marey::format::match
