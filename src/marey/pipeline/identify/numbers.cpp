#include "marey/pipeline/identify/numbers.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/csv_table.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::pipeline::identify {
namespace {

constexpr std::int64_t kMaxTrack = 1'000'000'000;  // by definition: as in lists of names
constexpr std::size_t kMaxShirt = 2;               // by definition: digits on a shirt

double field(const format::CsvTable::Row& row, const char* column, double most) {
  const auto value = format::number_of(row.text(column));
  if (!value || !(*value >= 0) || *value > most)
    throw Error("{}: {} is not a {} as marey track --numbers writes it", row.where(), format::shown(row.text(column)), column);
  return *value;
}

ReadNumber number_from(const format::CsvTable::Row& row) {
  ReadNumber read;
  read.where = row.where();
  const auto track = format::whole_number_of(row.text("id"));
  if (!track || *track < 1 || *track > kMaxTrack)
    throw Error("{}: {} is not a number of a track", row.where(), format::shown(row.text("id")));
  const auto shirt = format::whole_number_of(row.text("number"));
  if (!shirt || *shirt < 0 || row.text("number").size() > kMaxShirt)
    throw Error("{}: {} is not a shirt number of one or two digits", row.where(), format::shown(row.text("number")));
  read.track = static_cast<int>(*track);
  read.number = fmt::format("{}", *shirt);
  read.probability = field(row, "probability", 1);
  read.time_s = field(row, "time", 1e9);
  return read;
}

std::string shirt_of(const ReadNumber& read) {
  return fmt::format("#{} has number {} with {:.3f}", read.track, read.number, read.probability);
}

/// The one member who is meant, else nothing and why.
std::optional<int> member_of(const ReadNumber& read, const std::string& team, const std::vector<SquadMember>& squads,
                             std::vector<std::string>& messages) {
  std::vector<int> found;
  const bool known = std::any_of(squads.begin(), squads.end(), [&](const SquadMember& one) { return one.team == team; });
  for (std::size_t i = 0; i < squads.size(); ++i) {
    if (squads[i].number == read.number && (!known || squads[i].team == team)) found.push_back(static_cast<int>(i));
  }
  if (found.size() == 1) {
    const SquadMember& member = squads[static_cast<std::size_t>(found.front())];
    const bool is_on = (!member.in_s || read.time_s >= *member.in_s) && (!member.out_s || read.time_s <= *member.out_s);
    if (is_on) return found.front();
    messages.push_back(fmt::format("{}, which {} has, who is not on the pitch then", shirt_of(read), member.label()));
    return std::nullopt;
  }
  messages.push_back(found.empty()
                         ? fmt::format("{}, which no person in the squads{} has", shirt_of(read), known ? " of " + team : "")
                         : fmt::format("{}, which {} and {} have; the take has no team of that person", shirt_of(read),
                                       squads[static_cast<std::size_t>(found[0])].label(),
                                       squads[static_cast<std::size_t>(found[1])].label()));
  return std::nullopt;
}

bool are_together(const TrackColumns& one, const TrackColumns& other) {
  return !one.empty() && !other.empty() && one.at().front() <= other.at().back() && other.at().front() <= one.at().back();
}

/// Members that two tracks would be at the same time.
std::set<int> twice(const std::vector<SquadNaming>& namings, const Recording& recording) {
  std::set<int> members;
  for (std::size_t i = 0; i < namings.size(); ++i) {
    for (std::size_t j = i + 1; j < namings.size(); ++j) {
      if (namings[i].member == namings[j].member &&
          are_together(*recording.find(TrackId{namings[i].track}), *recording.find(TrackId{namings[j].track})))
        members.insert(namings[i].member);
    }
  }
  return members;
}

}  // namespace

std::vector<ReadNumber> parse_numbers(std::string_view text, const std::string& name) {
  const format::CsvTable table(text, name, {"id", "number", "probability", "time"}, {"readings"});
  std::vector<ReadNumber> numbers;
  for (const format::CsvTable::Row& row : table.rows()) {
    ReadNumber read = number_from(row);
    if (std::any_of(numbers.begin(), numbers.end(), [&](const ReadNumber& one) { return one.track == read.track; }))
      throw Error("{}: #{} has a number already; a track has one row", row.where(), read.track);
    numbers.push_back(std::move(read));
  }
  return numbers;
}

std::vector<ReadNumber> read_numbers(const std::string& path) {
  return parse_numbers(format::read_file(path), path);
}

NumberNamings namings_by_numbers(const std::vector<ReadNumber>& numbers, double min_probability,
                                 const std::vector<SquadMember>& squads, const std::vector<SquadNaming>& given,
                                 const Recording& recording) {
  NumberNamings found;
  for (const ReadNumber& read : numbers) {
    const TrackColumns* track = recording.find(TrackId{read.track});
    if (track == nullptr)
      throw Error("{}: #{} is not a track of the take; read the numbers in the same run", read.where, read.track);
    if (read.probability < min_probability) continue;
    const auto member = member_of(read, track->name.team, squads, found.messages);
    if (!member) continue;
    const bool by_hand = std::any_of(given.begin(), given.end(), [&](const SquadNaming& naming) {
      return naming.track == read.track || naming.member == *member;
    });
    if (!by_hand) found.namings.push_back({read.time_s, read.track, *member, read.where});
  }
  const std::set<int> together = twice(found.namings, recording);
  std::erase_if(found.namings, [&](const SquadNaming& naming) {
    if (!together.contains(naming.member)) return false;
    const SquadMember& member = squads[static_cast<std::size_t>(naming.member)];
    found.messages.push_back(fmt::format("#{} has the number of {}, and so has another person at the same time: neither is named",
                                         naming.track, member.label()));
    return true;
  });
  std::stable_sort(found.namings.begin(), found.namings.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return found;
}

}  // namespace marey::pipeline::identify
