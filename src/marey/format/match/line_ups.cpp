#include "marey/format/match/line_ups.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

bool is_referee(const GroundRecording::Person& person) {
  for (std::string text : {person.team, person.label}) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (text.find("referee") != std::string::npos || text == "ref" || text == "officials") return true;
  }
  return false;
}

/// Teams by how often their people are seen; then by their first person.
std::vector<std::string> teams_by_size(const GroundRecording& recording) {
  std::vector<std::int64_t> seen(recording.people.size(), 0);
  for (const auto& sample : recording.samples) ++seen[static_cast<std::size_t>(sample.person)];
  std::vector<std::string> names;
  std::map<std::string, std::int64_t> sizes;
  for (std::size_t i = 0; i < recording.people.size(); ++i) {
    const GroundRecording::Person& person = recording.people[i];
    if (person.team.empty() || is_referee(person)) continue;
    if (!sizes.contains(person.team)) names.push_back(person.team);
    sizes[person.team] += seen[i];
  }
  std::stable_sort(names.begin(), names.end(), [&](const auto& a, const auto& b) { return sizes[a] > sizes[b]; });
  return names;
}

std::array<std::string, 2> two_teams(const GroundMatch& match, LineUps& squads) {
  std::vector<std::string> teams = teams_by_size(match.recording);
  for (const std::string& name : {match.home, match.away}) {
    if (name.empty() || match.recording.people.empty() || std::find(teams.begin(), teams.end(), name) != teams.end()) continue;
    throw Error("nobody is of the team \"{}\"; there {}", name,
                teams.empty() ? std::string("are no teams") : fmt::format("are: {}", fmt::join(teams, ", ")));
  }
  if (teams.size() > 2) {
    squads.warnings.push_back(
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
    const auto& people = match.recording.people;
    return std::find_if(people.begin(), people.end(), [&](const auto& one) { return one.team == team; });
  };
  if (match.home.empty() && match.away.empty() && !pair[1].empty() && first_of(pair[1]) < first_of(pair[0]))
    std::swap(pair[0], pair[1]);
  return pair;
}

/// The label where it is a shirt's number and still free, else the id, else the next free one.
int number_for(const GroundRecording::Person& person, std::set<int>& taken) {
  const auto label = whole_number_of(person.label);
  int number = label && *label >= 0 && *label <= 999 ? static_cast<int>(*label) : person.id;
  while (!taken.insert(number).second) ++number;
  return number;
}

}  // namespace

std::vector<std::int32_t> LineUps::of(Side side) const {
  std::vector<std::int32_t> people;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i].side == side) people.push_back(static_cast<std::int32_t>(i));
  }
  return people;
}

LineUps line_ups_of(const GroundMatch& match) {
  LineUps squads;
  const std::array<std::string, 2> pair = two_teams(match, squads);
  const bool no_teams = pair[0].empty() && pair[1].empty();
  if (no_teams && !match.recording.people.empty())
    squads.warnings.push_back("nobody has a team; all were written as the home team's");
  std::map<Side, std::set<int>> taken;
  for (const GroundRecording::Person& person : match.recording.people) {
    LineUps::Member& member = squads.members.emplace_back();
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
  squads.teams = {pair[0].empty() ? "Home" : pair[0], pair[1].empty() ? "Away" : pair[1]};
  return squads;
}

std::vector<GroundPeriod> periods_of(const GroundMatch& match) {
  if (!match.periods.empty() || match.recording.samples.empty()) return match.periods;
  return {{1, match.recording.samples.front().frame, match.recording.samples.back().frame}};
}

bool has_velocities(const GroundRecording& recording) {
  return std::any_of(recording.samples.begin(), recording.samples.end(),
                     [](const auto& sample) { return sample.velocity != Vector<2>::Zero(); });
}

int whole_rate(double rate_hz, std::string_view format) {
  const double whole = std::round(rate_hz);
  if (!(whole >= 1) || std::abs(rate_hz - whole) > 0.005 * whole)
    throw Error("{} holds whole numbers of frames a second only, and the recording has {:.3f}; write ground or mot", format,
                rate_hz);
  return static_cast<int>(whole);
}

std::string with_ending(const std::string& path, std::string_view ending) {
  return std::filesystem::path(path).replace_extension(ending).string();
}

}  // namespace marey::format::match
