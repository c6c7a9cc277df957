#include "marey/format/match/ground_exchange.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/other_ground.h"
#include "marey/format/mapped_file.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/match/line_ups.h"
#include "marey/format/read_file.h"
#include "marey/format/take/take_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLookedAt = 4096;

struct NamedFormat {
  GroundFormat format;
  std::string_view name;
};
constexpr std::array kFormats{
    NamedFormat{GroundFormat::csv, "ground"},      NamedFormat{GroundFormat::mot, "mot"},
    NamedFormat{GroundFormat::metrica, "metrica"}, NamedFormat{GroundFormat::tracab, "tracab"},
    NamedFormat{GroundFormat::epts, "epts"},       NamedFormat{GroundFormat::soccernet, "soccernet"},
    NamedFormat{GroundFormat::sportec, "sportec"}, NamedFormat{GroundFormat::statsperform, "statsperform"}};

std::string beginning_of(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  std::ifstream in(path, std::ios::binary);
  std::string bytes(kLookedAt, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  return bytes;
}

bool all_numbers(const std::vector<std::string_view>& fields) {
  return std::all_of(fields.begin(), fields.end(), [](std::string_view field) { return number_of(field).has_value(); });
}

bool is_ground_csv(const std::vector<std::string_view>& head) {
  const auto has = [&](std::string_view name) { return std::find(head.begin(), head.end(), name) != head.end(); };
  return (has("frame") || has("time")) && has("id") && has("x") && has("y") && !has("z");
}

/// A tracking file whose lines begin with a frame and a colon: TRACAB's targets have six whole fields or so, EPTS' are its own.
std::optional<GroundFormat> by_colon(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !whole_number_of(line.substr(0, colon))) return std::nullopt;
  std::vector<std::string_view> target;
  const std::string_view rest = line.substr(colon + 1);
  split_fields(rest.substr(0, rest.find_first_of(";:")), ',', target);
  if (target.size() == 6 && all_numbers(target) && whole_number_of(target[0]) && rest.find(';') != std::string_view::npos) {
    const auto team = *whole_number_of(target[0]);
    if (team >= -1 && team <= 4) return GroundFormat::tracab;
  }
  return GroundFormat::epts;
}

std::optional<GroundFormat> of_lines(std::string_view text) {
  TextLines lines(text);
  std::string_view line, third;
  while (lines.next(line) && line.empty()) continue;
  if (line.empty()) return std::nullopt;
  std::vector<std::string_view> fields;
  split_fields(line, ',', fields);
  if (is_ground_csv(fields)) return GroundFormat::csv;
  if (lines.next(third) && lines.next(third) && third.starts_with("Period,Frame,Time [s]")) return GroundFormat::metrica;
  if (fields.size() >= 9 && all_numbers(fields)) return GroundFormat::mot;
  const std::size_t semicolon = line.find(';');
  if (semicolon != std::string_view::npos && whole_number_of(line.substr(0, semicolon)) && line.find(':') > semicolon) {
    split_fields(line.substr(semicolon + 1, line.find(':') - semicolon - 1), ',', fields);
    if (fields.size() == 3 && all_numbers(fields)) return GroundFormat::statsperform;
  }
  return by_colon(line);
}

bool is_metadata(std::string_view text) {
  return text.find("<TracabMetaData") != std::string_view::npos || text.find("<GlobalConfig") != std::string_view::npos ||
         text.find("<MatchInformation") != std::string_view::npos ||
         (text.find("<GameID") != std::string_view::npos && text.find("<Phase1StartFrame") != std::string_view::npos);
}

std::optional<GroundFormat> of_bytes(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return std::nullopt;
  const auto has = [&](std::string_view what) { return text.find(what) != std::string_view::npos; };
  if (text[begin] == '<') {
    if (has("<PutDataRequest") && (has("<Positions") || has("<MatchInformation"))) return GroundFormat::sportec;
    if (has("<GlobalConfig")) return GroundFormat::epts;
    if (is_metadata(text)) return GroundFormat::tracab;
    return std::nullopt;
  }
  if (text[begin] == '{') {
    const bool game = has("\"bbox_pitch\"") || has("\"predictions\"") || (has("\"im_ext\"") && has("\"seq_length\""));
    return game ? std::optional(GroundFormat::soccernet) : std::nullopt;
  }
  return of_lines(text);
}

/// Names that the partner of a file may bear: the same with another ending, or with a word of the name replaced.
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
std::optional<std::string> partner_of(const std::string& path, GroundFormat format, bool metadata,
                                      const std::vector<std::string>& endings) {
  for (const std::string& name : partner_names(path, endings)) {
    std::error_code error;
    if (fs::equivalent(name, path, error)) continue;
    const std::string text = beginning_of(name);
    if (!text.empty() && of_bytes(text) == format && is_metadata(text) == metadata) return name;
  }
  return std::nullopt;
}

struct Pair {
  std::string data, metadata;
};

/// Which is which of a file and its partner; `must` where it cannot be read without metadata.
Pair pair_of(const std::string& path, GroundFormat format, const GroundReadOptions& options,
             const std::vector<std::string>& data_endings, bool must) {
  if (is_metadata(beginning_of(path))) {
    const auto data = partner_of(path, format, false, data_endings);
    if (!data) throw Error("{}: is metadata only; name the file with the places, and this one with --metadata", path);
    return {*data, path};
  }
  if (!options.metadata.empty()) return {path, options.metadata};
  const auto metadata = partner_of(path, format, true, {".xml"});
  if (!metadata && must) {
    throw Error("{}: its metadata is not beside it under a like name ({}); name it with --metadata", path,
                fs::path(path).filename().replace_extension(".xml").string());
  }
  return {path, metadata.value_or("")};
}

using TwoTexts = GroundMatch (*)(std::string_view, const std::string&, std::string_view, const std::string&);

GroundMatch read_pair(const Pair& pair, TwoTexts parse) {
  const MappedFile data(pair.data);
  if (pair.metadata.empty()) return parse(data.text(), pair.data, {}, {});
  const MappedFile metadata(pair.metadata);
  return parse(data.text(), pair.data, metadata.text(), pair.metadata);
}

GroundMatch read_metrica(const std::string& path, const geometry::PitchSize& pitch) {
  std::string other = path;
  bool is_home = true;
  for (const auto& [mine, theirs] :
       {std::pair("home", "away"), std::pair("Home", "Away"), std::pair("away", "home"), std::pair("Away", "Home")}) {
    const std::size_t at = fs::path(path).filename().string().rfind(mine);
    if (at == std::string::npos) continue;
    other = (fs::path(path).parent_path() / fs::path(path).filename().string().replace(at, 4, theirs)).string();
    is_home = mine[0] == 'h' || mine[0] == 'H';
    break;
  }
  std::error_code error;
  if (other == path || !fs::exists(other, error))
    throw Error("{}: Metrica's files come in pairs, ..._home.csv and ..._away.csv, and the other one is not beside it", path);
  const MappedFile mine(path), theirs(other);
  return is_home ? parse_metrica(mine.text(), path, theirs.text(), other, pitch)
                 : parse_metrica(theirs.text(), other, mine.text(), path, pitch);
}

GroundMatch read_csv(const std::string& path, const GroundReadOptions& options) {
  GroundFile file = read_ground_in_order(path, options.rate_hz);
  GroundMatch match;
  match.recording = std::move(file.recording);
  match.order = std::move(file.order);
  match.pitch = options.pitch;
  return match;
}

Recording turned(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame, bool to) {
  require_ground(recording, "the pitch's corner");
  const Vector<2> middle(pitch.length / 2, pitch.width / 2);
  const auto place = [&](Vector<2> at) {
    if (to && frame.centred) at += middle;
    if (frame.y_down) at.y() = pitch.width - at.y();
    if (!to && frame.centred) at -= middle;
    return at;
  };
  const Matrix<2> linear = Vector<2>(1, frame.y_down ? -1 : 1).asDiagonal();
  return on_other_ground(std::move(recording), {FrameOfReference::Kind::user_ground, {}}, {place, linear});
}

GroundMatch read_of_format(const std::string& path, GroundFormat format, const GroundReadOptions& options) {
  switch (format) {
    case GroundFormat::csv:
      return read_csv(path, options);
    case GroundFormat::mot: {
      GroundMatch match = parse_mot_world(read_file(path), path, options.rate_hz);
      match.pitch = options.pitch;
      return match;
    }
    case GroundFormat::metrica:
      return read_metrica(path, options.pitch);
    case GroundFormat::tracab:
      return read_pair(pair_of(path, format, options, {".dat", ".txt"}, true), parse_tracab);
    case GroundFormat::epts:
      return read_pair(pair_of(path, format, options, {".txt", ".dat"}, true), parse_epts);
    case GroundFormat::soccernet:
      return parse_soccernet(read_file(path), path, options);
    case GroundFormat::sportec:
      return read_pair(pair_of(path, format, options, {".xml"}, false), parse_sportec);
    case GroundFormat::statsperform:
      return parse_statsperform(read_file(path), path, options.pitch);
  }
  throw Error("{}: cannot be read", path);
}

}  // namespace

RecordingHeader ground_header(const std::string& name) {
  RecordingHeader header;
  header.name = name;
  header.frame.kind = FrameOfReference::Kind::user_ground;
  header.rate_hz = 25;
  return header;
}

std::string ground_format_names() {
  std::string names;
  for (const NamedFormat& format : kFormats) names.append(names.empty() ? "" : ", ").append(format.name);
  return names;
}

std::string_view ground_format_name(GroundFormat format) {
  const auto named = std::find_if(kFormats.begin(), kFormats.end(), [&](const NamedFormat& each) { return each.format == format; });
  return named == kFormats.end() ? std::string_view() : named->name;
}

GroundFormat parse_ground_format(std::string_view name) {
  for (const NamedFormat& format : kFormats) {
    if (format.name == name) return format.format;
  }
  throw Error("\"{}\" is no format of people on the ground; these are: {}", name, ground_format_names());
}

std::optional<GroundFormat> ground_format_of_content(const std::string& path) {
  return of_bytes(beginning_of(path));
}

std::optional<GroundFormat> ground_format_of_name(std::string_view path) {
  std::string name = fs::path(path).filename().string();
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (name.ends_with("_home.csv") || name.ends_with("_away.csv")) return GroundFormat::metrica;
  if (name.ends_with(".csv")) return GroundFormat::csv;
  if (name.ends_with(".txt")) return GroundFormat::mot;
  if (name.ends_with(".dat")) return GroundFormat::tracab;
  if (name.ends_with(".xml")) return GroundFormat::epts;
  if (name.ends_with(".json")) return GroundFormat::soccernet;
  return std::nullopt;
}

GroundMatch read_ground_any(const std::string& path, const GroundReadOptions& options) {
  if (path == "-") return read_csv(path, options);
  std::error_code error;
  if (!fs::exists(path, error)) throw Error("{}: no such file", path);
  if (fs::is_directory(path, error)) throw Error("{}: is a folder, not a file", path);
  if (take::is_take(path)) {
    GroundMatch match;
    match.pitch = options.pitch;
    match.recording = take::read_recording(path);
    match.recording.header.name = path;
    require_ground(match.recording, "a match");
    for (const TrackColumns& track : match.recording.tracks()) match.order.push_back(track.id());
    return match;
  }
  // What is no format at all is told by the reader of ours, which says what it wants.
  return read_ground_as(path, ground_format_of_content(path).value_or(GroundFormat::csv), options);
}

GroundMatch read_ground_as(const std::string& path, GroundFormat format, const GroundReadOptions& options) {
  GroundMatch match = read_of_format(path, format, options);
  match.recording.header.name = path == "-" ? "standard input" : path;
  return match;
}

std::vector<std::string> write_ground_as(const GroundMatch& match, const std::string& path, GroundFormat format) {
  require_ground(match.recording, ground_format_name(format));
  switch (format) {
    case GroundFormat::csv:
      write_ground(match.recording, path);
      return {};
    case GroundFormat::mot:
      write_mot_world(match, path);
      return {};
    case GroundFormat::metrica:
      return write_metrica(match, path);
    case GroundFormat::tracab:
      return write_tracab(match, path);
    case GroundFormat::epts:
      return write_epts(match, path);
    case GroundFormat::soccernet:
      return write_soccernet(match, path);
    case GroundFormat::sportec:
    case GroundFormat::statsperform:
      break;
  }
  throw Error("{}: {} is read only; write ground, mot, metrica, tracab, epts or soccernet", path, ground_format_name(format));
}

Recording from_corner(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame) {
  return turned(std::move(recording), pitch, frame, false);
}

Recording to_corner(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame) {
  return turned(std::move(recording), pitch, frame, true);
}

}  // namespace marey::format::match
