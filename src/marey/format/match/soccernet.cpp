// SoccerNet's game state: JSON with a list of people seen in images, each with its place on the pitch, m from the centre spot, x
// to the right and y downwards. The truth lists them as "annotations" (the file is named Labels-GameState.json), a tracker's result
// as "predictions"; both are read, and the name decides which is written. The last six digits of an image_id count images from 1.
// Teams are "left" and "right", shirts' numbers are strings or null.
#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/game_state.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/match/ground_match.h"
#include "marey/format/match/line_ups.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

using nlohmann::json;

constexpr std::int64_t kImages = 1'000'000;  // image ids of one clip
constexpr std::string_view kPerson =
    "\n{{\"id\":\"{}\",\"image_id\":\"{}\",\"track_id\":{},\"supercategory\":\"object\",\"category_id\":{},"
    "\"attributes\":{},\"bbox_pitch\":{{\"x_bottom_left\":{:.3f},\"y_bottom_left\":{:.3f},\"x_bottom_right\":{:.3f},"
    "\"y_bottom_right\":{:.3f},\"x_bottom_middle\":{:.3f},\"y_bottom_middle\":{:.3f}}}}}";
constexpr std::int64_t kNoClip = 1000;  // what ours begin with where the path names no clip
const std::set<std::string, std::less<>> kRoles{"", "player", "goalkeeper", "referee", "other"};

class SoccernetReader {
 public:
  SoccernetReader(const std::string& name, const ReadOptions& options) : name_(name), builder_(name) {
    match_.pitch = options.pitch;
    match_.recording.header.rate_hz = options.rate_hz;
  }

  GroundMatch read(std::string_view text) {
    check_nesting(text, Notation::json, name_);
    const json root = json::parse(text);
    if (!root.is_object()) throw Error("{}: is not a game state of SoccerNet: it must be an object", name_);
    if (const auto info = root.find("info"); info != root.end() && info->is_object()) {
      const double rate = number_or(*info, "frame_rate", match_.recording.header.rate_hz);
      if (rate >= 0.1 && rate <= 10'000) match_.recording.header.rate_hz = rate;
    }
    const auto list = root.contains("predictions") ? root.find("predictions") : root.find("annotations");
    if (list == root.end() || !list->is_array())
      throw Error("{}: is not a game state of SoccerNet: \"predictions\" or \"annotations\" is missing", name_);
    for (std::size_t i = 0; i < list->size(); ++i) {
      where_ = fmt::format("{}: person {} of the list", name_, i + 1);
      add((*list)[i]);
    }
    match_.home = "left", match_.away = "right";
    match_.order = builder_.finish(match_.recording);
    warn();
    return std::move(match_);
  }

 private:
  static double number_or(const json& object, const char* key, double otherwise) {
    const auto value = object.find(key);
    return value != object.end() && value->is_number() ? value->get<double>() : otherwise;
  }

  static std::string text_of(const json& object, const char* key) {
    const auto value = object.find(key);
    if (value == object.end()) return {};
    if (value->is_string()) return value->get<std::string>();
    return value->is_number_integer() ? std::to_string(value->get<std::int64_t>()) : std::string();
  }

  /// Lines and cameras are in the list too; so are people whose place is not known.
  void add(const json& one) {
    if (!one.is_object()) throw Error("{} is not an object", where_);
    const auto box = one.find("bbox_pitch");
    if (text_of(one, "supercategory") != "object" || box == one.end() || !box->is_object()) return;
    const json& attributes = one.contains("attributes") && one["attributes"].is_object() ? one["attributes"] : json::object();
    const std::string role = text_of(attributes, "role");
    if (role == "ball") return;
    const auto image = whole_number_of(text_of(one, "image_id"));
    if (!image || *image % kImages < 1) throw Error("{}: image_id is no number that ends in an image's, counted from 1", where_);
    const auto track = whole_number_of(text_of(one, "track_id"));
    if (!track || *track < 0 || *track > 1'000'000'000) throw Error("{}: track_id is no number from 0", where_);
    const auto location = [&](const char* key) {
      const auto value = box->find(key);
      if (value == box->end() || !value->is_number()) throw Error("{}: bbox_pitch has no number {}", where_, key);
      return value->get<double>();
    };
    const auto frame = static_cast<std::int32_t>(*image % kImages - 1);
    if (!kRoles.contains(role)) ++unknown_roles_[role];
    const std::string team = role == "referee" ? role : text_of(attributes, "team");
    const std::string jersey = text_of(attributes, "jersey");
    const std::string label = role != "goalkeeper" ? jersey : jersey.empty() ? "keeper" : jersey + " keeper";
    note_shirt(frame, team, jersey, *track);
    const std::int32_t person = builder_.person(std::to_string(*track), static_cast<int>(*track), label, team);
    builder_.add(frame, frame / match_.recording.header.rate_hz, person, match_.pitch.length / 2 + location("x_bottom_middle"),
                 match_.pitch.width / 2 - location("y_bottom_middle"), where_);
  }

  /// Two people of one team with one number in one image are reported.
  void note_shirt(std::int32_t frame, const std::string& team, const std::string& jersey, std::int64_t track) {
    if (jersey.empty() || team.empty()) return;
    const auto [first, is_new] = wearing_.try_emplace({frame, team, jersey}, track);
    if (!is_new && first->second != track) shared_[{team, jersey}].insert({first->second, track});
  }

  void warn() {
    for (const auto& [role, count] : unknown_roles_)
      match_.warnings.push_back(
          fmt::format("{}: the role {} of {} entries is unknown; their people are read without one", name_, shown(role), count));
    for (const auto& [shirt, tracks] : shared_)
      match_.warnings.push_back(fmt::format("{}: {} people of the team {} have the number {} at one time (tracks {})", name_,
                                            tracks.size(), shirt.first, shirt.second, fmt::join(tracks, ", ")));
  }

  const std::string& name_;
  GroundBuilder builder_;
  GroundMatch match_;
  std::string where_;
  std::map<std::string, std::int64_t> unknown_roles_;
  std::map<std::tuple<std::int32_t, std::string, std::string>, std::int64_t> wearing_;  // image, team, number → track
  std::map<std::pair<std::string, std::string>, std::set<std::int64_t>> shared_;
};

/// What image ids begin with: the split from 1 and the clip's three digits, as in "valid/SNGS-021.json" → 2021.
std::int64_t clip_of(const std::string& path) {
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  const bool labels = absolute.filename().string().find("Labels") != std::string::npos;
  const std::string clip = labels ? absolute.parent_path().filename().string() : absolute.stem().string();
  const std::size_t dash = clip.rfind('-');
  const auto number = dash == std::string::npos || clip.size() != dash + 4 ? std::nullopt : whole_number_of(clip.substr(dash + 1));
  if (!number || *number < 0) return kNoClip;
  const std::array<std::string, 4> splits{"train", "valid", "test", "challenge"};
  for (std::filesystem::path folder = absolute.parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    const std::string name = folder.filename().string();
    const auto split =
        std::ranges::find_if(splits, [&](const std::string& one) { return name == one || name.ends_with("-" + one); });
    if (split != splits.end()) return 1000 * (split - splits.begin() + 1) + *number;
  }
  return kNoClip;
}

std::int64_t image_id(std::int64_t clip, std::int64_t frame) {
  return clip * kImages + frame + 1;
}

bool is_keeper(const TrackName& person) {
  const auto last_word = std::string_view(person.label).substr(person.label.rfind(' ') + 1);
  return last_word == "keeper" || last_word == "goalkeeper";
}

std::string attributes_of(const LineUps::Member& member, const TrackName& person) {
  const bool plays = member.side == Side::home || member.side == Side::away;
  const char* role = plays && is_keeper(person)     ? "goalkeeper"
                     : plays                        ? "player"
                     : member.side == Side::referee ? "referee"
                     : member.side == Side::ball    ? "ball"
                                                    : "other";
  // The label's own number: a line-up has each number once, a game state as it is worn.
  const auto number = whole_number_of(std::string_view(person.label).substr(0, person.label.find(' ')));
  const bool shirt = plays && number && *number >= 0 && *number <= 99;
  return fmt::format(R"({{"role":"{}","jersey":{},"team":{}}})", role, shirt ? fmt::format("\"{}\"", *number) : "null",
                     !plays                      ? "null"
                     : member.side == Side::home ? "\"left\""
                                                 : "\"right\"");
}

int category_of(Side side, const TrackName& person) {
  return side == Side::ball ? 4 : side == Side::referee ? 3 : side == Side::other ? 7 : is_keeper(person) ? 2 : 1;
}

std::string images_of(const Recording& recording, std::int64_t clip) {
  std::string text;
  for (const auto& [frame, time] : recording.instants()) {
    fmt::format_to(std::back_inserter(text),
                   "{}\n{{\"is_labeled\":true,\"image_id\":\"{}\",\"file_name\":\"{:06}.jpg\",\"has_labeled_person\":true,"
                   "\"has_labeled_pitch\":true,\"has_labeled_camera\":true}}",
                   text.empty() ? "" : ",", image_id(clip, frame), frame + 1);
  }
  return text;
}

}  // namespace

GroundMatch parse_soccernet(std::string_view text, const std::string& name, const ReadOptions& options) {
  try {
    return SoccernetReader(name, options).read(text);
  } catch (const json::exception& error) {
    const auto* broken = dynamic_cast<const json::parse_error*>(&error);
    if (broken == nullptr)
      throw Error("{}: holds something else than SoccerNet's game state where a number or a text is wanted", name);
    const auto read = text.substr(0, broken->byte);
    throw Error("{}:{}: is not JSON from here on; the file may be cut off", name, std::count(read.begin(), read.end(), '\n') + 1);
  }
}

namespace {

bool is_soccernet(const Beginning& file) {
  const std::size_t begin = file.text().find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos || file.text()[begin] != '{') return false;
  return file.has("\"bbox_pitch\"") || file.has("\"predictions\"") || (file.has("\"im_ext\"") && file.has("\"seq_length\""));
}

}  // namespace

bool is_game_state(const std::string& path) {
  if (path == "-") return false;
  const Beginning file = beginning_of(path);
  return !file.folder && file.is_text() && is_soccernet(file);
}

namespace {

GroundMatch read_soccernet(const std::string& path, const ReadOptions& options) {
  return parse_soccernet(read_file(path), path, options);
}

std::vector<std::string> write_soccernet(const GroundMatch& match, const std::string& path) {
  const Recording& recording = match.recording;
  const std::int64_t last = recording.instants().empty() ? 0 : recording.instants().back().index;
  if (last + 1 >= kImages) throw Error("SoccerNet's image ids count to {}, and the recording has frame {}", kImages - 1, last);
  const LineUps line_ups = line_ups_of(match);
  const bool labels = std::filesystem::path(path).filename().string().find("Labels") != std::string::npos;
  WholeFile file(path);
  file.write(
      fmt::format("{{\"info\":{{\"version\":\"1.3\",\"name\":\"marey\",\"im_dir\":\"img1\",\"im_ext\":\".jpg\",\"frame_rate\":{:g},"
                  "\"seq_length\":{}}},\n\"categories\":[{{\"id\":1,\"name\":\"player\",\"supercategory\":\"object\"}},"
                  "{{\"id\":2,\"name\":\"goalkeeper\",\"supercategory\":\"object\"}},"
                  "{{\"id\":3,\"name\":\"referee\",\"supercategory\":\"object\"}},"
                  "{{\"id\":4,\"name\":\"ball\",\"supercategory\":\"object\"}},"
                  "{{\"id\":7,\"name\":\"other\",\"supercategory\":\"object\"}}],\n\"images\":[",
                  match.recording.header.rate_hz, last + 1));
  const std::int64_t clip = clip_of(path);
  file.write(images_of(recording, clip));
  file.write(fmt::format("],\n\"{}\":[", labels ? "annotations" : "predictions"));
  std::string text;
  InstantRows rows(recording);
  std::int64_t count = 0;
  for (std::size_t instant = 0; instant < recording.instants().size(); ++instant) {
    for (const auto& [index, row] : rows.at(instant)) {
      const TrackColumns& track = recording.tracks()[index];
      const LineUps::Member& member = line_ups.members[index];
      const double x = track.x()[row] - match.pitch.length / 2, y = match.pitch.width / 2 - track.y()[row];
      text += count++ == 0 ? "" : ",";
      fmt::format_to(std::back_inserter(text), kPerson, count, image_id(clip, recording.instants()[instant].index),
                     number(track.id()), category_of(member.side, track.name), attributes_of(member, track.name), x, y, x, y, x, y);
    }
    if (text.size() < (std::size_t{1} << 20)) continue;
    file.write(text);
    text.clear();
  }
  file.write(text + "]}\n");
  file.finish();
  return line_ups.warnings;
}

}  // namespace

Format soccernet_format() {
  return {
      .name = "soccernet",
      .title = "a game state of SoccerNet",
      .endings = ".json",
      .holds = Content::ground,
      .detail =
          "centre spot, y down, m; game state: ids, roles, shirts, teams as left (home) and right; image ids of the clip that the "
          "path names. `Labels-GameState.json` is written with \"annotations\", any other name with \"predictions\"",
      .is = match::is_soccernet,
      .read = match::read_soccernet,
      .write = match::write_soccernet,
      .from_corner = true};
}

}  // namespace marey::format::match
