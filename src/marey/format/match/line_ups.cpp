#include "marey/format/match/line_ups.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

bool is_referee(const TrackName& person) {
  for (std::string text : {person.team, person.label}) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (text.find("referee") != std::string::npos || text == "ref" || text == "officials") return true;
  }
  return false;
}

/// Teams by how often their people are seen; then by their first person.
std::vector<std::string> teams_by_size(const GroundMatch& match, const std::vector<std::size_t>& listed) {
  std::vector<std::string> names;
  std::map<std::string, std::size_t> sizes;
  for (const std::size_t i : listed) {
    const TrackColumns& track = match.recording.tracks()[i];
    const std::string& team = track.name.team;
    if (team.empty() || is_referee(track.name)) continue;
    if (!sizes.contains(team)) names.push_back(team);
    sizes[team] += track.size();
  }
  std::stable_sort(names.begin(), names.end(), [&](const auto& a, const auto& b) { return sizes[a] > sizes[b]; });
  return names;
}

std::array<std::string, 2> two_teams(const GroundMatch& match, LineUps& line_ups) {
  const auto& tracks = match.recording.tracks();
  std::vector<std::string> teams = teams_by_size(match, line_ups.listed);
  for (const std::string& name : {match.home, match.away}) {
    if (name.empty() || tracks.empty() || std::find(teams.begin(), teams.end(), name) != teams.end()) continue;
    throw Error("no person is of the team \"{}\"; there {}", name,
                teams.empty() ? std::string("are not teams") : fmt::format("are: {}", fmt::join(teams, ", ")));
  }
  if (teams.size() > 2) {
    line_ups.warnings.push_back(
        fmt::format("the format knows two teams, the recording {}: {}; --home and --away choose others than the "
                    "largest",
                    teams.size(), fmt::join(teams, ", ")));
  }
  std::erase(teams, match.home);
  std::erase(teams, match.away);
  const auto next = [&] {
    if (teams.empty()) return std::string();
    const std::string first = teams.front();
    teams.erase(teams.begin());
    return first;
  };
  std::array<std::string, 2> pair{match.home, match.away};
  for (std::string& name : pair) {
    if (name.empty()) name = next();
  }
  // Of two that were found, the one whose people come first is at home.
  const auto first_of = [&](const std::string& team) {
    return std::find_if(line_ups.listed.begin(), line_ups.listed.end(), [&](std::size_t i) { return tracks[i].name.team == team; });
  };
  if (match.home.empty() && match.away.empty() && !pair[1].empty() && first_of(pair[1]) < first_of(pair[0]))
    std::swap(pair[0], pair[1]);
  return pair;
}

/// The shirt's number that a label is, "7", or begins with, "7 Kane".
std::optional<std::int64_t> shirt_number_in(const std::string& label) {
  return whole_number_of(std::string_view(label).substr(0, label.find(' ')));
}

/// The label's number where it has one that is still free, else the id, else the next free one.
int number_for(const TrackName& person, std::set<int>& taken) {
  const auto label = shirt_number_in(person.label);
  int number = label && *label >= 0 && *label <= 999 ? static_cast<int>(*label) : marey::number(person.id);
  while (!taken.insert(number).second) ++number;
  return number;
}

}  // namespace

std::vector<std::size_t> LineUps::of(Side side) const {
  std::vector<std::size_t> tracks;
  std::copy_if(listed.begin(), listed.end(), std::back_inserter(tracks), [&](std::size_t i) { return members[i].side == side; });
  return tracks;
}

std::vector<std::size_t> listed_tracks(const GroundMatch& match) {
  const std::vector<TrackColumns>& tracks = match.recording.tracks();
  std::map<TrackId, std::size_t> left;
  for (std::size_t i = 0; i < tracks.size(); ++i) left[tracks[i].id()] = i;
  std::vector<std::size_t> listed;
  for (const TrackId id : match.order) {
    if (const auto track = left.extract(id)) listed.push_back(track.mapped());
  }
  for (const auto& [id, track] : left) listed.push_back(track);
  return listed;
}

LineUps line_ups_of(const GroundMatch& match) {
  LineUps line_ups;
  line_ups.listed = listed_tracks(match);
  line_ups.members.resize(line_ups.listed.size());
  const std::array<std::string, 2> pair = two_teams(match, line_ups);
  const bool no_teams = pair[0].empty() && pair[1].empty();
  if (no_teams && !line_ups.listed.empty())
    line_ups.warnings.push_back("no person has a team; all were written as the home team's");
  std::map<Side, std::set<int>> taken;
  for (const std::size_t i : line_ups.listed) {
    const TrackName& person = match.recording.tracks()[i].name;
    LineUps::Member& member = line_ups.members[i];
    if (person.kind == TrackKind::ball) {
      member.side = Side::ball;
      line_ups.ball = i;
      continue;
    }
    if (is_referee(person)) {
      member.side = Side::referee;
    } else if (no_teams || (!person.team.empty() && person.team == pair[0])) {
      member.side = Side::home;
    } else if (!person.team.empty() && person.team == pair[1]) {
      member.side = Side::away;
    }
    member.number = number_for(person, taken[member.side]);
    member.name = person.label.empty() || number_of(person.label) ? fmt::format("Player No.{}", member.number) : person.label;
  }
  line_ups.teams = {pair[0].empty() ? "Home" : pair[0], pair[1].empty() ? "Away" : pair[1]};
  return line_ups;
}

std::vector<std::optional<BallAt>> ball_by_instant(const GroundMatch& match, const LineUps& line_ups) {
  std::vector<std::optional<BallAt>> locations(match.recording.instants().size());
  if (!line_ups.ball) return locations;
  const TrackColumns& ball = match.recording.tracks()[*line_ups.ball];
  for (std::size_t row = 0; row < ball.size(); ++row)
    locations[static_cast<std::size_t>(ball.at()[row])] = BallAt{ball.position(row), ball.velocity(row)};
  return locations;
}

std::vector<GroundPeriod> periods_of(const GroundMatch& match) {
  const auto& instants = match.recording.instants();
  if (!match.periods.empty() || instants.empty()) return match.periods;
  return {{1, static_cast<std::int32_t>(instants.front().index), static_cast<std::int32_t>(instants.back().index)}};
}

int whole_rate(double rate_hz, std::string_view format) {
  const double whole = std::round(rate_hz);
  constexpr double kMaxRate = 1000;
  if (!(whole >= 1 && whole <= kMaxRate) || std::abs(rate_hz - whole) > 0.005 * whole)
    throw Error("{} holds whole numbers of frames a second only, up to {:g}, and the recording has {:.3f}; write ground or mot",
                format, kMaxRate, rate_hz);
  return static_cast<int>(whole);
}

std::string with_ending(const std::string& path, std::string_view ending) {
  return std::filesystem::path(path).replace_extension(ending).string();
}

}  // namespace marey::format::match
