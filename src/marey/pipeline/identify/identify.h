// Who is who in a take of people on the ground: names that people gave are carried along, what is uncertain is listed, and answers
// are applied. Nothing recorded is changed; all of it are edits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/detect/shirts/number_votes.h"
#include "marey/pipeline/identify/review.h"

namespace marey::pipeline::identify {

struct IdentifyOptions {
  std::string roster;   ///< CSV: number,name,team
  std::string names;    ///< CSV: time,id,name; may be empty if `numbers` is given
  std::string numbers;  ///< CSV of read shirt numbers: id,number,probability,readings,time; may be empty
  double min_number = detect::shirts::kDecisiveNumber;  ///< a less probable number is not used
  std::string review_items;                             ///< CSV to be written; empty: not
  double minimum = 0.02;                                ///< what is less probable to be wrong is not listed
};

struct IdentifySummary {
  struct Person {
    std::string label, team;
    int track = 0;
    double known_s = 0;
  };
  double recorded_s = 0;
  std::vector<Person> people;  ///< who were named, in the roster's order
  double unnamed_s = 0;        ///< that others are there for, together
  std::int64_t excluded = 0;   ///< places that were deleted: of a person who is elsewhere then, or between two people
  std::vector<ReviewItem> review_items;
  std::vector<std::string> unused_numbers;  ///< a sentence for each number that is probable enough and is not used
  std::int64_t numbered = 0;                ///< people that were named by a number
  std::int64_t edits = 0;
};

/// Names people and carries the names on. Throws Error, and changes nothing, for what does not fit: see format/match/squads.h,
/// people.h and numbers.h.
IdentifySummary name_people(const std::string& take, const IdentifyOptions& options, const Hooks& hooks = {});

struct AnswerSummary {
  std::int64_t answered = 0, blank = 0;
  std::int64_t before = 0;  ///< of those answered, how many were applied already
  std::int64_t edits = 0;
};

/// Applies the answers of a list of doubts, all or none. `roster` may be empty.
AnswerSummary apply_answers(const std::string& take, const std::string& review_items, const std::string& roster,
                            const Hooks& hooks = {});

}  // namespace marey::pipeline::identify
