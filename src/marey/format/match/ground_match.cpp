#include "marey/format/match/ground_match.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/format/mapped_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

namespace fs = std::filesystem;

/// Names that the partner of a file may have: the same with another ending, or with a word of the name replaced.
std::vector<std::string> partner_names(const std::string& path, const std::vector<std::string>& endings) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> words{{{"raw", "meta"},
                                                                                {"tracking", "metadata"},
                                                                                {"positional", "meta"},
                                                                                {"positions", "matchinformation"},
                                                                                {"meta", "raw"},
                                                                                {"metadata", "tracking"},
                                                                                {"meta", "positional"},
                                                                                {"matchinformation", "positions"}}};
  std::vector<std::string> names;
  const fs::path file(path);
  const std::string stem = file.stem().string();
  for (const std::string& ending : endings) {
    const auto add = [&](const std::string& name) { names.push_back((file.parent_path() / (name + ending)).string()); };
    add(stem);
    add(stem + "_metadata");
    add(stem + "_meta");
    for (const auto& [from, to] : words) {
      const std::size_t at = stem.rfind(from);
      if (at != std::string::npos) add(std::string(stem).replace(at, from.size(), to));
    }
    for (const std::string_view last : {"_metadata", "_meta"}) {
      if (stem.ends_with(last)) add(stem.substr(0, stem.size() - last.size()));
    }
  }
  return names;
}

/// The file beside `path` that is of this format, and metadata or not as asked.
std::optional<std::string> partner_of(const std::string& path, const TwoFiles& format, bool metadata,
                                      const std::vector<std::string>& endings) {
  for (const std::string& name : partner_names(path, endings)) {
    std::error_code error;
    if (fs::equivalent(name, path, error) || !fs::is_regular_file(name, error)) continue;
    const Beginning beginning = beginning_of(name);
    if (format.is(beginning) && format.is_metadata(beginning.bytes) == metadata) return name;
  }
  return std::nullopt;
}

struct Pair {
  std::string data, metadata;
};

/// Which is which of a file and its partner.
Pair pair_of(const std::string& path, const TwoFiles& format, const ReadOptions& options) {
  if (format.is_metadata(beginning_of(path).bytes)) {
    const auto data = partner_of(path, format, false, format.endings);
    if (!data) throw Error("{}: is metadata only; name the file with the places, and this one with --metadata", path);
    return {*data, path};
  }
  if (!options.metadata.empty()) return {path, options.metadata};
  const auto metadata = partner_of(path, format, true, {".xml"});
  if (!metadata && format.needs_metadata) {
    throw Error("{}: its metadata is not beside it under a like name ({}); name it with --metadata", path,
                fs::path(path).filename().replace_extension(".xml").string());
  }
  return {path, metadata.value_or("")};
}

/// The header's rig follows: a frame that it leads to is another one now.
void turn_rig(RecordingHeader& header, const GroundFrame& frame, bool to, const Vector<2>& moved) {
  const bool leads = header.rig && header.rig->ground_from_world;
  const Matrix<3> rotated_over = Vector<3>(1, -1, 1).asDiagonal();
  Matrix<3> change = frame.y_down ? rotated_over : Matrix<3>(Matrix<3>::Identity());
  change.topRightCorner<2, 1>() = moved;
  const Matrix<3> unknown = to && frame.y_down ? rotated_over : Matrix<3>(Matrix<3>::Identity());
  const Matrix<3> now = change * (leads ? *header.rig->ground_from_world : unknown);
  if (!header.rig) header.rig.emplace();
  header.rig->ground_from_world = now;
}

Recording rotated(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame, bool to) {
  require_ground(recording, "the pitch's corner");
  const Vector<2> middle(pitch.length / 2, pitch.width / 2);
  const auto location = [&](Vector<2> at) {
    if (to && frame.centred) at += middle;
    if (frame.y_down) at.y() = pitch.width - at.y();
    if (!to && frame.centred) at -= middle;
    return at;
  };
  const Matrix<2> linear = Vector<2>(1, frame.y_down ? -1 : 1).asDiagonal();
  turn_rig(recording.header, frame, to, location(Vector<2>::Zero()));
  return on_other_ground(std::move(recording), {FrameOfReference::Kind::user_ground, {}}, {location, linear});
}

}  // namespace

RecordingHeader ground_header(const std::string& name) {
  RecordingHeader header;
  header.name = name;
  header.frame.kind = FrameOfReference::Kind::user_ground;
  header.rate_hz = 25;
  return header;
}

GroundMatch read_two_files(const std::string& path, const TwoFiles& format, const ReadOptions& options) {
  const Pair pair = pair_of(path, format, options);
  const MappedFile data(pair.data);
  if (pair.metadata.empty()) return format.parse(data.text(), pair.data, {}, {});
  const MappedFile metadata(pair.metadata);
  return format.parse(data.text(), pair.data, metadata.text(), pair.metadata);
}

bool all_numbers(const std::vector<std::string_view>& fields) {
  return std::all_of(fields.begin(), fields.end(), [](std::string_view field) { return number_of(field).has_value(); });
}

Recording from_corner(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame) {
  return rotated(std::move(recording), pitch, frame, false);
}

Recording to_corner(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame) {
  return rotated(std::move(recording), pitch, frame, true);
}

}  // namespace marey::format::match
