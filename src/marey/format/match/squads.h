// The lists that people keep beside a match, as CSV with a row of names on top: the players (`number,name,team`, and if wanted
// `role,in,out`), and who was recognised where (`time,id,name`, and if wanted `team`).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marey::format::match {

enum class SquadRole { player, keeper, referee };

struct SquadMember {
  std::string number;  ///< of the shirt; empty if absent
  std::string name;
  std::string team;  ///< "Referees" for a referee that the list does not describe
  SquadRole role = SquadRole::player;
  std::optional<double> in_s, out_s;  ///< from the recording's beginning, where the list says so

  /// "7 Kane"; what a track is called.
  std::string label() const;
};

/// Throws Error, one sentence with file and line, where a number or a name occurs twice in one team, or a row is not as it should
/// be.
std::vector<SquadMember> parse_squads(std::string_view text, const std::string& name);
std::vector<SquadMember> read_squads(const std::string& path);

/// A person was recognised.
struct SquadNaming {
  double time_s = 0;  ///< from the recording's beginning
  int track = 0;
  int member = 0;     ///< index into the squads
  std::string where;  ///< "names.csv:3"
};

/// The member that is meant: "Kane", "7 Kane", "7" where only one team has it, "7 Spurs" or "Spurs 7". Throws Error, which begins
/// with `where`, if it is absent or ambiguous.
int member_called(const std::string& called, const std::string& team, const std::vector<SquadMember>& squads,
                  const std::string& where);

/// By time. Throws Error as above.
std::vector<SquadNaming> parse_namings(std::string_view text, const std::string& name, const std::vector<SquadMember>& squads);
std::vector<SquadNaming> read_namings(const std::string& path, const std::vector<SquadMember>& squads);

/// 63.2, 1:03.2 or 0:01:03.2 in seconds; nothing for what is not one.
std::optional<double> seconds_of_clock(std::string_view text);
/// "1:03.2".
std::string clock_of_seconds(double seconds);

}  // namespace marey::format::match
