// FIFA's EPTS as Metrica writes it, see epts_reader.cpp. The ball has its channels, NaN where it is not known.
#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/epts.h"
#include "marey/format/match/epts_periods.h"
#include "marey/format/match/line_ups.h"
#include "marey/format/xml_text.h"

namespace marey::format::match {
namespace {

constexpr std::array<const char*, 2> kTeamIds = {"TEAM_A", "TEAM_B"};
constexpr double kPerHour = 3.6;  // km/h in a m/s

/// What the metadata and the text must agree on.
struct Plan {
  LineUps line_ups;
  std::vector<std::size_t> people;  // home, then away
  bool speed = false;
  std::vector<GroundPeriod> periods;
};

void add_parameter(pugi::xml_node& parent, const std::string& name, const std::string& value) {
  pugi::xml_node parameter = parent.append_child("ProviderParameter");
  add_text(parameter, "Name", name);
  add_text(parameter, "Value", value);
}

void add_globals(pugi::xml_node& metadata, const GroundMatch& match, const Plan& plan) {
  pugi::xml_node global = metadata.append_child("GlobalConfig");
  add_text(global, "TrackingType", "Optical");
  // Readers take the frame that they know for this provider's, and know no other.
  add_text(global, "ProviderName", "Metrica Sports");
  add_text(global, "FrameRate", fmt::format("{}", whole_rate(match.recording.header.rate_hz, "EPTS")));
  pugi::xml_node parameters = global.append_child("ProviderGlobalParameters");
  for (const GroundPeriod& period : plan.periods) {
    if (period.number < 1 || period.number > static_cast<int>(kEptsPeriodNames.size())) continue;
    const char* name = kEptsPeriodNames[static_cast<std::size_t>(period.number) - 1];
    add_parameter(parameters, fmt::format("{}_start", name), std::to_string(period.first_frame));
    add_parameter(parameters, fmt::format("{}_end", name), std::to_string(period.last_frame));
  }
}

void add_session(pugi::xml_node& metadata, const GroundMatch& match) {
  pugi::xml_node session = metadata.append_child("Sessions").append_child("Session");
  session.append_attribute("id") = "session1";
  add_text(session, "SessionType", "Match");
  pugi::xml_node score = session.append_child("MatchParameters").append_child("Score");
  score.append_attribute("idLocalTeam") = kTeamIds[0];
  score.append_attribute("idVisitingTeam") = kTeamIds[1];
  score.append_child("LocalTeamScore");
  score.append_child("VisitingTeamScore");
  pugi::xml_node size = session.append_child("FieldSize");
  add_text(size, "Width", fmt::format("{:g}", match.pitch.length));
  add_text(size, "Height", fmt::format("{:g}", match.pitch.width));
}

std::string player_id(const GroundMatch& match, std::size_t person) {
  return fmt::format("Track_{}", number(match.recording.tracks()[person].id()));
}

void add_people(pugi::xml_node& metadata, const GroundMatch& match, const Plan& plan) {
  pugi::xml_node teams = metadata.append_child("Teams");
  for (std::size_t i = 0; i < kTeamIds.size(); ++i) {
    pugi::xml_node team = teams.append_child("Team");
    team.append_attribute("id") = kTeamIds[i];
    add_text(team, "Name", plan.line_ups.teams[i]);
  }
  pugi::xml_node players = metadata.append_child("Players");
  for (const std::size_t person : plan.people) {
    const LineUps::Member& member = plan.line_ups.members[person];
    pugi::xml_node player = players.append_child("Player");
    player.append_attribute("id") = player_id(match, person).c_str();
    player.append_attribute("teamId") = kTeamIds[member.side == Side::home ? 0 : 1];
    add_text(player, "Name", member.name);
    add_text(player, "ShirtNumber", std::to_string(member.number));
  }
}

void add_sensor(pugi::xml_node& sensors, const char* id, const char* name,
                const std::vector<std::array<const char*, 3>>& channels) {
  pugi::xml_node sensor = sensors.append_child("Sensor");
  sensor.append_attribute("id") = id;
  add_text(sensor, "Name", name);
  pugi::xml_node all = sensor.append_child("Channels");
  for (const auto& [channel_id, channel_name, unit] : channels) {
    pugi::xml_node channel = all.append_child("Channel");
    channel.append_attribute("id") = channel_id;
    add_text(channel, "Name", channel_name);
    add_text(channel, "Unit", unit);
  }
}

std::vector<const char*> channels_of(const Plan& plan) {
  return plan.speed ? std::vector<const char*>{"x", "y", "s"} : std::vector<const char*>{"x", "y"};
}

void add_channels(pugi::xml_node& metadata, const GroundMatch& match, const Plan& plan) {
  pugi::xml_node device = metadata.append_child("Devices").append_child("Device");
  device.append_attribute("id") = "device1";
  add_text(device, "Name", "Device 1");
  pugi::xml_node sensors = device.append_child("Sensors");
  add_sensor(sensors, "position", "Position", {{"x", "position_x", "normalized"}, {"y", "position_y", "normalized"}});
  if (plan.speed) add_sensor(sensors, "speed", "Speed in kilometers per hour", {{"s", "speed_kph", "kph"}});
  pugi::xml_node channels = metadata.append_child("PlayerChannels");
  for (const std::size_t person : plan.people) {
    for (const char* channel : channels_of(plan)) {
      pugi::xml_node node = channels.append_child("PlayerChannel");
      node.append_attribute("channelId") = channel;
      node.append_attribute("id") = fmt::format("{}_{}", player_id(match, person), channel).c_str();
      node.append_attribute("playerId") = player_id(match, person).c_str();
    }
  }
}

pugi::xml_node add_split(pugi::xml_node& parent, const char* separator) {
  pugi::xml_node split = parent.append_child("SplitRegister");
  split.append_attribute("separator") = separator;
  return split;
}

void add_layout(pugi::xml_node& root, const GroundMatch& match, const Plan& plan) {
  pugi::xml_node layout = root.append_child("DataFormatSpecifications").append_child("DataFormatSpecification");
  layout.append_attribute("startFrame") = match.recording.instants().front().index;
  layout.append_attribute("endFrame") = match.recording.instants().back().index;
  layout.append_attribute("separator") = ":";
  layout.append_child("StringRegister").append_attribute("name") = "frameCount";
  pugi::xml_node players = add_split(layout, ";");
  for (const std::size_t person : plan.people) {
    pugi::xml_node player = add_split(players, ",");
    for (const char* channel : channels_of(plan))
      player.append_child("PlayerChannelRef").append_attribute("playerChannelId") =
          fmt::format("{}_{}", player_id(match, person), channel).c_str();
  }
  pugi::xml_node ball = add_split(layout, ",");
  for (const char* channel : {"x", "y"}) ball.append_child("BallChannelRef").append_attribute("channelId") = channel;
}

void write_metadata(const GroundMatch& match, const Plan& plan, const std::string& path) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "utf-8";
  pugi::xml_node root = document.append_child("main");
  root.append_attribute("xmlns:tns") = "FIFADataTransferFormatEPTSNamespace/FIFADataTransferFormatEPTS";
  pugi::xml_node metadata = root.append_child("Metadata");
  add_globals(metadata, match, plan);
  add_session(metadata, match);
  add_people(metadata, match, plan);
  add_channels(metadata, match, plan);
  add_layout(root, match, plan);
  WholeFile file(path);
  file.write(to_text(document));
  file.finish();
}

}  // namespace

std::vector<std::string> write_epts(const GroundMatch& match, const std::string& path) {
  if (match.recording.samples() == 0) throw Error("no person is in the recording, and EPTS's readers take that for broken");
  Plan plan{line_ups_of(match), {}, has_velocities(match.recording), periods_of(match)};
  plan.people = plan.line_ups.of(Side::home);
  const std::vector<std::size_t> guests = plan.line_ups.of(Side::away);
  plan.people.insert(plan.people.end(), guests.begin(), guests.end());
  WholeFile file(with_ending(path, ".txt"));
  std::string text;
  const std::vector<TrackColumns>& tracks = match.recording.tracks();
  std::vector<std::optional<std::size_t>> row_of(tracks.size());
  InstantRows rows(match.recording);
  const std::vector<std::optional<BallAt>> balls = ball_by_instant(match, plan.line_ups);
  for (std::size_t instant = 0; instant < match.recording.instants().size(); ++instant) {
    std::fill(row_of.begin(), row_of.end(), std::nullopt);
    for (const auto& [index, row] : rows.at(instant)) row_of[index] = row;
    fmt::format_to(std::back_inserter(text), "{}:", match.recording.instants()[instant].index);
    for (std::size_t i = 0; i < plan.people.size(); ++i) {
      const TrackColumns& track = tracks[plan.people[i]];
      const auto row = row_of[plan.people[i]];
      if (i > 0) text += ';';
      if (!row) {
        text += plan.speed ? "NaN,NaN,NaN" : "NaN,NaN";
        continue;
      }
      fmt::format_to(std::back_inserter(text), "{:.5f},{:.5f}", track.x()[*row] / match.pitch.length,
                     1 - track.y()[*row] / match.pitch.width);
      const auto velocity = track.velocity(*row);
      if (plan.speed) fmt::format_to(std::back_inserter(text), ",{:.3f}", velocity ? kPerHour * velocity->head<2>().norm() : 0);
    }
    if (balls[instant])
      fmt::format_to(std::back_inserter(text), ":{:.5f},{:.5f}\n", balls[instant]->location.x() / match.pitch.length,
                     1 - balls[instant]->location.y() / match.pitch.width);
    else
      text += ":NaN,NaN\n";
    if (text.size() < (std::size_t{1} << 20)) continue;
    file.write(text);
    text.clear();
  }
  file.write(text);
  write_metadata(match, plan, with_ending(path, ".xml"));
  file.finish();
  const auto excluded = tracks.size() - plan.people.size() - (plan.line_ups.ball ? 1 : 0);
  if (excluded > 0)
    plan.line_ups.warnings.push_back(
        fmt::format("{} people of neither team were omitted: EPTS is written for two teams", excluded));
  return plan.line_ups.warnings;
}

}  // namespace marey::format::match
