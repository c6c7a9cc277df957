// What is uncertain about who is who, as questions that a person who sees the match answers with yes, no or a name; and what the
// answers mean as edits.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/recording.h"
#include "marey/pipeline/identify/edits.h"

namespace marey::pipeline::identify {

/// s: two who met again sooner are asked for once, and an exchange that was made by hand so near is the one that is asked for.
constexpr double kOneEncounter = 4;

/// One row of the list.
struct ReviewItem {
  double time_s = 0;       ///< from the recording's beginning
  std::string kind;        ///< "exchange": did two change places? "same": is it still the same one? "who": who is it?
  std::string question;    ///< "1:03.2 near (34, 20) m: did 7 Kane and 10 Son change places?"
  std::string a, b;        ///< tracks as "#5 7 Kane"; `b` of "who": names with their probabilities, "7 Kane 0.62; 10 Son 0.21"
  std::int64_t frame = 0;  ///< from which on the answer counts
  double probability = 0;  ///< that what the take says is wrong: of "who", that it is a person of the roster
  std::int64_t edit = 0;   ///< the last one that counted when this was listed; 0: none
  double changes_s = 0;    ///< s of person-time that have another name after the answer that is not the take's; as of listing
  std::string answer = {};
  std::string where = {};  ///< "doubts.csv:3", of a list that was read
};

/// The likeliest to be wrong first. Nothing that is less probable than `least`.
std::vector<ReviewItem> review_items_of(const track::ground::offline::GroundIdentities& found, const TrackedPeople& people,
                                        const NamedPaths& named, const Recording& recording, const std::vector<SquadMember>& squads,
                                        double minimum);

std::string review_csv(const std::vector<ReviewItem>& review_items);
/// Throws Error, with file and line, where a row is not as `review_csv` writes it.
std::vector<ReviewItem> parse_review_items(std::string_view text, const std::string& name);
std::vector<ReviewItem> read_review_items(const std::string& path);

struct AnswerEdits {
  std::vector<take::EditRequest> edits;
  std::int64_t before = 0;  ///< rows whose answers were applied already
};

/// The edits of all rows that are answered, in the order of time; none for blank answers, and none for what was applied already, by
/// answers or by hand. `recording` as the take is now, with its edits, which `history` has. Throws Error, with file and line, for
/// an answer that is not one, and a row that the take no longer fits. Names that are not in the take are taken as the roster has
/// them.
AnswerEdits edits_of_answers(const std::vector<ReviewItem>& review_items, const Recording& recording,
                             const take::EditHistory& history, const std::vector<SquadMember>& squads, TrackId initiated);

}  // namespace marey::pipeline::identify
