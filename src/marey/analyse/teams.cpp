#include "marey/analyse/teams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "marey/analyse/colour_mixture.h"
#include "marey/analyse/colour_names.h"
#include "marey/core/error.h"

namespace marey::analyse {
namespace {

constexpr double min_team = 0.12;         // share of all people's time that a team's people have at least
constexpr double keepers_length = 22;     // m from the goal line: where a keeper is nearly always
constexpr double keepers_width = 20;      // m to either side of the middle
constexpr double keepers_time = 0.85;     // nearly always
constexpr std::size_t last_players = 3;   // of a team, that show which goal is its own
constexpr double officials = 0.2;         // share that referees have at most
constexpr double another_colour = 14;     // L*a*b*: by how much an official's colour differs from each team's
constexpr float max_channel_layout = 35;  // chroma
constexpr double longest_step = 0.5;      // s from one row of a person to the next that counts as seen
constexpr double colours_differ = 25;     // L*a*b*: how far a team's colour may lie from the one that is named

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

/// Where and for how long a person was seen.
struct Presence {
  double seconds = 0;
  double near_goal[2] = {0, 0};  // s before the goal at x = 0 and before the other
};

Presence presence_of(const Recording& recording, const TrackColumns& track, const std::optional<geometry::PitchSize>& pitch) {
  Presence presence;
  double last = -1e9;
  for (std::size_t row = 0; row < track.size(); ++row) {
    if (!track.measured(row)) continue;
    const double time = recording.seconds_at(static_cast<std::size_t>(track.at()[row]));
    const double step = std::min(longest_step, time - last);
    last = time;
    if (step >= longest_step) continue;
    presence.seconds += step;
    if (!pitch || std::abs(track.y()[row] - pitch->width / 2) > keepers_width) continue;
    if (track.x()[row] < keepers_length) presence.near_goal[0] += step;
    if (track.x()[row] > pitch->length - keepers_length) presence.near_goal[1] += step;
  }
  return presence;
}

std::vector<Presence> presences(const Recording& recording, const std::optional<geometry::PitchSize>& pitch) {
  std::vector<Presence> all;
  for (const TrackColumns& track : recording.tracks()) all.push_back(presence_of(recording, track, pitch));
  return all;
}

/// The kinds that are teams, in the order in which they are reported.
std::vector<std::size_t> choose_teams(const ColourMixture& mixture, const std::vector<TeamName>& names) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < mixture.kinds.size(); ++k) {
    if (mixture.kinds[k].fraction >= min_team) chosen.push_back(k);
  }
  if (names.empty()) {
    if (chosen.size() > 2) chosen.resize(2);
    return chosen;
  }
  // Large kinds of about the colours named, each named team another kind, or none.
  std::vector<std::size_t> best;
  double best_worth = 0;
  const auto merit = [&](std::size_t kind, const TeamName& name) {
    const double apart = colours_apart(mixture.kinds[kind].colour, name.colour) / colours_differ;
    return std::log(mixture.kinds[kind].fraction / min_team) + 4 - apart * apart / 2;
  };
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> kinds = chosen;
  kinds.push_back(none);
  for (const std::size_t a : kinds) {
    for (const std::size_t b : kinds) {
      if (a == b && a != none) continue;
      const double sum = (a == none ? 0 : merit(a, names[0])) + (b == none ? 0 : merit(b, names[1]));
      if (sum <= best_worth) continue;
      best_worth = sum;
      best = {a, b};
    }
  }
  return best;
}

/// What cameras and light make of grey: the colour of the kind of people that has least, if that is little enough to be it.
Appearance layout_of(const ColourMixture& mixture) {
  Appearance tint{.lightness = 0};
  float minimum = max_channel_layout;
  for (const ColourMixture::Kind& kind : mixture.kinds) {
    const float chroma = std::hypot(kind.colour.a, kind.colour.b);
    if (chroma >= minimum) continue;
    minimum = chroma;
    tint.a = kind.colour.a;
    tint.b = kind.colour.b;
  }
  return tint;
}

/// Names for teams that the user has not named: by colour, distinguished by lightness where they have the same.
void name_by_colour(std::vector<Teams::Team>& teams, const Appearance& tint) {
  for (Teams::Team& team : teams) {
    Appearance colour = team.colour;
    colour.a -= tint.a;
    colour.b -= tint.b;
    team.name = name_of_colour(colour);
  }
  if (teams.size() < 2 || teams[0].name != teams[1].name) return;
  const bool first_lighter = teams[0].colour.lightness > teams[1].colour.lightness;
  teams[0].name = (first_lighter ? "light " : "dark ") + teams[0].name;
  teams[1].name = (first_lighter ? "dark " : "light ") + teams[1].name;
}

/// Mean of the `count` least values, m.
double mean_of_lowest(std::vector<double>& values, std::size_t count) {
  std::partial_sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count), values.end());
  return std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count), 0.0) / static_cast<double>(count);
}

/// The team whose last players stood nearer to the goal of `end` (0: x = 0) while the keeper was seen. All of a team say less: who
/// attacks has most of its players in the other half, and who defends leaves some in front.
std::optional<int> team_of_keeper(const Recording& recording, std::span<const Teams::Member> members, std::size_t keeper, int end) {
  double lead = 0;
  InstantRows rows(recording);
  for (const std::int32_t instant : recording.tracks()[keeper].at()) {
    std::array<std::vector<double>, 2> before_goal;
    for (const auto& [index, row] : rows.at(static_cast<std::size_t>(instant))) {
      const Teams::Member& member = members[index];
      if (member.role != Teams::Role::player || !member.team) continue;
      const double x = recording.tracks()[index].x()[row];
      before_goal[static_cast<std::size_t>(*member.team)].push_back(end == 0 ? x : -x);
    }
    const std::size_t last = std::min({last_players, before_goal[0].size(), before_goal[1].size()});
    if (last > 0) lead += mean_of_lowest(before_goal[0], last) - mean_of_lowest(before_goal[1], last);
  }
  if (lead == 0) return std::nullopt;
  return lead < 0 ? 0 : 1;
}

/// Every person's colour and time, for those who were seen long enough.
struct Candidates {
  std::vector<int> people;
  std::vector<ColourObserved> detected;
};

Candidates candidates(std::span<const Presence> presence, std::span<const std::optional<Appearance>> clothing, double shortest) {
  double longest = 0;
  for (const Presence& one : presence) longest = std::max(longest, one.seconds);
  Candidates result;
  for (std::size_t identity = 0; identity < presence.size(); ++identity) {
    if (!clothing[identity] || presence[identity].seconds < std::min(shortest, longest)) continue;
    result.people.push_back(static_cast<int>(identity));
    result.detected.push_back({*clothing[identity], std::max(presence[identity].seconds / std::max(longest, 1e-9), 1e-3)});
  }
  return result;
}

class Finder {
 public:
  Finder(const Recording& recording, std::span<const std::optional<Appearance>> clothing, const TeamOptions& options)
      : recording_(recording),
        options_(options),
        presence_(presences(recording, options.pitch)),
        candidates_(candidates(presence_, clothing, options.shortest)),
        mixture_(find_colours(candidates_.detected)) {}

  Teams find() {
    teams_.members.resize(recording_.tracks().size());
    const std::vector<std::size_t> kinds = choose_teams(mixture_, options_.names);
    for (std::size_t t = 0; t < kinds.size(); ++t) {
      Teams::Team team;
      if (kinds[t] < mixture_.kinds.size())
        team.colour = mixture_.kinds[kinds[t]].colour;
      else
        team.colour = options_.names[t].colour;
      if (!options_.names.empty()) team.name = options_.names[t].name;
      teams_.teams.push_back(team);
    }
    if (options_.names.empty()) name_by_colour(teams_.teams, layout_of(mixture_));
    vote(kinds);
    for (std::size_t i = 0; i < candidates_.people.size(); ++i) position_official(i);
    return std::move(teams_);
  }

 private:
  void vote(std::span<const std::size_t> kinds) {
    for (std::size_t i = 0; i < candidates_.people.size(); ++i) {
      Teams::Member& member = teams_.members[static_cast<std::size_t>(candidates_.people[i])];
      for (std::size_t t = 0; t < kinds.size(); ++t) {
        if (kinds[t] >= mixture_.kinds.size()) continue;
        const double probability = mixture_.membership[i][kinds[t]];
        if (probability <= member.confidence) continue;
        member.confidence = probability;
        member.team = static_cast<int>(t);
      }
      if (member.confidence >= options_.sure && !may_be_keeper(i, *member.team)) {
        member.role = Teams::Role::player;
        ++teams_.teams[static_cast<std::size_t>(*member.team)].people;
      } else {
        member = {};
      }
    }
  }

  /// Who is nearly always before a goal, and plainly not in the team's colour although no other is nearer.
  bool may_be_keeper(std::size_t candidate, int team) const {
    const ColourObserved& detected = candidates_.detected[candidate];
    const Presence& presence = presence_[static_cast<std::size_t>(candidates_.people[candidate])];
    const bool at_home = std::max(presence.near_goal[0], presence.near_goal[1]) >= keepers_time * presence.seconds;
    const double apart = colours_apart(detected.colour, teams_.teams[static_cast<std::size_t>(team)].colour);
    return at_home && presence.seconds > 0 && apart > colours_differ;
  }

  /// Who is in no team's colour: a keeper, a referee, or unknown.
  void position_official(std::size_t candidate) {
    const int identity = candidates_.people[candidate];
    Teams::Member& member = teams_.members[static_cast<std::size_t>(identity)];
    if (member.role != Teams::Role::unknown || teams_.teams.empty()) return;
    const ColourObserved& detected = candidates_.detected[candidate];
    double apart = 1e9;
    for (const Teams::Team& team : teams_.teams) apart = std::min(apart, colours_apart(detected.colour, team.colour));
    if (apart < another_colour + detected.colour.deviation / 2) return;
    const double confidence = std::clamp(1 - another_colour / (2 * apart), 0.0, 1.0);
    const Presence& presence = presence_[static_cast<std::size_t>(identity)];
    for (const int end : {0, 1}) {
      if (presence.near_goal[end] < keepers_time * presence.seconds || presence.seconds == 0) continue;
      member = {Teams::Role::keeper,
                teams_.teams.size() == 2 ? team_of_keeper(recording_, teams_.members, static_cast<std::size_t>(identity), end)
                                         : std::nullopt,
                confidence};
      return;
    }
    if (fraction_of_kind(candidate) <= officials) member = {Teams::Role::referee, std::nullopt, confidence};
  }

  /// How many wear what this one wears: of all people's time.
  double fraction_of_kind(std::size_t candidate) const {
    const std::vector<double>& membership = mixture_.membership[candidate];
    const auto likeliest = std::max_element(membership.begin(), membership.end());
    if (likeliest == membership.end() || *likeliest < 0.5) return 0;
    return mixture_.kinds[static_cast<std::size_t>(likeliest - membership.begin())].fraction;
  }

  const Recording& recording_;
  const TeamOptions& options_;
  std::vector<Presence> presence_;
  Candidates candidates_;
  ColourMixture mixture_;
  Teams teams_;
};

}  // namespace

std::vector<TeamName> parse_teams(std::string_view text) {
  std::vector<TeamName> names;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    const std::string_view one = text.substr(from, to - from);
    const std::size_t equals = one.find('=');
    const std::string name = trimmed(one.substr(0, equals));
    const std::string colour = equals == std::string_view::npos ? name : trimmed(one.substr(equals + 1));
    if (name.empty() || colour.empty()) {
      throw Error(
          fmt::format("teams \"{}\": a name or a colour is missing; give two, as in white,blue or City=sky blue,United=red", text));
    }
    names.push_back({name, colour_named(colour)});
    from = to + 1;
  }
  if (names.size() != 2) throw Error(fmt::format("teams \"{}\": there are {}; give two, as in white,blue", text, names.size()));
  if (names[0].name == names[1].name) throw Error(fmt::format("teams \"{}\": both have one name", text));
  return names;
}

Teams find_teams(const Recording& recording, std::span<const std::optional<Appearance>> clothing, const TeamOptions& options) {
  require_ground(recording, "finding teams");
  return Finder(recording, clothing, options).find();
}

void note_teams(const Teams& teams, Recording& recording) {
  for (std::size_t identity = 0; identity < recording.tracks().size(); ++identity) {
    const Teams::Member& member = teams.members[identity];
    TrackName name = recording.tracks()[identity].name;
    name.team = member.team ? teams.teams[static_cast<std::size_t>(*member.team)].name : std::string();
    if (name.label.empty() && member.role == Teams::Role::keeper) name.label = "keeper";
    if (name.label.empty() && member.role == Teams::Role::referee) name.label = "referee";
    recording.set_name(name);
  }
}

}  // namespace marey::analyse
