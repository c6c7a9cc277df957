// TRACAB: one line an instant, `frame:target;target;...;:ball;:`, a target being team,target id,shirt,x,y,speed; cm from the centre
// spot, y upwards, m/s. Team 1 is at home, 0 is the guest, 3 a referee, -1 is not known and 4 is a target that is not used. The
// metadata's XML comes with attributes of <match> or flat, lengths then in cm.
//
// A ball that is not known is written dead on the centre spot, for readers insist on one. Readers insist on who has it too: the
// team of the one who was last within two metres of it, to begin with the home team.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/match/ground_match.h"
#include "marey/format/match/line_ups.h"
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format::match {
namespace {

constexpr double kMetre = 100;  // of TRACAB's units
constexpr std::int64_t kMaxFrames = 1'000'000'000;

/// A number with a dot or, as some exports have it, a comma.
std::optional<double> decimal(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  return number_of(text);
}

class TracabReader {
 public:
  TracabReader(const std::string& name, const std::string& metadata_name)
      : name_(name), metadata_name_(metadata_name), builder_(name) {}

  GroundMatch read(std::string_view text, std::string_view metadata) {
    read_metadata(metadata);
    for_each_line(text, name_, [this](std::string_view line, std::string where) {
      where_ = std::move(where);
      read_line(line);
    });
    match_.order = builder_.finish(match_.recording);
    return std::move(match_);
  }

 private:
  double metadata_number(const std::string& text, const char* what, double minimum, double maximum) const {
    const auto value = decimal(text);
    if (!value || !(*value >= minimum && *value <= maximum))
      throw Error("{}: {} is {}; a number from {:g} to {:g} is wanted", metadata_name_, what, shown(text), minimum, maximum);
    return *value;
  }

  void add_period(int number, double first, double last) {
    if (first == 0 && last == 0) return;
    match_.periods.push_back({number, static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)});
  }

  void read_metadata(std::string_view text) {
    const pugi::xml_document document = parse_xml(text, metadata_name_);
    const pugi::xml_node root = document.document_element();
    if (const pugi::xml_node head = root.child("match")) {
      match_.recording.header.rate_hz = metadata_number(head.attribute("iFrameRateFps").as_string(), "iFrameRateFps", 1, 1000);
      match_.pitch.length = metadata_number(head.attribute("fPitchXSizeMeters").as_string(), "fPitchXSizeMeters", 1, 1000);
      match_.pitch.width = metadata_number(head.attribute("fPitchYSizeMeters").as_string(), "fPitchYSizeMeters", 1, 1000);
      for (const pugi::xml_node period : head.children("period")) {
        add_period(period.attribute("iId").as_int(),
                   metadata_number(period.attribute("iStartFrame").as_string(), "iStartFrame", 0, kMaxFrames),
                   metadata_number(period.attribute("iEndFrame").as_string(), "iEndFrame", 0, kMaxFrames));
      }
    } else if (root.child("FrameRate")) {
      match_.recording.header.rate_hz = metadata_number(root.child_value("FrameRate"), "FrameRate", 1, 1000);
      match_.pitch.length = metadata_number(root.child_value("PitchLongSide"), "PitchLongSide", 100, 1e5) / kMetre;
      match_.pitch.width = metadata_number(root.child_value("PitchShortSide"), "PitchShortSide", 100, 1e5) / kMetre;
      for (int phase = 1; phase <= 5; ++phase) {
        const std::string start = fmt::format("Phase{}StartFrame", phase), end = fmt::format("Phase{}EndFrame", phase);
        if (!root.child(start.c_str())) continue;
        add_period(phase, metadata_number(root.child_value(start.c_str()), start.c_str(), 0, kMaxFrames),
                   metadata_number(root.child_value(end.c_str()), end.c_str(), 0, kMaxFrames));
      }
    } else {
      throw Error("{}: is not a metadata of TRACAB: neither <match> nor <FrameRate> is in it", metadata_name_);
    }
    read_team(root.child("HomeTeam"), 1, "Home", match_.home);
    read_team(root.child("AwayTeam"), 0, "Away", match_.away);
  }

  void read_team(const pugi::xml_node& team, int side, const char* otherwise, std::string& name) {
    name = team.child_value("ShortName");
    if (name.empty()) name = otherwise;
    for (const pugi::xml_node player : team.child("Players").children()) {
      const std::string first = player.child_value("FirstName"), last = player.child_value("LastName");
      const int number = player.child("JerseyNo").text().as_int(-1);
      names_[{side, number}] = fmt::format("{}{}{}", first, first.empty() || last.empty() ? "" : " ", last);
    }
  }

  void read_line(std::string_view line) {
    const std::size_t head = line.find(':');
    const auto frame = whole_number_of(line.substr(0, head));
    const std::size_t end = head == std::string_view::npos ? head : line.find(':', head + 1);
    if (!frame || *frame < 0 || *frame > kMaxFrames || end == std::string_view::npos)
      throw Error("{}: is not an instant of TRACAB; it must read frame:targets:ball:", where_);
    split_fields(line.substr(head + 1, end - head - 1), ';', targets_);
    for (const std::string_view target : targets_) {
      if (!target.empty()) read_target(target, static_cast<std::int32_t>(*frame));
    }
    read_ball(line.substr(end + 1), static_cast<std::int32_t>(*frame));
  }

  /// x,y,z,speed,team,state. A ball dead on the centre spot is one whose position is unknown.
  void read_ball(std::string_view text, std::int32_t frame) {
    split_fields(text.substr(0, text.find_first_of(";:")), ',', fields_);
    if (fields_.size() < 6) return;
    const auto x = number_of(fields_[0]), y = number_of(fields_[1]), z = number_of(fields_[2]);
    if (!x || !y || !z || !(std::abs(*x) < 1e6 && std::abs(*y) < 1e6 && std::abs(*z) < 1e6)) return;
    if (*x == 0 && *y == 0 && *z == 0 && fields_[5] == "Dead") return;
    GroundBuilder::Row row{.frame = frame, .time = frame / match_.recording.header.rate_hz};
    row.location = {*x / kMetre + match_.pitch.length / 2, *y / kMetre + match_.pitch.width / 2};
    row.height = *z / kMetre;
    builder_.add(builder_.ball(), row);
  }

  void read_target(std::string_view target, std::int32_t frame) {
    split_fields(target, ',', fields_);
    std::array<double, 5> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto value = i < fields_.size() ? number_of(fields_[i]) : std::nullopt;
      if (!value || std::abs(*value) > 1e9)
        throw Error("{}: {} is not a target; it must read team,target,shirt,x,y,speed", where_, shown(target));
      values[i] = *value;
    }
    const int team = static_cast<int>(values[0]), id = static_cast<int>(values[1]), number = static_cast<int>(values[2]);
    if (team == 4) return;
    const bool plays = team == 0 || team == 1;
    const std::string key = fmt::format("{} {} {}", team, plays ? number : -1, plays ? -1 : id);
    const auto named = names_.find({team, number});
    const std::string label = plays ? label_of(named == names_.end() ? std::string() : named->second, number) : std::string();
    const std::string owner = team == 1 ? match_.home : team == 0 ? match_.away : team == 3 ? "referee" : "";
    builder_.add(frame, frame / match_.recording.header.rate_hz, builder_.person(key, id, label, owner),
                 values[3] / kMetre + match_.pitch.length / 2, values[4] / kMetre + match_.pitch.width / 2, where_);
  }

  const std::string& name_;
  const std::string& metadata_name_;
  GroundBuilder builder_;
  GroundMatch match_;
  std::string where_;
  std::map<std::pair<int, int>, std::string> names_;  // by team and shirt
  std::vector<std::string_view> targets_, fields_;
};

void add_team(pugi::xml_node& root, const char* element, int id, const LineUps& line_ups, Side side, const Recording& recording,
              const std::vector<GroundPeriod>& periods) {
  pugi::xml_node team = root.append_child(element);
  const std::string& name = line_ups.teams[side == Side::home ? 0 : 1];
  // Readers take a bare number for a number, and fail.
  const std::string shown_name = number_of(name) ? "Team " + name : name;
  add_text(team, "LongName", shown_name);
  add_text(team, "ShortName", shown_name);
  add_text(team, "TeamId", std::to_string(id));
  pugi::xml_node players = team.append_child("Players");
  for (const std::size_t person : line_ups.of(side)) {
    const LineUps::Member& member = line_ups.members[person];
    pugi::xml_node player = players.append_child("Player");
    const std::size_t space = member.name.rfind(' ');
    const bool two =
        space != std::string::npos && !number_of(member.name.substr(space + 1)) && !number_of(member.name.substr(0, space));
    add_text(player, "PlayerId", std::to_string(number(recording.tracks()[person].id())));
    add_text(player, "FirstName", two ? member.name.substr(0, space) : "");
    add_text(player, "LastName", two ? member.name.substr(space + 1) : member.name);
    add_text(player, "JerseyNo", std::to_string(member.number));
    add_text(player, "StartFrameCount", std::to_string(periods.front().first_frame));
    add_text(player, "EndFrameCount", std::to_string(periods.back().last_frame));
  }
}

void write_metadata(const GroundMatch& match, const LineUps& line_ups, const std::string& path) {
  const std::vector<GroundPeriod> periods = periods_of(match);
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("TracabMetaData");
  root.append_attribute("sVersion") = "1.0";
  pugi::xml_node head = root.append_child("match");
  head.append_attribute("iId") = "1";
  head.append_attribute("dtDate") = "1970-01-01 00:00:00";
  head.append_attribute("iFrameRateFps") = whole_rate(match.recording.header.rate_hz, "TRACAB");
  head.append_attribute("fPitchXSizeMeters") = fmt::format("{:.2f}", match.pitch.length).c_str();
  head.append_attribute("fPitchYSizeMeters") = fmt::format("{:.2f}", match.pitch.width).c_str();
  head.append_attribute("fTrackingAreaXSizeMeters") = "unknown";
  head.append_attribute("fTrackingAreaYSizeMeters") = "unknown";
  for (int number = 1; number <= 5; ++number) {
    pugi::xml_node node = head.append_child("period");
    const auto period = std::find_if(periods.begin(), periods.end(), [&](const GroundPeriod& one) { return one.number == number; });
    node.append_attribute("iId") = number;
    node.append_attribute("iStartFrame") = period == periods.end() ? 0 : period->first_frame;
    node.append_attribute("iEndFrame") = period == periods.end() ? 0 : period->last_frame;
  }
  // Readers take teams without players for broken.
  if (!line_ups.of(Side::home).empty() && !line_ups.of(Side::away).empty()) {
    add_team(root, "HomeTeam", 1, line_ups, Side::home, match.recording, periods);
    add_team(root, "AwayTeam", 2, line_ups, Side::away, match.recording, periods);
  }
  WholeFile file(path);
  file.write(to_text(document));
  file.finish();
}

constexpr int code_of(Side side) {
  return side == Side::home ? 1 : side == Side::away ? 0 : side == Side::referee ? 3 : -1;
}

}  // namespace

GroundMatch parse_tracab(std::string_view text, const std::string& name, std::string_view metadata,
                         const std::string& metadata_name) {
  return TracabReader(name, metadata_name).read(text, metadata);
}

namespace {

bool is_tracab_metadata(std::string_view text) {
  const auto has = [&](std::string_view part) { return text.find(part) != std::string_view::npos; };
  return has("<TracabMetaData") || (has("<GameID") && has("<Phase1StartFrame"));
}

/// Lines begin with a frame and a colon; targets have six numbers, the first of which is a team.
bool is_tracab(const Beginning& file) {
  if (file.has("<")) return is_tracab_metadata(file.bytes);
  const std::string_view line = file.first_line();
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !whole_number_of(line.substr(0, colon))) return false;
  const std::string_view rest = line.substr(colon + 1);
  std::vector<std::string_view> target;
  split_fields(rest.substr(0, rest.find_first_of(";:")), ',', target);
  if (target.size() != 6 || !all_numbers(target) || rest.find(';') == std::string_view::npos) return false;
  const auto team = whole_number_of(target[0]);
  return team && *team >= -1 && *team <= 4;
}

const TwoFiles& tracab_files() {
  static const TwoFiles files{parse_tracab, is_tracab, is_tracab_metadata, {".dat", ".txt"}};
  return files;
}

/// The ball's part of a line: x,y,z,speed,team,state. `owner` is who had it, and has it now.
std::string ball_text(const std::optional<BallAt>& ball, const GroundMatch& match, char owner) {
  if (!ball) return fmt::format("0,0,0,0.00,{},Dead", owner);
  const Vector<3>& at = ball->location;
  const bool in_play = at.x() >= 0 && at.y() >= 0 && at.x() <= match.pitch.length && at.y() <= match.pitch.width;
  return fmt::format("{},{},{},{:.2f},{},{}", std::lround(kMetre * (at.x() - match.pitch.length / 2)),
                     std::lround(kMetre * (at.y() - match.pitch.width / 2)), std::lround(kMetre * at.z()),
                     ball->velocity ? ball->velocity->norm() : 0, owner, in_play ? "Alive" : "Dead");
}

std::vector<std::string> write_tracab(const GroundMatch& match, const std::string& path) {
  if (match.recording.samples() == 0) throw Error("no person is in the recording, and TRACAB's readers take that for broken");
  const LineUps line_ups = line_ups_of(match);
  WholeFile file(path);
  std::string text;
  InstantRows rows(match.recording);
  const std::vector<std::optional<BallAt>> balls = ball_by_instant(match, line_ups);
  constexpr double kReach = 2;  // m
  char owner = 'H';
  for (std::size_t instant = 0; instant < match.recording.instants().size(); ++instant) {
    fmt::format_to(std::back_inserter(text), "{}:", match.recording.instants()[instant].index);
    double nearest = kReach;
    for (const auto& [index, row] : rows.at(instant)) {
      const TrackColumns& track = match.recording.tracks()[index];
      const LineUps::Member& member = line_ups.members[index];
      if (member.side == Side::ball) continue;
      const double away = balls[instant] ? (track.location(row) - balls[instant]->location.head<2>()).norm() : kReach;
      if (away < nearest && (member.side == Side::home || member.side == Side::away)) {
        nearest = away;
        owner = member.side == Side::home ? 'H' : 'A';
      }
      const auto velocity = track.velocity(row);
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{:.2f};", code_of(member.side), number(track.id()),
                     member.side == Side::other ? -1 : member.number,
                     std::lround(kMetre * (track.x()[row] - match.pitch.length / 2)),
                     std::lround(kMetre * (track.y()[row] - match.pitch.width / 2)), velocity ? velocity->head<2>().norm() : 0);
    }
    fmt::format_to(std::back_inserter(text), ":{};:\n", ball_text(balls[instant], match, owner));
    if (text.size() < (std::size_t{1} << 20)) continue;
    file.write(text);
    text.clear();
  }
  file.write(text);
  write_metadata(match, line_ups, with_ending(path, ".xml"));
  file.finish();
  return line_ups.warnings;
}

}  // namespace

Format tracab_format() {
  return {.name = "tracab",
          .title = "a TRACAB file",
          .endings = ".dat",
          .holds = Content::ground,
          .detail =
              "with `.xml` beside it; centre spot, y up, whole cm; halves, shirts, teams, referees, people of no known team, "
              "speed. Whole numbers of frames a second",
          .is = match::is_tracab,
          .read = [](const std::string& path,
                     const ReadOptions& options) { return match::read_two_files(path, match::tracab_files(), options); },
          .write = match::write_tracab,
          .from_corner = true,
          .companions = {{".dat", ".xml"}}};
}

}  // namespace marey::format::match
