#include "marey/format/match/squads.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/csv_table.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

constexpr std::size_t kMaxName = 200;  // bytes
constexpr std::size_t kMaxMembers = 256;

std::string folded(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// A name as tracks may have it: edits know no quotation marks within one.
std::string name_from(const std::string& field, const std::string& where) {
  std::string name = plain_text(field);
  std::replace(name.begin(), name.end(), '"', '\'');
  if (name.size() > kMaxName) throw Error("{}: a name has {} bytes; at most {} are read", where, name.size(), kMaxName);
  return name;
}

SquadRole role_from(const std::string& text, const std::string& where) {
  const std::string role = folded(text);
  if (role.empty() || role == "player") return SquadRole::player;
  if (role == "keeper" || role == "goalkeeper") return SquadRole::keeper;
  if (role == "referee") return SquadRole::referee;
  throw Error("{}: {} is not a role; player, keeper and referee are", where, shown(text));
}

std::optional<double> minute_from(const std::string& text, const std::string& where) {
  if (text.empty()) return std::nullopt;
  const auto minute = number_of(text);
  if (!minute || *minute < 0) throw Error("{}: {} is not a minute", where, shown(text));
  return 60 * *minute;
}

SquadMember member_from(const CsvTable::Row& row) {
  SquadMember member;
  member.number = name_from(row.text("number"), row.where());
  member.name = name_from(row.text("name"), row.where());
  member.team = name_from(row.text("team"), row.where());
  member.role = role_from(row.text("role"), row.where());
  member.in_s = minute_from(row.text("in"), row.where());
  member.out_s = minute_from(row.text("out"), row.where());
  if (member.number.empty() && member.name.empty()) throw Error("{}: has neither a number nor a name", row.where());
  if (!member.number.empty() && !whole_number_of(member.number))
    throw Error("{}: {} is no number of a shirt", row.where(), shown(member.number));
  if (member.in_s && member.out_s && *member.out_s <= *member.in_s)
    throw Error("{}: {} goes out before coming in", row.where(), member.label());
  if (member.team.empty() && member.role == SquadRole::referee) member.team = "Referees";
  return member;
}

void require_apart(const SquadMember& one, const SquadMember& other, const std::string& where) {
  if (one.team == other.team && !one.number.empty() && one.number == other.number)
    throw Error("{}: number {} is there twice in the team {}: {} and {}", where, one.number, shown(one.team), one.label(),
                other.label());
  if (one.label() == other.label())
    throw Error("{}: two are called {}, and could not be distinguished; write one's name otherwise", where, one.label());
}

}  // namespace

std::string SquadMember::label() const {
  if (number.empty()) return name;
  return name.empty() ? fmt::format("{} {}", number, team) : fmt::format("{} {}", number, name);
}

std::vector<SquadMember> parse_squads(std::string_view text, const std::string& name) {
  const CsvTable table(text, name, {"number", "name", "team"}, {"role", "in", "out"});
  std::vector<SquadMember> squads;
  for (const CsvTable::Row& row : table.rows()) {
    const SquadMember member = member_from(row);
    for (const SquadMember& other : squads) require_apart(other, member, row.where());
    squads.push_back(member);
    if (squads.size() > kMaxMembers) throw Error("{}: more than {} people", row.where(), kMaxMembers);
  }
  if (squads.empty()) throw Error("{}: names no person", name);
  return squads;
}

std::vector<SquadMember> read_squads(const std::string& path) {
  return parse_squads(read_file(path), path);
}

int member_called(const std::string& called, const std::string& team, const std::vector<SquadMember>& squads,
                  const std::string& where) {
  const std::string sought = folded(name_from(called, where));
  std::vector<std::size_t> found, partial;
  for (std::size_t i = 0; i < squads.size(); ++i) {
    const SquadMember& one = squads[i];
    if (!team.empty() && folded(one.team) != folded(team)) continue;
    const std::array<std::string, 3> exactly{one.label(), one.number + " " + one.team, one.team + " " + one.number};
    if (std::any_of(exactly.begin(), exactly.end(), [&](const std::string& text) { return folded(text) == sought; }))
      found.push_back(i);
    if (sought == folded(one.name) || sought == one.number) partial.push_back(i);
  }
  if (found.empty()) found = partial;
  if (found.empty())
    throw Error("{}: no person in the roster is called {}{}", where, shown(called),
                team.empty() ? "" : " in the team " + shown(team));
  if (found.size() == 1) return static_cast<int>(found.front());
  std::vector<std::string> labels;
  for (const std::size_t i : found) labels.push_back(fmt::format("{} ({})", squads[i].label(), squads[i].team));
  throw Error("{}: {} may be {}; say number and name, or number and team", where, shown(called), fmt::join(labels, " or "));
}

std::vector<SquadNaming> parse_namings(std::string_view text, const std::string& name, const std::vector<SquadMember>& squads) {
  const CsvTable table(text, name, {"time", "id", "name"}, {"team"});
  std::vector<SquadNaming> namings;
  for (const CsvTable::Row& row : table.rows()) {
    SquadNaming naming{.where = row.where()};
    const auto time = seconds_of_clock(row.text("time"));
    if (!time) throw Error("{}: {} is not a time; write 63.2, 1:03.2 or 0:01:03.2", row.where(), shown(row.text("time")));
    std::string id = row.text("id");
    if (id.starts_with('#')) id.erase(0, 1);
    const auto track = whole_number_of(id);
    if (!track || *track < 1 || *track > 1'000'000'000)
      throw Error("{}: {} is no number of a track", row.where(), shown(row.text("id")));
    naming.time_s = *time;
    naming.track = static_cast<int>(*track);
    naming.member = member_called(row.text("name"), row.text("team"), squads, row.where());
    namings.push_back(naming);
  }
  if (namings.empty()) throw Error("{}: names no person", name);
  std::stable_sort(namings.begin(), namings.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return namings;
}

std::vector<SquadNaming> read_namings(const std::string& path, const std::vector<SquadMember>& squads) {
  return parse_namings(read_file(path), path, squads);
}

std::optional<double> seconds_of_clock(std::string_view text) {
  double seconds = 0;
  for (int part = 0; part < 3; ++part) {
    const std::size_t colon = text.find(':');
    const auto value = number_of(text.substr(0, colon));
    const bool last = colon == std::string_view::npos;
    if (!value || *value < 0 || (part > 0 && *value >= 60) || (!last && *value != std::floor(*value))) return std::nullopt;
    seconds = 60 * seconds + *value;
    if (last) return seconds;
    text.remove_prefix(colon + 1);
  }
  return std::nullopt;
}

std::string clock_of_seconds(double seconds) {
  const auto tenths = static_cast<std::int64_t>(std::llround(10 * seconds));
  const std::int64_t minutes = tenths / 600;
  const std::string rest = fmt::format("{:02}.{}", tenths / 10 % 60, tenths % 10);
  return minutes < 60 ? fmt::format("{}:{}", minutes, rest) : fmt::format("{}:{:02}:{}", minutes / 60, minutes % 60, rest);
}

}  // namespace marey::format::match
